"""`info`, `plot` and `compare` on files of integrated models."""

import json

import h5py
import numpy as np
import pytest
from matplotlib.image import imread

from crafting import craft
from goniosim.store import open_models, open_result, write_result
from synthetic import make_result, write_models

INTERNAL = ("reflection/direct", "reflection/internal")


@pytest.fixture
def models(folder):
    """The file ``models.h5`` of two materials in the working directory."""
    write_models(folder / "models.h5", ("amber", "zinc"), channels=("R", "G", "B"), components=INTERNAL)
    return folder / "models.h5"


@pytest.fixture
def results(folder):
    """The folder ``results`` with one result."""
    (folder / "results").mkdir()
    result = make_result(components=INTERNAL, channels=("R", "G", "B"))
    write_result(result, folder / "results" / "plastic.h5")
    return folder / "results"


def one_line(err, *words):
    assert err.startswith("goniosim: error: ") and err.count("\n") == 1
    assert all(word in err for word in words), err


def test_info_lists_materials_and_models(goniosim, models):
    code, out, err = goniosim("info", "models.h5")
    assert (code, err) == (0, "")
    lines = [" ".join(line.split()) for line in out.splitlines()]
    assert lines[0].startswith("models.h5 (")
    assert lines[1] == "Integrated models of 2 materials, schema 1.2"
    assert "amber reflection/internal classic, 6 x 8 R G B 1e5 2" in lines
    assert "incident theta [deg]: 0, 60" in lines
    assert "ww09 default reflection/direct, reflection/internal 2 of 2" in lines
    assert "belcour18_forward jacobian=snell reflection/direct, reflection/internal 2 of 2" in lines
    assert "subcells 5" in lines


def test_info_as_json(goniosim, models):
    code, out, _ = goniosim("info", "models.h5", "--json")
    data = json.loads(out)
    assert code == 0 and data["filetype"] == "goniosim-models"
    assert [material["name"] for material in data["materials"]] == ["amber", "zinc"]
    amber = data["materials"][0]
    assert amber["theta_deg"] == [0.0, 60.0] and amber["slice"] == {
        "parametrization": "classic",
        "rows": 6,
        "columns": 8,
    }
    assert amber["models"][1] == {
        "label": "belcour18_forward[jacobian=snell]",
        "model": "belcour18_forward",
        "options": "jacobian=snell",
        "components": {name: {"contains_delta": False} for name in INTERNAL},
    }


def test_plot_draws_all_models_of_every_material_side_by_side(goniosim, models, folder):
    code, out, err = goniosim("plot", "models.h5", "-o", "pictures")
    kinds = ("lobes", "views", "lobes-theta_0", "lobes-theta_60")
    assert (code, err) == (0, "")
    assert out.splitlines() == [f"pictures/models-{name}-{kind}.png" for name in ("amber", "zinc") for kind in kinds]
    for line in out.splitlines():
        assert np.std(imread(folder / line)) > 0.05


def test_plot_of_many_materials_keeps_to_overviews(goniosim, folder):
    names = [f"m{number}" for number in range(4)]
    write_models(folder / "models.h5", names, components=INTERNAL)
    code, out, _ = goniosim("plot", "models.h5", "--format", "svg")
    assert code == 0
    assert out.splitlines() == [f"models-{name}-{kind}.svg" for name in names for kind in ("lobes", "views")]
    code, out, _ = goniosim("plot", "models.h5", "--material", "m2", "--format", "svg")
    assert code == 0
    assert out.splitlines() == [
        f"models-m2-{kind}.svg" for kind in ("lobes", "views", "lobes-theta_0", "lobes-theta_60")
    ]
    code, out, _ = goniosim("plot", "models.h5", "--theta", "60")
    assert out.splitlines() == [f"models-{name}-lobes-theta_60.png" for name in names]


def test_plot_of_one_model_alone(goniosim, models):
    code, out, _ = goniosim("plot", "models.h5", "--material", "zinc", "--model", "ww09")
    assert code == 0
    assert out.splitlines() == [f"models-zinc-ww09{end}.png" for end in ("", "-theta_0", "-theta_60")]
    code, out, _ = goniosim("plot", "models.h5", "--model", "belcour18_forward[jacobian=snell]", "--theta", "60")
    assert code == 0
    assert out.splitlines() == [
        f"models-{name}-belcour18_forward-jacobian=snell-theta_60.png" for name in ("amber", "zinc")
    ]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--material", "zink"], ["no material zink", "did you mean zinc?"]),
        (["--material", "gold-leaf"], ["no material gold-leaf", "`goniosim info` lists them"]),
        (["--model", "ww9"], ["no model ww9", "did you mean ww09?"]),
        (["--theta", "45"], ["theta 45", "0, 60"]),
    ],
)
def test_what_is_not_there_is_8(goniosim, models, folder, arguments, words):
    before = sorted(folder.iterdir())
    code, out, err = goniosim("plot", "models.h5", *arguments)
    assert (code, out) == (8, "")
    one_line(err, *words)
    assert sorted(folder.iterdir()) == before


