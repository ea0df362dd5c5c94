"""Files in the making of killed runs are removed by the next run on that output; those of living runs never."""

import errno
import fcntl
import os
import re
import signal
import subprocess
import sys
import textwrap
import time
from pathlib import Path

import pytest

from goniosim import parts
from goniosim.claims import SILENCE, Claim
from goniosim.parts import Part, remove_dead, turn
from goniosim.report.comparison.folder import ReportFolder
from goniosim.store import open_result, reserve_output, write_result
from goniosim.writing import write_text
from synthetic import make_result

RUN = """
    import sys, time
    from pathlib import Path
    from goniosim.parts import Part
    from goniosim.store import ModelsWriter, reserve_output
    from goniosim.writing import Replacement

    folder = Path(sys.argv[1])
    reservation = reserve_output(folder / "r.h5", 1000)
    table = Replacement(folder / "table.csv")
    # As those of reports.
    fresh, earlier = Part(folder / "fresh", folder=True), Part(folder / "earlier", folder=True, inside=True)
    models = ModelsWriter(earlier.path / "models.h5", {})
    print("ready", flush=True)
    time.sleep(600)
"""


@pytest.fixture
def run(tmp_path):
    """A run with all kinds of parts of the outputs in ``tmp_path``, as an open process."""
    (tmp_path / "earlier").mkdir()
    process = subprocess.Popen([sys.executable, "-c", textwrap.dedent(RUN), tmp_path], stdout=subprocess.PIPE)
    assert process.stdout.readline() == b"ready\n"
    yield process
    process.kill()
    process.communicate()


def found(folder):
    return sorted(path.name for path in folder.rglob("*.part"))


def next_run(folder):
    """Use each of the outputs again."""
    write_result(make_result(), folder / "r.h5")
    write_text(folder / "table.csv", "text")
    ReportFolder(folder / "fresh", []).discard()
    ReportFolder(folder / "earlier", []).discard()


def test_a_killed_run_leaves_nothing_once_the_next_one_has_come(tmp_path, run):
    left = found(tmp_path)
    assert len(left) == 5
    # While it lives, it is left alone.
    next_run(tmp_path)
    assert found(tmp_path) == left
    run.send_signal(signal.SIGKILL)
    run.wait()
    assert found(tmp_path) == left
    next_run(tmp_path)
    assert sorted(path.name for path in tmp_path.rglob("*")) == ["earlier", "r.h5", "table.csv"]
    assert open_result(tmp_path / "r.h5").name == "synthetic"


@pytest.fixture
def dead(tmp_path):
    """What a run on ``r.h5`` left behind, and a function that gives it another owner."""
    part = Part(tmp_path / "r.h5")
    os.close(part.descriptor)

    def rename(host=None, boot=None, pid=None):
        old = re.fullmatch(r"(\.r\.h5\.)(\w+)-(\w+)-(\d+)(.*)", part.path.name)
        name = f"{old[1]}{host or old[2]}-{boot or old[3]}-{pid or old[4]}{old[5]}"
        return part.path.rename(part.path.with_name(name))

    return rename


GONE = 4_194_305  # More than any process has for a number.


@pytest.mark.parametrize(
    ("owner", "locks", "removed"),
    [
        ({}, True, True),  # The number may have gone to another process since.
        ({"host": "0" * 8}, True, True),  # Another container of this machine.
        ({"boot": "0" * 8}, True, True),  # This machine, before it was started anew.
        ({"host": "0" * 8, "boot": "0" * 8}, True, False),  # Another machine, of which nobody here knows.
        ({}, False, False),
        ({"pid": GONE}, False, True),
        ({"boot": "0" * 8}, False, True),
        ({"host": "0" * 8, "pid": GONE}, False, False),
    ],
)
def test_who_is_dead(tmp_path, dead, monkeypatch, owner, locks, removed):
    """With locks and without."""
    path = dead(**owner)
    if not locks:

        def unsupported(*_):
            raise OSError(errno.ENOLCK, "no locks available")

        monkeypatch.setattr(fcntl, "flock", unsupported)
    remove_dead([tmp_path / "r.h5"])
    assert path.exists() != removed


