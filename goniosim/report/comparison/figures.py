"""All figures of a comparison, written as PNG and SVG."""

from ...writing import file_name
from . import entries
from .cost import cost_figure
from .errors import errors_figure
from .sheets import overviews, single_directions

FORMATS = ("png", "svg")
EXTENTS = ("all", "overview", "none")


def material_figures(comparison, folder, extent="all"):
    """Figures of one material.

    Parameters
    ----------
    comparison : goniosim.compare.material.MaterialComparison
    folder : Path
    extent : str
        ``all``, ``overview`` (lobes and views, all directions in one figure) or ``none``.

    Returns
    -------
    list of tuple
        Arguments of `goniosim.report.drawing.files.write_figure`.
    """
    if not comparison.variants or extent == "none":
        return []
    name, component = comparison.result.name, comparison.components[0]
    seen = [entries.of_comparison(comparison, number) for number in range(len(comparison.result.theta_deg))]
    figures = overviews(name, component, seen, folder / file_name(name), FORMATS)
    if extent == "all":
        figures += single_directions(name, component, seen, folder / file_name(name), FORMATS)
    return figures


def joint_figures(summaries, folder):
    """Figures of all materials together: errors, and errors against cost.

    Parameters
    ----------
    summaries : list of goniosim.compare.summary.Summary
    folder : Path

    Returns
    -------
    list of tuple
        As from `material_figures`.
    """
    if not any(summary.overall() for summary in summaries):
        return []
    return [
        (folder / "errors", FORMATS, errors_figure, summaries),
        (folder / "cost", FORMATS, cost_figure, summaries),
    ]
