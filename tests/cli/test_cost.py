"""`goniosim cost`: the price list of a scene."""

import json

import pytest
from click.testing import CliRunner
from goniosim_cli.main import main

from goniosim.report.cost.price_list import price_list as measure
from goniosim.report.drawing.files import is_figure
from small import SCENE

# A base that is connected to all cells makes replicates in no time.
PLASTIC = SCENE.replace(
    "{type: conductor, eta: 1.45, kappa: [1.0, 0.01, 0.01], alpha: 0.2}", "{type: lambert, rho: [0.1, 0.6, 0.2]}"
)
QUICK = ("--max-time", "0.1s", "--threads", 1)


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """One price list, told and drawn, and the same once more as JSON."""
    folder = tmp_path_factory.mktemp("cost")
    scene = folder / "scene.yaml"
    scene.write_text(PLASTIC)
    known = []

    def once(*arguments):
        known.append(known[0] if known else measure(*arguments))
        return known[-1]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("goniosim.report.cost.price_list.price_list", once)
        command = ["cost", str(scene), *map(str, QUICK)]
        told = CliRunner().invoke(main, [*command, "--models", "-o", str(folder / "out")])
        data = CliRunner().invoke(main, [*command, "--json"])
    assert (told.exit_code, data.exit_code) == (0, 0), told.output + data.output
    return folder, told.stdout, json.loads(data.stdout)


def test_the_text_has_prices_effects_and_limits(made):
    _, told, _ = made
    for words in (
        "small: what accuracy costs, 1 direction on 1 thread",
        "reflection/internal",
        "0.1 %",
        "predicted ± ",
        "analog: error ~ t^-s, s = 0.5",
        "bati19_ww: ",
        "rough_interfaces",
        "all interfaces smooth",
        "5 x 5",
        "averaging over cells, reflection/internal: 6 x 12: ",
        "interpolation between incident directions, reflection/internal: 7: ",
    ):
        assert words in told, words


def test_figures_are_drawn_into_the_folder_and_without_one_not_for_programs(made):
    folder, _, _ = made
    assert all(is_figure(folder / "out" / f"small-cost.{suffix}") for suffix in ("png", "svg"))
    assert sorted(path.name for path in folder.iterdir()) == ["out", "scene.yaml"]


def test_json_has_the_agreed_shape(made):
    _, _, data = made
    assert data.keys() == {"components", "effects", "limits"}
    assert data["components"].keys() == {"reflection/internal"}
    estimators = data["components"]["reflection/internal"]["estimators"]
    assert list(estimators) == ["auto", "analog"]
    for prices in estimators.values():
        assert [price["error"] for price in prices] == [0.1, 0.03, 0.01, 0.003, 0.001]
        for price in prices:
            assert price.keys() == {"error", "seconds", "cpu_seconds", "measured", "uncertainty"}
            assert price["seconds"] > 0.0 and price["cpu_seconds"] > 0.0 and price["uncertainty"] > 0.0
        # The first replicates may be better than any price asks for.
        assert prices[-1]["cpu_seconds"] >= prices[0]["cpu_seconds"]
    assert data["limits"].keys() == {"subcells", "cells", "directions", "nodes"}
    assert [entry["n"] for entry in data["limits"]["subcells"]["models"]["ww09"]] == [1, 3, 5, 9, 15]
    assert [entry["directions"] for entry in data["limits"]["directions"]["reflection/internal"]] == [7, 15, 30]
    assert data["limits"]["nodes"] == {}
    assert data["effects"].keys() == {"rough_interfaces", "absorption", "chromatic"}
    assert data["effects"]["absorption"]["ratio"] > 0.0


def test_a_study_is_refused_in_one_line(folder, goniosim):
    code, out, err = goniosim("cost", "study.yaml", *QUICK)
    assert (code, out) == (3, "")
    assert "study.yaml: describes 3 materials" in err


def test_a_file_of_somebody_else_is_not_overwritten(folder, goniosim):
    (folder / "small-cost.svg").write_text("mine")
    code, _, err = goniosim("cost", "scene.yaml", *QUICK)
    assert code == 4
    assert "small-cost.svg: exists" in err
    assert not (folder / "small-cost.png").exists()


def test_a_material_without_sampled_light_has_no_prices(folder, goniosim):
    text = (folder / "scene.yaml").read_text().splitlines()
    (folder / "metal.yaml").write_text(
        "\n".join(line for line in text if "dielectric" not in line and "tau" not in line)
    )
    code, out, _ = goniosim("cost", "metal.yaml", *QUICK)
    assert code == 0
    assert "Nothing is sampled" in out


@pytest.mark.parametrize("written", ["soon", "0s", "-1m", "10 days", ""])
def test_what_is_no_time_is_refused(folder, goniosim, written):
    code, _, err = goniosim("cost", "scene.yaml", "--max-time", written)
    assert code == 2
    assert "must be a time above 0: seconds, or 90s, 10m, 2h or 1h30m" in err


def test_without_memory_for_more_cells_or_directions_the_rest_is_told(folder, goniosim, monkeypatch):
    (folder / "scene.yaml").write_text(PLASTIC)
    monkeypatch.setattr("goniosim.report.cost.price_list.shortage", lambda scene: "too little")
    code, out, _ = goniosim("cost", "scene.yaml", *QUICK, "--json")
    assert code == 0
    data = json.loads(out)
    assert data["limits"]["cells"] == data["limits"]["directions"] == {}
    assert data["components"]
