"""`goniosim.simulate` and its like in a script or a notebook: what they take, say, and keep on Ctrl-C."""

import signal
import threading

import numpy as np
import pytest

import goniosim
from goniosim.compare.comparison import Comparison
from goniosim.errors import ConfigError, OutputError, ResourceError, StoppedError

SCENE = {
    "material": {"name": "coated", "layers": [{"interface": {"type": "dielectric", "eta": 1.5, "alpha": 0.2}}]},
    "incident": {"theta_deg": [0, 60]},
    "slice": {"rows": 2, "columns": 4},
    "simulation": {"rays": 2000},
}
STUDY = {
    "study": {
        "name": "coats",
        "cross": {"alpha": [0.1, 0.2, 0.3]},
        "material": {
            "name": "coat-${alpha}",
            "layers": [{"interface": {"type": "dielectric", "eta": 1.5, "alpha": "${alpha}"}}],
        },
    },
    **{key: SCENE[key] for key in ("incident", "slice", "simulation")},
}
NAMES = ["coat-0.1", "coat-0.2", "coat-0.3"]
# Enough to be interrupted, and few enough that a test which is not comes to an end.
MANY = 3e8


@pytest.fixture(autouse=True)
def hearing():
    """Ctrl-C as in a terminal: a shell lets what it starts in the background ignore it."""
    earlier = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, earlier)


def press(after=0, times=1):
    """A progress function that presses Ctrl-C once more than ``after`` rays are done."""
    left = [times]

    def progress(done_rays, total_rays):
        while done_rays > after and left[0]:
            left[0] -= 1
            signal.raise_signal(signal.SIGINT)

    return progress


def same(one, other):
    return all(
        np.array_equal(component.energy, other.components[name].energy) for name, component in one.components.items()
    )


def test_a_scene_is_a_dict_a_path_text_or_a_scene(tmp_path):
    """With numbers and arrays of numpy, and any mapping and sequence."""
    arrays = {**SCENE, "incident": {"theta_deg": np.array([0, 60])}, "slice": {"rows": np.int64(2), "columns": 4}}
    layers = tuple(SCENE["material"]["layers"])
    ranges = {**SCENE, "incident": {"theta_deg": range(0, 61, 60)}, "material": {"name": "coated", "layers": layers}}
    scene = goniosim.load_scene(SCENE)
    path = tmp_path / "scene.yaml"
    path.write_text(scene.to_yaml())
    for source in (arrays, ranges, scene.to_yaml(), path, str(path)):
        assert goniosim.load_scene(source) == scene
    assert same(goniosim.simulate(SCENE), goniosim.simulate(scene))
    assert goniosim.load_scenes(SCENE) == [scene]
    assert [each.material.name for each in goniosim.load_scenes(STUDY)] == NAMES


@pytest.mark.parametrize(
    ("source", "problem"),
    [
        (
            {**SCENE, "slice": {"rows": np.float64(0.5)}},
            "slice.rows: must be a whole number from 1 to 4e6 [got 0.5]",
        ),
        (
            "material: 1\nincident: {theta_deg: [0]}",
            "<string>:1: material: must be a mapping with name and layers [got 1]",
        ),
        (5, "a scene must be a path, a mapping or YAML text [got 5]"),
        (
            STUDY,
            "study: describes several materials, and one is needed here: "
            "give a scene with material, or use load_scenes or simulate_study",
        ),
    ],
)
def test_mistakes_in_a_scene_without_a_file_name_the_field(source, problem):
    with pytest.raises(ConfigError) as caught:
        goniosim.simulate(source)
    assert caught.value.problems == [problem]


@pytest.mark.parametrize(
    ("arguments", "problems"),
    [
        ({"rays": "many"}, ["rays must be a whole number from 100 to 1e15, such as 1e7 [got 'many']"]),
        ({"rays": 1000.5}, ["rays must be a whole number from 100 to 1e15, such as 1e7 [got 1000.5]"]),
        ({"rays": np.int32(5)}, ["rays must be a whole number from 100 to 1e15, such as 1e7 [got 5]"]),
        (
            {"seed": -1, "threads": 0},
            [
                "seed must be a whole number from 0 to 2^63 - 1 [got -1]",
                "threads must be a whole number from 1 to 4096; leave it out to use every core [got 0]",
            ],
        ),
        ({"progress": 5}, ["progress must be True, False or a function of done and total rays [got 5]"]),
        ({"stop": True}, ["stop must be a threading.Event [got True]"]),
    ],
)
def test_wrong_arguments_are_called_by_their_python_name(arguments, problems):
    for simulate, what in ((goniosim.simulate, SCENE), (goniosim.simulate_study, STUDY)):
        with pytest.raises(goniosim.GoniosimError) as caught:
            simulate(what, **arguments)
        assert caught.value.problems == problems


