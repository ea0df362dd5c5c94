"""Figures of a result: an overview, and one for each incident direction."""

import numpy as np
from matplotlib import rc_context

from ...errors import OutputError, UnusableResultError
from .. import text
from .direction import direction_figure
from .overview import overview_figure

DPI = 150

# The same file for the same result: no dates, no random names inside an SVG.
STYLE = {
    "font.size": 9.0,
    "axes.edgecolor": "0.4",
    "axes.labelcolor": "0.2",
    "xtick.color": "0.3",
    "ytick.color": "0.3",
    "svg.hashsalt": "goniosim",
}
WITHOUT_DATE = {"png": {}, "svg": {"Date": None}, "pdf": {"CreationDate": None}}


def draw(result, folder, stem, *, suffix="png", theta_deg=None):
    """Draw the figures of a result and write them.

    Parameters
    ----------
    result : goniosim.result.Result
    folder : Path
        Created if it does not exist.
    stem : str
        Beginning of the file names.
    suffix : str
        ``png``, ``svg`` or ``pdf``.
    theta_deg : sequence of float, optional
        Only the figures of these directions, without the overview.

    Returns
    -------
    list of Path
        Files written: ``<stem>.<suffix>`` (the overview) and ``<stem>-theta_<angle>.<suffix>``.

    Raises
    ------
    UnusableResultError
        If an angle was not simulated.
    OutputError
        If a file cannot be written.
    """
    figures = {} if theta_deg else {folder / f"{stem}.{suffix}": lambda: overview_figure(result)}
    for i in _directions(result, theta_deg):
        angle = text.degrees(result.theta_deg[i])
        figures[folder / f"{stem}-theta_{angle}.{suffix}"] = lambda i=i: direction_figure(result, i)
    place = folder
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with rc_context(STYLE):
            for place, make in figures.items():
                make().savefig(place, dpi=DPI, metadata=WITHOUT_DATE[suffix])
    except OSError as error:
        raise OutputError(f"{place}: cannot be written: {error.strerror}; choose another place") from error
    return list(figures)


def _directions(result, theta_deg):
    if not theta_deg:
        return range(len(result.theta_deg))
    chosen = []
    for angle in theta_deg:
        (found,) = np.nonzero(np.isclose(result.theta_deg, angle, rtol=0.0, atol=1e-6))
        if not found.size:
            simulated = ", ".join(map(text.degrees, result.theta_deg))
            raise UnusableResultError(f"theta {text.degrees(angle)} was not simulated; there is {simulated}")
        chosen.append(int(found[0]))
    return chosen
