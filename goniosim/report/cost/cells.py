"""Where cells limit: how much of the norm of a slice is lost by averaging over its cells, seen on finer ones."""

import numpy as np

from ...scene.model import MAX_CELLS
from .norms import difference
from .runs import sampled

# Fine cells along each side of a cell; and of a cell of twice the width.
FINER = 2
MOST_DIRECTIONS = 3


def finer_scene(scene):
    """The scene on finer cells, for a few of its directions; None if there would be too many cells.

    Parameters
    ----------
    scene : goniosim.scene.Scene

    Returns
    -------
    goniosim.scene.Scene or None
    """
    rows, columns = scene.slice.rows * FINER, scene.slice.columns * FINER
    if rows * columns > MAX_CELLS:
        return None
    angles = scene.incident.theta_deg
    places = np.linspace(0, len(angles) - 1, min(len(angles), MOST_DIRECTIONS)).round().astype(int)
    return scene.model_copy(
        update={
            "slice": scene.slice.model_copy(update={"rows": rows, "columns": columns}),
            "incident": scene.incident.model_copy(update={"theta_deg": tuple(angles[i] for i in places)}),
        }
    )


def lost_to_cells(result):
    """What averaging over cells takes away from the norm of each sampled component.

    Parameters
    ----------
    result : goniosim.result.Result
        Of `finer_scene`.

    Returns
    -------
    dict of str to list of dict
        For the cells of the scene and for cells of twice their width: ``rows``, ``columns``, ``lost`` (norm of the
        slice minus its averages, over that of the slice, the largest of the directions) and its standard error
        ``uncertainty``; nothing where light leaves in one exact direction, for which no cell is fine enough.
    """
    found = {}
    for name, component in sampled(result).items():
        if component.contains_delta:
            continue
        rows, columns = component.energy.shape[2:]
        sides = [side for side in (FINER, 2 * FINER) if rows % side == columns % side == 0]
        found[name] = [
            {"rows": rows // side, "columns": columns // side} | _lost(component, result.cells, side) for side in sides
        ]
    return found


def _lost(component, cells, side):
    """``lost`` and ``uncertainty`` for blocks of ``side`` x ``side`` cells."""
    worst = 0.0, 0.0
    for m in range(len(component.energy)):
        # An invalid cell may have no size; its block does not count.
        whole = _blocks(cells.valid[m], side).all(axis=(-1, -2))[..., None, None]
        size = np.where(whole, _blocks(cells.projected_solid_angle[m], side), 0.0)
        f, variance = (_blocks(a[m], side) for a in (component.bsdf, component.bsdf_stderr**2))
        share = size / np.maximum(size.sum(axis=(-1, -2), keepdims=True), 1e-300)
        away = f - (share * f).sum(axis=(-1, -2), keepdims=True)
        # The mean follows the noise of each cell by its share.
        noise = variance * (1.0 - 2.0 * share) + (share**2 * variance).sum(axis=(-1, -2), keepdims=True)
        worst = max(worst, difference(away, noise, f**2 - variance, size))
    return dict(zip(("lost", "uncertainty"), worst, strict=True))


def _blocks(values, side):
    """Values (..., R, K) as (..., R / side, K / side, side, side)."""
    rows, columns = values.shape[-2:]
    parts = values.reshape(*values.shape[:-2], rows // side, side, columns // side, side)
    return np.swapaxes(parts, -3, -2)
