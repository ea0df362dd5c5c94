"""An interface between equal indices does nothing, whatever its roughness; one that differs by 1e-9 masks."""

import numpy as np
import pytest

import goniosim
from goniosim.compare.variants import components_for
from goniosim.engine import simulate
from goniosim.engine.layout import DOWN, UP
from goniosim.engine.plan import make_plan
from goniosim.models import MODELS, prepare
from reference.scenes import conductor, dielectric, lambert, make_scene, medium

SKIN = dielectric(1.5, 0.5)
BETWEEN = {
    "plastic": ([dielectric(1.5, 0.1)], [medium([0.05, 0.1, 0.4]), lambert([0.1, 0.6, 0.2])]),
    "metal": ([dielectric(1.5), medium(0.1)], [medium([0.0, 0.1, 0.1]), conductor(1.2, [1.0, 0.01, 0.01], 0.1)]),
    "slab": ([dielectric(1.5), medium(0.1)], [dielectric(1.3), dielectric(1.0, 0.2)]),
}


@pytest.mark.parametrize("name", BETWEEN)
def test_the_simulation_has_the_bits_of_the_stack_without_it(name):
    above, below = BETWEEN[name]
    with_it, without = (
        simulate(make_scene([*above, *skin, *below], [0, 45, 89.99], orders=2, rows=18, columns=36), rays=20_000)
        for skin in ([SKIN], [])
    )
    assert list(with_it.components) == list(without.components)
    for path, component in with_it.components.items():
        other = without.components[path]
        assert component.contains_delta == other.contains_delta
        for part in ("energy", "stderr", "bsdf", "bsdf_stderr"):
            np.testing.assert_array_equal(getattr(component, part), getattr(other, part))
        for order, inner in component.orders.items():
            np.testing.assert_array_equal(inner.energy, other.orders[order].energy)
    for entry, energy in with_it.audit.energy.items():
        np.testing.assert_array_equal(energy, without.audit.energy[entry])
    assert with_it.effects == without.effects


@pytest.mark.parametrize("name", BETWEEN)
def test_the_models_have_the_bits_of_the_stack_without_it(name):
    above, below = BETWEEN[name]
    with_it, without = (make_scene([*above, *skin, *below], 30) for skin in ([SKIN], []))
    assert components_for(with_it) == components_for(without)
    v = np.array([[0.1, -0.5, 0.9], [0.2, 0.0, 0.0], [0.0, 0.0, 0.0]])
    v[2] = np.sqrt(1.0 - v[0] ** 2 - v[1] ** 2)
    for model in MODELS:
        for component in components_for(with_it):
            if MODELS[model].supports(with_it, component):
                continue
            found, expected = (prepare(model, scene, 30.0, component) for scene in (with_it, without))
            np.testing.assert_array_equal(found.evaluate(*v), expected.evaluate(*v))
            np.testing.assert_array_equal(found.mirror_energy, expected.mirror_energy)


@pytest.mark.parametrize("deviation", [0.0, 5e-13, -5e-13])
def test_a_rough_first_or_last_one_loses_nothing_and_lets_light_straight_through(deviation):
    eta = 1.0 + deviation
    result = simulate(make_scene([dielectric(eta, 0.5), dielectric(1.0, 0.3)], [0, 60, 89.99]), rays=2000)
    assert (result.audit.energy["transmitted"] == 1.0).all()
    through = result.components["transmission"]
    assert through.contains_delta
    assert (np.count_nonzero(through.energy, axis=(1, 2, 3)) == 3).all()
    assert not result.components["reflection/direct"].energy.any()


def test_a_white_base_below_it_shows_all_its_light_up_to_the_horizon():
    """Where 1 - cos^2 rounds to 1 there is no total reflection: exact to rounding at every angle."""
    for theta in (89.99999, 89.999999, 89.9999999):
        audit = simulate(make_scene([dielectric(1.0), lambert(1.0)], theta, rows=9, columns=36), rays=2000).audit
        assert audit.energy["reflected_internal"] == pytest.approx(1.0, abs=1e-12)
        assert not audit.direct_integrated.any()


