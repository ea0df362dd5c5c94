"""All figures of a comparison, written as PNG and SVG."""

from .. import text
from ..drawing import directions
from . import entries
from .cost import cost_figure
from .direction import direction_figure
from .errors import errors_figure
from .lobes import lobes_figure
from .views import views_figure

FORMATS = ("png", "svg")
EXTENTS = ("all", "overview", "none")
# Of more directions, some stand for all in the overviews.
MOST = 12


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
    figures = overviews(name, component, seen, folder / name, FORMATS)
    if extent == "all":
        figures += single_directions(name, component, seen, folder / name, FORMATS)
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


def overviews(name, component, seen, stem, suffixes):
    """Figures in which all directions stand together.

    Parameters
    ----------
    name, component : str
        For the titles.
    seen : list of goniosim.report.comparison.entries.Direction
    stem : Path
        Beginning of the file names.
    suffixes : sequence of str

    Returns
    -------
    list of tuple
        As from `material_figures`.
    """
    shown = [seen[number] for number in directions.spread(len(seen), MOST)]
    return [
        (stem.with_name(f"{stem.name}-{kind}"), suffixes, make, name, component, shown)
        for kind, make in (("lobes", lobes_figure), ("views", views_figure))
    ]


def single_directions(name, component, seen, stem, suffixes):
    """A figure for each direction; arguments and result as in `overviews`."""
    return [
        (
            stem.with_name(f"{stem.name}-lobes-theta_{text.degrees(direction.theta_deg)}"),
            suffixes,
            direction_figure,
            name,
            component,
            direction,
        )
        for direction in seen
    ]
