"""The figures of one material, whether its models are compared with a simulation or stand alone."""

from ..drawing import directions
from .direction import direction_figure
from .lobes import lobes_figure
from .views import views_figure

# Of more directions, some stand for all in the overviews.
MOST = 12


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
        Arguments of `goniosim.report.drawing.files.write_figure`.
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
            stem.with_name(f"{stem.name}-lobes-theta_{direction.angle}"),
            suffixes,
            direction_figure,
            name,
            component,
            direction,
        )
        for direction in seen
    ]
