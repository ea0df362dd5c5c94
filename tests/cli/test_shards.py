"""`goniosim simulate --shard` and `goniosim merge`: any number of shards in any order, to the files of a plain run."""

import json
import random
import signal

import pytest

from goniosim.claims import Claim
from goniosim.cluster import error_path
from goniosim.store import open_result, read_portion
from impatient import IMPATIENT, wait_for
from sameness import datasets

ANALOG = ("--estimator", "analog")
STUDY = ("simulate", "study.yaml", "-q", *ANALOG)
SCENE = ("simulate", "scene.yaml", "-q", *ANALOG)
NAMES = ["coat-0.1", "coat-0.2", "coat-0.3"]


def only_line(err):
    (line,) = err.splitlines()
    return line


def same(one, other):
    return all(datasets(path) == datasets(other / path.name) for path in one.glob("*.h5"))


@pytest.mark.slow
@pytest.mark.parametrize("threads", [1, 2, 3])
@pytest.mark.parametrize("shards", [1, 2, 5, 13])
def test_any_threads_and_shards_in_any_order(goniosim, folder, threads, shards):
    """A study of three materials; the plain run is on two threads."""
    assert goniosim(*STUDY, "--threads", 2, "-o", "plain") == (0, "", "")
    order = random.Random(shards).sample(range(1, shards + 1), shards)
    for shard in order:
        given = ("--threads", 1 + (threads + shard) % 3) if threads == 3 else ("--threads", threads)
        assert goniosim(*STUDY, *given, "--shard", f"{shard}/{shards}", "-o", "shards") == (0, "", "")
    code, out, err = goniosim("merge", "shards", "-o", "merged", "--threads", threads)
    assert (code, err) == (0, "") and all(f"{name}   complete" in out for name in NAMES)
    assert sorted(path.name for path in (folder / "merged").iterdir()) == [f"{name}.h5" for name in NAMES]
    assert same(folder / "plain", folder / "merged")
    merged = open_result(folder / "merged" / "coat-0.1.h5")
    assert merged.provenance["merged"] == f"{shards} shards"


@pytest.mark.slow
@pytest.mark.parametrize("shards", [1, 3])
def test_what_comes_of_replicates(goniosim, folder, shards):
    """As `auto` has it: operators at wide interfaces."""
    asked = ("simulate", "scene.yaml", "-q", "--rays", "3e5")
    assert goniosim(*asked) == (0, "", "")
    for shard in range(1, shards + 1):
        assert goniosim(*asked, "--shard", f"{shard}/{shards}", "-o", "shards")[0] == 0
    assert goniosim("merge", "shards", "-o", "merged.h5", "-q") == (0, "", "")
    assert datasets(folder / "small.h5") == datasets(folder / "merged.h5")


def test_what_a_shard_says(goniosim, folder, monkeypatch):
    """Its files, a second time nothing but them; and a shard without work, where there are more than pieces of it."""
    monkeypatch.setenv("SLURM_ARRAY_TASK_ID", "2")
    asked = ("simulate", "scene.yaml", *ANALOG, "--shard", "auto/3")
    code, out, err = goniosim(*asked)
    assert code == 0 and out.splitlines()[0] == "shard 2 of 3: 1 file" and "100 % of its light paths" in out
    path = folder / "small.shards" / "small.shard-00002-of-00003.h5"
    before = path.read_bytes()
    assert goniosim(*asked)[0] == 0 and path.read_bytes() == before
    # The count is known by now.
    code, out, _ = goniosim(*asked[:-1], "auto")
    assert code == 0 and "shard 2 of 3" in out
    code, out, err = goniosim(*asked[:-1], "50/100", "-o", "many")
    assert (code, out, err) == (0, "shard 50 of 100: no work\n", "")


def test_some_materials_by_name(goniosim, folder):
    assert goniosim(*STUDY, "--only", "coat-0.3", "-o", "out")[0] == 0
    assert [path.name for path in (folder / "out").iterdir()] == ["coat-0.3.h5"]
    code, _, err = goniosim(*STUDY, "--only", "coat-03")
    assert code == 3 and "--only coat-03: there is no such material; did you mean coat-0.3?" in err
    assert goniosim(*STUDY, "--only", "coat-0.2", "--shard", "1/1", "-o", "shards")[0] == 0
    assert [path.name for path in (folder / "shards").glob("*.h5")] == ["coat-0.2.shard-00001-of-00001.h5"]


