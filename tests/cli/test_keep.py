"""What `goniosim simulate` does when a file stands where its result is to go."""

import os
import signal

import pytest

from goniosim import load_scene, simulate
from goniosim.errors import FewerRaysError, NewerSchemaError, OutputError
from goniosim.store import open_result, write_result
from synthetic import write_models


@pytest.fixture
def small(goniosim, folder):
    """The result of ``scene.yaml`` with 2000 rays."""
    assert goniosim("simulate", "scene.yaml", "-q", "--rays", "2e3")[0] == 0
    return folder / "small.h5"


@pytest.fixture
def untraced(monkeypatch):
    """Nothing may be traced from now on."""
    monkeypatch.setattr("goniosim.engine.simulate", lambda *_, **__: pytest.fail("traced again"))


def only_line(err):
    (line,) = err.splitlines()
    return line


@pytest.mark.parametrize("rays", ["2e3", "1e3"])
def test_a_file_with_the_rays_asked_for_stays(goniosim, folder, small, untraced, rays):
    before = small.read_bytes()
    # Threads, the name and the way of writing are no difference.
    (folder / "again.yaml").write_text(
        (folder / "scene.yaml").read_text().replace("tau: 0.2", "tau: [2e-1, 0.20, 0.2]")
    )
    options = ("--rays", rays, "--threads", "1", "--set", "material.name=other", "-o", small)
    code, out, err = goniosim("simulate", "again.yaml", *options)
    assert (code, out) == (0, "")
    assert only_line(err).endswith(f"{small} stays as it is: it holds 2000 rays per direction of this scene")
    assert goniosim("simulate", "again.yaml", *options, "-q") == (0, "", "")
    assert small.read_bytes() == before


def test_more_rays_replace_it_and_nothing_is_left_beside(goniosim, folder, small):
    assert goniosim("simulate", "scene.yaml", "-q", "--rays", "3e3") == (0, "", "")
    assert open_result(small).rays.tolist() == [3000]
    assert sorted(path.name for path in folder.iterdir()) == ["scene.yaml", "small.h5", "study.yaml"]


@pytest.mark.parametrize("first, second", [("analog", "split"), ("split", "analog")])
def test_between_estimators_noise_is_the_measure(folder, first, second):
    """Rays are not: a few of a better estimator tell more than many independent ones."""
    scene = load_scene("scene.yaml")
    made = {name: simulate(scene, estimator=name, rays=rays) for name, rays in (("analog", 4e5), ("split", 1.4e5))}
    for result in made.values():
        result.config_yaml = scene.to_yaml()
    assert made["split"].rays.sum() < made["analog"].rays.sum()
    write_result(made[first], "small.h5")
    if second == "split":
        write_result(made[second], "small.h5")
    else:
        with pytest.raises(FewerRaysError, match="by split with a noise of .*, by analog with "):
            write_result(made[second], "small.h5")
    assert open_result("small.h5").estimator == "split"
    # Nobody knows what a direction will have that was not begun.
    made["split"].rays[:] = 0
    with pytest.raises(FewerRaysError):
        write_result(made["split"], "small.h5")


def interrupt(monkeypatch, rays):
    """Let the next simulation be stopped after so many rays."""
    from goniosim import engine

    simulate = engine.simulate

    def stopped(scene, progress, stop, **_):
        result = simulate(scene.model_copy(update={"simulation": scene.simulation.model_copy(update={"rays": rays})}))
        progress(rays, scene.simulation.rays)
        os.kill(os.getpid(), signal.SIGINT)
        assert stop.wait(10.0)
        result.status, result.config_yaml = "partial", scene.to_yaml()
        return result

    monkeypatch.setattr(engine, "simulate", stopped)


def test_an_interrupted_run_with_fewer_rays_leaves_the_file(goniosim, folder, small, monkeypatch):
    before = small.read_bytes()
    interrupt(monkeypatch, 1000)
    code, out, err = goniosim("simulate", "scene.yaml", "--rays", "1e6")
    assert (code, out) == (130, "")
    held = "small.h5 stays as it is: it holds 2000 rays per direction of this scene, the new result 1000"
    anew, kept = err.splitlines()
    why = "what is there was made by analog, and operator serves what is asked for"
    assert anew.endswith(f"small.h5: begins anew: {why}") and kept.endswith(f"stopped by Ctrl-C: {held}")
    assert small.read_bytes() == before
    assert sorted(path.name for path in folder.iterdir()) == ["scene.yaml", "small.h5", "study.yaml"]


def test_a_partial_file_counts_by_its_rays(goniosim, folder, small, monkeypatch):
    """Its scene asks for a million; it holds 2500, more than the complete file, and enough for who asks for these."""
    with monkeypatch.context() as patch:
        interrupt(patch, 2500)
        assert goniosim("simulate", "scene.yaml", "-q", "--rays", "1e6")[0] == 130
    assert (open_result(small).status, open_result(small).rays.tolist()) == ("partial", [2500])
    assert "holds 2500 rays" in goniosim("simulate", "scene.yaml", "--rays", "2500")[2]
    assert goniosim("simulate", "scene.yaml", "-q", "--rays", "2600")[0] == 0
    assert (open_result(small).status, open_result(small).rays.tolist()) == ("complete", [2600])


