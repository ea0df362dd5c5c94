"""Products of matrices on one thread each: several run side by side, and their bits depend on no number of threads."""

import threading
from contextlib import contextmanager

from threadpoolctl import ThreadpoolController

_lock = threading.Lock()
_users = 0
_limit = None


@contextmanager
def one_thread():
    """While any thread is inside, the library of linear algebra starts no threads of its own."""
    global _users, _limit
    with _lock:
        if _users == 0:
            _limit = ThreadpoolController().limit(limits=1, user_api="blas")
        _users += 1
    try:
        yield
    finally:
        with _lock:
            _users -= 1
            if _users == 0:
                _limit.restore_original_limits()
