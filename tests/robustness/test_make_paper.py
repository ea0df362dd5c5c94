"""`make paper` does what is missing and nothing twice; the commands themselves are stood in for."""

import os
import shutil
import subprocess
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SIMULATE, COMPARE, VARY, WRITE = "simulate", "compare", "vary", "write"

# Like goniosim, leaves alone a result that has the rays asked for, and replaces it for more.
GONIOSIM = """\
#!/bin/sh
echo $1 >> log
if [ $1 = simulate ]; then
    mkdir -p $6
    file=$6/$(basename $2 .yaml).h5
    [ "$(cat $file 2>/dev/null)" = $4 ] || echo $4 > $file
else
    mkdir -p $4
fi
"""
PYTHON = """\
#!/bin/sh
if [ "$4" = --experiments ]; then echo vary >> log; touch $3/experiments.csv; else echo write >> log; fi
"""


@pytest.fixture
def make(tmp_path):
    """Run `make` in a folder with the project's Makefile and stand-ins; returns what was called."""
    shutil.copy(ROOT / "Makefile", tmp_path)
    for name in (
        "pyproject.toml",
        "constraints.txt",
        "goniosim/models/one.py",
        "benchmarks/paper_study/experiments/a.py",
    ):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).touch()
    folder = tmp_path / ".venv" / "bin"
    folder.mkdir(parents=True)
    for name, script in (("goniosim", GONIOSIM), ("python", PYTHON)):
        (folder / name).write_text(script)
        (folder / name).chmod(0o755)
    (tmp_path / ".venv" / ".installed").touch()
    quiet = {name: value for name, value in os.environ.items() if name not in ("MAKEFLAGS", "MAKELEVEL", "MFLAGS")}

    def run(*arguments):
        log = tmp_path / "log"
        log.write_text("")
        command = ["make", "paper", *arguments]
        subprocess.run(command, cwd=tmp_path, env=quiet, check=True, capture_output=True)
        return log.read_text().split()

    run.folder = tmp_path
    return run


def change(path):
    """Write a file later than all that was made so far, also by a clock that ticks every 10 ms."""
    time.sleep(0.05)
    path.touch()


def test_a_second_run_does_nothing_but_look_at_the_results(make):
    assert make() == [SIMULATE] * 3 + [COMPARE, VARY, WRITE]
    assert make() == [SIMULATE] * 3


def test_more_rays_start_all_over(make):
    make("RAYS=1e6")
    time.sleep(0.05)
    assert make("RAYS=1e7") == [SIMULATE] * 3 + [COMPARE, VARY, WRITE]
    assert make("RAYS=1e7") == [SIMULATE] * 3


def test_a_changed_model_is_compared_anew_and_a_changed_page_only_written(make):
    make()
    change(make.folder / "benchmarks" / "paper_study" / "readme.py")
    assert make() == [SIMULATE] * 3 + [WRITE]
    change(make.folder / "goniosim" / "models" / "one.py")
    assert make() == [SIMULATE] * 3 + [COMPARE, VARY, WRITE]


def test_what_failed_is_done_again(make):
    script = make.folder / ".venv" / "bin" / "goniosim"
    script.write_text(GONIOSIM.replace("mkdir -p $4", "exit 1"))
    with pytest.raises(subprocess.CalledProcessError):
        make()
    script.write_text(GONIOSIM)
    assert make() == [SIMULATE] * 3 + [COMPARE, VARY, WRITE]
