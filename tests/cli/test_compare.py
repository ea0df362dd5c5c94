"""`goniosim compare` and `goniosim models`: reports, refusals, exit codes."""

import csv
import functools
import json
import re
from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray as xr
from click.testing import CliRunner

from crafting import craft
from goniosim.compare.rows import COLUMNS
from goniosim.scene import parse_scene
from goniosim.store import layout, open_result, write_result
from synthetic import make_result

METAL = """\
material:
  name: metal
  layers:
    - interface: {type: dielectric, eta: 1.0}
    - interface: {type: conductor, eta: 1.45, kappa: 1.0, alpha: 0.3}
incident: {theta_deg: [0, 50]}
slice: {rows: 9, columns: 16}
simulation: {rays: 3e4, seed: 3}
"""


def run(*arguments):
    """Call the command in this process; exit code, stdout, stderr."""
    from goniosim_cli.main import main

    outcome = CliRunner().invoke(main, [str(argument) for argument in arguments])
    return outcome.exit_code, outcome.stdout, outcome.stderr


@pytest.fixture(scope="module")
def reports(tmp_path_factory):
    """Joint reports of a metal that Eq. 5 describes exactly and of a made-up plastic, by the seed of the metal."""
    return functools.cache(lambda seed: make_report(tmp_path_factory.mktemp("compare"), seed))


@pytest.fixture(scope="module")
def report(reports):
    return reports(3)


def make_report(folder, seed):
    from goniosim import simulate

    (folder / "results").mkdir()
    write_result(simulate(parse_scene(METAL), seed=seed, threads=2), folder / "results" / "metal.h5")
    plastic = make_result(components=("reflection/direct", "reflection/internal"), channels=("R", "G", "B"))
    write_result(plastic, folder / "results" / "plastic.h5")
    code, out, err = run(
        "compare",
        folder / "results",
        "-o",
        folder / "report",
        "--subcells",
        "9",
        "--models",
        "ww09,bati19_ww",
        "--models",
        "belcour18_forward",
        "--set",
        "ww09.masking=correlated",
    )
    assert code == 0, err
    return folder / "report", folder / "results", out, err


def read_csv(path):
    with open(path, encoding="utf-8", newline="") as f:
        return list(csv.DictReader(f))


@pytest.mark.false_alarm(0.05, seeds=tuple(range(3, 10)))
def test_the_table_ranks_the_models_and_knows_what_is_noise(reports, seed):
    """One exact model in 20 at most is told from noise."""
    _, _, out, err = reports(seed)
    metal = out[out.index("metal  (reflection/internal)") : out.index("synthetic  (reflection/internal)")]
    assert sorted(line.split()[0] for line in metal.splitlines()[3:7]) == [
        "bati19_ww",
        "belcour18_forward",
        "belcour18_forward[refraction_scale=paper]",
        "ww09[masking=correlated]",
    ]
    (exact,) = [line for line in metal.splitlines() if line.strip().startswith("bati19_ww")]
    assert "below noise" in exact
    assert "n/a: belcour18_forward: does not apply to a Lambertian base" in out
    assert "1/2 metal: integrating the models" in err


@pytest.mark.false_alarm(0.1, seeds=tuple(range(3, 13)))
def test_errors_csv_has_a_row_for_all_and_one_for_each(reports, seed):
    """One exact model in 20 at most is told from noise, and one of its cells in as many."""
    rows = read_csv(reports(seed)[0] / "errors.csv")
    assert list(rows[0])[: len(COLUMNS)] == list(COLUMNS)
    required = "material, model, options, component, channel, theta_deg, rmse, rmse_stderr, noise_floor"
    assert set(f"{required}, albedo_reference, albedo_model".split(", ")) <= set(rows[0])
    # 4 variants on the metal and 2 on the plastic, 2 components, 3 rows of directions, 4 of channels; 1 n/a.
    assert len(rows) == (4 + 2) * 2 * 3 * 4 + 1
    (na,) = [row for row in rows if row["note"]]
    assert (na["model"], na["rmse"], na["material"]) == ("belcour18_forward", "", "synthetic")
    (exact,) = [
        row
        for row in rows
        if (row["material"], row["model"], row["component"]) == ("metal", "bati19_ww", "reflection/internal")
        and (row["channel"], row["theta_deg"]) == ("mean", "all")
    ]
    assert exact["below_noise"] == "1" and exact["subcells"] == "9"
    # No cell of the exact model is anything but noise; a cell of a wrong one is, and stands in full.
    worst = [name for name in COLUMNS if name.startswith("worst_")]
    assert not any(exact[name] for name in worst)
    (wrong,) = [
        row
        for row in rows
        if (row["material"], row["model"], row["options"]) == ("metal", "belcour18_forward", "")
        and (row["component"], row["channel"], row["theta_deg"]) == ("reflection/internal", "mean", "all")
    ]
    assert all(wrong[name] for name in worst)
    assert abs(float(wrong["worst_difference"])) > 4.0 * float(wrong["worst_stderr"])
    assert float(exact["rmse_eq4"]) == pytest.approx(float(exact["noise_floor"]), rel=0.2)
    assert abs(float(exact["albedo_error"])) < 5.0 * float(exact["albedo_reference_stderr"])