@pytest.mark.parametrize(
    ("owner", "age", "removed"),
    [
        ({"host": "0" * 8, "boot": "0" * 8}, 2 * SILENCE, True),
        ({"host": "0" * 8, "boot": "0" * 8}, 0.5 * SILENCE, False),
        # Of this machine: its owner is asked, who holds a lock.
        (None, 2 * SILENCE, False),
    ],
)
def test_whoever_has_claimed_an_output_removes_what_other_machines_left(tmp_path, dead, owner, age, removed):
    living = Part(tmp_path / "r.h5")
    path = living.path if owner is None else dead(**owner)
    os.utime(path, (time.time() - age,) * 2)
    with Claim(tmp_path / "r.h5") as claim:
        claim.remove_parts()
        assert path.exists() != removed
    living.remove()


def test_parts_whose_names_are_cut_may_be_of_somebody_else(tmp_path):
    """The output of another process may begin with the same words."""
    target, other = tmp_path / f"{'x' * 40}1.h5", tmp_path / f"{'x' * 40}2.h5"
    part = Part(other)
    path = part.path.rename(re.sub(r"\w+-\w+-(?=\d+-)", "00000000-00000000-", str(part.path)))
    os.utime(path, (0.0, 0.0))
    with Claim(target) as claim:
        claim.remove_parts()
    assert path.exists()
    os.close(part.descriptor)


def test_only_parts_of_this_output_are_looked_at(tmp_path, dead):
    path = dead()
    others = [".r.h5.part", ".r.h5.0123abcd.part", "r.h5.part", "r.h5"]
    for name in others:
        (tmp_path / name).write_text("mine")
    remove_dead([tmp_path / "other.h5", tmp_path / "r.h", tmp_path / "missing" / "r.h5"])
    assert path.exists()
    remove_dead([tmp_path / "r.h5"])
    assert sorted(entry.name for entry in tmp_path.iterdir()) == sorted(others)


def test_a_part_that_is_taken_for_dead_while_it_is_made_is_made_anew(tmp_path, monkeypatch):
    """Another run looks between the creation of the file and its lock."""
    lock = parts.try_lock
    seen = []

    def late(descriptor):
        if not seen:
            seen.extend(tmp_path.iterdir())
            remove_dead([tmp_path / "r.h5"])
        return lock(descriptor)

    monkeypatch.setattr(parts, "try_lock", late)
    part = Part(tmp_path / "r.h5")
    assert len(seen) == 1 and list(tmp_path.iterdir()) == [part.path] != seen


def test_two_writers_of_different_scenes_one_wins_whole(tmp_path, monkeypatch):
    """Neither saw the other when it began; the second result is saved elsewhere."""
    (tmp_path / "rescued").mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "rescued"))
    path = tmp_path / "r.h5"
    first, second = reserve_output(path, 1000), reserve_output(path, 1000)
    config = make_result().config_yaml
    write_result(make_result(name="first"), path, reservation=first)
    with pytest.raises(Exception, match=r"another scene \(layers\[0\].*the result was saved as"):
        other = make_result(
            name="second",
            config_yaml=config.replace("alpha: 0.2", "alpha: 0.3").replace("name: synthetic", "name: second"),
        )
        write_result(other, path, reservation=second)
    assert open_result(path).name == "first"
    assert open_result(next((tmp_path / "rescued").iterdir())).name == "second"
    assert found(tmp_path) == []


def test_a_lock_that_somebody_else_holds_on_the_folder_stops_nobody_for_long(tmp_path):
    with turn(tmp_path), turn(tmp_path, patience=0.05):
        write_text(tmp_path / "file", "text")
    with turn(Path(tmp_path / "missing")):
        pass