def test_the_step_is_where_the_documents_say():
    """At a ratio of 1 + 1e-9 the facets mask, and nothing is flagged."""
    result = simulate(make_scene([dielectric(1.0 + 1e-9, 0.5), lambert(1.0)], [60]), rays=20_000)
    assert result.audit.energy["lost_masked_transmission"].min() > 0.1
    assert result.effects["rough_interfaces"]


TOP, MATCHED, ROUGH = dielectric(1.5), dielectric(1.0), dielectric(1.5, 0.2)
METAL, BLACK, GLASS = conductor(1.45, 1.0), conductor(1.5, 0.0), dielectric(1.0)


@pytest.mark.parametrize(
    ("layers", "top", "up", "down"),
    [
        ([TOP], True, False, True),
        ([ROUGH], False, False, False),
        ([MATCHED], False, False, True),
        ([dielectric(1.0, 0.2)], False, False, True),
        ([TOP, GLASS], True, True, True),
        ([TOP, dielectric(1.0, 0.2)], True, False, False),
        ([ROUGH, GLASS], False, False, False),
        # The lower interface reflects nothing, or is absent.
        ([TOP, dielectric(1.5, 0.2)], True, False, True),
        ([TOP, SKIN, dielectric(1.0, 0.2)], True, False, False),
        # Not only the second interface sends light back.
        ([TOP, dielectric(1.3), dielectric(1.0, 0.2)], True, True, False),
        ([MATCHED, TOP, dielectric(1.0, 0.2)], False, True, False),
        ([MATCHED, METAL], False, True, False),
        ([TOP, METAL], True, True, False),
        ([TOP, conductor(1.45, 1.0, 0.1)], True, False, False),
        ([TOP, BLACK], True, False, False),
        ([TOP, conductor(1.5, [0.0, 0.1, 0.0])], True, True, False),
        ([TOP, lambert(0.5)], True, False, False),
        ([METAL], True, False, False),
        ([lambert(0.5)], False, False, False),
    ],
)
def test_light_in_one_direction_is_told_by_what_happens(layers, top, up, down):
    plan = make_plan(make_scene(layers, [0, 40]))
    assert bool(plan.mirrors[0]) is top
    assert plan.has_specular_chain(UP) is up
    assert plan.has_specular_chain(DOWN) is down


def test_no_chain_leads_through_total_reflection():
    layers = [dielectric(0.5), dielectric(1.0)]
    for theta, enters in ((20, True), (40, False)):
        plan = make_plan(make_scene(layers, [theta, 80]))
        assert plan.has_specular_chain(UP) is plan.has_specular_chain(DOWN) is enters


def test_the_index_comes_back_exactly():
    """1.5 / 1.33 * 1.33 is not 1.5: ratios are formed from the indices, not multiplied up."""
    plan = make_plan(make_scene([dielectric(n) for n in (1.5, 1.33, 1.5, 1.9, 1.0)], 0))
    assert plan.etas.tolist() == [1.5 / 1.0, 1.33 / 1.5, 1.5 / 1.33, 1.9 / 1.5, 1.0 / 1.9]


def test_a_comparison_sees_the_stack_without_it():
    result = simulate(make_scene([dielectric(1.0, 0.5), conductor(1.45, 1.0, 0.2)], 30), rays=2000)
    (material,) = goniosim.compare(result, models=["elek10", "bati19_belcour"]).materials
    assert material.components == ("reflection/internal", "reflection")
    plain = simulate(make_scene([dielectric(1.0), conductor(1.45, 1.0, 0.2)], 30), rays=2000)
    (other,) = goniosim.compare(plain, models=["elek10", "bati19_belcour"]).materials
    for key, component in material.slices.items():
        np.testing.assert_array_equal(component.energy, other.slices[key].energy)
