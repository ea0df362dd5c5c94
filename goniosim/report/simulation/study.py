"""The materials of a study, one line each."""

import os

import numpy as np

from .. import text
from .audit import albedos


def row(result, path):
    """Sum up one result of a study.

    Parameters
    ----------
    result : goniosim.result.Result
    path : path
        File that holds it.

    Returns
    -------
    list of str
        One entry for each column of `study_text`.
    """
    traced = result.rays > 0
    albedo = [float(np.mean(value[traced])) for value, _ in albedos(result).values()]
    lost = sum(energy for name, energy in result.audit.energy.items() if name.startswith("lost_masked"))
    cost = result.cost
    seconds = float(cost.elapsed[-1]) if cost.checkpoints else 0.0
    return [
        result.name,
        result.status,
        text.counts(result.rays),
        text.duration(seconds),
        f"{sum(albedo):.4f}",
        f"{100.0 * float(np.max(lost)):.1f} %",
        f"{noise(result):.1e}",
        text.size(os.path.getsize(path)),
    ]


def noise(result):
    """Noise of a result in sr^-1/2, the largest of its components and directions; 0 of what has none."""
    cost = result.cost
    return max((float(cost.noise(name)[-1]) for name in cost.error if cost.checkpoints), default=0.0)


def study_text(rows):
    """Lay out the rows of a study as a table.

    Parameters
    ----------
    rows : list of list of str
        From `row`.

    Returns
    -------
    str
    """
    header = [
        "material",
        "status",
        "rays per\ndirection",
        "time",
        "mean\nalbedo",
        "lost to\nmasking",
        "noise\n[sr^-1/2]",
        "file size",
    ]
    return "\n".join(
        [
            *text.table(header, rows),
            "  Mean albedo: all components, mean over directions and channels; lost: the most of any",
            "  direction and channel, a property of the single-scattering model.",
        ]
    )
