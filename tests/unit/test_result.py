"""What people do with a result in Python: look at it, take albedos, draw it, label it, save it."""

import pickle
import sys

import numpy as np
import pytest
import xarray as xr
from matplotlib.image import imread

import goniosim
from goniosim.engine.estimate import mean_and_error
from goniosim.errors import OutputError, UnusableResultError
from goniosim.report.simulation.figures import draw
from goniosim.report.simulation.summary import description
from synthetic import fill, make_result


@pytest.fixture(scope="module")
def result():
    return make_result(channels=("R", "G", "B"), orders=3)


def test_the_albedo_of_a_component_is_its_own(result):
    """Sampled ones have the error of sums over cells that share their paths; the direct one the integration's."""
    for name in ("reflection/internal", "transmission", "transmission/order_2"):
        part, _, order = name.partition("/order")
        component = result.components[part].orders[f"order{order}"] if order else result.components[part]
        value, stderr = result.albedo(name)
        np.testing.assert_array_equal(value, component.albedo)
        np.testing.assert_allclose(stderr, component.albedo_stderr, rtol=1e-15)
        assert (stderr < 0.99 * np.sqrt((component.stderr**2).sum(axis=(2, 3)))).all()
    value, stderr = result.albedo("reflection/direct")
    np.testing.assert_array_equal(value, result.audit.direct_integrated)
    np.testing.assert_allclose(stderr, result.audit.direct_integrated_stderr, rtol=1e-15)


def test_albedos_add_up(result):
    parts = [result.albedo(name) for name in result.components]
    value, stderr = result.albedo("reflection")
    np.testing.assert_allclose(value, parts[0][0] + parts[1][0], rtol=1e-15)
    np.testing.assert_allclose(stderr, np.hypot(parts[0][1], parts[1][1]), rtol=1e-15)
    np.testing.assert_allclose(result.albedo()[0], sum(value for value, _ in parts), rtol=1e-12)


@pytest.mark.parametrize(
    ("estimators", "batches", "expected"),
    [
        # Batches that scatter together; one component against the other; nothing known; two runs.
        (("split", "split"), (1.0, 1.0), "sum"),
        (("split", "split"), (1.0, -1.0), "difference"),
        (("split", "split"), None, "sum"),
        (("split", "analog"), (1.0, 0.0), "quadrature"),
    ],
    ids=["together", "against", "unknown", "apart"],
)
def test_two_components_of_other_estimators_add_up(estimators, batches, expected):
    names = ("reflection/internal", "transmission")
    result = make_result(components=names, estimator=dict(zip(names, estimators, strict=True)))
    parts = [result.components[name] for name in names]
    for part, sign in zip(parts, batches or (), strict=False):
        if part.batches is not None:
            mean = part.batches.mean(axis=1, keepdims=True)
            part.batches = mean + sign * (part.batches - mean)
    if batches is None:
        parts[0].batches = None
    a, b = (part.albedo_stderr for part in parts)
    stderr = {"sum": a + b, "difference": abs(a - b), "quadrature": np.hypot(a, b)}[expected]
    np.testing.assert_allclose(result.albedo()[1], stderr, rtol=1e-9)


def test_the_estimator_of_a_result_is_that_of_its_parts():
    assert (
        make_result().estimator == "analog" and make_result(components=("reflection/direct",)).estimator == "integrated"
    )
    result = make_result(estimator={"transmission": "split"})
    assert result.estimator == "mixed" and "sampled (split)," in repr(result.components["transmission"])
    assert make_result(estimator="split").estimator == "split"
    result.components["transmission"].energy[0, 1] = 0.0
    value, stderr = result.albedo("transmission")
    assert stderr[0, 1] == 1.5 / result.rays[0] > 0.0 and stderr[0, 0] != stderr[0, 1]


@pytest.mark.false_alarm(0)
@pytest.mark.parametrize("name", [None, "reflection/internal/order_2"])
def test_sums_over_cells_have_the_error_of_sums_over_paths(name):
    """Paths are made up one by one: the error of their total energy must come out of cells alone, to rounding."""
    rng = np.random.default_rng(5)
    result = make_result(theta_deg=(0.0,), channels=("R",), rows=3, columns=4, orders=2, rays=500)
    sides = [result.components["reflection/internal"], result.components["transmission"]]
    # Half the paths leave; where, and with what energy, is up to chance. Both sides are half of 24 cells.
    cell = rng.integers(-24, 24, 500)
    weight = rng.uniform(0.0, 1.0, 500)
    made = np.where(cell == np.arange(24)[:, None], weight, 0.0).reshape(2, 3, 4, 500)
    energy, stderr = mean_and_error(made.sum(axis=-1), (made**2).sum(axis=-1), 500)
    for side, value, error, paths in zip(sides, energy, stderr, made, strict=True):
        for component in (side, side.orders["order_2"]):
            component.energy, component.stderr = value[None, None], error[None, None]
            component.hits = (paths > 0).sum(axis=-1)[None]
            fill(component, 500)
    direct = result.components["reflection/direct"]
    direct.albedo[:] = direct.albedo_stderr[:] = 0.0
    total = (made if name is None else made[0]).reshape(-1, 500).sum(axis=0)
    value, error = result.albedo(name)
    assert value[0, 0] == pytest.approx(total.mean(), rel=1e-12)
    assert error[0, 0] == pytest.approx(total.std(ddof=1) / 500**0.5, rel=1e-9)


