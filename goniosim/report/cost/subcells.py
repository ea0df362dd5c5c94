"""Where sub-cells limit: models integrated with n x n sub-cells per cell, against an integration to convergence."""

import numpy as np

from ...compare.cells import to_slice
from ...compare.convergence import converge
from ...compare.variants import components_for
from ...integration import Grid, Pool, integrate_fixed
from ...models import MODELS, prepare
from ...slices import slice_geometry

# Sub-cells along each side of a cell; 5 is what `compare` takes.
SIDES = (1, 3, 5, 9, 15)


def subcell_errors(scene):
    """Errors of the fixed integration of every model that applies, in the middle one of the directions.

    Parameters
    ----------
    scene : goniosim.scene.Scene

    Returns
    -------
    dict
        ``component``; ``theta_deg``; ``models``: for each, relative errors by the ``n`` of `SIDES`, or nothing where
        no model applies.
    """
    theta = sorted(scene.incident.theta_deg)[len(scene.incident.theta_deg) // 2]
    component = components_for(scene)[0]
    grid = _grid(scene.slice, theta)
    models = {}
    with Pool() as pool:
        for name, model in MODELS.items():
            if model.supports(scene, component) is None:
                models[name] = _errors(prepare(name, scene, theta, component), grid, pool)
    return {"component": component, "theta_deg": theta, "models": models}


def _grid(chosen, theta):
    geometry = slice_geometry(chosen.parametrization, chosen.rows, chosen.columns, theta)
    return Grid(
        parametrization=chosen.parametrization,
        rows=chosen.rows,
        columns=chosen.columns,
        theta_deg=theta,
        valid=geometry.valid,
        projected_solid_angle=geometry.projected_solid_angle,
    )


def _errors(prepared, grid, pool):
    found = {n: integrate_fixed(prepared, grid, n, pool) for n in SIDES}
    exact = converge(prepared, grid, max(SIDES), pool, *found[max(SIDES)]).converged
    norm = _norm(prepared, grid, exact)
    return {n: _norm(prepared, grid, energy - exact) / norm if norm > 0.0 else 0.0 for n, (energy, _) in found.items()}


def _norm(prepared, grid, energy):
    """Norm of Eq. 4 of a slice, mean over the channels; what leaves in one exact direction is not integrated."""
    full = to_slice(prepared, grid, energy)
    if np.any(prepared.mirror_energy):
        full = full - to_slice(prepared, grid, np.zeros_like(energy))
    size = grid.projected_solid_angle
    squares = np.divide(full**2, size, out=np.zeros_like(full), where=grid.valid & (size > 0.0))
    return float(np.sqrt(squares.sum(axis=(1, 2))).mean())
