"""What all tests of the command line share: small scene files and a way to call `goniosim`."""

import subprocess
import sys

import pytest
from click.testing import CliRunner

from small import SCENE, STUDY


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """An empty working directory with ``scene.yaml`` and ``study.yaml``."""
    (tmp_path / "scene.yaml").write_text(SCENE)
    (tmp_path / "study.yaml").write_text(STUDY)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def goniosim():
    """Call the command in this process: ``goniosim("info", path)`` returns exit code, stdout, stderr."""
    from goniosim_cli.main import main

    def call(*arguments, stdin=None):
        outcome = CliRunner().invoke(main, [str(argument) for argument in arguments], input=stdin)
        return outcome.exit_code, outcome.stdout, outcome.stderr

    return call


@pytest.fixture
def python():
    """Start a Python script in a process of its own."""

    def popen(script, *arguments):
        return subprocess.Popen(
            [sys.executable, "-c", script, *map(str, arguments)],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )

    return popen


@pytest.fixture
def start(python):
    """Start the command in a process of its own."""
    return lambda *arguments: python("from goniosim_cli.main import main; main()", *arguments)