def test_the_noise_floor_is_that_of_the_simulation(report):
    """The cost table of the result states the root of the mean over channels, equal here."""
    _, results, *_ = report
    result = open_result(results / "metal.h5")
    rows = json.loads((report[0] / "errors.json").read_text(encoding="utf-8"))["errors"]
    (row,) = [
        row
        for row in rows
        if (row["model"], row["component"], row["channel"], row["theta_deg"], row["material"])
        == ("bati19_ww", "reflection/internal", "mean", "all", "metal")
    ]
    assert row["noise_floor"] == pytest.approx(result.cost.noise("reflection/internal")[-1], rel=1e-9)


def test_errors_json_has_units_provenance_and_the_same_rows(report):
    def refuse(constant):
        raise AssertionError(constant)

    text = (report[0] / "errors.json").read_text(encoding="utf-8")
    data = json.loads(text, parse_constant=refuse)
    assert data["filetype"] == "goniosim-errors"
    assert data["columns"]["rmse"]["unit"] == "sr-0.5" and set(data["columns"]) == set(COLUMNS)
    assert data["provenance"]["subcells"] == "9"
    assert data["provenance"]["command"].startswith("goniosim compare ") and data["provenance"]["processor"]
    assert {source["material"] for source in data["results"]} == {"metal", "synthetic"}
    table = read_csv(report[0] / "errors.csv")
    assert len(data["errors"]) == len(table)
    for row, line in zip(data["errors"], table, strict=True):
        assert list(row) == list(line)[: len(row)]
        if row["rmse"] is not None:
            assert float(line["rmse"]) == pytest.approx(row["rmse"], rel=1e-8)
        assert line["rmse_unit"] == "sr-0.5" and line["albedo_unit"] == "1" and line["angle_unit"] == "degree"
        assert line["goniosim_version"] == data["provenance"]["goniosim_version"]
        assert line["created_utc"] == data["provenance"]["created_utc"]


def test_models_h5_reads_like_results(report):
    with h5py.File(report[0] / "models.h5") as file, h5py.File(report[1] / "metal.h5") as result:
        assert file.attrs["filetype"] == b"goniosim-models"
        group = file["metal/ww09[masking=correlated]"]
        assert group.attrs["options"] == b"masking=correlated"
        for name in ("direction", "row", "incident/theta_deg", "cells/valid", "cells/projected_solid_angle"):
            np.testing.assert_array_equal(group[name][()], result[name][()])
        for component in ("reflection/direct", "reflection/internal"):
            for name in ("energy", "stderr", "bsdf", "bsdf_stderr"):
                ours, theirs = (root[component][name] for root in (group, result))
                assert ours.shape == theirs.shape and ours.dtype == theirs.dtype and ours.fletcher32
                assert ours.attrs["units"] == theirs.attrs["units"]
                assert [dim[0].name.split("/")[-1] for dim in ours.dims] == list(
                    layout.describe(f"{component}/{name}").dims
                )
        internal = group["reflection/internal"]
        size = group["cells/projected_solid_angle"][()][:, None]
        np.testing.assert_allclose(internal["bsdf"][()] * size, internal["energy"][()], rtol=2e-7)
        # A smooth coat of air reflects nothing, and one stored component is enough for that.
        assert group["reflection/direct/energy"] == file["metal/bati19_ww/reflection/direct/energy"]
    group = "synthetic/bati19_ww/reflection/internal"
    with xr.open_dataset(report[0] / "models.h5", group=group, engine="h5netcdf") as slices:
        assert slices.bsdf.dims == ("direction", "channel", "row", "column")
        assert list(slices.theta_deg.values) == [0, 60]


def test_figures_are_there_in_both_formats_and_nothing_is_left_over(report):
    files = sorted(path.relative_to(report[0]).as_posix() for path in report[0].rglob("*") if path.is_file())
    angles = {"metal": (0, 50), "synthetic": (0, 60)}
    figures = ["cost", "errors", *(f"{name}-{kind}" for name in angles for kind in ("lobes", "views"))]
    figures += [f"{name}-lobes-theta_{angle}" for name in angles for angle in angles[name]]
    expected = [f"figures/{name}.{suffix}" for name in figures for suffix in ("png", "svg")]
    assert files == sorted(["errors.csv", "errors.json", "models.h5", *expected])
    assert sorted(json.loads((report[0] / "errors.json").read_text(encoding="utf-8"))["files"]) == files
    assert not list(report[0].parent.glob(".*"))
    for name in expected:
        start = (report[0] / name).read_bytes()[:100]
        assert start.startswith(b"\x89PNG" if name.endswith("png") else b"<?xml")


