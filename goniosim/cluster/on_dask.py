"""Workers of dask as an executor: those of a scheduler that runs somewhere, or processes of this machine."""

import contextlib
import logging
import signal
from collections.abc import Iterator
from concurrent.futures import Executor

import dask
from distributed import Client, LocalCluster, Worker, WorkerPlugin
from distributed.scheduler import KilledWorker

from goniosim.cores import available_cores
from goniosim.errors import RefusalError

LOCAL = "local"
# Of a shard that raises an error; dask itself bears with as many lost workers.
_RETRIES = 3
_SECONDS_TO_CONNECT = 10
_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGUSR1, signal.SIGUSR2, signal.SIGXCPU)


class _Deaf(WorkerPlugin):
    """Leaves signals to the command: terminals and batch systems send them to its workers too."""

    def setup(self, worker: Worker) -> None:
        for each in _SIGNALS:
            signal.signal(each, signal.SIG_IGN)


@contextlib.contextmanager
def dask_executor(address: str, threads: int = 1) -> Iterator[tuple[Executor, int]]:
    """Connect to workers of dask.

    Parameters
    ----------
    address : str
        Of a scheduler, such as ``tcp://10.0.0.1:8786``; or ``local``, for processes on all cores of this machine.
    threads : int
        That each task will use.

    Yields
    ------
    executor : concurrent.futures.Executor
    slots : int
        Tasks that are done side by side; 0 if there are no workers yet.

    Raises
    ------
    RefusalError
        If no scheduler answers, or its workers are lost or cannot do what they are to do.
    """
    # What happens to shards, the command tells in its own words.
    for name in ("distributed", "distributed.client"):
        logging.getLogger(name).setLevel(logging.CRITICAL)
    with contextlib.ExitStack() as stack:
        if address == LOCAL:
            # Otherwise it asks the libraries of this very process for a single thread, and of what follows too.
            stack.enter_context(dask.config.set({"distributed.nanny.pre-spawn-environ": {}}))
            count = max(1, available_cores() // threads)
            # The engine looks after memory itself.
            given = {"memory_limit": 0, "dashboard_address": None, "silence_logs": logging.CRITICAL}
            cluster = stack.enter_context(LocalCluster(n_workers=count, threads_per_worker=1, **given))
            client = stack.enter_context(Client(cluster))
            client.register_plugin(_Deaf())
        else:
            client = stack.enter_context(_connected(address))
        try:
            # Not pure: what a shard does depends on what lies in its folder.
            yield client.get_executor(pure=False, retries=_RETRIES), sum(client.ncores().values())
        except KilledWorker as error:
            raise RefusalError(
                "dask: a shard lost its worker again and again: for want of memory, or time; what is done stays: run "
                "this again, with workers that have more, or fewer threads"
            ) from error
        except ModuleNotFoundError as error:
            raise RefusalError(f"dask: its workers lack something: {error}; install goniosim there as here") from error


def _connected(address: str) -> Client:
    try:
        return Client(address, timeout=_SECONDS_TO_CONNECT, set_as_default=False)
    except (OSError, ValueError) as error:
        why = " ".join(str(error).split())
        raise RefusalError(
            f"--dask {address}: no scheduler answers: {why}; name one as tcp://HOST:8786, or local for this machine"
        ) from error
