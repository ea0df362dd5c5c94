"""`goniosim.simulate_study` with an executor: the numbers of a plain call, whoever traces, also after a stop."""

import multiprocessing
import signal
import threading
from concurrent.futures import CancelledError, Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool

import pytest

import goniosim
from goniosim.cluster import shards_folder, spreading
from goniosim.errors import ConfigError, OutputError, RefusalError, StoppedError
from sameness import content, datasets
from small import STUDY as THREE

STUDY = THREE.replace("[0.1, 0.2, 0.3]", "[0.1, 0.2]")
ASKED = {"rays": 4000, "estimator": "analog"}
NAMES = ["coat-0.1", "coat-0.2"]


@pytest.fixture(scope="module")
def wholes():
    """Results of a plain call."""
    return goniosim.simulate_study(STUDY, **ASKED)


@pytest.fixture
def pool():
    with ThreadPoolExecutor(2) as pool:
        yield pool


def call(pool, **given):
    return goniosim.simulate_study(STUDY, **{**ASKED, "executor": pool, "shards": 3, **given})


def same(results, wholes):
    return list(results) == NAMES and all(content(results[name]) == content(wholes[name]) for name in NAMES)


def test_results_are_those_of_a_plain_call(pool, wholes):
    told = []
    assert same(call(pool, progress=lambda *each: told.append(each)), wholes)
    assert told[0] == (0, 8000) and told[-1] == (8000, 8000) and told == sorted(told)


@pytest.mark.slow
def test_files_are_those_of_a_plain_call(pool, tmp_path, monkeypatch):
    goniosim.simulate_study(STUDY, folder=tmp_path / "plain", **ASKED)
    # More shards than pieces of work.
    files = call(pool, folder=tmp_path / "out", shards=40)
    assert [path.name for path in files.values()] == [f"{name}.h5" for name in NAMES]
    for path in files.values():
        assert datasets(path) == datasets(tmp_path / "plain" / path.name)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["out", "plain"]
    monkeypatch.setattr(spreading, "run_shard", lambda *_, **__: pytest.fail("traced again"))
    assert call(pool, folder=tmp_path / "out") == files


@pytest.mark.slow
def test_processes_trace_it(wholes):
    with ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("spawn")) as pool:
        assert same(call(pool), wholes)


class Stopping(Executor):
    """Traces some shards at once, and asks to stop before the others."""

    def __init__(self, count):
        self.left, self.event = count, threading.Event()

    def submit(self, function, *arguments):
        future = Future()
        if self.left:
            future.set_result(function(*arguments))
        else:
            self.event.set()
            future.set_running_or_notify_cancel()
            threading.Timer(0.4, lambda: future.set_result(function(*arguments))).start()
        self.left -= self.left > 0
        return future


def test_a_stopped_call_goes_on_where_it_was(pool, tmp_path, wholes):
    """With as many shards as before, though nobody says how many."""
    stopping = Stopping(1)
    with pytest.raises(StoppedError):
        call(stopping, folder=tmp_path / "out", stop=stopping.event)
    shards = shards_folder(tmp_path / "out")
    assert shards == tmp_path / "out.shards"
    assert sorted(path.name for path in shards.iterdir()) == ["coat-0.1.shard-00001-of-00003.h5", "plan.json"]
    files = call(pool, folder=tmp_path / "out", shards=None)
    assert same({name: goniosim.open_result(path) for name, path in files.items()}, wholes)
    assert not shards.exists()


@pytest.mark.slow
def test_without_a_folder_what_there_is_comes_back(wholes):
    stopping = Stopping(2)
    found = call(stopping, stop=stopping.event)
    assert [found[name].status for name in NAMES] == ["complete", "partial"]
    assert content(found["coat-0.1"]) == content(wholes["coat-0.1"])
    assert 0 < found["coat-0.2"].rays[0] < 4000


def test_ctrl_c_with_nothing_to_return_is_one(tmp_path):
    def press(done, total):
        signal.raise_signal(signal.SIGINT)

    earlier = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt):
            call(Stopping(0), progress=press, folder=tmp_path / "out")
    finally:
        signal.signal(signal.SIGINT, earlier)


@pytest.mark.slow
def test_a_shard_that_fails_holds_up_no_other(pool, tmp_path, monkeypatch, wholes):
    def failing(folder, shard, **given):
        if shard == 2:
            raise OutputError("no room")
        return run_shard(folder, shard, **given)

    run_shard = spreading.run_shard
    with monkeypatch.context() as patch:
        patch.setattr(spreading, "run_shard", failing)
        with pytest.raises(OutputError, match="^no room$"):
            call(pool, folder=tmp_path / "out")
    held = sorted(path.name for path in (tmp_path / "out.shards").iterdir())
    assert held == ["coat-0.1.shard-00001-of-00003.h5", "coat-0.2.shard-00003-of-00003.h5", "plan.json"]
    files = call(pool, folder=tmp_path / "out")
    assert same({name: goniosim.open_result(path) for name, path in files.items()}, wholes)


class Broken(Executor):
    """Whose processes are killed, or that is shut down by somebody."""

    def __init__(self, error):
        self.error = error

    def submit(self, function, *arguments):
        future = Future()
        future.set_exception(self.error)
        return future


@pytest.mark.parametrize("error", [BrokenProcessPool("A process was terminated abruptly"), CancelledError("lost")])
def test_an_executor_that_gives_up(tmp_path, error):
    with pytest.raises(RefusalError, match="a shard was given up: .* run this again") as caught:
        call(Broken(error), folder=tmp_path / "out")
    assert "\n" not in str(caught.value)


def test_workers_that_do_not_see_the_folder_say_so(tmp_path):
    with pytest.raises(RefusalError, match="does not see this folder; choose a place that all workers share"):
        spreading._trace(str(tmp_path / "elsewhere"), 1, 1, 60.0, ".stop")


def test_what_is_no_executor(pool):
    with pytest.raises(ConfigError, match=r"executor must be a concurrent\.futures\.Executor \[got 5\]"):
        call(5)
    with pytest.raises(ConfigError, match="shards are for an executor"):
        call(None)
    with pytest.raises(ConfigError, match="shards must be a whole number"):
        call(pool, shards="many")
    with pytest.raises(ConfigError, match=r"shards must be a whole number from 1 to 1000000 \[got 0\]"):
        call(pool, shards=0)
