"""One process at a time works on an output, however processes end, and wherever they run."""

import errno
import fcntl
import os
import signal
import subprocess
import sys
import threading
import time

import pytest

from abandoned import ELSEWHERE, GONE, leave
from goniosim import owners
from goniosim.claims import SILENCE, Claim, Owner, life, owner_of, remove_dead, taking

_HOLD = """
import sys, time
from pathlib import Path
from goniosim.claims import Claim
assert Claim(Path(sys.argv[1])).owner is None
print("ready", flush=True)
time.sleep(600)
"""


@pytest.fixture
def target(tmp_path):
    return tmp_path / "r.h5"


@pytest.fixture
def other(target):
    """Another process that has claimed the target."""
    process = subprocess.Popen([sys.executable, "-c", _HOLD, target], stdout=subprocess.PIPE)
    assert process.stdout.readline() == b"ready\n"
    yield process
    process.kill()
    process.communicate()


@pytest.fixture
def no_locks(monkeypatch):
    def unsupported(*_):
        raise OSError(errno.ENOLCK, "no locks available")

    monkeypatch.setattr(fcntl, "flock", unsupported)


def hidden(folder):
    return sorted(path.name for path in folder.iterdir() if path.name.startswith("."))


def test_one_has_it_and_others_learn_who(target):
    assert owner_of(target) is None
    with Claim(target) as claim:
        assert claim.owner is None
        (name,) = hidden(target.parent)
        assert name.startswith(".r.h5.") and not name.endswith(".h5")
        owner = Claim(target).owner
        assert owner == owner_of(target) and (owner.host, owner.pid) == (os.uname().nodename, os.getpid())
        assert str(owner).startswith(f"host {owner.host}, pid {owner.pid}, since 2")
        assert owner_of(target.with_name("other.h5")) is None
    assert owner_of(target) is None and hidden(target.parent) == []
    claim.release()
    with Claim(target) as again:
        # Nor does one that is over take away that of somebody else.
        claim.release()
        assert again.owner is None and owner_of(target) is not None


def test_names_that_are_cut_or_links_are_told_apart(tmp_path):
    long, longer = tmp_path / ("x" * 250 + ".h5"), tmp_path / ("x" * 251 + ".h5")
    (tmp_path / "link.h5").symlink_to(long)
    with Claim(long), Claim(longer) as second:
        assert second.owner is None
        assert Claim(tmp_path / "link.h5").owner is not None
    assert hidden(tmp_path) == []


@pytest.mark.parametrize("locks", [True, False])
def test_it_dies_with_its_owner(target, other, request, locks):
    if not locks:
        request.getfixturevalue("no_locks")
    assert Claim(target).owner.pid == owner_of(target).pid == other.pid
    other.kill()
    other.wait()
    assert owner_of(target) is None
    with Claim(target) as claim:
        assert claim.owner is None and owner_of(target).pid == os.getpid()
    assert hidden(target.parent) == []


def test_what_dead_owners_left_is_removed_and_nothing_else(target, other):
    files = [target, target.with_name("other.h5")]
    leave(files[1], pid=GONE)
    kept = [".r.h5.claim", ".notes.claim", ".r.h5.0123abcd.claim"]
    for name in kept:
        (target.parent / name).write_text("mine")
    remove_dead([*files, target.parent / "missing" / "r.h5"])
    assert owner_of(target).pid == other.pid
    other.kill()
    other.wait()
    assert len(hidden(target.parent)) == len(kept) + 1
    remove_dead(files)
    assert hidden(target.parent) == sorted(kept)


@pytest.mark.parametrize(
    ("record", "age", "lives"),
    [
        ({}, 0.0, True),
        # The time does not count where the number of the process tells: it may have been suspended.
        ({}, 2 * SILENCE, True),
        ({"pid": GONE}, 0.0, False),
        ({"pid": 10**30}, 0.0, False),
        # Another process has its number by now.
        ({"started": "1"}, 0.0, False),
        # This machine, before it was started anew: nobody renews it.
        ({"boot": "0" * 8}, 2 * SILENCE, False),
        # Another container of this machine: the lock tells.
        ({"numbering": "pid:[1]"}, 0.0, False),
        ({"numbering": "pid:[1]", "locked": False}, 0.0, True),
        ({"numbering": "pid:[1]", "locked": False}, 2 * SILENCE, False),
        (ELSEWHERE, 0.0, True),
        (ELSEWHERE, 0.8 * SILENCE, True),
        (ELSEWHERE, 1.2 * SILENCE, False),
        # The clock of the file server was set back.
        (ELSEWHERE, -2 * SILENCE, False),
        ({**ELSEWHERE, "pid": GONE}, 0.0, True),
    ],
)
def test_who_lives(target, record, age, lives):
    """Files without a lock on them."""
    leave(target, age, **record)
    owner = owner_of(target)
    assert (owner is not None) == lives
    with Claim(target) as claim:
        assert claim.owner == owner
    assert len(hidden(target.parent)) == lives


@pytest.mark.parametrize("text", ["", "mine", "[]", "{}", '{"host": 1}', "[" * 1900, "\x00" * 3000])
def test_what_says_nothing_is_judged_by_its_time(target, text):
    """It may have been created a moment ago."""
    path = leave(target)
    path.write_text(text)
    assert Claim(target).owner == owner_of(target) == Owner()
    os.utime(path, (time.time() - 2 * SILENCE,) * 2)
    with Claim(target) as claim:
        assert claim.owner is None
    assert hidden(target.parent) == []


