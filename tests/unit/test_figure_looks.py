"""Nothing in a figure looks like what it is not: variants, channels, cells without a hit, errors within the noise."""

import itertools

import numpy as np
import pytest
from matplotlib import colormaps
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

from goniosim.compare.variants import Variant
from goniosim.models import MODELS, describe_options
from goniosim.report.comparison import style
from goniosim.report.comparison.cost import cost_figure
from goniosim.report.comparison.errors import SIGMAS, errors_figure
from goniosim.report.comparison.ranking import ranking
from goniosim.report.drawing import bands, disks, panels, tone, view, zoom
from goniosim.report.simulation.direction import direction_figure
from synthetic import make_result, make_summary


def all_variants():
    """Every model with every combination of its options."""
    for model in MODELS:
        infos = describe_options(model)
        for values in itertools.product(*(info.values for info in infos)):
            chosen = [(i.name, v) for i, v in zip(infos, values, strict=True) if v != i.default]
            yield Variant(model, tuple(chosen))


def strokes(look):
    """The dash as a cycle of strokes and gaps, whatever it begins with; the empty one is solid."""
    if look.dash == "-":
        return ()
    pattern = look.dash[1]
    pairs = [pattern[n : n + 2] for n in range(0, len(pattern), 2)]
    return min(tuple(pairs[n:] + pairs[:n]) for n in range(len(pairs)))


def test_no_two_variants_of_all_models_look_alike():
    looks = {variant.label: style.of(variant) for variant in all_variants()}
    assert len(looks) > 200
    # A dash that differs as a cycle tells lines apart, and a colour and a marker tell models apart.
    lines = {(look.colour, strokes(look)) for look in looks.values()}
    assert len(lines) == len(looks)
    for one, other in itertools.combinations(MODELS, 2):
        assert looks[one].colour != looks[other].colour and looks[one].marker != looks[other].marker


@pytest.mark.parametrize("given", ["", "masking=correlated", "fgd=exact", "fgd=fresnel", "normalise_lobes=true"])
def test_readings_that_stand_in_one_figure_differ_in_dash_and_mark(given):
    """`compare` adds one of two readings beside the options given; studies of metals and slabs have both."""
    beside = ("refraction_scale=paper", "jacobian=snell")
    options = [given, *(",".join(filter(None, (given, each))) for each in beside)]
    looks = [style.look("belcour18_forward", each) for each in options]
    assert len({strokes(look) for look in looks}) == 3
    assert len({look.fill for look in looks}) == 3


def test_a_look_depends_on_the_variant_alone():
    one, other = style.look("ww09", "masking=correlated"), style.look("elek10", "masking=correlated")
    assert (one.dash, one.fill) == (other.dash, other.fill)
    assert style.look("new21", "x=1") == style.look("new21", "x=1") != style.look("new22", "x=1")


def test_models_differ_in_brightness_or_mark_on_grey_paper():
    """Neighbours in the list differ in luminance, and all of them in their marks."""
    brightness = [np.array(to_rgb(colour)) @ tone.LUMINANCE for colour in style.COLOURS.values()]
    assert np.ptp(brightness) > 0.3
    assert len(set(style.MARKERS.values())) == len(style.MARKERS)


def test_channels_are_told_by_dash_as_well():
    looks = [panels.channel_look(name, c, 3) for c, name in enumerate("RGB")]
    assert len({dash for _, dash in looks}) == len({colour for colour, _ in looks}) == 3
    others = [panels.channel_look(f"{c} nm", c, 31) for c in range(31)]
    assert all(one[1] != next_one[1] for one, next_one in itertools.pairwise(others))
    assert len(set(others)) == 31


def test_bands_get_brighter_all_the_way():
    scale = bands.scale(1e-4, 10.0)
    brightness = scale.cmap.colors[:, :3] @ tone.LUMINANCE
    assert np.all(np.diff(brightness) > 0.02)
    np.testing.assert_allclose(scale.cmap.colors[-1], colormaps["viridis"](1.0))