def test_another_scene_is_4_and_every_difference_is_named(goniosim, folder, small, untraced):
    before = small.read_bytes()
    changes = (
        "material.layers[0].interface.alpha=0.3",
        "material.layers[1].medium.tau=[0.2, 0.2, 0.3]",
        "slice.rows=5",
    )
    options = [word for change in changes for word in ("--set", change)]
    code, out, err = goniosim("simulate", "scene.yaml", *options, "--seed", "2", "--set", "incident.theta_deg=[30, 60]")
    assert (code, out) == (4, "")
    assert err.splitlines() == [
        "small.h5: layers[0].interface.alpha: 0.2 in the file, 0.3 asked for",
        "small.h5: layers[1].medium.tau: 0.2 in the file, [0.2, 0.2, 0.3] asked for",
        "small.h5: incident.theta_deg: [30] in the file, [30, 60] asked for",
        "small.h5: slice.rows: 6 in the file, 5 asked for",
        "small.h5: simulation.seed: 1 in the file, 2 asked for",
        "goniosim: error: small.h5: holds the result of another scene; nothing is overwritten: "
        "choose another place with -o, or replace results with --overwrite",
    ]
    assert small.read_bytes() == before


def test_overwrite_replaces_results_and_nothing_else(goniosim, folder, small):
    for options in (("--seed", "2"), ("--seed", "2", "--rays", "1e3")):
        assert goniosim("simulate", "scene.yaml", "-q", "--overwrite", *options)[0] == 0
    assert (open_result(small).seed, open_result(small).rays.tolist()) == (2, [1000])
    small.write_text("my thesis")
    code, _, err = goniosim("simulate", "scene.yaml", "--overwrite")
    assert code == 4 and "not a goniosim result" in only_line(err)
    assert small.read_text() == "my thesis"


def test_a_study_names_all_conflicts_at_once_and_traces_nothing(goniosim, folder, request):
    goniosim("simulate", "study.yaml", "-q", "--rays", "1e3", "-o", "out")
    request.getfixturevalue("untraced")
    (folder / "out" / "coat-0.2.h5").write_text("my thesis")
    before = {path: path.read_bytes() for path in (folder / "out").iterdir()}
    code, _, err = goniosim("simulate", "study.yaml", "--rays", "1e3", "--seed", "2", "-o", "out")
    assert code == 4
    *lines, last = err.splitlines()
    assert sorted(line.split(": ")[0] for line in lines) == [f"out/coat-{alpha}.h5" for alpha in (0.1, 0.2, 0.3)]
    assert sum("simulation.seed: 1 in the file, 2 asked for" in line for line in lines) == 2
    assert last.startswith("goniosim: error: 3 files hold something else") and "--overwrite" in last
    assert {path: path.read_bytes() for path in (folder / "out").iterdir()} == before


@pytest.mark.parametrize("damage", ["cut", "flipped"])
def test_a_damaged_result_is_replaced_and_that_is_said(goniosim, folder, small, damage):
    content = bytearray(small.read_bytes())
    if damage == "cut":
        del content[-100:]
    else:
        content[len(content) // 2] ^= 1
    small.write_bytes(content)
    code, _, err = goniosim("simulate", "scene.yaml", "--rays", "1e3")
    assert code == 0
    assert any("to be replaced: small.h5: " in line for line in err.splitlines())
    assert open_result(small).rays.tolist() == [1000]


def test_models_and_newer_files_are_foreign(goniosim, folder, untraced):
    write_models(folder / "small.h5")
    for options in ((), ("--overwrite",)):
        code, _, err = goniosim("simulate", "scene.yaml", *options)
        assert code == 4 and "not a goniosim result" in only_line(err)


def test_a_file_of_a_newer_goniosim_is_not_overwritten(goniosim, folder, small, untraced, monkeypatch):
    def newer(path):
        raise NewerSchemaError(f"{path}: follows schema 9.0; update goniosim")

    monkeypatch.setattr("goniosim.store.keeping.read_header", newer)
    monkeypatch.setattr("tempfile.tempdir", str(folder))
    before = small.read_bytes()
    for options in ((), ("--overwrite",)):
        code, _, err = goniosim("simulate", "scene.yaml", "--rays", "1e6", *options)
        said = "small.h5: follows schema 9.0; update goniosim; the file is not overwritten"
        assert (code, only_line(err)) == (4, f"goniosim: error: {said}")
    for overwrite in (False, True):
        with pytest.raises(OutputError, match="the file is not overwritten; the result was saved as"):
            write_result(open_result(small), small, overwrite=overwrite)
    assert small.read_bytes() == before


def test_the_identity_of_an_old_file_is_that_of_its_scene(goniosim, folder, small, untraced):
    """In files of schema 1.0 the hash covered the rays as well; the text of the scene tells."""
    result = open_result(small)
    result.config_hash = "0" * 64
    write_result(result, small)
    assert "stays as it is" in goniosim("simulate", "scene.yaml", "--rays", "1e3")[2]
