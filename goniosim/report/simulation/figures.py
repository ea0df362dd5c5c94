"""Figures of a result: an overview, and one for each incident direction."""

from ...writing import make_folder
from .. import text
from ..drawing import directions
from ..drawing.figure import styled
from ..drawing.files import refuse_foreign, write_figure
from .direction import direction_figure
from .overview import overview_figure


def figure(result, theta_deg=None):
    """Draw one figure of a result.

    Parameters
    ----------
    result : goniosim.result.Result
    theta_deg : float, optional
        The direction; without it, the overview.

    Returns
    -------
    goniosim.report.drawing.figure.Figure

    Raises
    ------
    UnusableResultError
        If the angle was not simulated.
    """
    if theta_deg is None:
        return styled(overview_figure, result)
    (i,) = directions.chosen(result.theta_deg, [float(theta_deg)])
    return styled(direction_figure, result, i)


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
        If a file cannot be written, or something else stands there than a figure of goniosim.
    """
    numbers = directions.chosen(result.theta_deg, theta_deg)
    shown = text.angles(result.theta_deg)
    make_folder(folder)
    figures = [] if theta_deg else [(folder / stem, [suffix], overview_figure, result)]
    figures += [(folder / f"{stem}-theta_{shown[i]}", [suffix], direction_figure, result, i) for i in numbers]
    refuse_foreign(f"{figure[0]}.{suffix}" for figure in figures)
    return [path for figure in figures for path in write_figure(*figure)]
