"""Estimators from the command line: what is written is whole, read by every command, and says how it was made."""

import json

import pytest

from goniosim import open_result

LAYERS = {
    "metal": "{type: conductor, eta: 1.45, kappa: [1.0, 0.01, 0.01], alpha: 0.2}",
    "plastic": "{type: lambert, rho: [0.1, 0.6, 0.2]}",
    "slab": "{type: dielectric, eta: 1.0, alpha: 0.2}",
}
SCENE = """\
material:
  name: {name}
  layers:
    - interface: {{type: dielectric, eta: 1.5, alpha: 0.2}}
    - medium: {{tau: [0.05, 0.1, 0.4]}}
    - interface: {base}
incident: {{theta_deg: [0, 60]}}
slice: {{rows: 18, columns: 36}}
simulation: {{rays: 8192, seed: 1}}
"""


@pytest.fixture
def scene(folder):
    """Writes a scene and returns its name."""

    def write(name):
        (folder / f"{name}.yaml").write_text(SCENE.format(name=name, base=LAYERS[name]))
        return f"{name}.yaml"

    return write


@pytest.mark.parametrize(
    ("name", "estimator", "main"),
    [
        ("metal", "operator", "reflection/internal"),
        ("plastic", "connection", "reflection/internal"),
        ("slab", "split", "transmission"),
    ],
)
def test_results_of_estimators_serve_all_commands(folder, goniosim, scene, name, estimator, main):
    assert goniosim("simulate", scene(name), "--estimator", estimator, "-q")[0] == 0
    said = json.loads(goniosim("info", f"{name}.h5", "--json")[1])
    assert said["estimator"] == estimator
    code, out, _ = goniosim("info", f"{name}.h5")
    assert code == 0 and f"estimator {estimator}" in out and f"{main}: {estimator} (as asked for)" in out
    assert "Accuracy: relative standard error of slice" in out
    assert f"{main}: " in said["provenance"]["estimator_gain"] and "estimator_gain " in out
    assert goniosim("plot", f"{name}.h5", "--theta", 60, "-o", "pictures")[0] == 0
    assert goniosim("compare", f"{name}.h5", "--models", "bati19_ww", "--figures", "none", "-q")[0] == 0


def test_a_file_that_holds_it_stays(folder, goniosim, scene):
    path = scene("plastic")
    assert goniosim("simulate", path, "--estimator", "connection", "-q")[0] == 0
    _, _, err = goniosim("simulate", path, "--estimator", "connection")
    assert "stays as it is" in err
    code, _, err = goniosim("simulate", path, "--estimator", "split")
    assert code == 4 and "simulation.estimator" in err


@pytest.mark.parametrize(("name", "estimator"), [("metal", "connection"), ("slab", "connection")])
def test_an_estimator_that_does_not_apply_is_refused_with_the_reason(folder, goniosim, scene, name, estimator):
    code, _, err = goniosim("simulate", scene(name), "--estimator", estimator)
    assert code == 3 and f"simulation.estimator: {estimator} does not apply" in err and "Lambertian base" in err
    assert not (folder / f"{name}.h5").exists()


def test_check_says_who_serves_what(folder, goniosim, scene, monkeypatch):
    monkeypatch.setattr("goniosim.report.simulation.forecast.PROBE", 0.01)
    path = scene("slab")
    few = json.loads(goniosim("check", path, "--json")[1])
    assert few["estimator_gains"] == {}
    assert few["estimators"] == [
        "reflection/internal and transmission: analog (fewer than 131072 rays are too few for replicates)"
    ]
    many = json.loads(goniosim("check", path, "--rays", "1e6", "--json")[1])["estimators"]
    assert [line.split(" (")[0] for line in many] == ["reflection/internal: operator", "transmission: operator"]
    _, out, _ = goniosim("check", path, "--rays", "1e6")
    assert "  gain  " not in out
    _, out, _ = goniosim("check", path, "--rays", "1e6", "-v")
    assert all(f"  gain        {name}: " in out for name in ("reflection/internal", "transmission"))


@pytest.mark.parametrize("of", ["slice", "albedo", "cells"])
def test_a_target_is_reached_by_what_is_enough_for_it(folder, goniosim, scene, of):
    path = scene("plastic")
    code, out, err = goniosim("simulate", path, "--target", "5%", "--of", of, "-o", "a.h5")
    assert code == 0, err
    assert f"target: 5 % of {of}: reached" in out
    result = open_result("a.h5")
    assert result.target_reached is True and result.status == "complete"


def test_a_target_beyond_the_limits_is_9(folder, goniosim, scene):
    path = scene("slab")
    code, out, err = goniosim(
        "simulate", path, "--estimator", "analog", "--target", "0.01%", "--max-rays", "2e5", "-o", "a.h5"
    )
    assert code == 9 and "was not reached" in err and "not reached" in out
    result = open_result("a.h5")
    assert result.target_reached is False and (result.rays <= 200_000).all()
    assert result.cost.rays.shape[0] == 2