def test_whole_numbers_of_any_type_are_numbers_of_rays():
    for rays in (2000, 2e3, np.int64(2000), np.float32(2000.0)):
        assert goniosim.simulate(SCENE, rays=rays, seed=np.uint8(1)).rays.tolist() == [2000, 2000]


def test_ctrl_c_returns_what_was_gathered():
    earlier = signal.getsignal(signal.SIGINT)
    result = goniosim.simulate(SCENE, rays=MANY, progress=press())
    assert result.status == "partial"
    assert result.rays.min() > 0 and result.rays.max() < MANY
    assert signal.getsignal(signal.SIGINT) is earlier


def test_ctrl_c_twice_is_a_keyboard_interrupt():
    earlier = signal.getsignal(signal.SIGINT)
    with pytest.raises(KeyboardInterrupt):
        goniosim.simulate(SCENE, rays=MANY, progress=press(times=2))
    assert signal.getsignal(signal.SIGINT) is earlier


@pytest.mark.parametrize("tracing", [False, True])
@pytest.mark.parametrize(
    ("simulate", "what"), [(goniosim.simulate, SCENE), (goniosim.simulate_study, STUDY)], ids=["scene", "study"]
)
def test_ctrl_c_with_nothing_gathered_is_a_keyboard_interrupt(monkeypatch, simulate, what, tracing):
    """At once while kernels compile; after a moment once rays are on their way."""

    def engine(scene, progress, stop, **_):
        if tracing:
            progress(0, 1000)
        signal.raise_signal(signal.SIGINT)
        assert tracing and stop.is_set()
        raise StoppedError("stopped before the first rays were through")

    monkeypatch.setattr("goniosim.engine.simulate", engine)
    earlier = signal.getsignal(signal.SIGINT)
    with pytest.raises(KeyboardInterrupt):
        simulate(what)
    assert signal.getsignal(signal.SIGINT) is earlier


def test_a_handler_of_ones_own_is_called_too_and_comes_back():
    heard = []

    def own(signum, frame):
        heard.append(signum)

    earlier = signal.signal(signal.SIGINT, own)
    try:
        assert goniosim.simulate(SCENE, rays=MANY, progress=press()).status == "partial"
        assert heard == [signal.SIGINT]
        assert signal.getsignal(signal.SIGINT) is own
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        assert goniosim.simulate(SCENE, progress=press()).status == "complete"
    finally:
        signal.signal(signal.SIGINT, earlier)


def test_an_event_stops_beside_ctrl_c_and_in_other_threads():
    stop = threading.Event()
    found = []

    def work():
        found.append(goniosim.simulate(SCENE, rays=MANY, progress=lambda done, total: done and stop.set(), stop=stop))

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert found[0].status == "partial"
    with pytest.raises(StoppedError):
        goniosim.simulate(SCENE, stop=stop)
    mine = threading.Event()
    assert goniosim.simulate(SCENE, rays=MANY, progress=press(), stop=mine).status == "partial"
    assert not mine.is_set()


def test_a_bar_or_nothing(capsys):
    goniosim.simulate(SCENE, progress=False)
    assert capsys.readouterr() == ("", "")
    goniosim.simulate(SCENE, progress=True)
    assert "coated: 100%|" in capsys.readouterr().err


def test_a_study_gives_a_result_for_each_name():
    seen = []
    results = goniosim.simulate_study(STUDY, progress=lambda *rays: seen.append(rays))
    assert list(results) == NAMES
    assert seen == sorted(seen) and seen[-1] == (12_000, 12_000)
    (scene, *_) = goniosim.load_scenes(STUDY)
    assert same(results["coat-0.1"], goniosim.simulate(scene))
    assert list(goniosim.simulate_study([scene], rays=1000)) == list(goniosim.simulate_study(scene)) == ["coat-0.1"]
    for wrong, message in (([], "no scenes"), ([SCENE, SCENE], "named coated"), (5, "must be a path")):
        with pytest.raises(ConfigError, match=message):
            goniosim.simulate_study(wrong)