def test_cells_that_were_not_hit_look_unlike_dark_and_invalid_ones():
    result = make_result(theta_deg=(60.0,), channels=("R", "G", "B"), rows=3, columns=4)
    component = result.components["reflection/internal"]
    component.hits[:] = 5
    component.hits[0, 0, 0] = component.hits[0, 1, 1] = 0
    component.energy[0, :, 0, :2] = component.bsdf[0, :, 0, :2] = 0.0
    result.cells.valid[0, 2] = False
    component.energy[0, :, 2] = component.bsdf[0, :, 2] = 0.0
    component.hits[0, 2] = 0
    unseen = panels.unseen_cells([component], result.cells, 0)
    # Energy without a hit there is not, but it would be no darkness; what is invalid is not unseen.
    assert unseen.tolist() == [[True, False, False, False], [False] * 4, [False] * 4]
    direct = result.components["reflection/direct"]
    assert panels.unseen_cells([direct], result.cells, 0) is None
    assert panels.unseen_cells([direct, component], result.cells, 0) is None
    component.hits, counted = None, component.hits
    # Without hits darkness is all that tells.
    component.estimator = ["split"]
    assert panels.unseen_cells([component], result.cells, 0).tolist() == [
        [True, True, False, False],
        *[[False] * 4] * 2,
    ]
    component.hits, component.estimator = counted, ["analog"]

    numbers = view.disk(result.cells, 0, 60.0, 60)
    disk = disks.Board(Figure(figsize=(3.0, 3.0))).disk(0.0, 0.0, 2.0)
    disk.colour(component.bsdf[0], numbers, 60.0, 1.0, unseen=unseen)
    disk.bands(component.bsdf[0], numbers, 60.0, bands.scale(0.01, 1.0), unseen=unseen)
    for image, colour in zip(disk.axes.images, panels.UNSEEN, strict=True):
        found = np.asarray(image.get_array())
        nothing, dark, invalid = (found[numbers == n][:, :3] for n in (0, 1, view.INVALID))
        np.testing.assert_allclose(nothing, np.broadcast_to(colour, nothing.shape))
        assert np.abs(dark - nothing[0]).max(axis=1).min() > 0.1
        # Hatched, in two greys that neither of the others has.
        assert {tuple(each) for each in invalid} == {panels.INVALID_GREY, panels.INVALID_STRIPE}


def test_curves_that_coincide_are_found():
    x = np.linspace(-80.0, 80.0, 50)
    wave = np.sin(x / 30.0)
    gap = np.where(np.abs(x) < 10.0, np.nan, wave)
    curves = [(x, wave), (x, wave + 0.009), (x, wave + 0.02), (x[::2], wave[::2]), (x, gap), (x, gap), (x[:0], x[:0])]
    found = panels.coinciding(curves, 0.01)
    assert found == [set(), {0}, set(), {0}, set(), {4}, set()]


@pytest.mark.parametrize(("width", "narrow"), [(0.05, True), (0.6, True), (8.0, False)])
def test_narrow_lobes_are_enlarged(width, narrow):
    angle = np.sort(np.concatenate([np.arange(-89.5, 90.0), 30.0 + np.linspace(-1.0, 1.0, 401)]))
    f = 1e-3 + 100.0 / (1.0 + ((angle - 30.0) / width) ** 2) ** 2
    shown = zoom.window(angle, f, 0.01 * f)
    assert (shown is not None) == narrow
    if narrow:
        assert shown[0] < 30.0 - 2.0 * width and 30.0 + 2.0 * width < shown[1]
        assert shown[1] - shown[0] < 20.0 * width
    # Noise is no lobe, nor is a ripple on a bright ground.
    assert zoom.window(angle, f, 0.5 * f) is None
    assert zoom.window(angle, 100.0 + f, 0.01 * f) is None
    assert zoom.window(angle, 0.0 * f, 0.0 * f) is None


