"""What limits besides noise, on made-up results whose answers are known; scenes without an effect."""

from types import SimpleNamespace

import numpy as np
import pytest

from goniosim.report.cost.cells import finer_scene, lost_to_cells
from goniosim.report.cost.directions import COUNTS, dense_scene, gaps, lost_between
from goniosim.report.cost.nodes import node_bias
from goniosim.report.cost.norms import difference, noise_of, norm_of
from goniosim.report.cost.without import without_effects
from goniosim.scene import effects
from patina import dielectric, layered, medium, patina
from synthetic import make_result

NAME = "reflection/internal"


def filled(result, bsdf, stderr=0.0, seed=1):
    """The result with a given slice and Gaussian noise."""
    component = result.components[NAME]
    noise = stderr * np.random.default_rng(seed).normal(size=component.bsdf.shape)
    component.bsdf[:] = (bsdf + noise) * result.cells.valid[:, None]
    component.bsdf_stderr[:] = stderr * result.cells.valid[:, None]
    return result


@pytest.mark.false_alarm(1.2e-6, seeds=(1, 101))
@pytest.mark.parametrize("stderr", [0.0, 0.2])
def test_what_is_lost_to_cells_is_the_scatter_within_them(stderr, seed):
    """Values 1 and 3 side by side: the mean 2, off by 1. With noise within 5 stated errors, twice: fails in 1.2e-6."""
    result = make_result((30.0,), rows=24, columns=48, components=(NAME,))
    stripes = np.where(np.arange(48) % 2, 3.0, 1.0)
    (fine, coarse) = lost_to_cells(filled(result, stripes, stderr, seed))[NAME]
    assert (fine["rows"], fine["columns"], coarse["rows"], coarse["columns"]) == (12, 24, 6, 12)
    for each in (fine, coarse):
        assert each["lost"] == pytest.approx(1.0 / np.sqrt(5.0), abs=5.0 * each["uncertainty"] + 1e-12)
        assert (each["uncertainty"] > 0.0) == (stderr > 0.0)


def test_light_in_one_exact_direction_is_lost_to_any_cells():
    result = make_result((30.0,), rows=24, columns=48, components=(NAME,))
    result.components[NAME].contains_delta = True
    assert lost_to_cells(result) == {}


def test_finer_cells_are_seen_in_a_few_directions():
    fine = finer_scene(patina(incident={"theta_deg": list(range(0, 80, 10))}))
    assert (fine.slice.rows, fine.slice.columns) == (180, 720)
    assert fine.incident.theta_deg == (0.0, 40.0, 70.0)
    assert finer_scene(patina(slice={"rows": 1000, "columns": 2000})) is None


def test_the_error_between_directions_is_that_of_a_parabola():
    """With f = theta^2, in degrees, linear interpolation over a gap h is off by h^2 / 4 in its middle."""
    scene = patina(incident={"theta_deg": [20, 80]})
    dense = dense_scene(scene)
    result = make_result(dense.incident.theta_deg, components=(NAME,))
    theta = result.theta_deg[:, None, None, None]
    found = lost_between(scene, filled(result, theta**2))[NAME]
    assert [each["directions"] for each in found] == list(COUNTS)
    for each, several in zip(found, gaps(scene).values(), strict=True):
        worst = max(0.25 * (after - before) ** 2 / between**2 for before, between, after in several)
        assert each["error"] == pytest.approx(worst, rel=1e-6)


@pytest.mark.false_alarm(1e-6, seeds=(2, 102))
def test_noise_is_taken_out_of_a_difference(seed):
    """A difference of 0.3 under noise of 1: within 5 stated errors, which fails in 1e-6 of the cases."""
    noise = np.random.default_rng(seed).normal(size=(3, 100_000))
    one = np.ones_like(noise)
    error, uncertainty = difference(0.3 + noise, one, one, one[0] / 100_000)
    assert error == pytest.approx(0.3, abs=5.0 * uncertainty)
    assert uncertainty == pytest.approx(np.sqrt((4.0 * 1.09 + 2.0) / 100_000) / 0.6, rel=0.1)


def test_norms_are_those_of_equation_4():
    result = filled(make_result((30.0,), components=(NAME,)), 2.0)
    component = result.components[NAME]
    size = (result.cells.projected_solid_angle * result.cells.valid).sum()
    assert norm_of(component, result.cells) == pytest.approx([2.0 * np.sqrt(size)])
    component.bsdf_stderr[:] = 0.5
    assert noise_of(component, result.cells) == pytest.approx([0.5 * np.sqrt(size)])


def test_a_scene_without_an_effect_does_not_call_for_it():
    scene = patina(simulation={"orders": 2})
    found = without_effects(scene)
    assert found.keys() == {"rough_interfaces", "absorption", "chromatic", "orders"}
    for name, (_, left) in found.items():
        active = {effect.name: effect.active for effect in effects(left)}
        assert not active[name], name


def test_inner_interfaces_and_the_way_out_below_can_be_left_out():
    scene = layered(dielectric(1.5, 0.1), medium(0.1), dielectric(1.3, 0.2), dielectric(1.0))
    found = without_effects(scene)
    assert [type(layer.interface or layer.medium).__name__ for layer in found["layers[2]"][1].material.layers] == [
        "Dielectric",
        "Medium",
        "Dielectric",
    ]
    assert not found["transmission"][1].material.transmits


def test_nodes_tell_their_worst_direction_that_is_lit():
    parts = {
        name: SimpleNamespace(node_bias=bias) for name, bias in ((NAME, np.array([1.0, 2.0, 9.0])), ("other", None))
    }
    rung = SimpleNamespace(
        norm={NAME: np.array([10.0, 10.0, 0.0]), "other": np.ones(3)}, result=SimpleNamespace(components=parts)
    )
    assert node_bias(rung) == {NAME: 0.2}
