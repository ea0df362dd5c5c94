"""Words have room in figures, however long: nothing is cut, nothing lies on a title or a legend."""

import dataclasses
import itertools

import pytest
from matplotlib import rc_context
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.text import Text

from goniosim.compare.variants import Variant
from goniosim.report.comparison import entries
from goniosim.report.comparison.cost import cost_figure
from goniosim.report.comparison.direction import direction_figure
from goniosim.report.comparison.errors import errors_figure
from goniosim.report.comparison.lobes import lobes_figure
from goniosim.report.comparison.views import views_figure
from goniosim.report.drawing import legend, letters
from goniosim.report.drawing.files import STYLE
from goniosim.report.simulation.direction import direction_figure as figure_of_a_result
from goniosim.report.simulation.overview import overview_figure
from synthetic import make_result, make_summary

PARTS, WORD = "alpha0_0.001-" * 9 + "end", "w" * 120
OPTIONS = "masking=correlated,fgd=fresnel,refraction_scale=paper,jacobian=snell,normalise_lobes=true"
CHANNELS = tuple(f"{wavelength} nm" for wavelength in range(400, 720, 20))
INTERNAL = "reflection/internal"


def make_direction(theta_deg):
    result = make_result(theta_deg=(theta_deg,), channels=("R", "G", "B"), rows=9, columns=12, rays=2000)
    seen = entries._entry(result.cells, 0, theta_deg, INTERNAL, "simulation", None, "", result.components)
    models = [
        dataclasses.replace(seen, label=label, model=model, options_text=options, error="123.45678 ± 0.00012 *")
        for model in ("ww09", "a_model_from_elsewhere_with_a_long_name")
        for label, options in ((model, ""), (f"{model}[{OPTIONS}]", OPTIONS))
    ]
    return entries.Direction(0, theta_deg, f"{theta_deg:g}", result.cells, [seen, *models])


def long_summary(name, alpha, category="metals"):
    made = make_summary(name, alpha, category)
    options = tuple(tuple(option.split("=")) for option in OPTIONS.split(","))
    long = Variant("belcour18_symmetric", options)
    row = made.rows[0] | {"model": long.model, "options": long.options_text}
    return dataclasses.replace(made, variants=[*made.variants, long], rows=[*made.rows, row])


def figures():
    seen = [make_direction(0.0), make_direction(60.0)]
    yield "direction", direction_figure, (PARTS, INTERNAL, seen[1])
    yield "views", views_figure, (WORD, INTERNAL, seen)
    yield "lobes", lobes_figure, (PARTS, INTERNAL, seen)
    for make, name, channels in ((figure_of_a_result, WORD, CHANNELS), (overview_figure, PARTS, ("R", "G", "B"))):
        result = make_result(channels=channels, parametrization="half", rays=2000, name=name)
        for component in result.components.values():
            component.contains_delta = True
        yield f"result, {len(channels)} channels", make, (result, 1)[: 1 + (make is figure_of_a_result)]
    many = [long_summary(f"{PARTS}{n}", alpha) for n in range(4) for alpha in (0.001, 0.2)]
    many.append(long_summary(WORD, 0.05, "plastics"))
    yield "errors", errors_figure, (many,)
    yield "errors of one", errors_figure, (many[-1:],)
    yield "cost", cost_figure, (many,)


@pytest.mark.parametrize(("make", "arguments"), [pytest.param(*each[1:], id=each[0]) for each in figures()])
def test_words_stay_inside_the_figure_and_off_each_other(make, arguments):
    figure = drawn(make, *arguments)
    renderer = FigureCanvasAgg(figure).get_renderer()
    boxes = [(each, each.get_window_extent(renderer)) for each in words_of(figure, renderer)]
    for words, box in boxes:
        inside = min(box.x0, box.y0) >= -0.5 and box.x1 <= figure.bbox.x1 + 0.5 and box.y1 <= figure.bbox.y1 + 0.5
        assert inside, words
    headings = {*figure.texts, *figure.legends, *(axes.title for axes in figure.axes)}
    boxes = [(words, box) for words, box in boxes if words in headings]
    for (one, box), (other, other_box) in itertools.combinations(boxes, 2):
        assert not box.overlaps(other_box), (one, other)


def drawn(make, *arguments):
    """The figure as it is written: letters are wider at fewer dots per inch."""
    with rc_context(STYLE):
        return make(*arguments)


def words_of(figure, renderer):
    """Everything that is written: headings, legends as a whole, texts and labels of axes, ticks within their limits."""
    found = [*figure.texts, *figure.legends]
    for axes in figure.axes:
        found += [axes.title, *axes.texts]
        if axes.axison:
            # Sets the ticks.
            axes.get_tightbbox(renderer)
            found += [axes.xaxis.label, axes.yaxis.label, *tick_labels(axes.xaxis), *tick_labels(axes.yaxis)]
    return [each for each in found if not isinstance(each, Text) or each.get_text().strip()]


def tick_labels(axis):
    low, high = sorted(axis.get_view_interval())
    return [tick.label1 for tick in axis.get_major_ticks() if low <= tick.get_loc() <= high]


def test_tick_labels_do_not_touch():
    figure = drawn(errors_figure, [long_summary("a", 0.2)])
    renderer = FigureCanvasAgg(figure).get_renderer()
    (axes,) = figure.axes
    axes.get_tightbbox(renderer)
    boxes = [label.get_window_extent(renderer) for label in tick_labels(axes.yaxis)]
    assert len(boxes) >= 2
    assert not any(one.overlaps(other) for one, other in itertools.combinations(boxes, 2))


@pytest.mark.parametrize("number", range(1, 13))
@pytest.mark.parametrize("room", [3.0, 5.0, 8.0])
def test_a_legend_fills_its_rows(number, room):
    columns, _ = legend.layout(["a label"] * number, 9.0, room)
    rows = -(-number // columns)
    assert columns == -(-number // rows)


def test_words_are_measured_and_broken():
    one_line = letters.width("material", 8.0)
    assert 0.3 < one_line < 0.8 and letters.width("material\nx", 8.0) == one_line
    assert letters.fitting("material", 8.0, 1.0) == 8.0
    assert letters.width("material", letters.fitting("material", 8.0, 0.2)) <= 0.2
    for words in (PARTS, WORD):
        lines = letters.broken(words, 8.0, 1.0)
        assert lines.replace("\n", "") == words and letters.width(lines, 8.0) <= 1.0
    assert letters.broken("ww09[masking=correlated]", 8.0, 0.9).split("\n")[0] in ("ww09[", "ww09[masking=")
    words, size = letters.snug(WORD, 8.0, 4.0)
    assert words.count("\n") == 1 and letters.width(words, size) <= 4.0
