"""What the figures of a comparison show: every model in every direction, on the scale of the simulation."""

from pathlib import Path

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from goniosim.report.comparison import entries, labels, style
from goniosim.report.comparison.direction import direction_figure
from goniosim.report.comparison.lobes import lobes_figure
from goniosim.report.comparison.scale import FAINTEST, Scale
from goniosim.report.comparison.sheets import overviews, single_directions
from goniosim.report.comparison.views import views_figure
from goniosim.report.drawing.directions import spread
from goniosim.report.drawing.legend import caption, title
from synthetic import make_result

MASKING = "masking=correlated"
INTERNAL = ("reflection/direct", "reflection/internal")


def make_entry(label, model=None, options="", level=0.1, theta_deg=60.0, dirac=None, error="", converged=True):
    """An entry of constant BSDF, but for its Dirac cell."""
    result = make_result(theta_deg=(theta_deg,), channels=("R", "G", "B"), rows=18, columns=36)
    component = result.components["reflection/internal"]
    component.bsdf[:] = level
    component.bsdf_stderr[:] = 0.01 * level
    component.contains_delta = dirac is not None
    if dirac is not None:
        component.bsdf.reshape(1, 3, -1)[..., dirac] = 1e6
        component.energy[:] = 0.0
        component.energy.reshape(1, 3, -1)[..., dirac] = 1.0
    parts = {"reflection/internal": component}
    seen = "reflection/internal", label, model, options, parts
    made = entries._entry(result.cells, 0, theta_deg, *seen, error=error, converged=converged)
    return made, result.cells


def make_direction(*made, theta_deg=60.0):
    return entries.Direction(0, theta_deg, f"{theta_deg:g}", made[0][1], [entry for entry, _ in made])


@pytest.fixture
def direction():
    errors = [labels.error_text(0.02, 0.003, 0.05, *flags) for flags in ((True, True), (False, True), (True, False))]
    return make_direction(
        make_entry("simulation"),
        make_entry("ww09", "ww09", level=5.0, error=errors[0]),
        make_entry("elek10", "elek10", error=errors[1]),
        make_entry(f"bati19_ww[{MASKING}]", "bati19_ww", MASKING, error=errors[2], converged=False),
    )


def texts(figure):
    """All words in a figure."""
    found = [text.get_text() for text in figure.texts]
    for axes in figure.axes:
        found += [text.get_text() for text in [*axes.texts, axes.title]]
    return [words for words in found if words]


def test_the_figure_of_a_direction_shows_every_entry_twice_with_its_error(direction):
    figure = direction_figure("plastic", "reflection/internal", direction)
    (board,) = [axes for axes in figure.axes if axes.images]
    assert len(board.images) == 2 * len(direction.entries)
    words = texts(figure)
    assert "plastic,  reflection/internal,  light at 60°" in words
    # In the list of curves and below the views.
    for each in ("0.020 ± 0.003", "below noise (< 5.0e-02)", "0.020 ± 0.003 *"):
        assert words.count(each) == 2
    assert "bati19_ww\nmasking=correlated" in words and "bati19_ww[masking=correlated] = elek10" in words
    assert "simulation, ± 2 standard errors" in words
    (explained,) = [each for each in words if "standard error." in each.replace("\n", " ") or "errors.csv" in each]
    assert "log(1 + √f)" in explained and "sub-cells too coarse" in explained.replace("\n", " ")


def test_the_overviews_show_every_direction(direction):
    (lobes, views) = overviews("plastic", "reflection/internal", [direction] * 3, Path("plastic"), ("png",))
    figure = lobes[2](*lobes[3:])
    assert lobes[2] is lobes_figure and len(figure.axes) == 3
    # The noise of the simulation, and a curve for every entry.
    assert all(len(axes.patches) >= 1 for axes in figure.axes)
    figure = views[2](*views[3:])
    assert views[2] is views_figure and len(figure.axes[0].images) == 3 * len(direction.entries)
    assert [lobes[0].name, views[0].name] == ["plastic-lobes", "plastic-views"]
    (single,) = single_directions("plastic", "reflection/internal", [direction], Path("plastic"), ("png",))
    assert single[0].name == "plastic-lobes-theta_60"


def test_the_simulation_sets_the_scale(direction):
    assert direction.scaling is direction.entries[0]
    assert direction.scaling.highest == pytest.approx(0.1 * 1.02)
    scale = Scale(direction, 60)
    assert scale.white == pytest.approx(0.1)


