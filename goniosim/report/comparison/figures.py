"""All figures of a comparison, written as PNG and SVG."""

import numpy as np
from matplotlib import rc_context

from ...errors import OutputError
from ..simulation.figures import DPI, STYLE, WITHOUT_DATE
from .cost import cost_figure
from .errors import errors_figure
from .lobes import lobes_figure
from .views import views_figure

FORMATS = ("png", "svg")
# Of more directions, some evenly picked ones stand for all.
MOST = 12


def draw_material(comparison, folder):
    """Draw the figures of one material: its lobes, and its top views.

    Parameters
    ----------
    comparison : goniosim.compare.material.MaterialComparison
    folder : Path
        Exists.

    Returns
    -------
    list of Path
    """
    if not comparison.variants:
        return []
    n = len(comparison.result.theta_deg)
    directions = sorted(set(np.linspace(0, n - 1, min(n, MOST)).round().astype(int).tolist()))
    name = comparison.result.name
    return _write(
        {
            folder / f"{name}-lobes": lambda: lobes_figure(comparison, directions),
            folder / f"{name}-views": lambda: views_figure(comparison, directions),
        }
    )


def draw_joint(summaries, folder):
    """Draw the figures of all materials together: errors, and errors against cost.

    Parameters
    ----------
    summaries : list of goniosim.compare.summary.Summary
    folder : Path
        Exists.

    Returns
    -------
    list of Path
    """
    if not any(summary.overall() for summary in summaries):
        return []
    return _write(
        {
            folder / "errors": lambda: errors_figure(summaries),
            folder / "cost": lambda: cost_figure(summaries),
        }
    )


def _write(figures):
    written = []
    with rc_context(STYLE):
        for stem, make in figures.items():
            figure = make()
            for suffix in FORMATS:
                path = stem.with_name(f"{stem.name}.{suffix}")
                try:
                    figure.savefig(path, dpi=DPI, metadata=WITHOUT_DATE[suffix])
                except OSError as error:
                    raise OutputError(f"{path}: cannot be written: {error.strerror}; choose another place") from error
                written.append(path)
    return written