def test_what_was_not_seen_is_bounded_and_what_was_not_traced_is_not_known():
    result = make_result()
    component = result.components["transmission"]
    for array in (component.hits, component.energy, component.stderr):
        array[0] = 0
    fill(component, 100_000)
    result.rays[1] = 0
    value, stderr = result.albedo("transmission")
    assert (value[0] == 0.0).all() and stderr[0] == pytest.approx(1.5 / result.rays[0])
    assert np.isnan(value[1]).all() and np.isnan(stderr[1]).all()
    assert np.isfinite(result.albedo("reflection/direct")[0]).all()
    assert "nan" not in repr(result)


def test_an_unknown_component_is_refused_with_those_that_there_are(result):
    with pytest.raises(UnusableResultError, match="no component 'reflected'; there is reflection/direct.*order_2"):
        result.albedo("reflected")


def test_everything_is_shown_in_a_few_words(result):
    """Never as arrays, of which thousands of numbers would fill the screen."""
    assert repr(result).splitlines()[:4] == [
        "<Result synthetic (complete)",
        "  incident theta [deg]: 0, 60",
        "  classic slices of 6 x 8 cells, channels R, G, B",
        "  rays per direction: 1e5, seed 1",
    ]
    value, stderr = result.albedo("transmission")
    assert f"transmission {value.mean():.4f} ± " in repr(result)
    parts = [result.cells, result.audit, result.cost, *result.components.values()]
    for part in [*parts, goniosim.load_scene(result.config_yaml)]:
        assert str(part) == repr(part)
        assert repr(part).startswith(f"<{type(part).__name__}")
        assert len(repr(part)) < 250 and "\n" not in repr(part) and "array" not in repr(part)


def test_many_directions_are_not_all_listed():
    many = make_result(theta_deg=range(90), rows=2, columns=2)
    assert "incident theta [deg]: 0, 1, 2, ..., 88, 89 (90 directions)\n" in repr(many)
    many.rays[:] = 0
    assert "transmission not traced>" in repr(many)


def test_a_figure_of_all_directions_or_of_one(tmp_path):
    """Saved by hand it is the picture that the command draws; notebooks show it without pyplot."""
    result = make_result(channels=("R", "G", "B"), components=("transmission",))
    (written,) = draw(result, tmp_path, "stem", theta_deg=[60.0])
    figure = result.plot(theta_deg=60)
    figure.savefig(tmp_path / "own.png")
    np.testing.assert_array_equal(imread(tmp_path / "own.png"), imread(written))
    overview = pickle.loads(pickle.dumps(result.plot()))
    assert overview._repr_png_().startswith(b"\x89PNG")
    assert [text.get_text() for text in overview.texts] != [text.get_text() for text in figure.texts]
    with pytest.raises(UnusableResultError, match="theta 45 was not simulated; there is 0, 60"):
        result.plot(theta_deg=45)


def test_labelled_arrays_are_those_of_the_file(tmp_path):
    """Groups, names, axes, coordinates, units, attributes and numbers."""
    result = make_result(orders=2, parametrization="half")
    path = result.save(tmp_path / "result.h5")
    with xr.open_datatree(path, engine="h5netcdf") as file:
        # Sums over the bytes of a file mean nothing beside it.
        groups = {group: data.load() for group, data in file.to_dict().items() if group != "/checksums"}
    for variable in (variable for group in groups.values() for variable in group.variables.values()):
        variable.attrs.pop("sha256", None)
    tree = xr.DataTree.from_dict(groups)
    xr.testing.assert_identical(result.to_xarray(), tree)
    assert _types(result.to_xarray()) == _types(tree)


def _types(tree):
    """Types of the attributes, which may be equal without being alike."""
    return {group.path: {name: type(value) for name, value in group.attrs.items()} for group in tree.subtree}


def test_without_xarray_the_remedy_is_named(result, monkeypatch):
    monkeypatch.setitem(sys.modules, "xarray", None)
    with pytest.raises(ImportError, match=r"pip install goniosim\[xarray\]"):
        result.to_xarray()


def test_save_gives_the_path_and_open_result_reads_it(result, tmp_path):
    path = result.save(str(tmp_path / "result.h5"), overwrite=True)
    assert path == tmp_path / "result.h5"
    assert goniosim.open_result(path).name == result.name


def test_a_refused_save_leaves_nothing_behind(result, tmp_path, monkeypatch):
    """Whoever saves has the result still: no copy is rescued."""
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(temporary))
    (tmp_path / "notes.h5").write_text("mine")
    with pytest.raises(OutputError, match="not a goniosim result"):
        result.save(tmp_path / "notes.h5")
    assert list(temporary.iterdir()) == []


def test_a_result_without_hits_is_compared_and_described_as_one_with_hits(tmp_path):
    """The same numbers by another estimator: the same error of a model, but for what batches say of its error bar."""
    found = {}
    for name in ("analog", "split"):
        components = ("reflection/direct", "reflection/internal")
        made = make_result(channels=("R", "G", "B"), components=components, estimator=name)
        result = goniosim.open_result(made.save(tmp_path / f"{name}.h5"))
        (found[name],) = goniosim.compare(result, models=["ww09"]).rows()
        assert f"estimator {name}" in description(result)
    one, other = found["analog"], found["split"]
    assert one["rmse"] == other["rmse"] > 0.0 and one["noise_floor"] == other["noise_floor"]
    assert 0.0 < one["rmse_stderr"] != other["rmse_stderr"] > 0.0
    # Batches that scatter by a tenth, all cells alike.
    expected = 0.1 * one["albedo_reference"] / 31**0.5
    assert other["albedo_reference_stderr"] == pytest.approx(expected / 2**0.5, rel=1e-6)
