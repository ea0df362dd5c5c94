"""Interfaces between equal indices: left out of the stack, and said so."""

import pytest

from goniosim.report.simulation.forecast import effects_text
from goniosim.scene import absent_interfaces, distinct_channels, effects, optical_stack
from reference.scenes import conductor, dielectric, lambert, make_scene, medium


def reduced(*layers):
    stack = optical_stack(make_scene(list(layers), 0).material)
    faces = [
        (face.type, getattr(face, "eta", None), getattr(face, "alpha", None)) for face in stack.material.interfaces
    ]
    return faces, stack.material.tau, stack.places, stack.absent


def active(scene):
    return {effect.name for effect in effects(scene) if effect.active}


def test_a_stack_without_equal_indices_stays_what_it_is():
    material = make_scene([dielectric(1.5, 0.1), medium(0.2), dielectric(1.0, 0.2)], 0).material
    stack = optical_stack(material)
    assert stack.material is material
    assert stack.places == (0, 1, 2) and stack.absent == ()


def test_an_inner_one_goes_and_the_media_about_it_add_up():
    faces, tau, places, absent = reduced(
        dielectric(1.5), medium([0.1, 0.2, 0.3]), dielectric(1.5, 0.5), medium(0.4), lambert(0.5)
    )
    assert faces == [("dielectric", 1.5, 0.0), ("lambert", None, None)]
    assert tau == ((0.1 + 0.4, 0.2 + 0.4, 0.3 + 0.4),)
    assert places == (0, 1, 3, 4) and absent == (2,)


def test_the_first_and_the_last_one_stay_smooth():
    faces, _, places, absent = reduced(dielectric(1.0 + 5e-13, 0.3), dielectric(1.0, 0.5), dielectric(1.0 - 5e-13, 0.2))
    assert faces == [("dielectric", 1.0, 0.0), ("dielectric", 1.0, 0.0)]
    assert places == (0, 2) and absent == (0, 1, 2)
    faces, _, _, absent = reduced(dielectric(1.5, 0.3), dielectric(1.5 * (1.0 + 1e-13), 0.3))
    assert faces == [("dielectric", 1.5, 0.3), ("dielectric", 1.5, 0.0)]
    assert absent == (1,)
    assert reduced(dielectric(1.0, 0.3))[0] == [("dielectric", 1.0, 0.0)]


@pytest.mark.parametrize("above", [1.0, 1.33, 1.5, 9.7])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_equal_means_to_1e_12(above, sign):
    for deviation, count in ((0.0, 2), (9e-13, 2), (1e-12, 2), (1.1e-12, 3), (1e-9, 3)):
        layers = [dielectric(above), dielectric(above * (1.0 + sign * deviation), 0.2), conductor(2.0, 1.0)]
        assert len(reduced(*layers)[0]) == count


def test_small_steps_do_not_add_up_unseen():
    """Each index is held against that of the medium that light is in."""
    steps = [dielectric(1.5 * (1.0 + k * 8e-13), 0.2) for k in range(1, 4)]
    assert reduced(dielectric(1.5), *steps, lambert(0.5))[3] == (1, 3)


def test_opaque_bases_are_never_absent():
    assert reduced(dielectric(1.5), conductor(1.5, 0.0, 0.2))[3] == ()


def test_effects_are_those_of_what_is_left():
    inner = make_scene([dielectric(1.5), dielectric(1.5, 0.5), medium(0.1), lambert(0.5)], 0)
    assert active(inner) == active(make_scene([dielectric(1.5), medium(0.1), lambert(0.5)], 0))
    assert "rough_interfaces" not in active(make_scene([dielectric(1.0, 0.5), conductor(1.2, 1.0)], 0))
    why = {effect.name: effect.why for effect in effects(inner)}
    assert why["absorption"] == "asked for by layers[2] (medium, tau 0.1)"
    assert why["internal_paths"] == "light walks between 2 interfaces"


def test_check_names_what_is_absent():
    scene = make_scene([dielectric(1.0, 0.2), dielectric(1.5), dielectric(1.5, 0.5), lambert(0.5)], 0)
    assert absent_interfaces(scene) == [
        "layers[0] (dielectric, alpha 0.2) is optically absent: the indices above and below it are equal",
        "layers[2] (dielectric, alpha 0.5) is optically absent: the indices above and below it are equal",
    ]
    shown = effects_text(scene)
    assert "Note: layers[2] (dielectric, alpha 0.5) is optically absent" in shown
    assert "asked for by layers[0] (dielectric, equal indices), layers[1] (dielectric, alpha 0)" in shown
    assert "optically absent" not in effects_text(make_scene([dielectric(1.5), lambert(0.5)], 0))


def test_channels_agree_by_what_light_meets():
    layers = [dielectric(1.5), medium([1, 0, 0]), dielectric(1.5, 0.1), medium([0, 1, 1]), lambert(0.5)]
    assert distinct_channels(make_scene(layers, 0)) == ([0], [0, 0, 0])
