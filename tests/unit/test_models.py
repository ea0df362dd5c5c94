"""The models as a user meets them: names, options, refusals, shapes, and extreme materials."""

import dataclasses

import numpy as np
import pytest

from goniosim.errors import ConfigError
from goniosim.models import COMPONENTS, MODELS, describe_options, evaluate_model, prepare
from goniosim.models.options import parse_options
from reference.scenes import conductor, dielectric, lambert, make_scene, medium

PLASTIC = [dielectric(1.5, 0.05), medium([0.1, 0.2, 0.8]), lambert([0.1, 0.6, 0.1])]
METAL = [dielectric(1.5, 0.05), medium([0.1, 0.2, 0.8]), conductor(1.2, [1.0, 0.01, 0.01], 0.2)]
SLAB = [dielectric(1.5, 0.05), medium(0.2), dielectric(1.0, 0.2)]
BASES = {"lambert": PLASTIC, "conductor": METAL, "dielectric": SLAB}
FAMILY = ("ww09", "elek10", "bati19_ww")
AFTER_BELCOUR = ("belcour18_forward", "belcour18_symmetric", "bati19_belcour")


def test_registry_is_ordered_and_complete():
    assert tuple(MODELS) == FAMILY + AFTER_BELCOUR
    for name, model in MODELS.items():
        assert model.name == name
        assert "20" in model.citation and model.applies_to


@pytest.mark.parametrize("name", MODELS)
def test_options_are_described_and_their_defaults_allowed(name):
    infos = describe_options(name)
    assert [info.name for info in infos] == [f.name for f in dataclasses.fields(MODELS[name].options)]
    for info in infos:
        assert info.default == info.values[0]
        assert len(info.values) > 1 and info.meaning


@pytest.mark.parametrize("name", MODELS)
def test_every_option_changes_something(name):
    """A three-layer metal, directions off the mirror: no option value is without effect."""
    layers = [dielectric(1.5, 0.2), medium(0.2), dielectric(1.3, 0.1), conductor(1.2, 1.0, 0.3)]
    scene = make_scene(layers, 0)
    default = evaluate_model(name, scene, 50, 30, 150)
    same = {"fgd": "exact", "refraction_scale": "normal"}
    for info in describe_options(name):
        for value in info.values[1:]:
            changed = evaluate_model(name, scene, 50, 30, 150, options={info.name: value})
            assert np.array_equal(changed, default) == (same.get(info.name) == value), (info.name, value)


@pytest.mark.parametrize("name", MODELS)
@pytest.mark.parametrize("component", COMPONENTS)
@pytest.mark.parametrize("base", BASES)
def test_models_apply_or_say_why_not(name, component, base):
    scene = make_scene(BASES[base], 30)
    if component == "transmission":
        applies = name == "belcour18_forward" and base == "dielectric"
    elif base == "dielectric":
        applies = name == "belcour18_forward" and component == "reflection"
    else:
        applies = base == "conductor" or name in FAMILY
    reason = MODELS[name].supports(scene, component)
    assert (reason is None) == applies
    if applies:
        values = evaluate_model(name, scene, 30, 40, 170, component)
        assert values.shape == (3,) and (values > 0.0).all()
    else:
        assert "\n" not in reason
        with pytest.raises(ConfigError, match=f"^model {name} "):
            evaluate_model(name, scene, 30, 40, 170, component)


@pytest.mark.parametrize("name", MODELS)
@pytest.mark.parametrize("base", BASES)
def test_what_a_model_applies_to_hangs_together(name, base):
    """A comparison asks for a main component and for all reflection, which it takes apart or leaves whole."""
    scene = make_scene(BASES[base], 30)
    applies = {component: MODELS[name].supports(scene, component) is None for component in COMPONENTS}
    assert applies["reflection/direct"] == applies["reflection/internal"]
    assert applies["reflection"] >= max(applies.values())


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("ww9", 30, 40, 0), r"no model 'ww9'.*did you mean ww09"),
        (("ww09", 90, 40, 0), "theta_i_deg must be 0 or more and below 90"),
        (("ww09", float("nan"), 40, 0), "theta_i_deg must be"),
        (("ww09", 30, 91, 0), "theta_o_deg must lie between 0 and 90"),
        (("ww09", 30, 40, float("inf")), "phi_o_deg must be finite"),
        (("ww09", 30, 40, 0, "reflexion"), r"no component 'reflexion'.*did you mean reflection"),
        (("ww09", 30, 40, 0, "reflection", {"mask": "separable"}), r"no option 'mask'.*did you mean masking"),
        (("ww09", 30, 40, 0, "reflection", {"masking": "seperable"}), "masking.*did you mean separable"),
        (("ww09", 30, 40, 0, "reflection", {"jacobian": "snell"}), "no option 'jacobian'"),
        (("ww09", 30, 40, 0, "reflection", "masking"), "options must be a mapping"),
        (("ww09", 30, 40, 0, "reflection", MODELS["ww09"].options), "options must be a mapping"),
    ],
)
def test_wrong_arguments_are_explained(arguments, message):
    name, *rest = arguments
    with pytest.raises(ConfigError, match=message):
        evaluate_model(name, make_scene(PLASTIC, 30), *rest)


