"""Standard input, output and error as the shell leaves them: closed, full, or with a reader who has gone.

None of that may reach the computation. What standard error does not take is lost and nothing else is. What
standard output does not take is remembered, and said once the work is done and in its place.
"""

import contextlib
import errno
import io
import os
import select
import sys

# As for any output that cannot be written.
EXIT_CODE = 4
# Seconds to wait for a reader who is slow.
PATIENCE = 10.0


class _Lenient(io.FileIO):
    """A file descriptor whose first error is kept instead of raised, and that takes nothing more after it."""

    error = None

    def write(self, data):
        rest = memoryview(data).cast("B")
        size = len(rest)
        while rest and self.error is None:
            try:
                written = super().write(rest)
            except OSError as error:
                self.error = error
                break
            if written is not None:
                rest = rest[written:]
            # A pipe that does not wait, and has no room now: its reader may only be slow.
            elif not select.select([], [self], [], PATIENCE)[1]:
                self.error = BlockingIOError(errno.EAGAIN, os.strerror(errno.EAGAIN))
        return size


@contextlib.contextmanager
def guarded():
    """Guard the standard streams of a command, and turn an output that was lost into an exit code.

    Streams that somebody else put into place are left alone. A closed descriptor becomes the null device:
    a file opened later would get its number, and messages would go into that file.
    """
    _open_missing()
    output = _replace("stdout", "backslashreplace")
    _replace("stderr", "backslashreplace")
    try:
        yield
    except SystemExit as leaving:
        raise SystemExit(leaving.code or _complain(output)) from None
    if code := _complain(output):
        raise SystemExit(code)


def _open_missing():
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        try:
            os.fstat(number)
        except OSError:
            # The lowest free number is this one.
            os.set_inheritable(os.open(os.devnull, os.O_RDWR), True)
        if getattr(sys, name) is None:
            stream = open(number, "r" if number == 0 else "w", closefd=False)  # noqa: SIM115 - lives as long as we
            setattr(sys, name, stream)
            setattr(sys, f"__{name}__", stream)


def _replace(name, errors):
    """Put a lenient stream into the place of a real one; return its raw file."""
    given = getattr(sys, name)
    if given is not getattr(sys, f"__{name}__"):
        return None
    try:
        raw = _Lenient(given.fileno(), "w", closefd=False)
    except (OSError, ValueError):
        return None
    stream = io.TextIOWrapper(
        raw if given.write_through else io.BufferedWriter(raw),
        encoding=given.encoding,
        errors=errors if given.errors == "strict" else given.errors,
        line_buffering=given.line_buffering,
        write_through=given.write_through,
    )
    setattr(sys, name, stream)
    setattr(sys, f"__{name}__", stream)
    return raw


def _complain(output):
    """Say that what the command had to say got lost, if it did; return the exit code of that."""
    if output is None:
        return 0
    sys.stdout.flush()
    # A reader who left (`| head`) has seen enough.
    if output.error is None or output.error.errno == errno.EPIPE:
        return 0
    print(
        f"goniosim: error: standard output cannot be written: {output.error.strerror}; "
        "redirect it elsewhere (the files that this command writes are complete)",
        file=sys.stderr,
    )
    return EXIT_CODE
