"""Commands in processes of their own that tell early how far they are, and waiting for what they tell."""

import threading

import pytest

# The first line on progress comes early: it tells that something is gathered.
IMPATIENT = """
import goniosim.report.progress
goniosim.report.progress.FIRST_LINE = 0.1
from goniosim_cli.main import main
main()
"""


def wait_for(process, words):
    """Read standard error until a line holds the words; stop the process if that never happens."""
    guard = threading.Timer(300.0, process.kill)
    guard.start()
    try:
        lines = []
        for line in process.stderr:
            lines.append(line)
            if words in line:
                return lines
        pytest.fail(f"{words!r} never came: {''.join(lines)}")
    finally:
        guard.cancel()