def test_a_result_has_no_models_to_choose(goniosim, results):
    code, _, err = goniosim("plot", results / "plastic.h5", "--model", "ww09")
    assert code == 2 and "models.h5" in err


@pytest.mark.parametrize("command", ["info", "plot"])
def test_damaged_foreign_and_newer_files(goniosim, models, folder, command):
    raw = models.read_bytes()
    with h5py.File(models) as file:
        chunk = file["zinc/ww09/reflection/internal/bsdf"].id.get_chunk_info(0)
    flipped = bytearray(raw)
    flipped[chunk.byte_offset + chunk.size // 2] ^= 1
    for content in (raw[: len(raw) // 2], raw[:-1], bytes(flipped)):
        models.write_bytes(content)
        code, _, err = goniosim(command, "models.h5")
        assert code == 6
        one_line(err, "models.h5", "compare again")
    models.write_bytes(raw)
    craft(models, version="2.0")
    code, _, err = goniosim(command, "models.h5")
    assert code == 7
    one_line(err, "schema 2.0", "update goniosim")
    with h5py.File(folder / "other.h5", "w") as file:
        file["energy"] = [1.0]
    code, _, err = goniosim(command, "other.h5")
    assert code == 5
    one_line(err, "other.h5", "not a goniosim result")


def test_a_note_that_was_added_is_told_and_no_damage(goniosim, models):
    with h5py.File(models, "r+") as file:
        file["zinc"].attrs["note"] = "mine"
    code, out, err = goniosim("info", "models.h5")
    assert code == 0 and "zinc" in out
    assert err.startswith("goniosim: note: models.h5: annotated: something was added") and err.count("\n") == 1


def test_compare_with_a_file_of_models_is_8(goniosim, models):
    code, out, err = goniosim("compare", "models.h5")
    assert (code, out) == (8, "")
    one_line(err, "models.h5", "holds integrated models", "name a file that a simulation wrote")


def test_a_folder_of_nothing_but_models_is_8(goniosim, models, folder):
    code, _, err = goniosim("compare", folder)
    assert code == 8
    one_line(err, "no result files")


def test_compare_steps_over_the_models_in_a_folder(goniosim, results, folder):
    """A second comparison, into the same folder and into another one."""
    quick = ("--models", "ww09", "--subcells", "1", "--figures", "none")
    code, _, err = goniosim("compare", results, "-o", results, *quick)
    assert code == 0 and "models.h5" not in err
    first = (results / "errors.csv").read_text().splitlines()
    code, out, err = goniosim("compare", results, "-o", results, *quick)
    assert code == 0 and "synthetic" in out
    (line,) = [line for line in err.splitlines() if "models.h5" in line]
    assert line == f"{results}/models.h5: holds integrated models, not a result; stepped over"
    assert len((results / "errors.csv").read_text().splitlines()) == len(first)
    assert goniosim("compare", results, "-o", folder / "again", *quick, "-q") == (0, "", "")
    with open_models(folder / "again" / "models.h5") as models:
        assert models.materials == ("synthetic",)


def test_python_steps_over_the_models_too(results):
    import goniosim

    write_models(results / "models.h5")
    comparison = goniosim.compare(results, models=["ww09"], subcells=1)
    assert [material.result.name for material in comparison.materials] == ["synthetic"]


@pytest.mark.parametrize("name", ["models.h5", "errors.csv", "errors.json"])
def test_a_report_overwrites_nothing_but_a_report(goniosim, results, name):
    """A material may be called models, and its result stand where the slices would go."""
    if name == "models.h5":
        (results / "plastic.h5").rename(results / name)
    else:
        (results / name).write_text("my own notes\n")
    before = (results / name).read_bytes()
    code, out, err = goniosim("compare", results, "-o", results)
    assert (code, out) == (4, "")
    one_line(err, name, "is not overwritten", "another folder")
    assert (results / name).read_bytes() == before
    if name == "models.h5":
        assert open_result(results / name).name == "synthetic"


def test_a_name_that_leads_elsewhere_is_refused(goniosim, results, folder):
    """Names of materials become names of files; a file from a stranger may hold any."""
    write_result(make_result(components=INTERNAL, name="../../escaped"), results / "plastic.h5", overwrite=True)
    code, _, err = goniosim("compare", results, "-o", folder / "report")
    assert code == 6
    one_line(err, "plastic.h5", "name must be usable as a file name")
    assert not (folder / "report").exists()


def test_nothing_is_drawn_if_any_of_the_slices_is_wrong(goniosim, folder, models):
    def edit(file):
        values = file["zinc/ww09/reflection/internal/energy"]
        values[...] = -1.0 - values[...]

    craft(models, edit)
    code, out, err = goniosim("plot", "models.h5", "-o", "figures")
    assert (code, out) == (6, "") and not (folder / "figures").exists()
    one_line(err, "reflection/internal/energy must be")