@pytest.mark.slow
def test_a_material_with_a_target_is_one_shards_own(goniosim, folder):
    asked = ("simulate", "study.yaml", "-q", *ANALOG, "--target", "20%")
    assert goniosim(*asked, "-o", "plain")[0] == 0
    for shard in (2, 1):
        assert goniosim(*asked, "--shard", f"{shard}/2", "-o", "shards")[0] == 0
    names = sorted(path.name for path in (folder / "shards").iterdir())
    assert names == [*(f"{name}.h5" for name in NAMES), "plan.json"]
    assert goniosim("merge", "shards", "-o", "merged", "-q")[0] == 0
    assert same(folder / "plain", folder / "merged")
    (folder / "shards" / "coat-0.2.h5").unlink()
    code, _, err = goniosim("merge", "shards", "-o", "again", "-q")
    shard = 1 if json.loads((folder / "shards" / "plan.json").read_text())["weights"][0] > 1 else 2
    assert code == 8 and f"--array={shard} " in err and "coat-0.2.h5: missing" in err


def test_a_target_that_is_missed_is_said_by_the_merge(goniosim, folder):
    """As by a plain run."""
    asked = ("scene.yaml", "-q", "--target", "1e-4", "--max-rays", "2e3")
    assert goniosim("simulate", *asked, "--shard", "1/1", "-o", "shards")[0] == 0
    code, out, err = goniosim("merge", "shards", "-o", "merged.h5", "-q")
    assert (code, out) == (9, "") and "merged.h5: the target of 0.01 % of slice was not reached" in only_line(err)
    assert goniosim("simulate", *asked, "-o", "plain.h5")[0] == 9
    assert datasets(folder / "plain.h5") == datasets(folder / "merged.h5")


def test_a_merge_leaves_alone_what_another_process_works_on(goniosim, folder, three):
    with Claim(folder / "merged.h5"):
        code, _, err = goniosim("merge", "shards", "-o", "merged.h5")
        assert code == 4 and "merged.h5: another process is at work on it" in only_line(err)
    assert goniosim("merge", "shards", "-o", "merged.h5", "-q")[0] == 0


@pytest.fixture
def three(goniosim, folder):
    """A folder with three shards of a scene."""
    for shard in (1, 2, 3):
        assert goniosim(*SCENE, "--shard", f"{shard}/3", "-o", "shards")[0] == 0
    return folder / "shards"


def test_what_is_missing_is_named(goniosim, folder, three):
    for shard in (1, 3):
        (three / f"small.shard-0000{shard}-of-00003.h5").unlink()
    code, out, err = goniosim("merge", "shards", "-o", "merged.h5")
    assert (code, out) == (8, "") and not (folder / "merged.h5").exists()
    lines = err.splitlines()
    assert lines[:2] == [f"shards/small.shard-0000{shard}-of-00003.h5: missing" for shard in (1, 3)]
    assert lines[2] == (
        "goniosim: error: shards: 2 of its files are missing, not finished or damaged, and nothing was written; "
        "run these shards again: --array=1,3 (by hand: goniosim simulate shards --shard 1), "
        "or merge what is there with --allow-missing"
    )
    code, out, err = goniosim("merge", "shards", "-o", "merged.h5", "--allow-missing")
    assert code == 0 and "small  (partial)" in out and err.count("left out: ") == 2
    found, whole = open_result(folder / "merged.h5"), folder / "whole.h5"
    assert found.status == "partial" and 0 < found.rays[0] < 1e4
    assert found.provenance["merged"] == "3 shards, of which 1,3 are missing or not finished"
    # With the rest, it is what it would have been.
    for shard in (3, 1):
        assert goniosim(*SCENE, "--shard", f"{shard}/3", "-o", "shards")[0] == 0
    assert goniosim("merge", "shards", "-o", "merged.h5", "-q") == (0, "", "")
    assert goniosim(*SCENE, "-o", whole)[0] == 0
    assert datasets(folder / "merged.h5") == datasets(whole)


@pytest.mark.parametrize("options", [("--seed", "2"), ("--rays", "2e4"), ("--set", "incident.theta_deg=[40]")])
def test_another_simulation_does_not_come_into_the_folder(goniosim, folder, options):
    asked = (*SCENE, "--shard", "1/2", "-o", "shards")
    assert goniosim(*asked)[0] == 0
    code, _, err = goniosim(*asked, *options)
    assert code == 4 and "shards: holds shards of something else; choose another folder with -o" in err
    code, _, err = goniosim(*SCENE, "--shard", "1/3", "-o", "shards")
    assert code == 4 and "it is cut into 2 shards, not into 3" in err