def test_every_wrong_option_is_named():
    with pytest.raises(ConfigError) as caught:
        prepare("elek10", make_scene(PLASTIC, 30), 30, options={"a": 1, "masking": "b", "t_masking": "smith"})
    assert len(caught.value.problems) == 2


def test_options_may_be_text_or_an_options_object():
    kind = MODELS["belcour18_forward"].options
    assert parse_options("belcour18_forward", kind, {"normalise_lobes": "true"}).normalise_lobes is True
    assert parse_options("belcour18_forward", kind, kind(fgd="exact")) == kind(fgd="exact")


@pytest.mark.parametrize("name", MODELS)
def test_arguments_broadcast(name):
    scene = make_scene(METAL, 30)
    theta_i, theta_o, phi = np.array([[0.0], [50.0]]), np.array([10.0, 20.0, 80.0]), 170.0
    grid = evaluate_model(name, scene, theta_i, theta_o, phi)
    assert grid.shape == (3, 2, 3)
    for i in range(2):
        for j in range(3):
            one = evaluate_model(name, scene, theta_i[i, 0], theta_o[j], phi)
            assert grid[:, i, j] == pytest.approx(one, rel=1e-12)
    assert evaluate_model(name, scene, np.empty(0), 10.0, 0.0).shape == (3, 0)


@pytest.mark.parametrize("name", MODELS)
def test_long_rows_are_evaluated_in_blocks(name):
    scene = make_scene(METAL, 30)
    theta_o = np.linspace(0.0, 89.0, 9001)
    whole = evaluate_model(name, scene, 30.0, theta_o, 150.0)
    part = evaluate_model(name, scene, 30.0, theta_o[5000:5010], 150.0)
    assert whole[:, 5000:5010] == pytest.approx(part, rel=1e-12)


@pytest.mark.parametrize("name", MODELS)
def test_reflection_is_direct_plus_internal(name):
    scene = make_scene(METAL, 30)
    parts = [evaluate_model(name, scene, 50, [0, 50, 85], [0, 180, 90], c) for c in COMPONENTS[:3]]
    assert parts[0] == pytest.approx(parts[1] + parts[2], rel=1e-12)


def test_smooth_interfaces_report_their_mirror_energy():
    """Dirac lobes have an energy and no value; those of the rough base below have values."""
    scene = make_scene([dielectric(1.5), medium([0.0, 0.0, 1.0]), conductor(1.45, 1.0, 0.2)], 0)
    for name in MODELS:
        prepared = prepare(name, scene, 0.0)
        assert prepared.mirror_energy == pytest.approx([0.04] * len(prepared.mirror_energy), rel=1e-12)
        assert not prepare(name, scene, 0.0, "reflection/internal").mirror_energy.any()
        assert not evaluate_model(name, scene, 0.0, 0.0, 0.0, "reflection/direct").any()
        assert (evaluate_model(name, scene, 0.0, 0.0, 0.0, "reflection/internal") > 0.0).all()


_EXTREMES = {
    "no_refraction": [dielectric(1.0, 0.1), medium(0.1), conductor(1.0, 0.0, 0.1)],
    "narrowest": [dielectric(1.5, 1e-6), medium(0.1), conductor(1.45, 1.0, 1e-6)],
    "widest": [dielectric(1.5, 1.0), medium(0.1), conductor(1.45, 1.0, 1.0)],
    "smooth": [dielectric(1.5), medium(0.1), conductor(1.45, 1.0)],
    "black": [dielectric(1.5, 0.1), medium(1e9), conductor(1.45, 1.0, 0.1)],
    "mirror": [dielectric(1.5, 0.1), conductor(1e3, 1e6, 0.1)],
    "thin": [dielectric(1.5, 0.1), conductor(1e-3, 0.0, 0.1)],
    "total_reflection": [dielectric(0.1, 0.1), medium(0.1), conductor(1.45, 1.0, 0.1)],
    "total_inside": [dielectric(10.0, 0.1), medium(0.1), dielectric(0.1, 0.5), conductor(1.45, 1.0, 0.1)],
    "bare_metal": [conductor(1.45, 1.0, 0.1)],
    "bare_base": [lambert(1.0)],
    "plastic": [dielectric(1.5, 0.1), medium(0.1), lambert(1.0)],
    "slab": [dielectric(1.5, 1e-6), medium(0.1), dielectric(1.0, 1.0)],
    "slab_out": [dielectric(1.5, 0.1), dielectric(0.1, 0.1)],
    "half_space": [dielectric(1.5, 0.1)],
}


@pytest.mark.parametrize("material", _EXTREMES)
@pytest.mark.parametrize("name", MODELS)
def test_values_are_finite_everywhere(name, material):
    scene = make_scene(_EXTREMES[material], 0)
    theta_o, phi = np.meshgrid([0.0, 1e-4, 45.0, 89.0, 89.99, 90.0], [0.0, 60.0, 180.0])
    for component in COMPONENTS:
        if MODELS[name].supports(scene, component):
            continue
        for options in ({}, {"masking": "correlated"}):
            for theta_i in (0.0, 45.0, 89.99):
                values = evaluate_model(name, scene, theta_i, theta_o, phi, component, options)
                assert np.isfinite(values).all() and (values >= 0.0).all()
                energy = prepare(name, scene, theta_i, component, options).mirror_energy
                assert np.isfinite(energy).all() and (energy >= 0.0).all()
