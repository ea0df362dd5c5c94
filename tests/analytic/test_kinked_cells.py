"""Total reflection begins on an arc through the cells: their integrals are right to the errors that they state."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from goniosim.compare.convergence import TOLERANCE, converge
from goniosim.engine import direct
from goniosim.engine.direct import ABSOLUTE_TOLERANCE, RELATIVE_TOLERANCE, direct_reflection
from goniosim.engine.plan import make_plan
from goniosim.integration import Grid, Pool, find_lobe, integrate_adaptively, integrate_fixed
from goniosim.slices import slice_geometry
from reference.closed_forms import reflection_density
from reference.kinked_cells import integrate_kinked_cells
from reference.scenes import dielectric, make_scene

# Index, alpha, angle, slice. The first one was once off by 200 times the stated error, and single cells by 200 000.
CASES = [
    (0.8, 0.1, 53.13, "classic", 18, 36),
    (0.5, 0.3, 20.0, "classic", 18, 36),
    (0.95, 0.2, 60.0, "classic", 18, 36),
    (0.5, 0.3, 40.0, "half", 18, 36),
    (0.95, 0.2, 85.0, "half", 18, 36),
    # The arc meets the horizon.
    (0.8, 0.15, 55.5, "half", 18, 18),
    # The arc passes the pole, where the cells end, at less than a degree.
    (0.32, 0.8, 37.1, "classic", 6, 8),
]
FINE = [
    (0.8, 1.0, 53.13, "classic", 90, 360),
    (0.8, 1.0, 53.13, "half", 90, 360),
    (0.8, 0.1, 80.0, "classic", 90, 360),
]


@pytest.fixture(scope="module")
def pool():
    with Pool(1) as threads:
        yield threads


def exact_cells(eta, alpha, theta_deg, parametrization, rows, columns, nodes=24):
    beyond = math.sqrt(1.0 - eta * eta)
    return integrate_kinked_cells(
        reflection_density(alpha, eta), beyond, theta_deg, rows, columns, parametrization, nodes
    )


@pytest.mark.parametrize("case", [*CASES, *(pytest.param(*[case], marks=pytest.mark.slow) for case in FINE)])
def test_the_direct_reflection_of_a_rarer_medium(pool, case):
    """Arcs once cut off corners of cells that no node saw."""
    eta, alpha, theta_deg, parametrization, rows, columns = case
    scene = make_scene([dielectric(eta, alpha)], theta_deg, parametrization, rows=rows, columns=columns)
    (energy,), (error,) = (each[:1] for each in direct_reflection(make_plan(scene), 0, pool))
    exact = exact_cells(*case)
    # The exact integrals are good to 2e-11 of the slice.
    allowed = 3.0 * error + 3.0 * (RELATIVE_TOLERANCE * exact + ABSOLUTE_TOLERANCE)
    assert (np.abs(energy - exact) <= allowed + 3e-11 * exact.max()).all()
    assert abs((energy - exact).sum()) <= 3.0 * error.sum() + RELATIVE_TOLERANCE
    # Nor are they stated where there is nothing to fear.
    assert error.sum() < 1e-7


@pytest.mark.parametrize("relative", [1e-4, 1e-6])
@pytest.mark.parametrize("case", [CASES[0], CASES[3]])
def test_the_rule_of_models(pool, case, relative):
    """Three nodes see less of a cell than five."""
    model, grid = model_of(*case)
    lobe = find_lobe(grid, grid.light, model.narrowest)
    found = integrate_adaptively(model, grid, pool, grid.all_numbers, relative=relative, lobe=lobe, nodes=3)
    energy, error = (grid.unfold(each)[0] for each in (found.energy, found.error))
    exact = exact_cells(*case)
    assert (np.abs(energy - exact) <= 3.0 * error + 3.0 * relative * exact + 1e-11).all()
    assert abs((energy - exact).sum()) <= 3.0 * error.sum() + relative


def test_a_comparison_converges_at_a_kink(pool):
    case = CASES[0]
    model, grid = model_of(*case)
    levels = converge(model, grid, 5, pool, *integrate_fixed(model, grid, 5, pool))
    off = levels.converged[0] - exact_cells(*case)[:, : grid.half_columns].ravel()[grid.numbers]
    size = grid.projected_solid_angle[:, : grid.half_columns].ravel()[grid.numbers]
    assert levels.integration == "adaptive"
    assert (off**2 / size).sum() < TOLERANCE**2 * (levels.converged[0] ** 2 / size).sum()


def model_of(eta, alpha, theta_deg, parametrization, rows, columns):
    """A rough dielectric as a model prepares it, and its grid."""
    geometry = slice_geometry(parametrization, rows, columns, theta_deg)
    grid = Grid(parametrization, rows, columns, theta_deg, geometry.valid, geometry.projected_solid_angle)
    tables = (direct.ROUGH_DIELECTRIC, alpha, eta, np.zeros((2, 1)))
    return SimpleNamespace(kernel=direct.evaluate, tables=tables, light=grid.light, channels=1, narrowest=alpha), grid