def test_what_belongs_to_others_is_not_merged(goniosim, folder, three):
    """Under another shard's name, of another division, seed, number of rays, or version of goniosim."""
    first, second = (three / f"small.shard-0000{shard}-of-00003.h5" for shard in (1, 2))
    kept, plan = second.read_bytes(), (three / "plan.json").read_text()

    def refused(code, words):
        found, _, err = goniosim("merge", "shards", "-o", "merged.h5")
        assert found == code and words in only_line(err) and not (folder / "merged.h5").exists()

    second.write_bytes(first.read_bytes())
    refused(4, "is shard 1 of 3, and not 2 of 3; it is left alone: remove it")
    # Nor does the shard itself replace it.
    code, _, err = goniosim(*SCENE, "--shard", "2/3", "-o", "shards")
    assert code == 4 and "is shard 1 of 3" in only_line(err)
    assert "is shard 1 of 3" in error_path(three, 2, 3).read_text()
    second.unlink()
    assert goniosim(*SCENE, "--shard", "2/3", "-o", "shards")[0] == 0 and not error_path(three, 2, 3).exists()
    for options in (("--seed", "2"), ("--rays", "2e4")):
        assert goniosim(*SCENE, *options, "--shard", "2/3", "-o", "other")[0] == 0
        second.write_bytes((folder / "other" / second.name).read_bytes())
        refused(4, "is of another scene; it is left alone")
        (folder / "other" / second.name).unlink()
        (folder / "other" / "plan.json").unlink()
    second.write_bytes(kept)
    stray = three / "small.shard-00002-of-00004.h5"
    stray.write_bytes(kept)
    refused(4, "small.shard-00002-of-00004.h5: of another division of the work; remove what is not to be merged")
    stray.unlink()
    second.write_bytes((folder / "scene.yaml").read_bytes())
    refused(4, "it stands in the place of a shard and is left alone: remove it")
    second.write_bytes(kept)
    here = json.loads(plan)["goniosim_version"]
    (three / "plan.json").write_text(plan.replace(here, "0.0.1"))
    refused(8, f"shards: its shards are of goniosim 0.0.1, and this is {here}; use that one for the rest")
    code, _, err = goniosim(*SCENE, "--shard", "2/3", "-o", "shards")
    assert code == 8 and "its shards are of goniosim 0.0.1" in only_line(err)
    (three / "plan.json").write_text(plan)
    assert goniosim("merge", "shards", "-o", "merged.h5", "-q") == (0, "", "")


def test_a_portion_is_no_result(goniosim, folder, three):
    path = three / "small.shard-00001-of-00003.h5"
    for command in ("info", "plot", "compare"):
        code, out, err = goniosim(command, path)
        assert (code, out) == (8, "")
        assert f"{path}: holds a portion of a simulation; join it with the others by `goniosim merge`" in only_line(err)


def test_shards_have_a_folder_of_their_own(goniosim, folder, three):
    """Among results they would stand in the way of whatever takes the folder."""
    (folder / "results").mkdir()
    (folder / "results" / "mine.h5").write_bytes(b"")
    code, _, err = goniosim("simulate", "scene.yaml", "--shard", "1/3", "-o", "results")
    assert code == 4 and "holds other files, such as mine.h5" in only_line(err)
    code, _, err = goniosim("simulate", "shards")
    assert code == 2 and "shards is a folder of shards: say which with --shard" in err


def test_a_folder_that_is_none_of_shards(goniosim, folder):
    code, _, err = goniosim("merge", ".", "-o", "merged.h5")
    assert code == 5 and "is no folder of shards: plan.json is missing" in only_line(err)
    (folder / "plan.json").write_text("{")
    code, _, err = goniosim("merge", ".", "-o", "merged.h5")
    assert code == 5 and "cannot be read" in only_line(err)


# Some seconds of work, on any machine.
RAYS = "2e8"


@pytest.mark.slow
def test_a_shard_that_is_stopped_goes_on(python, goniosim, folder):
    """Merged before that, it is used as far as it goes; and in the end it is as if nothing had happened."""
    asked = ("simulate", "scene.yaml", *ANALOG, "--rays", RAYS, "-o", "shards", "--shard")
    assert goniosim("simulate", "scene.yaml", *ANALOG, "--rays", RAYS, "-q")[0] == 0
    process = python(IMPATIENT, *asked, "1/2")
    wait_for(process, "% of ")
    process.send_signal(signal.SIGTERM)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 75 and "stopped by SIGTERM; the same command goes on" in err
    path = folder / "shards" / "small.shard-00001-of-00002.h5"
    held = read_portion(path)[0]
    assert not held.is_whole and 0 < held.done_rays < 1e8
    code, _, err = goniosim("merge", "shards", "-o", "merged.h5")
    assert code == 8 and "small.shard-00001-of-00002.h5: not finished" in err and "--array=1-2 " in err
    code, _, err = goniosim("merge", "shards", "-o", "merged.h5", "--allow-missing")
    assert code == 0 and "used as far as it goes: shards/small.shard-00001-of-00002.h5: not finished" in err
    assert open_result(folder / "merged.h5").rays[0] == held.done_rays
    code, out, err = goniosim(*asked, "1/2")
    assert code == 0 and "small.shard-00001-of-00002.h5: goes on from" in err and read_portion(path)[0].is_whole
    assert goniosim(*asked, "2/2", "-q")[0] == 0
    assert goniosim("merge", "shards", "-o", "merged.h5", "-q")[0] == 0
    assert datasets(folder / "small.h5") == datasets(folder / "merged.h5")
