"""Figures as files: one look, one resolution, and the same bytes for the same figure."""

import contextlib
import os
import re
from pathlib import Path

from matplotlib import rc_context, rcdefaults, rcParams

from ...errors import OutputError
from ...writing import explained, replacing

STYLE = {
    "figure.dpi": 150,
    "font.size": 9.0,
    "axes.edgecolor": "0.4",
    "axes.labelcolor": "0.2",
    "xtick.color": "0.3",
    "ytick.color": "0.3",
    # No random names inside an SVG.
    "svg.hashsalt": "goniosim",
    # Disks that share their axes stay pictures of their own.
    "image.composite_image": False,
}
# By this a figure is known for one of ours; no date, so that equal figures are equal files.
MAKER = "goniosim"
_METADATA = {
    "png": {"Software": MAKER},
    "svg": {"Creator": MAKER, "Date": None},
    "pdf": {"Creator": MAKER, "CreationDate": None},
}
_MARKS = {
    "png": re.compile(rb"\x89PNG.{,200}tEXtSoftware\0goniosim", re.DOTALL),
    "svg": re.compile(rb"<\?xml.{,2000}<dc:creator>\s*<cc:Agent>\s*<dc:title>goniosim<", re.DOTALL),
    "pdf": re.compile(rb"%PDF.*/Creator \(goniosim\)", re.DOTALL),
}


@contextlib.contextmanager
def own_style():
    """While active, figures look as those of goniosim do, whatever the user's settings say."""
    # Figures have no date; matplotlib reads the variable all the same, and fails on what is no number.
    date = os.environ.pop("SOURCE_DATE_EPOCH", None)
    try:
        with _own_settings():
            yield
    finally:
        if date is not None:
            os.environ["SOURCE_DATE_EPOCH"] = date


@contextlib.contextmanager
def _own_settings():
    with rc_context():
        rcdefaults()
        rcParams.update(STYLE)
        yield


def write_figure(stem, suffixes, make, *arguments):
    """Draw a figure and write it, whole or not at all.

    Parameters
    ----------
    stem : Path
        The files without their endings; the folder exists.
    suffixes : sequence of str
        From ``png``, ``svg`` and ``pdf``: one file for each.
    make : callable
        ``make(*arguments)`` returns the `matplotlib.figure.Figure`.

    Returns
    -------
    list of Path

    Raises
    ------
    OutputError
    """
    written = []
    with own_style():
        figure = make(*arguments)
        for suffix in suffixes:
            path = stem.with_name(f"{stem.name}.{suffix}")
            with replacing(path) as temporary:
                figure.savefig(temporary, format=suffix, dpi="figure", metadata=_METADATA[suffix])
            written.append(path)
    return written


def refuse_foreign(paths):
    """Make sure, before anything is drawn, that only figures of goniosim will be replaced.

    Parameters
    ----------
    paths : iterable of path-like

    Raises
    ------
    OutputError
    """
    for path in map(Path, paths):
        with explained(path):
            exists = path.exists()
        if exists and not is_figure(path):
            raise OutputError(
                f"{path}: exists and is not a figure that goniosim drew, so it is not overwritten; "
                "choose another folder with -o, or remove it"
            )


def is_figure(path):
    """Whether a file is a figure that `write_figure` wrote."""
    mark = _MARKS.get(path.suffix[1:])
    if mark is None or not path.is_file():
        return False
    try:
        return mark.match(path.read_bytes()) is not None
    except OSError:
        return False
