"""Several processes with one command: one works on a scene, all share a study, and the dead do not count."""

import os
import signal
import time
from pathlib import Path

import pytest

import goniosim as package
from abandoned import ELSEWHERE, GONE, leave
from goniosim import engine
from goniosim.claims import SILENCE, Claim
from goniosim.engine.packing import pack
from goniosim.engine.session import VERSION
from goniosim.engine.simulate import simulate
from goniosim.scene import load_scenes
from goniosim.store import open_result, write_result
from impatient import IMPATIENT, wait_for
from reusing import encode_once
from small import STUDY

NAMES = ["coat-0.1", "coat-0.2", "coat-0.3"]
ASKED = ("simulate", "study.yaml", "-o", "out")
US = f"host {os.uname().nodename}, pid {os.getpid()}"


def quickly(scene, **given):
    """A result of a scene, by the cheapest estimator."""
    result = simulate(scene, estimator="analog", **given)
    result.config_yaml = scene.to_yaml()
    return result


@pytest.fixture
def traced(monkeypatch):
    """Names of the materials that are simulated.

    ``traced.then[name]`` is called before the end of one, and ``traced.resumed`` are those that went on.
    """

    class Traced(list):
        """With attributes."""

    names = Traced()
    names.then, names.resumed = {}, []

    def quick(scene, progress, resume=None, **_):
        names.append(scene.material.name)
        progress(1, 10)
        names.then.get(scene.material.name, lambda: None)()
        if resume is not None:
            names.resumed.append(scene.material.name)
        return quickly(scene)

    encode_once(monkeypatch)
    monkeypatch.setattr(engine, "simulate", quick)
    monkeypatch.setattr(engine, "warm_up", lambda scene: 0.0)
    return names


@pytest.fixture
def out(folder):
    (folder / "out").mkdir()
    return folder / "out"


def visible(folder):
    """Names of the materials in a folder, in which nothing else may be."""
    assert all(path.suffix == ".h5" for path in folder.iterdir())
    return sorted(path.stem for path in folder.iterdir())


def done_by_another(out, name, rays=None):
    """Put the result of a material into its place, or what is there of it when its owner dies."""
    (scene,) = (scene for scene in load_scenes("study.yaml") if scene.material.name == name)
    result = quickly(scene, rays=rays)
    if rays is not None:
        result.status, result.state = "partial", pack({"version": VERSION})
    write_result(result, out / f"{name}.h5", overwrite=True)


def test_a_scene_that_another_process_works_on_is_refused(goniosim, folder, traced):
    with Claim(folder / "small.h5"):
        for options in ((), ("-q",), ("--overwrite",)):
            code, out, err = goniosim("simulate", "scene.yaml", *options)
            (line,) = err.splitlines()
            assert (code, out, traced) == (4, "", [])
            assert line.startswith(f"goniosim: error: small.h5: another process is at work on it ({US}, since 2")
            assert line.endswith("; wait for its end, or choose another place with -o")
        assert goniosim("simulate", "scene.yaml", "-q", "-o", "other.h5")[0] == 0
    assert goniosim("simulate", "scene.yaml", "-q")[0] == 0
    assert not list(folder.glob(".*"))


def test_materials_of_others_are_left_to_them(goniosim, out, traced):
    with Claim(out / "coat-0.2.h5"), Claim(out / "coat-0.1.h5"):
        code, said, err = goniosim(*ASKED)
        assert (code, traced) == (0, ["coat-0.3"])
        assert err.splitlines()[-1].endswith(f"  2 materials are being simulated by others ({US})")
        assert "coat-0.3" in said and "coat-0.2" not in said
        assert goniosim(*ASKED, "-q", "--overwrite")[::2] == (0, "")
    assert goniosim(*ASKED, "-q")[::2] == (0, "")
    assert visible(out) == NAMES and traced[-2:] == NAMES[:2]


@pytest.mark.parametrize("overwrite", [False, True])
def test_what_others_finish_meanwhile_is_not_traced_again(goniosim, out, traced, overwrite):
    if overwrite:
        for name in NAMES:
            done_by_another(out, name)
    traced.then["coat-0.1"] = lambda: done_by_another(out, "coat-0.3")
    code, _, err = goniosim(*ASKED, *(["--overwrite"] if overwrite else []))
    assert (code, traced) == (0, ["coat-0.1", "coat-0.2"])
    assert err.splitlines()[-1].endswith("  1 material is finished by others meanwhile")
    assert visible(out) == NAMES
    assert open_result(out / "coat-0.3.h5").rays.tolist() == [10_000]


@pytest.mark.parametrize("overwrite", [False, True])
@pytest.mark.parametrize("how", ["command", "python"])
def test_what_one_that_died_meanwhile_has_left_is_gone_on_from(goniosim, out, traced, overwrite, how):
    """To overwrite is said of what stood there in the beginning."""
    for name in NAMES[:2]:
        done_by_another(out, name, rays=2000)
    traced.then["coat-0.1"] = lambda: done_by_another(out, "coat-0.2", rays=5000)
    if how == "python":
        package.simulate_study(STUDY, folder="out", overwrite=overwrite)
    else:
        assert goniosim(*ASKED, *(["--overwrite"] if overwrite else []))[0] == 0
    assert traced == NAMES and traced.resumed == (["coat-0.2"] if overwrite else NAMES[:2])
    assert visible(out) == NAMES


