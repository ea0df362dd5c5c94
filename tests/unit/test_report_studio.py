"""Figures drawn in other processes are those that would be drawn here, and their errors arrive."""

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest
from matplotlib.figure import Figure

from goniosim.errors import OutputError
from goniosim.report.drawing.studio import Studio


def _figure(words):
    figure = Figure(figsize=(3, 2))
    figure.text(0.1, 0.5, words)
    return figure


def _end(_):
    os._exit(9)


@pytest.fixture
def studio():
    studio = Studio(2)
    yield studio
    studio.close()


def test_two_processes_draw_what_one_draws(tmp_path, studio):
    names = ["a", "b", "c"]
    for folder in ("here", "there"):
        (tmp_path / folder).mkdir()
    written = studio.draw([(tmp_path / "there" / name, ("png", "svg"), _figure, name) for name in names])
    assert [path.name for path in written] == [f"{name}.{suffix}" for name in names for suffix in ("png", "svg")]
    Studio(1).draw([(tmp_path / "here" / name, ("png", "svg"), _figure, name) for name in names])
    for path in written:
        assert path.read_bytes() == (tmp_path / "here" / path.name).read_bytes()


def test_an_error_arrives(tmp_path, studio):
    with pytest.raises(OutputError, match="missing/a.png: cannot be written: No such file or directory"):
        studio.draw([(tmp_path / "missing" / "a", ("png",), _figure, "a")])
    (path,) = studio.draw([(tmp_path / "b", ("png",), _figure, "b")])
    assert path.exists()


def test_a_process_that_is_killed_is_explained(tmp_path, studio):
    with pytest.raises(OutputError, match="a process that draws was ended"):
        studio.draw([(tmp_path / "a", ("png",), _end, "a")])


ORPHANS = """
import os, signal, sys
from pathlib import Path
sys.path.insert(0, {folder!r})
from goniosim.report.drawing.studio import Studio
from orphan import pid_figure
if __name__ == "__main__":
    Studio(2).draw([(Path({folder!r}) / "pid", ("png",), pid_figure, {folder!r})])
    os.kill(os.getpid(), signal.SIGKILL)
"""


def test_nobody_goes_on_when_the_caller_is_killed(tmp_path):
    """The process that draws ends by itself, although nobody can tell it to."""
    (tmp_path / "orphan.py").write_text(
        "import os\nfrom pathlib import Path\nfrom matplotlib.figure import Figure\n"
        "def pid_figure(folder):\n"
        "    (Path(folder) / 'number').write_text(str(os.getpid()))\n"
        "    return Figure(figsize=(1, 1))\n"
    )
    (tmp_path / "main.py").write_text(ORPHANS.format(folder=str(tmp_path)))
    run = subprocess.run([sys.executable, str(tmp_path / "main.py")], capture_output=True, text=True)
    assert run.returncode == -9, run.stderr
    number = int((tmp_path / "number").read_text())
    for _ in range(100):
        if not _is_alive(number):
            return
        time.sleep(0.1)
    os.kill(number, 9)
    pytest.fail("the process goes on")


def _is_alive(number):
    try:
        os.kill(number, 0)
    except ProcessLookupError:
        return False
    # Ended, but in a container without anybody to take note of it.
    state = Path(f"/proc/{number}/stat")
    return not (state.exists() and state.read_text().rpartition(")")[2].split()[0] == "Z")