def test_an_error_below_the_noise_floor_has_its_bar_and_its_halo():
    figure = errors_figure([make_summary()])
    (axes,) = figure.axes
    assert axes.get_ylabel() == "RMSE [sr$^{-1/2}$]"
    # The band of noise reaches down to the axis; the mark stands before it, with two standard errors.
    (bar, _) = axes.containers
    (ends,) = bar.lines[2][0].get_segments()
    assert ends[:, 1] == pytest.approx([0.001 - SIGMAS * 0.0003, 0.001 + SIGMAS * 0.0003])
    marks = [line for line in axes.lines if line.get_path_effects()]
    assert [line.get_ydata()[0] for line in marks] == [0.001, 0.002]
    band = axes.collections[0]
    assert all(line.get_zorder() > band.get_zorder() for line in marks)
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    assert "ww09" in labels and "belcour18_forward[jacobian=snell]" in labels
    assert "± 2 standard errors" in labels and any("marks in it are significant" in label for label in labels)


def test_the_cost_figure_names_every_model_material_and_axis():
    figure = cost_figure([make_summary("M1-a"), make_summary("M2-a")])
    (axes,) = figure.axes
    words = [text.get_text() for text in axes.texts]
    assert {"ww09", "belcour18_forward[jacobian=snell]", "M1", "M2"} <= set(words)
    # Not significant anywhere, so without a mark.
    assert "elek10" not in words
    assert axes.get_xlabel().endswith("[s]") and axes.get_ylabel().endswith("[1]")
    names = [text for text in axes.texts if text.get_text() in MODELS]
    places = [text.get_position()[1] for text in names]
    assert len(set(places)) == len(places)


def test_errors_have_their_unit_in_the_ranking():
    header = ranking([make_summary()]).splitlines()
    assert any(line.split().count("[sr^-1/2]") >= 2 for line in header[:4])


def test_the_figure_of_a_direction_looks_closer_at_a_narrow_lobe():
    """A lobe in four cells: another panel beside the plane, another picture between the disks."""
    result = make_result(theta_deg=(30.0,), channels=("R", "G", "B"), rows=90, columns=36, rays=10**7)
    component = result.components["reflection/internal"]
    result.components = {"reflection/internal": component}
    figure = direction_figure(result, 0)
    assert len([axes for axes in figure.axes if axes.lines]) == 2 and len(figure.axes[0].images) == 2
    component.bsdf[0, :, 29:31, 17:19] = 1e3
    component.bsdf_stderr[0, :, 29:31, 17:19] = 1.0
    figure = direction_figure(result, 0)
    board, near = figure.axes[0], figure.axes[-1]
    assert len(board.images) == 3
    low, high = near.get_xlim()
    assert low < 29.0 and high > 31.0 and high - low < 20.0
    assert "enlarged beside it" in [text.get_text() for text in figure.legends[0].get_texts()]
    # The bands reach the peak.
    values = np.asarray(board.images[2].get_array())
    np.testing.assert_allclose(values[60, 60, :3], colormaps["viridis"](1.0)[:3])


def test_one_exact_direction_is_not_enlarged_but_its_point_is_seen():
    """The cell of a Dirac part among cells that nothing hit: a line between two gaps shows nothing."""
    result = make_result(theta_deg=(30.0,), channels=("R", "G", "B"), rows=90, columns=36)
    component = result.components["transmission"]
    result.components = {"transmission": component}
    for array in (component.hits, component.energy, component.bsdf, component.bsdf_stderr):
        array[:] = 0
    component.hits[0, 30, 18], component.energy[0, :, 30, 18], component.bsdf[0, :, 30, 18] = 100, 0.1, 1e3
    figure = direction_figure(result, 0)
    (plane,) = [axes for axes in figure.axes if axes.lines and axes.axison]
    points = [line.get_xdata() for line in plane.lines if line.get_marker() == "."]
    assert [len(each) for each in points] == [1] and points[0][0] == pytest.approx(30.5, abs=1.0)
    assert panels.isolated(np.array([1.0, np.nan, 2.0, np.nan, 3.0, 4.0])).tolist() == [0, 2]
