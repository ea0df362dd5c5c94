"""Figures as files: one look, one resolution, and the same bytes for the same figure."""

from matplotlib import rc_context, rcdefaults, rcParams

from ...writing import replacing

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
_WITHOUT_DATE = {"png": {}, "svg": {"Date": None}, "pdf": {"CreationDate": None}}


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
    with rc_context():
        # Not what the user's settings say.
        rcdefaults()
        rcParams.update(STYLE)
        figure = make(*arguments)
        for suffix in suffixes:
            path = stem.with_name(f"{stem.name}.{suffix}")
            with replacing(path) as temporary:
                figure.savefig(temporary, format=suffix, dpi="figure", metadata=_WITHOUT_DATE[suffix])
            written.append(path)
    return written
