"""`goniosim simulate --dask`: shards on workers of dask, some of them lost, merged to the numbers of a plain run."""

import os
import signal
import sys
import time

import pytest

from impatient import IMPATIENT, wait_for
from sameness import content, datasets
from small import STUDY

pytest.importorskip("distributed", reason="an optional part")
import psutil  # noqa: E402
from distributed import Client, LocalCluster  # noqa: E402
from distributed.scheduler import KilledWorker  # noqa: E402

import goniosim as api  # noqa: E402
from goniosim.cluster import on_dask  # noqa: E402
from goniosim.errors import RefusalError  # noqa: E402

# Some seconds of work, on any machine.
RAYS = "6e7"
ASKED = ("simulate", "study.yaml", "--estimator", "analog", "--rays", RAYS)

DASK = ("--dask", "local", "-o", "out", "--checkpoint", "0.1s")


@pytest.fixture(scope="module")
def wholes(tmp_path_factory):
    """Files of a plain run, of a study whose kernels are compiled by then."""
    folder = tmp_path_factory.mktemp("plain")
    return api.simulate_study(STUDY, folder=folder, rays=float(RAYS), estimator="analog")


def wait_for_portions(process, folder):
    """Until some shards are at work and have kept something."""
    until = time.monotonic() + 300.0
    while not list(folder.glob("*.h5")):
        assert time.monotonic() < until and process.poll() is None


def same(folder, wholes):
    return all(datasets(folder / path.name) == datasets(path) for path in wholes.values())


@pytest.mark.slow
def test_workers_of_its_own(python, goniosim, folder, wholes):
    """Stopped by a signal that all of its processes get, it goes on; and then it leaves results alone."""
    process = python("import os; os.setsid()\n" + IMPATIENT, *ASKED, *DASK)
    first = wait_for(process, " shards, which lie in ")
    wait_for_portions(process, folder / "out.shards")
    os.killpg(process.pid, signal.SIGTERM)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 75
    assert "stopped by SIGTERM: what is done stays in" in err and f"{folder / 'out.shards'}" in first[-1]
    code, out, err = goniosim(*ASKED, *DASK)
    assert code == 0 and "goes on from" in err and "coat-0.3   complete" in out
    assert same(folder / "out", wholes) and not (folder / "out.shards").exists()
    code, _, err = goniosim(*ASKED, *DASK)
    assert code == 0 and "3 of 3 materials are finished: skipped" in err


@pytest.mark.slow
def test_a_worker_that_is_killed_in_mid_flight(python, folder, wholes):
    process = python(IMPATIENT, *ASKED, *DASK)
    wait_for_portions(process, folder / "out.shards")
    workers = [each for each in psutil.Process(process.pid).children() if each.cpu_times().user > 0.2]
    max(workers, key=lambda each: each.cpu_times().user).kill()
    out, err = process.communicate(timeout=300)
    assert process.returncode == 0, err
    assert same(folder / "out", wholes) and not (folder / "out.shards").exists()


@pytest.mark.slow
def test_an_executor_of_dask_whose_worker_is_killed(wholes):
    """From Python, in a cluster of the user's own."""
    killed = []
    with (
        LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None, silence_logs=50) as cluster,
        Client(cluster) as client,
    ):
        pids = list(client.run(os.getpid).values())

        def kill(done, total):
            if done and not killed:
                killed.append(os.kill(pids[0], signal.SIGKILL))

        executor = client.get_executor(pure=False, retries=3)
        given = {"rays": float(RAYS), "estimator": "analog", "progress": kill}
        found = api.simulate_study(STUDY, executor=executor, **given)
    assert killed
    for name, result in found.items():
        assert content(result) == content(api.open_result(wholes[name]))


def only_line(err):
    (line,) = err.splitlines()
    return line


def test_where_dask_is_not_installed(goniosim, folder, monkeypatch):
    monkeypatch.setitem(sys.modules, "goniosim.cluster.on_dask", None)
    code, out, err = goniosim("simulate", "scene.yaml", "--dask", "local")
    assert (code, out) == (10, "")
    assert 'error: --dask needs distributed, an optional part: pip install "goniosim[dask]"' in only_line(err)


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:1", "127.0.0.1:1", "nowhere://x"])
def test_a_scheduler_that_does_not_answer(goniosim, folder, monkeypatch, address):
    monkeypatch.setattr(on_dask, "_SECONDS_TO_CONNECT", 0.1)
    code, out, err = goniosim("simulate", "scene.yaml", "--dask", address)
    assert (code, out) == (10, "")
    assert f"error: --dask {address}: no scheduler answers: " in only_line(err)
    assert not (folder / "small.shards").exists()


@pytest.fixture
def empty():
    """A scheduler without workers."""
    with LocalCluster(n_workers=0, dashboard_address=None, silence_logs=50) as cluster:
        yield cluster


@pytest.mark.parametrize(
    ("error", "words"),
    [
        (KilledWorker("task", None, 3), "a shard lost its worker again and again: .* what is done stays"),
        (
            ModuleNotFoundError("No module named 'goniosim'"),
            "'goniosim'; install goniosim there as here",
        ),
    ],
)
def test_workers_that_are_no_help(empty, error, words):
    with pytest.raises(RefusalError, match=words) as caught, on_dask.dask_executor(empty.scheduler_address) as given:
        assert given[1] == 0
        raise error
    assert "\n" not in str(caught.value)


def test_a_scheduler_without_workers(goniosim, folder, empty):
    code, _, err = goniosim("simulate", "scene.yaml", "--dask", empty.scheduler_address)
    assert code == 10 and "it has no workers; start some" in only_line(err)


def test_one_shard_or_all_of_them(goniosim, folder):
    code, _, err = goniosim("simulate", "scene.yaml", "--dask", "local", "--shard", "1/2")
    assert code == 2 and "--dask traces all shards: leave out --shard" in err