def test_what_an_owner_says_does_not_reach_the_terminal(target):
    leave(target, host="\x1b[2J" + "x" * 100)
    assert "\x1b" not in str(owner_of(target)) and len(str(owner_of(target))) < 200


def test_the_clock_of_this_machine_does_not_count(target, monkeypatch):
    leave(target, 0.5 * SILENCE, **ELSEWHERE)
    for wrong in (0.0, 1e11):
        monkeypatch.setattr(time, "time", lambda wrong=wrong: wrong)
        assert owner_of(target) is not None


def test_signs_of_life_are_given(target, monkeypatch):
    monkeypatch.setattr(life, "BEAT", 0.01)
    with Claim(target):
        (path,) = target.parent.glob(".*.claim")
        os.utime(path, (0.0, 0.0))
        last = time.monotonic() + 10.0
        while path.stat().st_mtime == 0.0 and time.monotonic() < last:
            time.sleep(0.01)
        assert path.stat().st_mtime > 0.0
    # And no longer than it is held: threads do not pile up.
    while threading.active_count() > 1 and time.monotonic() < last:
        time.sleep(0.01)
    assert not [thread for thread in threading.enumerate() if "_beat" in thread.name]


def test_a_system_without_further_threads(target, monkeypatch):
    """The last one is left to the work."""
    start, left = threading.Thread.start, [1]

    def limited(thread):
        if not left[0]:
            raise RuntimeError("can't start new thread")
        left[0] -= 1
        start(thread)

    monkeypatch.setattr(threading.Thread, "start", limited)
    before = threading.active_count()
    for left[0] in (1, 0):
        with Claim(target) as claim:
            assert claim.owner is None and threading.active_count() == before


def test_of_two_that_find_a_dead_one_the_slower_gives_way(target, monkeypatch):
    """Each way in which one comes between the look and the move of another."""
    look = taking.look
    for after in range(1, 4):
        leave(target, pid=GONE)
        calls, first = [], []

        def slow(path, after=after, calls=calls, first=first):
            found = look(path)
            calls.append(path)
            if len(calls) == after:
                monkeypatch.setattr(taking, "look", look)
                first.append(Claim(target))
            return found

        monkeypatch.setattr(taking, "look", slow)
        second = Claim(target)
        monkeypatch.setattr(taking, "look", look)
        got = [claim for claim in (*first, second) if claim.owner is None]
        assert len(got) == 1
        got[0].release()
        assert hidden(target.parent) == []


def test_one_that_died_as_it_took_over_is_no_obstacle(target):
    path = leave(target, pid=GONE)
    text = path.read_text()
    successor = path.with_name(f"{path.name}.{taking.look(path).digest}")
    successor.write_text(text)
    with Claim(target) as claim:
        assert claim.owner is None
    # Nor is it left behind where nobody takes over.
    successor.write_text(text)
    remove_dead([target])
    assert hidden(target.parent) == []


def test_a_folder_that_takes_no_file(tmp_path):
    for target in (tmp_path / "missing" / "r.h5", "/proc/r.h5"):
        with pytest.raises(OSError):
            Claim(target)


@pytest.mark.parametrize("call", ["write", "fsync"])
def test_a_claim_that_cannot_be_written_leaves_nothing(target, monkeypatch, call):
    def full(*_):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, call, full)
    with pytest.raises(OSError, match="No space"):
        Claim(target)
    assert hidden(target.parent) == []


def test_a_process_that_ended_but_was_not_waited_for_is_dead(target, other):
    other.send_signal(signal.SIGKILL)
    last = time.monotonic() + 10.0
    while owners.runs(other.pid) and time.monotonic() < last:
        time.sleep(0.01)
    assert not owners.runs(other.pid)


_RACE = """
import sys, time, os
from pathlib import Path
from goniosim import claims
from goniosim.claims import taking
if sys.argv[3] == "no locks":
    taking.try_lock = lambda *_, **__: None
folder, name = Path(sys.argv[1]), sys.argv[2]
inside = folder / "inside"
held = 0
print("ready", flush=True)
sys.stdin.readline()
while held < 100:
    claim = claims.Claim(folder / name)
    if claim.owner is None:
        # Exclusive, or the assertion is heard.
        os.close(os.open(inside, os.O_CREAT | os.O_EXCL))
        held += 1
        os.unlink(inside)
        if held % 3:
            claim.release()
        else:
            # As if killed: a claim of a dead owner, for all to find.
            path = next(folder.glob(".*.claim"))
            text = path.read_text().replace(f'"pid": {os.getpid()}', '"pid": 4194305')
            os.close(claim._descriptor)
            claim._released.set()
            time.sleep(0.002)
            temporary = folder / f"dead-{os.getpid()}"
            temporary.write_text(text)
            os.replace(temporary, path)
print(held)
"""


@pytest.mark.slow
@pytest.mark.parametrize("locks", ["locks", "no locks"])
def test_many_processes_and_many_dead(tmp_path, locks):
    """Two at a time in the place that only one may be in would end with an error."""
    (tmp_path / "out").mkdir()
    started = [
        subprocess.Popen(
            [sys.executable, "-c", _RACE, tmp_path / "out", "r.h5", locks],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        for _ in range(4)
    ]
    try:
        for process in started:
            assert process.stdout.readline() == "ready\n"
        for process in started:
            process.stdin.write("go\n")
            process.stdin.flush()
        held = [int(process.communicate(timeout=60)[0]) for process in started]
        assert [process.returncode for process in started] == [0] * 4 and held == [100] * 4
    finally:
        for process in started:
            process.kill()
            process.communicate()
    remove_dead([tmp_path / "out" / "r.h5"])
    assert list((tmp_path / "out").iterdir()) == []
