"""Disks that fail: the calls of the operating system, within one folder."""

import errno
import io
import os
import shutil
from pathlib import Path


class Disk:
    """A folder whose file system can be made to fail, in this process; ``folder`` itself is sound at first."""

    def __init__(self, folder, monkeypatch):
        self.folder = folder
        self._patch = monkeypatch

    def fails(self, name, number, after=0):
        """Let a function of `os`, or ``flock``, fail with an error from now on, after so many calls that go well."""
        import fcntl

        module = fcntl if name == "flock" else os
        real, left = getattr(module, name), [after]

        def failing(first, *arguments, **options):
            if self._is_here(first) and self._matters(name, first, arguments):
                if not left[0]:
                    raise OSError(number, os.strerror(number))
                left[0] -= 1
            return real(first, *arguments, **options)

        self._patch.setattr(module, name, failing)

    def fills_up(self, number):
        """Take a little and no more."""
        pwrite = os.pwrite

        def full(descriptor, data, position):
            if self._is_here(descriptor):
                if position + len(data) > 20_000:
                    raise OSError(number, os.strerror(number))
                data = data[:1000]
            return pwrite(descriptor, data, position)

        self._patch.setattr(os, "pwrite", full)

    def reads(self, number):
        """Let files be opened, and nothing be read from them."""

        class Unreadable(io.FileIO):
            def readinto(_, buffer):
                raise OSError(number, os.strerror(number))

        def opening(path, mode):
            return io.BufferedReader(Unreadable(path)) if self._is_here(os.fspath(path)) else open(path, mode)

        self._patch.setattr("goniosim.store.opening.open", opening, raising=False)

    def vanishes(self):
        """Remove the folder with all that is in it."""
        shutil.rmtree(self.folder)

    def _is_here(self, first):
        path = f"/proc/self/fd/{first}" if isinstance(first, int) else first
        with_links = os.readlink(path) if isinstance(first, int) else os.fspath(path)
        return isinstance(with_links, str) and Path(os.path.abspath(with_links)).is_relative_to(self.folder)

    @staticmethod
    def _matters(name, first, arguments):
        # Reading goes on where nothing can be created any more, and what is hidden can be removed.
        if name == "open":
            return bool(arguments[0] & os.O_CREAT)
        return name != "stat" or not os.path.basename(first).startswith(".")


# What goes wrong, as a function of a disk, and what is said of it.
FAULTS = {
    **{f"pwrite {errno.errorcode[n]}": lambda disk, n=n: disk.fills_up(n) for n in (errno.ENOSPC, errno.EDQUOT)},
    **{
        f"{name} {errno.errorcode[n]}": lambda disk, name=name, n=n: disk.fails(name, n)
        for name, numbers in {
            "posix_fallocate": (errno.ENOSPC, errno.EDQUOT),
            "fsync": (errno.ENOSPC, errno.EDQUOT, errno.EIO, errno.ESTALE),
            "replace": (errno.EIO, errno.EXDEV, errno.ESTALE),
            "open": (errno.EROFS, errno.EACCES, errno.ENOSPC, errno.ESTALE),
            "ftruncate": (errno.EIO,),
            "stat": (errno.EIO, errno.ESTALE),
        }.items()
        for n in numbers
    },
    "vanished": Disk.vanishes,
}