def test_a_study_in_a_folder_goes_on_where_it_ended(tmp_path):
    folder = tmp_path / "new" / "coats"
    paths = {name: folder / f"{name}.h5" for name in NAMES}
    first = goniosim.simulate_study(STUDY, folder=folder, rays=5e5, threads=1, progress=press(after=1_100_000))
    assert first == {name: paths[name] for name in NAMES[:2]}
    assert [goniosim.open_result(path).status for path in first.values()] == ["complete", "partial"]
    before = paths["coat-0.1"].stat()
    assert goniosim.simulate_study(STUDY, folder=folder, rays=5e5) == paths
    assert paths["coat-0.1"].stat().st_mtime_ns == before.st_mtime_ns
    assert {goniosim.open_result(path).status for path in paths.values()} == {"complete"}
    whole = goniosim.simulate(goniosim.load_scenes(STUDY)[1], rays=5e5)
    assert same(goniosim.open_result(paths["coat-0.2"]), whole)
    assert sorted(folder.iterdir()) == sorted(paths.values())


def test_an_interrupted_study_keeps_what_is_finished():
    results = goniosim.simulate_study(STUDY, rays=5e5, threads=1, progress=press(after=1_100_000))
    assert {name: result.status for name, result in results.items()} == {"coat-0.1": "complete", "coat-0.2": "partial"}
    stop = threading.Event()
    stop.set()
    with pytest.raises(StoppedError):
        goniosim.simulate_study(STUDY, stop=stop)


def test_a_study_finds_what_stands_in_its_way_before_it_begins(tmp_path):
    (tmp_path / "coat-0.3.h5").write_text("my notes")
    with pytest.raises(OutputError, match=r"coat-0\.3\.h5: exists and is not a goniosim result"):
        goniosim.simulate_study(STUDY, folder=tmp_path, rays=MANY)


def test_results_are_compared_by_identity():
    # With arrays inside, == and `in` of a plain dataclass raise.
    one, other = (goniosim.simulate(SCENE, rays=100) for _ in range(2))
    assert one == one and one != other and other not in [one]
    assert {one: 1, other: 2}[other] == 2
    assert one.cells != other.cells and one.audit != other.audit
    assert Comparison([], []) != Comparison([], [])


def test_memory_is_told_without_words_of_the_command_line(monkeypatch):
    monkeypatch.setattr("goniosim.engine.memory.free_memory", lambda: (1, "to hand"))
    with pytest.raises(ResourceError, match="not enough memory") as refused:
        goniosim.simulate({**SCENE, "slice": {"rows": 900, "columns": 3600}}, threads=2)
    assert "--" not in str(refused.value)


@pytest.mark.parametrize("overrides", ["simulation.rays=1e6", {"simulation.rays": 1e6}, None, 3])
def test_overrides_are_a_list(overrides):
    with pytest.raises(ConfigError, match="overrides must be a list"):
        goniosim.load_scene(SCENE, overrides)


def test_what_is_no_path_at_all_is_said_to_be_none():
    with pytest.raises(ConfigError, match="cannot be the name of a file"):
        goniosim.load_scene("a\0b")


def test_arguments_of_comparisons_are_checked():
    result = goniosim.simulate(SCENE)
    for arguments, message in (
        ({"models": 5}, "models must be names of models"),
        ({"models": []}, "there are no models to compare"),
        ({"models": "ww0"}, "there is no model 'ww0'.*did you mean ww09"),
        ({"options": "masking"}, "options must be a mapping"),
        ({"subcells": True}, "subcells must be a whole number"),
    ):
        with pytest.raises(ConfigError, match=message):
            goniosim.compare(result, **arguments)
    for wrong in (5, [], [SCENE], SCENE):
        with pytest.raises(ConfigError, match="no results|must be results"):
            goniosim.compare(wrong)
    for angles in (["a", 0, 0], [[1, 2], [1, 2, 3], 0], [None, 0, 0]):
        with pytest.raises(ConfigError, match="theta_i_deg, theta_o_deg and phi_o_deg must be numbers|below 90"):
            goniosim.evaluate_model("ww09", SCENE, *angles)
