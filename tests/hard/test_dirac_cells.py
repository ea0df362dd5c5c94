"""Light that leaves a stack of smooth interfaces lands in one cell, by the tie rule.

Mirror directions of whole degrees fall on the corners of cells. Edges belong to
the cell with the higher number, poles to row 0 and column 0; rounding within the
walk must never scatter such light over the neighbours.
"""

import math

import numpy as np
import pytest

from goniosim.engine import simulate
from reference.scenes import conductor, dielectric, make_scene, medium

THETAS = list(range(90)) + [0.5, 17.25, 44.999, 89.5, 89.99]
COLUMNS = 36
# The edges of half slices have nothing to do with whole degrees.
FEW_THETAS = [0, 1, 30, 45, 60, 89, 89.99]

STACKS = {
    "mirror": [conductor(1.45, 1.0)],
    "slab": [dielectric(1.5), medium(0.1), dielectric(1.0)],
    "metal": [dielectric(1.5), medium(0.1), conductor(1.45, 1.0)],
    "ladder": [dielectric(n) for n in (1.5, 1.33, 1.9, 1.0, 2.4, 1.2, 1.0)],
}


def cell_of_mirror_direction(theta, parametrization):
    """Row and column of the exact mirror direction, which is also the straight-through one."""
    if parametrization == "half" or theta == 0:
        return 0, 0
    return math.floor(theta), COLUMNS // 2


@pytest.mark.parametrize("estimator", ["analog", "split"])
@pytest.mark.parametrize("parametrization", ["classic", "half"])
@pytest.mark.parametrize("name", STACKS)
def test_one_cell_for_every_angle(name, parametrization, estimator):
    """The split walk put half of it into the column before: what it folds is its own mirror image elsewhere."""
    if (name, estimator) == ("mirror", "split"):
        # It has nothing to do there.
        return
    thetas = THETAS if (parametrization, estimator) == ("classic", "analog") else FEW_THETAS
    scene = make_scene(STACKS[name], thetas, parametrization, 90, COLUMNS)
    result = simulate(scene, rays=5000, seed=1, estimator=estimator)
    for component in result.components.values():
        assert component.contains_delta
        for m, theta in enumerate(thetas):
            row, column = cell_of_mirror_direction(theta, parametrization)
            elsewhere = component.energy[m].copy()
            elsewhere[:, row, column] = 0.0
            assert not elsewhere.any(), f"{theta} degrees"
            # Nearer to the horizon hardly a ray enters the stack.
            assert (component.energy[m, :, row, column] > 0.0).all() or theta > 89.5, f"{theta} degrees"


@pytest.mark.parametrize("estimator", ["analog", "split"])
@pytest.mark.parametrize("rows, columns", [(7, 11), (7, 12), (90, 360), (180, 720), (1, 1), (1000, 7)])
def test_other_grids(rows, columns, estimator):
    """One cell also where edges are not whole degrees."""
    scene = make_scene(STACKS["slab"], [0, 30, 45, 60], rows=rows, columns=columns)
    result = simulate(scene, rays=2000, estimator=estimator)
    for component in result.components.values():
        for m, theta in enumerate([0, 30, 45, 60]):
            lit = np.argwhere(component.energy[m, 0])
            row = math.floor(theta / 90 * rows + 1e-9)
            column = math.floor(columns / 2 + 1e-9) if theta else 0
            assert lit.tolist() == [[row, column]]


@pytest.mark.false_alarm(4e-4, seeds=(1, 101, 201))
def test_what_lies_beside_the_plane_is_still_that_of_the_analog_walk(seed):
    """A beam in one cell and a wide lobe around it: 72 cells within 5.5 sigma of Student's t of 31 at the worst."""
    scene = make_scene([dielectric(1.5), dielectric(1.3), conductor(1.2, 1.0, 0.3)], 40, rows=6, columns=12)
    analog, split = (
        simulate(scene, rays=rays, estimator=name, seed=seed).components["reflection/internal"]
        for name, rays in (("analog", 1_000_000), ("split", 200_000))
    )
    sigma = np.hypot(analog.stderr, split.stderr)
    assert split.contains_delta and (np.abs(analog.energy - split.energy) < 5.5 * sigma + 1e-9).all()


@pytest.mark.parametrize("parametrization", ["classic", "half"])
def test_refraction_into_a_half_space(parametrization):
    """The transmitted beam bends, so that half slices hold it at phi_h = 0 or 180, not at the pole."""
    thetas = [10, 40, 70]
    for eta in (1.5, 1.1):
        result = simulate(make_scene([dielectric(eta)], thetas, parametrization), rays=2000)
        for m, theta in enumerate(np.radians(thetas)):
            inside = math.asin(math.sin(theta) / eta)
            if parametrization == "classic":
                expected = [math.floor(math.degrees(inside)), 180]
            else:
                u = math.sqrt(0.5 * (theta - inside) * math.pi / 2)
                expected = [math.floor(math.degrees(u)), 0]
            assert np.argwhere(result.components["transmission"].energy[m, 0]).tolist() == [expected]


def test_rough_interfaces_have_no_delta():
    result = simulate(make_scene([dielectric(1.5), dielectric(1.3, 0.2), conductor(1.2, 1.0)], 30), rays=2000)
    assert result.components["reflection/direct"].contains_delta
    assert not result.components["reflection/internal"].contains_delta


def test_smooth_coat_over_rough_slab_has_a_delta_only_above():
    result = simulate(make_scene([dielectric(1.5), dielectric(1.0, 0.2)], 30), rays=2000)
    deltas = {name: component.contains_delta for name, component in result.components.items()}
    assert deltas == {"reflection/direct": True, "reflection/internal": False, "transmission": False}


def test_mirror_below_a_smooth_layer_of_a_rough_stack_is_flagged():
    """Smooth over smooth over rough: part of the internal reflection is a delta, transmission is not."""
    layers = [dielectric(1.5), dielectric(1.3), dielectric(1.0, 0.2)]
    result = simulate(make_scene(layers, 30), rays=2000)
    assert result.components["reflection/internal"].contains_delta
    assert not result.components["transmission"].contains_delta
