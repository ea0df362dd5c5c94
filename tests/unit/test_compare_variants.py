"""Which models, options and components are compared."""

import pytest

from goniosim.compare.variants import Variant, check_request, components_for, variants_for
from goniosim.errors import ConfigError
from goniosim.models import MODELS
from goniosim.report.comparison.labels import short_names
from reference.scenes import conductor, dielectric, lambert, make_scene, medium

PLASTIC = make_scene([dielectric(1.5, 0.1), medium(0.2), lambert(0.5)], 30.0)
METAL = make_scene([dielectric(1.5, 0.1), conductor(1.45, 1.0, 0.2)], 30.0)
SLAB = make_scene([dielectric(1.5, 0.1), dielectric(1.0, 0.2)], 30.0)


def labels(scene, **request):
    return [variant.label for variant in variants_for(scene, check_request(**request))[0]]


def test_every_applicable_model_is_compared_and_the_second_reading_beside_it():
    assert labels(PLASTIC) == ["ww09", "elek10", "bati19_ww"]
    assert labels(METAL) == [
        "ww09",
        "elek10",
        "bati19_ww",
        "belcour18_forward",
        "belcour18_forward[refraction_scale=paper]",
        "belcour18_symmetric",
        "belcour18_symmetric[refraction_scale=paper]",
        "bati19_belcour",
        "bati19_belcour[refraction_scale=paper]",
    ]
    assert labels(SLAB) == ["belcour18_forward", "belcour18_forward[jacobian=snell]"]


def test_models_that_do_not_apply_say_why():
    for scene in (PLASTIC, METAL, SLAB):
        variants, reasons = variants_for(scene, check_request())
        assert {variant.model for variant in variants} | set(reasons) == set(MODELS)
        assert all(len(reason.split()) > 4 for reason in reasons.values())


def test_a_chosen_option_replaces_the_default_and_its_second_reading():
    options = {"belcour18_forward": {"refraction_scale": "paper", "normalise_lobes": "true"}}
    found = labels(METAL, models=["belcour18_forward"], options=options)
    assert found == ["belcour18_forward[refraction_scale=paper,normalise_lobes=true]"]
    options = {"belcour18_forward": {"masking": "correlated"}}
    assert labels(METAL, models=["belcour18_forward"], options=options) == [
        "belcour18_forward[masking=correlated]",
        "belcour18_forward[masking=correlated,refraction_scale=paper]",
    ]


def test_an_option_at_its_default_is_not_shown():
    assert labels(METAL, models=["ww09"], options={"ww09": {"masking": "separable"}}) == ["ww09"]
    assert Variant("ww09").options_text == ""


@pytest.mark.parametrize(
    ("request_", "words"),
    [
        ({"models": ["ww9"]}, ["ww9", "did you mean ww09"]),
        ({"options": {"ww09": {"maskin": "separable"}}}, ["maskin", "did you mean masking"]),
        ({"options": {"ww09": {"masking": "seperable"}}}, ["masking", "did you mean separable"]),
        ({"models": ["ww09"], "options": {"elek10": {"masking": "correlated"}}}, ["elek10", "not compared"]),
    ],
)
def test_mistakes_are_explained(request_, words):
    with pytest.raises(ConfigError) as caught:
        check_request(**request_)
    assert len(caught.value.problems) == 1
    for word in words:
        assert word in caught.value.problems[0]


def test_the_main_component_is_that_of_the_paper():
    assert components_for(PLASTIC) == components_for(METAL) == ("reflection/internal", "reflection")
    assert components_for(SLAB) == ("transmission", "reflection")
    assert components_for(make_scene([conductor(1.45, 1.0, 0.2)], 0.0)) == ("reflection",)


def test_short_names_drop_what_is_common_or_not_needed():
    parts = ["M1-alpha0_0.2-alpha1_0.1", "M1-alpha0_0.2-alpha1_0.2", "M2-alpha0_0.2-alpha1_0.2"]
    names = [f"{part}-tau_{number}" for number, part in enumerate(parts)]
    assert short_names(names) == ["M1-alpha1_0.1", "M1-alpha1_0.2", "M2-alpha1_0.2"]
    assert short_names(["gold"]) == ["gold"]
    assert short_names(["a", "a-b"]) == ["a", "b"]
    assert short_names(["a-b", "b-a"]) == ["a-b", "b-a"]