@pytest.mark.parametrize(("figures", "kinds"), [("overview", ["lobes", "views"]), ("none", [])])
def test_fewer_figures(report, tmp_path, figures, kinds):
    folder = tmp_path / "report"
    metal = report[1] / "metal.h5"
    code, _, err = run("compare", metal, "-o", folder, "--models", "ww09", "--subcells", "1", "--figures", figures)
    joint = ["cost", "errors"] if kinds else []
    expected = [f"{name}.{end}" for name in [*joint, *(f"metal-{kind}" for kind in kinds)] for end in ("png", "svg")]
    assert code == 0 and ("drawing" in err) == bool(kinds)
    assert sorted(path.name for path in (folder / "figures").iterdir()) == sorted(expected)
    assert (folder / "models.h5").exists() and (folder / "errors.csv").exists()


@pytest.fixture
def partial(tmp_path):
    result = make_result(components=("reflection/direct", "reflection/internal"), status="partial")
    write_result(result, tmp_path / "partial.h5")
    return tmp_path / "partial.h5"


def test_partial_results_are_refused_unless_allowed(partial, tmp_path):
    code, out, err = run("compare", partial, "-o", tmp_path / "report")
    assert code == 8 and out == ""
    assert re.fullmatch(r"goniosim: error: .*partial.h5: .*--allow-partial\n", err)
    assert not (tmp_path / "report").exists()
    code, out, err = run(
        "compare", partial, "-o", tmp_path / "report", "--allow-partial", "-q", "--models", "bati19_ww"
    )
    assert (code, out, err) == (0, "", "") and (tmp_path / "report" / "errors.csv").exists()


def test_foreign_newer_and_missing_files_are_refused(tmp_path):
    (tmp_path / "foreign.h5").write_bytes(b"not a result")
    assert run("compare", tmp_path / "foreign.h5")[0] == 5
    assert run("compare", tmp_path / "missing.h5")[0] == 5
    write_result(make_result(), tmp_path / "newer.h5")
    craft(tmp_path / "newer.h5", version="9.0")
    assert run("compare", tmp_path / "newer.h5")[0] == 7


def test_an_empty_folder_and_two_equal_names_are_refused(tmp_path):
    code, _, err = run("compare", tmp_path)
    assert code == 8 and "no result files" in err
    for name in ("a.h5", "b.h5"):
        write_result(make_result(), tmp_path / name)
    code, _, err = run("compare", tmp_path)
    assert code == 8 and "rename" in err and len(err.splitlines()) == 1


@pytest.mark.parametrize(
    ("arguments", "code", "word"),
    [
        (["--models", "ww9"], 3, "did you mean ww09"),
        (["--set", "ww09.masking"], 3, "MODEL.OPTION=VALUE"),
        (["--set", "masking=correlated"], 3, "MODEL.OPTION=VALUE"),
        (["--set", "ww09.masking=round"], 3, "separable"),
        (["--subcells", "0"], 2, "subcells"),
    ],
)
def test_mistakes_on_the_command_line_are_found_before_anything_is_read(arguments, code, word):
    found, _, err = run("compare", "nowhere.h5", *arguments)
    assert found == code and word in err


def test_a_report_that_cannot_be_written(partial, tmp_path):
    (tmp_path / "file").write_text("in the way")
    code, _, err = run("compare", partial, "--allow-partial", "-o", tmp_path / "file")
    assert code == 4 and len(err.splitlines()) == 1
    assert (tmp_path / "file").read_text() == "in the way"


def test_models_lists_every_model_with_options_and_speed():
    from goniosim.models import MODELS, describe_options

    code, out, _ = run("models")
    assert code == 0
    for name, model in MODELS.items():
        assert re.search(rf"^{name}$", out, re.MULTILINE)
        assert " ".join(model.citation.split()[:4]) in " ".join(out.split())
        assert all(f"{option.name} = " in out for option in describe_options(name))
    assert len(re.findall(r"[0-9.]+ ns per evaluation", out)) == len(MODELS)
    assert max(map(len, out.splitlines())) <= 100


def test_python_gives_the_same_as_the_command(report):
    import goniosim

    comparison = goniosim.compare(str(Path(report[1]) / "metal.h5"), models=["bati19_ww"], subcells=9)
    (row,) = comparison.rows()
    table = json.loads((report[0] / "errors.json").read_text(encoding="utf-8"))["errors"]
    (same,) = [
        other
        for other in table
        if all(other[key] == row[key] for key in ("material", "model", "component", "channel", "theta_deg"))
    ]
    assert row["rmse_eq4"] == pytest.approx(same["rmse_eq4"], rel=1e-12)
