"""What Python shows of a result and its parts: a few lines, and never their arrays."""

import numpy as np

from ..result import Audit, Cells, Component, Cost, Result
from . import text

# Of more angles, the first and the last few stand for all.
MOST_ANGLES = 10


def result(result: Result) -> str:
    """Name, status, directions, slices, rays, and the mean albedo of each component."""
    albedos = ", ".join(f"{name} {_mean_albedo(result, name)}" for name in result.components)
    lines = [
        f"<Result {result.name} ({result.status})",
        f"incident theta [deg]: {angles(result.theta_deg)}",
        f"{_grid(result.cells)}, channels {', '.join(result.channels)}",
        f"rays per direction: {text.counts(result.rays)}, seed {result.seed}",
        f"mean albedo: {albedos}>",
    ]
    return "\n  ".join(lines)


def component(component: Component) -> str:
    """Shape, mean albedo and kind of a component."""
    directions, channels, rows, columns = component.energy.shape
    albedo = component.energy.sum() / (directions * channels)
    kind = "integrated"
    if component.sampled:
        kind = f"sampled ({', '.join(dict.fromkeys(component.estimator))})"
    if component.hits is not None:
        kind += f", {text.count(component.hits.sum())} hits"
    parts = [f"{directions} directions, {channels} channels, {rows} x {columns} cells", kind]
    parts.append(f"mean albedo {albedo:.4g}")
    if component.contains_delta:
        parts.append("with a Dirac part")
    if component.orders:
        parts.append(f"split into {', '.join(component.orders)}")
    return f"<Component: {', '.join(parts)}>"


def cells(cells: Cells) -> str:
    """Parametrization, size and how many cells are valid."""
    valid = "all valid" if cells.valid.all() else f"{100.0 * cells.valid.mean():.3g} % of them valid"
    return f"<Cells: {_grid(cells)}, {valid}>"


def audit(audit: Audit) -> str:
    """Where the energy went, mean over directions and channels."""
    energies = {name: float(np.mean(energy)) for name, energy in audit.energy.items()}
    shown = ", ".join(f"{name} {energy:.3g}" for name, energy in energies.items() if energy)
    return f"<Audit, mean shares of the incident energy: {shown or 'nothing was traced'}>"


def cost(cost: Cost) -> str:
    """Rays, time and noise at the last checkpoint."""
    if not cost.checkpoints:
        return "<Cost: no checkpoints>"
    noise = "".join(f", noise of {name} {cost.noise(name)[-1]:.2g} sr^-1/2" for name in cost.error)
    rays = text.count(round(cost.rays[:, -1].mean()))
    return f"<Cost: {rays} rays per direction in {text.duration(cost.elapsed[-1])}{noise}>"


def angles(theta_deg: np.ndarray) -> str:
    """Format angles in degrees, many of them by the first and the last few."""
    shown = [text.degrees(theta) for theta in theta_deg]
    if len(shown) > MOST_ANGLES:
        shown = [*shown[:3], "...", *shown[-2:]]
        return f"{', '.join(shown)} ({len(theta_deg)} directions)"
    return ", ".join(shown)


def _grid(cells: Cells) -> str:
    rows, columns = len(cells.row_edges) - 1, len(cells.column_edges) - 1
    return f"{cells.parametrization} slices of {rows} x {columns} cells"


def _mean_albedo(result: Result, name: str) -> str:
    if not result.rays.any():
        return "not traced"
    value, stderr = (array[result.rays > 0] for array in result.albedo(name))
    # Directions are independent; channels share their paths.
    error = np.sqrt((stderr**2).sum(axis=0)).mean() / len(stderr)
    return text.with_error(value.mean(), error)
