"""A copy of the source, in which tests are run with and without a mutant."""

import os
import shutil
import subprocess
import sys
import time
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from pathlib import Path

from .catalogue import ROOT
from .compiled import take_over

# A mutant may make the walk endless.
LIMIT = 900.0
# How the message of a test begins that found something wrong, or to which goniosim said something else than expected.
# All else is broken code.
_FOUND = ("assert", "AssertionError", "Failed", "ExceptionGroup: Hypothesis", "goniosim.errors.")
_WHOSE = """
import goniosim, goniosim_cli
from goniosim._jit import CACHE_FOLDER
for path in (goniosim.__file__, goniosim_cli.__file__, CACHE_FOLDER):
    print(path)
"""


@dataclass(frozen=True)
class Verdict:
    """How tests ended.

    Attributes
    ----------
    passed : bool
        All of them, and there were some.
    caught_by : str or None
        The first test that found something wrong.
    seconds : float
    output : str
    """

    passed: bool
    caught_by: str | None
    seconds: float
    output: str


class Copy:
    """A copy of the source in a folder of its own.

    What is compiled is kept beside it: for the source as it is, and for a mutant, which has what it leaves as it is.
    """

    def __init__(self, folder):
        self._folder, self._tree = folder, folder / "tree"
        listed = subprocess.run(
            ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
            cwd=ROOT,
            capture_output=True,
            check=True,
        )
        for name in filter(None, os.fsdecode(listed.stdout).split("\0")):
            if (ROOT / name).is_file():
                (self._tree / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(ROOT / name, self._tree / name)
        (folder / "links").mkdir()
        (folder / "links" / "goniosim_cli").symlink_to(self._tree / "cli")
        self._compiled = self._cache_folder(folder / "compiled")

    def run(self, tests):
        """Run tests on the source as it is."""
        return self._run(tests, self._folder / "compiled")

    def run_with(self, mutant, size=None):
        """Run the tests of a mutant."""
        path = self._tree / mutant.file
        source, before = path.read_text(), path.stat()
        cache = self._folder / "mutant"
        path.write_text(mutant.applied(source, size))
        try:
            take_over(self._compiled, self._cache_folder(cache), self._tree, mutant.file)
            return self._run(mutant.tests, cache)
        finally:
            path.write_text(source)
            # Compiled code goes by the time of its source.
            os.utime(path, ns=(before.st_atime_ns, before.st_mtime_ns))
            shutil.rmtree(cache, ignore_errors=True)

    def _environment(self, cache):
        known = {name: value for name, value in os.environ.items() if not name.startswith(("PYTEST", "NUMBA"))}
        paths = os.pathsep.join(map(str, (self._tree, self._folder / "links")))
        return known | {"PYTHONPATH": paths, "XDG_CACHE_HOME": str(cache), "PYTHONDONTWRITEBYTECODE": "1"}

    def _cache_folder(self, cache):
        """Where the copy keeps compiled code; raises a RuntimeError if an installation of goniosim comes first."""
        cache.mkdir()
        done = subprocess.run(
            [sys.executable, "-c", _WHOSE],
            cwd=self._folder,
            env=self._environment(cache),
            capture_output=True,
            text=True,
            check=True,
        )
        found = done.stdout.split()
        if not all(path.startswith(str(self._folder)) for path in found):
            raise RuntimeError(f"tests would see {' and '.join(found)} instead of what is in {self._folder}")
        return Path(found[-1])

    def _run(self, tests, cache):
        report = self._folder / "report.xml"
        report.unlink(missing_ok=True)
        command = [sys.executable, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider", f"--junitxml={report}"]
        began = time.monotonic()
        try:
            done = subprocess.run(
                [*command, *tests],
                cwd=self._tree,
                env=self._environment(cache),
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
                timeout=LIMIT,
            )
        except subprocess.TimeoutExpired:
            return Verdict(False, None, time.monotonic() - began, f"not through after {LIMIT:.0f} s")
        caught_by = _first_failure(report) if done.returncode == 1 else None
        return Verdict(done.returncode == 0, caught_by, time.monotonic() - began, done.stdout)


def _first_failure(report):
    """The first test that found something wrong: ``file::name``; None if there is none."""
    for case in ElementTree.parse(report).iter("testcase"):
        for failure in case.iter("failure"):
            if failure.get("message", "").startswith(_FOUND):
                return f"{case.get('classname').replace('.', '/')}.py::{case.get('name')}"
    return None
