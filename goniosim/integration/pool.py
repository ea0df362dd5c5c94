"""Work on many cells, in blocks, on several threads."""

from concurrent.futures import ThreadPoolExecutor

from ..cores import available_cores, granted_threads

# Directions evaluated at a time: their arrays fit in a core's own cache.
BLOCK = 4096


class Pool(ThreadPoolExecutor):
    """Threads that share the work of an integration; a context manager.

    Parameters
    ----------
    threads : int, optional
        One for each core that this process may use by default.
    """

    def __init__(self, threads=None):
        self.threads = granted_threads(threads or available_cores())
        super().__init__(self.threads, thread_name_prefix="integration")

    def in_blocks(self, work, n, step):
        """Call ``work(start)`` for start = 0, step, 2 step, ... below ``n``.

        Parameters
        ----------
        work : callable
            Writes results to places of its own, so that the order does not matter.
        n, step : int
        """
        starts = range(0, n, step)

        def several(first):
            for start in starts[first :: self.threads]:
                work(start)

        if len(starts) <= 1 or self.threads == 1:
            for start in starts:
                work(start)
            return
        for _ in self.map(several, range(min(self.threads, len(starts)))):
            pass
