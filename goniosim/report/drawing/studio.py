"""Drawing in processes of their own: matplotlib keeps to one core, and a study has hundreds of figures."""

import contextlib
import multiprocessing
import os
import signal
import threading
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool

from ...errors import OutputError
from .files import write_figure

# Each process takes some 150 MB.
MOST_PROCESSES = 8


class Studio:
    """Draws figures side by side; to be closed.

    Parameters
    ----------
    processes : int
        One draws here; more are started with the first figures.
    """

    def __init__(self, processes):
        self._pool = None
        if processes > 1:
            methods = multiprocessing.get_all_start_methods()
            context = multiprocessing.get_context("forkserver" if "forkserver" in methods else "spawn")
            # Where the system lacks what processes share (/dev/shm, a folder for sockets), it is drawn here.
            with contextlib.suppress(OSError, ImportError, NotImplementedError):
                self._pool = ProcessPoolExecutor(min(processes, MOST_PROCESSES), context, _prepare)

    def draw(self, figures):
        """Draw and write figures, and wait for them.

        Parameters
        ----------
        figures : sequence of tuple
            Arguments of `files.write_figure`, which other processes can be sent.

        Returns
        -------
        list of Path

        Raises
        ------
        OutputError
        """
        if self._pool is None:
            return _draw_here(figures)
        try:
            drawn = [self._pool.submit(_draw, *figure) for figure in figures]
            return [path for each in drawn for path in each.result()]
        except BrokenProcessPool as error:
            raise OutputError(
                "the figures cannot be drawn: a process that draws was ended, perhaps for want of memory; "
                "rerun with fewer figures"
            ) from error
        except (OSError, RuntimeError):
            # The system grants no further process or thread.
            self.close()
            self._pool = None
            return _draw_here(figures)

    def close(self):
        """End the processes; figures that nobody waits for are not begun."""
        if self._pool is not None:
            self._pool.shutdown(wait=False, cancel_futures=True)


def _draw_here(figures):
    return [path for figure in figures for path in write_figure(*figure)]


_interrupted = threading.Event()


def _draw(*figure):
    # Some figures are on their way to this process when nobody waits for them any more.
    return [] if _interrupted.is_set() else write_figure(*figure)


def _prepare():
    # Ctrl-C reaches every process at the terminal; a figure that was begun is finished and leaves nothing behind.
    signal.signal(signal.SIGINT, lambda *_: _interrupted.set())
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent():
    """Nobody else tells a process of a pool that the one it works for was killed."""
    multiprocessing.parent_process().join()
    os._exit(1)
