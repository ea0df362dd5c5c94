"""A component that no ray reached: nothing seen is not nothing there."""

import math

import pytest

import goniosim
from goniosim import engine
from goniosim.albedo import arrived
from goniosim.report.simulation.accuracy import accuracy_lines
from goniosim.report.simulation.audit import albedo_lines
from goniosim.report.simulation.cost import cost_lines
from goniosim.report.simulation.target import far, shortfall
from goniosim.scene import with_arguments
from reference.scenes import conductor, dielectric, lambert, make_scene, medium


@pytest.mark.false_alarm(0.08, seeds=tuple(range(1, 10)))
@pytest.mark.parametrize("component", ["reflection/internal", "reflection"])
def test_where_hardly_a_ray_enters_only_wrong_models_are_called_wrong(component, seed):
    """At 89.999 degrees 4e-5 of the light enters: 0.08 hits of 2000 rays; a run with none is what is looked at.

    Eq. 5 is right to some per cent and cannot be told from the truth; two models claim that 86 % come back.
    """
    scene = make_scene([dielectric(1.5), lambert(1.0)], 89.999, rows=30, columns=60)
    result = goniosim.simulate(scene, rays=2000, seed=seed)
    assert not result.components["reflection/internal"].hits.any()
    rows = {row["model"]: row for row in goniosim.compare(result).rows(component)}
    assert {model: row["below_noise"] for model, row in rows.items()} == {"bati19_ww": 1, "ww09": 0, "elek10": 0}
    # What may hide there: three rays in one of the 1800 cells.
    assert 1e-2 < rows["bati19_ww"]["rmse_upper"] < 1e-1
    assert rows["bati19_ww"]["albedo_reference_stderr"] == pytest.approx(1.5 / 2000)


GRAZING = 89.9999999
# Matched so well that rough facets hardly bend what enters, whose way through the medium is 57,000 times its depth.
NEVER_SEEN = [dielectric(1.0000001, 0.2), medium(3.0), lambert(0.5)]
# Light that comes back has been absorbed to 1e-157; of such numbers there are no squares.
FAINT = [dielectric(1.5, 0.1), medium(180.0), conductor(0.2, 3.9, 0.1)]


def aimed(layers, theta, **given):
    scene = make_scene(layers, theta, rows=9, columns=18)
    return with_arguments(scene, {"target": 0.05, **given})


@pytest.mark.parametrize("of", ["slice", "albedo", "cells"])
def test_a_pilot_that_sees_nothing_does_not_say_how_many_rays_are_enough(of):
    scene = aimed([dielectric(1.5), lambert(0.5)], GRAZING, of=of)
    result = goniosim.simulate(scene)
    component = result.components["reflection/internal"]
    assert result.target_reached is True and component.estimator == ["connection"]
    assert "pilot" not in result.provenance["estimator_choice"] and (component.albedo_stderr > 0.0).all()


@pytest.mark.slow
def test_nor_above_a_rough_metal():
    result = goniosim.simulate(aimed([dielectric(1.5), conductor(0.2, 3.9, 0.1)], GRAZING))
    assert result.target_reached is True and "pilot" not in result.provenance["estimator_choice"]


@pytest.mark.parametrize("base", [lambert(0.5), conductor(0.2, 3.9, 0.1)], ids=["lambert", "conductor"])
def test_independent_paths_that_see_nothing_have_not_reached_a_target(base):
    """Nor have those of one hit: there is one in a hundred runs of so many paths."""
    result = goniosim.simulate(aimed([dielectric(1.5), base], GRAZING, estimator="analog", max_rays=1_000_000))
    assert result.target_reached is False and result.status == "complete" and result.rays[0] > 500_000


@pytest.mark.parametrize("estimator", ["analog", "split"])
def test_where_nothing_is_seen_no_error_is_told_and_no_price(estimator):
    told = []
    scene = aimed(NEVER_SEEN, 89.999, estimator=estimator, max_rays=600_000)
    result = engine.simulate(scene, tell=told.append)
    assert result.target_reached is False and not arrived(result.components["reflection/internal"]).any()
    (line,) = accuracy_lines(result)[1:]
    limit = f"nothing was seen at 89.999 deg: at most {3.0 / result.rays[0]:.1g}"
    assert line == f"  reflection/internal   {limit} (target 5 % of slice)"
    assert f"reached with at most 6e5 rays per direction (reflection/internal: {limit})" in shortfall(
        scene.simulation, result
    )
    assert "Half the noise" not in "\n".join(cost_lines(result))
    # That it is far is said while there is time, with the least that it takes.
    assert told[0].is_cut and told[0].error == math.inf
    assert "of reflection/internal too little was seen for an error after" in far(scene.simulation, told[0])
    assert "takes over" in far(scene.simulation, told[0])


def test_a_number_of_rays_that_see_nothing_tells_no_error_either():
    result = goniosim.simulate(make_scene(NEVER_SEEN, 89.999, rows=3, columns=4, rays=10_000))
    assert accuracy_lines(result)[1] == "  reflection/internal   nothing was seen at 89.999 deg: at most 0.0003"


@pytest.mark.parametrize("estimator", ["auto", "analog", "split"])
def test_a_target_on_what_is_too_faint_for_an_error_ends_at_once(estimator):
    """No number of rays changes that: it does not go on to its limits, of which there are none here."""
    scene = aimed(FAINT, 30.0, target=0.35, estimator=estimator)
    result = goniosim.simulate(scene)
    # One round.
    assert result.target_reached is False and result.rays[0] == (262_144 if estimator == "auto" else 131_072)
    (line,) = accuracy_lines(result)[1:]
    assert "too little was seen at 30 deg for an error to be known" in line and "better" not in line
    assert shortfall(scene.simulation, result).endswith("the result is kept: ask for rays instead")
    value = float(result.components["reflection/internal"].albedo[0, 0])
    assert 0.0 < value < 1e-155 and f"about {value:.1g}" in albedo_lines(result)[-1]


DARK = {
    "black base": [dielectric(1.5), lambert(0.0)],
    "black rough base": [dielectric(1.5, 0.1), conductor(1.5, 0.0, 0.3)],
    "opaque coat": [dielectric(1.5, 0.1), medium(2000.0), conductor(0.2, 3.9, 0.1)],
    "total reflection": [dielectric(0.9), lambert(1.0)],
}


@pytest.mark.parametrize("name", DARK)
@pytest.mark.parametrize("estimator", ["auto", "split"])
def test_what_is_dark_for_sure_has_reached_its_target_at_once(name, estimator):
    result = goniosim.simulate(aimed(DARK[name], 80.0, target=0.001, estimator=estimator))
    assert result.target_reached is True and result.rays[0] == 131_072
    assert not arrived(result.components["reflection/internal"]).any()
    assert accuracy_lines(result)[1:] == [
        "  reflection/internal   dark: no light leaves this way (target 0.1 % of slice)"
    ]


def test_dark_directions_and_channels_do_not_matter_beside_others():
    """At 80 degrees all is totally reflected; blue is absorbed everywhere."""
    scene = aimed([dielectric(0.9), lambert([0.5, 0.5, 0.0])], [30.0, 80.0])
    result = goniosim.simulate(scene)
    component = result.components["reflection/internal"]
    assert result.target_reached is True
    assert arrived(component).any(axis=1).tolist() == [True, False] and not component.energy[:, 2].any()
    assert " % at 30 deg, nine in ten errors below" in accuracy_lines(result)[1]