def test_what_another_scene_took_meanwhile_is_not_traced_for_nothing(goniosim, out, traced):
    def other():
        done_by_another(out, "coat-0.3")
        (out / "coat-0.3.h5").rename(out / "coat-0.2.h5")

    traced.then["coat-0.1"] = other
    code, _, err = goniosim(*ASKED)
    assert (code, traced) == (4, ["coat-0.1"])
    assert "out/coat-0.2.h5: holds the result of another scene; nothing is overwritten" in err.splitlines()[-1]
    assert visible(out) == NAMES[:2]


def test_whose_owner_dies_meanwhile_is_taken_over_in_the_end(goniosim, out, traced):
    claim = Claim(out / "coat-0.1.h5")
    traced.then["coat-0.3"] = claim.release
    code, said, err = goniosim(*ASKED)
    assert (code, traced) == (0, ["coat-0.2", "coat-0.3", "coat-0.1"])
    assert "others" not in err and visible(out) == NAMES


def test_claims_of_other_machines_count_as_long_as_they_are_renewed(goniosim, out, traced):
    leave(out / "coat-0.1.h5", **ELSEWHERE)
    leave(out / "coat-0.2.h5", 2 * SILENCE, **ELSEWHERE)
    leave(out / "coat-0.3.h5", pid=GONE)
    # As much as the result, on a disk that may be full.
    part = out / ".coat-0.2.h5.00000000-00000000-1-00000000.part"
    part.touch()
    os.utime(part, (0.0, 0.0))
    code, _, err = goniosim(*ASKED)
    assert (code, traced) == (0, ["coat-0.2", "coat-0.3"])
    assert f"1 material is being simulated by others (host n042, pid {os.getpid()})" in err
    assert len(list(out.glob(".*"))) == 1


def test_a_finished_material_keeps_no_claim_of_the_dead(goniosim, out, traced):
    goniosim(*ASKED, "-q")
    leave(out / "coat-0.1.h5", pid=GONE)
    assert goniosim(*ASKED, "-q") == (0, "", "")
    assert visible(out) == NAMES
    leave(out / "coat-0.1.h5", pid=GONE)
    package.simulate_study(STUDY, folder="out")
    assert visible(out) == NAMES and len(traced) == 3


def test_from_python_too(out, traced):
    paths = {name: Path("out") / f"{name}.h5" for name in NAMES}
    with Claim(out / "coat-0.2.h5"):
        traced.then["coat-0.1"] = lambda: done_by_another(out, "coat-0.3")
        found = package.simulate_study(STUDY, folder="out")
        assert found == {name: paths[name] for name in ("coat-0.1", "coat-0.3")} and traced == ["coat-0.1"]
    traced.clear()
    traced.then["coat-0.1"] = lambda: done_by_another(out, "coat-0.3")
    assert package.simulate_study(STUDY, folder="out", overwrite=True) == paths
    assert traced == ["coat-0.1", "coat-0.2"] and visible(out) == NAMES
    calls = []
    with Claim(out / "coat-0.1.h5"):
        package.simulate_study(STUDY, folder="out", overwrite=True, progress=lambda *told: calls.append(told))
    assert calls == [(10_001, 30_000), (10_002, 30_000)]


FOREVER = ("--estimator", "analog", "--rays", "1e11")


@pytest.mark.slow
def test_the_checkpoint_of_a_killed_owner_is_gone_on_from(python, goniosim, folder):
    """Real processes: another one is refused as long as the first lives."""
    process = python(IMPATIENT, "simulate", "scene.yaml", *FOREVER)
    wait_for(process, f"% of {FOREVER[-1]} rays")
    process.terminate()
    process.communicate()
    process = python(IMPATIENT, "simulate", "scene.yaml", *FOREVER)
    wait_for(process, "goes on from")
    code, _, err = goniosim("simulate", "scene.yaml", *FOREVER)
    assert code == 4 and f"pid {process.pid}" in err
    process.kill()
    process.communicate()
    assert len(list(folder.glob(".*.claim"))) == 1
    process = python(IMPATIENT, "simulate", "scene.yaml", *FOREVER)
    wait_for(process, "goes on from")
    wait_for(process, f"% of {FOREVER[-1]} rays")
    process.terminate()
    process.communicate()
    assert process.returncode == 75 and not list(folder.glob(".*"))


@pytest.mark.slow
def test_processes_that_share_a_study_trace_each_material_once(start, goniosim, folder):
    """Four of them, one of which is killed; then all is as if one had done it."""
    text = STUDY.replace("[0.1, 0.2, 0.3]", str([round(0.1 + 0.02 * n, 2) for n in range(12)]))
    (folder / "study.yaml").write_text(text)
    asked = ("simulate", "study.yaml", "--estimator", "analog", "--rays", "1e7", "--threads", "1")
    assert goniosim(*asked, "-q", "-o", "alone")[0] == 0
    started = [start(*asked, "-o", "out") for _ in range(4)]
    time.sleep(4.0)
    started[0].kill()
    told = [process.communicate() for process in started]
    assert [process.returncode for process in started] == [-signal.SIGKILL, 0, 0, 0]
    assert goniosim(*asked, "-q", "-o", "out")[0] == 0
    names = visible(folder / "out")
    assert len(names) == 12 and names == visible(folder / "alone")
    traced = [line.split()[0] for text, _ in told[1:] for line in text.splitlines() if line.startswith("  coat-")]
    assert len(traced) == len(set(traced))
    for name in names:
        one, other = (open_result(folder / where / f"{name}.h5") for where in ("out", "alone"))
        for path, component in one.components.items():
            assert component.energy.tobytes() == other.components[path].energy.tobytes()
