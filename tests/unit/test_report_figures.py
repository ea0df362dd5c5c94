"""Figures are written, are not empty, and say what is wrong when they cannot be."""

import numpy as np
import pytest
from matplotlib.image import imread

from goniosim.errors import OutputError, UnusableResultError
from goniosim.report.simulation.figures import draw
from synthetic import make_result


def _result(**options):
    return make_result(channels=("R", "G", "B"), rows=12, columns=24, **options)


@pytest.mark.parametrize("parametrization", ["classic", "half"])
def test_an_overview_and_one_figure_for_each_direction(tmp_path, parametrization):
    written = draw(_result(parametrization=parametrization), tmp_path / "new" / "folder", "stem")
    assert [path.name for path in written] == ["stem.png", "stem-theta_0.png", "stem-theta_60.png"]
    for path in written:
        image = imread(path)
        assert min(image.shape[:2]) > 500
        # More than white paper: a good part of the pixels is coloured.
        assert np.mean(image[..., :3].min(axis=-1) < 0.9) > 0.05


def test_chosen_directions_only(tmp_path):
    written = draw(_result(), tmp_path, "stem", theta_deg=[60.0])
    assert [path.name for path in written] == ["stem-theta_60.png"]
    assert [path.name for path in tmp_path.iterdir()] == ["stem-theta_60.png"]


def test_a_direction_that_was_not_simulated_is_refused(tmp_path):
    with pytest.raises(UnusableResultError, match="theta 45 was not simulated; there is 0, 60"):
        draw(_result(), tmp_path, "stem", theta_deg=[45.0])


@pytest.mark.parametrize(("suffix", "start"), [("svg", b"<?xml"), ("pdf", b"%PDF")])
def test_vector_formats_are_the_same_every_time(tmp_path, suffix, start):
    (first,) = draw(_result(), tmp_path / "a", "stem", suffix=suffix, theta_deg=[60.0])
    (second,) = draw(_result(), tmp_path / "b", "stem", suffix=suffix, theta_deg=[60.0])
    assert first.read_bytes().startswith(start)
    assert first.read_bytes() == second.read_bytes()


def test_a_folder_that_cannot_be_created_is_an_output_error(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError, match="the folder cannot be created"):
        draw(_result(), tmp_path / "file" / "folder", "stem")


def test_black_slices_partial_results_and_single_components_can_be_drawn(tmp_path):
    result = _result(components=("reflection/direct",), status="partial", theta_deg=(60.0,))
    component = result.components["reflection/direct"]
    for array in (component.energy, component.stderr, component.bsdf, component.bsdf_stderr):
        array[:] = 0.0
    component.contains_delta = True
    assert len(draw(result, tmp_path, "stem")) == 2


def test_many_directions_fit_into_the_overview(tmp_path):
    result = make_result(channels=("R", "G", "B"), theta_deg=tuple(range(0, 90, 5)))
    from goniosim.report.simulation.overview import MOST, overview_figure

    figure = overview_figure(result)
    # A curve and a disk for each direction shown, for reflection and transmission; all disks on one board.
    board, *curves = figure.axes
    assert len(curves) == len(board.images) == 2 * MOST
