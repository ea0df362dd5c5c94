"""Numbered pieces of work on threads, their outcomes handed on in the order of their numbers.

So sums are the same to the last bit on any number of threads.
"""

from concurrent.futures import FIRST_COMPLETED, ThreadPoolExecutor, wait

_POLL_SECONDS = 0.1


def in_order(works, work, spare, reduce, threads, stop, tick):
    """Do pieces of work, several at a time.

    Parameters
    ----------
    works : sequence
        What ``work`` is called with, one after the other.
    work : callable
        ``work(one, buffer)`` returns an outcome; called from other threads.
    spare : list
        Buffers; as many pieces are in flight at the most.
    reduce : callable
        ``reduce(one, outcome, buffer)``, in the order of ``works``, from this thread; the buffer is free afterwards.
    threads : int
    stop : threading.Event
        When set, no piece is begun any more; set if this ends with an error.
    tick : callable
        Called without arguments a few times a second.
    """
    spare = list(spare)
    pending, done = {}, {}
    submitted = reduced = 0
    with ThreadPoolExecutor(threads) as pool:
        try:
            while reduced < len(works):
                while spare and submitted < len(works) and not stop.is_set():
                    buffer = spare.pop()
                    pending[pool.submit(work, works[submitted], buffer)] = (submitted, buffer)
                    submitted += 1
                if not pending:
                    break
                finished, _ = wait(pending, timeout=_POLL_SECONDS, return_when=FIRST_COMPLETED)
                for future in finished:
                    number, buffer = pending.pop(future)
                    done[number] = (future.result(), buffer)
                while reduced in done:
                    outcome, buffer = done.pop(reduced)
                    reduce(works[reduced], outcome, buffer)
                    spare.append(buffer)
                    reduced += 1
                tick()
        except BaseException:
            stop.set()
            raise