def test_without_a_simulation_the_model_of_median_brightness_sets_it():
    levels = {"ww09": 40.0, "elek10": 0.1, "bati19_ww": 0.2}
    made = [make_entry(name, name, level=level) for name, level in levels.items()]
    direction = make_direction(*made)
    assert direction.scaling.label == "bati19_ww"
    assert Scale(direction, 60).white == pytest.approx(0.2)


def test_a_dirac_part_does_not_darken_the_rest():
    """Cell 12 x 36 + 18: where light at 60 degrees is mirrored to, in the plane."""
    number = 12 * 36 + 18
    direction = make_direction(make_entry("simulation", dirac=number), make_entry("ww09", "ww09"))
    assert direction.entries[0].dirac == number
    assert direction.entries[0].f.max() > 1e3
    assert direction.scaling.highest == pytest.approx(0.1 * 1.02, rel=1e-3)
    assert Scale(direction, 60).white == pytest.approx(0.1)
    spot = direction.spot(direction.entries[0])
    assert np.degrees(np.arccos(spot[2])) == pytest.approx(62.5) and spot[0] < 0.0
    assert direction.spot(direction.entries[1]) is None


def test_bands_leave_out_what_is_far_too_faint():
    direction = make_direction(
        make_entry("simulation"), *(make_entry(name, name, level=1e-12) for name in ("ww09", "elek10"))
    )
    levels = Scale(direction, 60).bands.norm.boundaries
    assert levels[1] >= 0.5 * FAINTEST * 0.1


def test_cells_without_a_value_are_explained(direction):
    assert "cut by the horizon" not in " ".join(texts(direction_figure("plastic", "reflection/internal", direction)))
    direction.cells.valid[:, -1] = False
    for figure in (direction_figure("plastic", "c", direction), views_figure("plastic", "c", [direction])):
        assert "hatched: cells cut by the horizon" in " ".join(texts(figure)).replace("\n", " ")


def test_black_slices_can_be_drawn():
    direction = make_direction(make_entry("simulation", level=0.0), make_entry("ww09", "ww09", level=0.0))
    assert direction.scaling.highest == 1.0
    assert Scale(direction, 60).bands is None
    figure = direction_figure("soot", "reflection/internal", direction)
    assert sum(len(axes.images) for axes in figure.axes) == 4


def test_a_component_in_parts_is_seen_whole():
    result = make_result(components=INTERNAL)
    whole = sum(part.bsdf[1] for part in result.components.values())
    seen = entries._entry(result.cells, 1, 60.0, "reflection", "simulation", None, "", result.components)
    np.testing.assert_array_equal(seen.slices, whole)
    # A model may also give all reflection at once, beside a part of it.
    parts = {"reflection": result.components["reflection/direct"], **result.components}
    seen = entries._entry(result.cells, 1, 60.0, "reflection", "ww09", "ww09", "", parts)
    np.testing.assert_array_equal(seen.slices, result.components["reflection/direct"].bsdf[1])


def test_lines_that_nearly_agree_are_told_apart_and_unknown_models_have_a_colour(direction):
    looks = style.lines(direction.entries)
    assert looks[0] == style.SIMULATION
    widths = [look["linewidth"] for look in looks[1:]]
    assert widths == sorted(widths, reverse=True) and len(set(widths)) == len(widths)
    stranger, _ = make_entry("new21", "new21")
    assert style.lines([stranger])[0]["color"] in style.SPARE_COLOURS


def test_errors_in_words():
    assert labels.error_text(0.02, 0.003, 0.05, True, True) == "0.020 ± 0.003"
    assert labels.error_text(0.02, 0.003, 0.05, True, False) == "0.020 ± 0.003 *"
    assert labels.error_text(0.0, 0.003, 0.05, False, False) == "below noise (< 5.0e-02)"


def test_some_directions_stand_for_many():
    assert spread(3, 12) == [0, 1, 2]
    many = spread(90, 12)
    assert len(many) == 12 and many[0] == 0 and many[-1] == 89


@pytest.mark.parametrize("width", [6.0, 12.0])
def test_long_words_stay_inside_the_figure(width):
    figure = Figure(figsize=(width, 3.0))
    title(figure, "S3-alpha0_0.05-alpha1_0.001-tau_0.05_0.1_0.8,  transmission,  light at 60°")
    caption(figure, "distance from the centre: luminance by log(1 + √f), labels in 1/sr; " * 3)
    renderer = FigureCanvasAgg(figure).get_renderer()
    for words in figure.texts:
        box = words.get_window_extent(renderer)
        assert box.x0 >= 0.0 and box.x1 <= figure.bbox.x1 and box.y0 >= 0.0
