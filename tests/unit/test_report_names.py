"""No two figures share a file, and no two directions a title; figures replace figures of goniosim only."""

import os

import numpy as np
import pytest
from matplotlib.figure import Figure

from goniosim.errors import OutputError, UnusableResultError
from goniosim.report import text
from goniosim.report.comparison import entries, files, sheets
from goniosim.report.drawing import directions
from goniosim.report.drawing.files import is_figure, write_figure
from goniosim.report.drawing.names import distinct
from goniosim.report.integrated import figures as integrated
from goniosim.report.simulation import figures
from goniosim.report.simulation.direction import direction_figure
from goniosim.report.simulation.summary import summary
from goniosim.store import open_models
from synthetic import make_result, write_models

NEAR = (30.0, 30.0000000000001)


@pytest.mark.parametrize(
    ("theta_deg", "shown"),
    [
        ((0.0, 60.0, 89.99), ["0", "60", "89.99"]),
        (NEAR, ["30", "30.0000000000001"]),
        ((0.3, 0.1 + 0.2, 60.0), ["0.3", "0.30000000000000004", "60"]),
        ((30.0, np.nextafter(30.0, 31.0)), ["30", "30.000000000000004"]),
        ((1 / 3, 2 / 3), ["0.3333333333", "0.6666666667"]),
        ((1e-9, 45.0, 45.00000000001), ["1e-09", "45", "45.00000000001"]),
    ],
)
def test_angles_in_so_many_digits_as_it_takes(theta_deg, shown):
    assert text.angles(np.array(theta_deg)) == shown


def test_any_angles_can_be_told_apart():
    """Fixed seed; neighbouring numbers and random ones. Nothing here fails by chance."""
    rng = np.random.default_rng(5)
    near = 45.0 + np.cumsum(rng.integers(1, 4, 100)) * np.spacing(45.0)
    theta_deg = np.unique(np.concatenate([near, rng.uniform(0.0, 90.0, 100), np.linspace(0.0, 85.0, 18)]))
    shown = text.angles(rng.permutation(theta_deg))
    assert len(set(shown)) == len(theta_deg)


def test_near_angles_share_neither_figure_nor_title_nor_row(tmp_path, monkeypatch):
    result = make_result(theta_deg=NEAR, channels=("R", "G", "B"))
    monkeypatch.setattr(figures, "direction_figure", lambda *_: Figure())
    monkeypatch.setattr(figures, "overview_figure", lambda *_: Figure())
    drawn = [path.name for path in figures.draw(result, tmp_path, "x")]
    assert drawn == ["x.png", "x-theta_30.png", "x-theta_30.0000000000001.png"]
    assert any("light at 30.0000000000001°" in words.get_text() for words in direction_figure(result, 1).texts)
    assert any(line.split()[:1] == ["30.0000000000001"] for line in summary(result).splitlines())


def test_near_angles_of_models_share_no_figure_either(tmp_path):
    write_models(tmp_path / "models.h5", theta_deg=NEAR, channels=("R", "G", "B"))
    with open_models(tmp_path / "models.h5") as models:
        material = models.material("synthetic")
        slices = [(entry, models.slices(material, entry, material.main_component)) for entry in material.models]
        seen = [entries.of_models(material, slices, number) for number in (0, 1)]
    drawn = sheets.single_directions("gold", "transmission", seen, tmp_path / "gold", ["png"])
    assert [figure[0].name for figure in drawn] == ["gold-lobes-theta_30", "gold-lobes-theta_30.0000000000001"]
    (title,) = [words.get_text() for words in drawn[1][2](*drawn[1][3:]).texts if "light at" in words.get_text()]
    assert title.endswith("light at 30.0000000000001°")


def test_near_angles_are_told_apart_in_the_table(tmp_path):
    rows = [dict.fromkeys(files.COLUMNS) | {"theta_deg": angle, "rmse": 1 / 3} for angle in (*NEAR, "all")]
    files.write_csv(tmp_path / "errors.csv", rows, {})
    column = list(files.COLUMNS).index("theta_deg")
    lines = [line.split(",") for line in (tmp_path / "errors.csv").read_text().splitlines()[1:]]
    assert [line[column] for line in lines] == ["30", "30.0000000000001", "all"]
    assert lines[0][list(files.COLUMNS).index("rmse")] == "0.333333333"


def test_the_nearest_angle_is_chosen():
    theta_deg = np.array([*NEAR, 60.0])
    assert directions.chosen(theta_deg, [30.0000000000001, 60.0000001, 30.0, 60.0]) == [1, 2, 0]
    for absent in (45.0, 60.00001, float("nan")):
        with pytest.raises(UnusableResultError, match="there is 30, 30.0000000000001, 60"):
            directions.chosen(theta_deg, [absent])


def test_names_that_some_file_systems_or_shells_confuse():
    labels = ["ww09", "ww09[masking=correlated]", "ww09-masking=correlated", "Gold", "gold", "GOLD", "gold~2", "a/../b"]
    parts = distinct(labels)
    assert parts[:5] == ["ww09", "ww09-masking=correlated", "ww09-masking=correlated~2", "Gold", "gold~2"]
    assert len({part.casefold() for part in parts}) == len(labels) and not any("/" in part for part in parts)


def test_materials_that_differ_in_case_only_share_no_figure(tmp_path, monkeypatch):
    monkeypatch.setattr(
        integrated, "overviews", lambda *args: [(args[3].with_name(args[3].name + "-x"), ["png"], Figure)]
    )
    monkeypatch.setattr(integrated, "single_directions", lambda *_: [])
    write_models(tmp_path / "models.h5", ("Gold", "gold"))
    with open_models(tmp_path / "models.h5") as models:
        drawn = [path.name for path in integrated.draw(models, tmp_path, "models")]
    assert drawn == ["models-Gold-x.png", "models-gold~2-x.png"]


@pytest.mark.parametrize("suffix", ["png", "svg", "pdf"])
def test_figures_replace_figures_of_goniosim_only(tmp_path, monkeypatch, suffix):
    (path,) = write_figure(tmp_path / "x", [suffix], Figure)
    assert is_figure(path)
    monkeypatch.setattr(figures, "overview_figure", lambda *_: Figure())
    monkeypatch.setattr(figures, "direction_figure", lambda *_: Figure())
    figures.draw(make_result(), tmp_path, "x", suffix=suffix)
    Figure().savefig(tmp_path / f"x-theta_60.{suffix}")
    before = {each: each.read_bytes() for each in tmp_path.iterdir()}
    path.unlink()
    with pytest.raises(OutputError, match=rf"x-theta_60.{suffix}: exists and is not a figure that goniosim drew"):
        figures.draw(make_result(), tmp_path, "x", suffix=suffix)
    # Seen before anything was drawn.
    assert {**before, **{each: each.read_bytes() for each in tmp_path.iterdir()}} == before and not path.exists()


@pytest.mark.parametrize("name", ["../../evil", "/abs/x", "..", ".hidden", "", "a\0b", "a\nb", "x" * 900, "a b;c"])
def test_a_name_from_data_is_one_harmless_file_name(name):
    (made,) = distinct([name])
    assert os.path.basename(made) == made and made[0] != "." and len(made) <= 200 and made.isprintable()
    assert distinct(["belcour18_forward-jacobian=snell,n=2"]) == ["belcour18_forward-jacobian=snell,n=2"]
