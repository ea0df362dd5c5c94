"""Kernels, compiled once before the workers of a parallel run need them: each would compile them for itself."""

import os
import subprocess
import sys
from pathlib import Path

pytest_plugins = ("alarms", "suite")

# By each of two processes, which take about as long.
_COMPILE = """
import sys
from goniosim.engine.estimators.choose import choose
from goniosim.engine.plan import make_plan
from goniosim.engine.probe import _warm_up
from reference.scenes import conductor, dielectric, lambert, make_scene

GLOSSY, ROUGH = dielectric(1.5, 0.001), dielectric(1.5, 0.2)
NARROW, WIDE = conductor(1.45, 1.0, 0.001), conductor(1.45, 1.0, 0.2)
scenes = {
    "walks": [[GLOSSY, NARROW]],
    "operators": [[ROUGH, WIDE], [GLOSSY, WIDE], [ROUGH, lambert(0.5)]],
}
for layers in scenes[sys.argv[1]]:
    plan = make_plan(make_scene(layers, 30))
    _warm_up(plan, choose(plan, "auto", None), sys.argv[1] == "walks")
"""


def pytest_configure(config):
    # Not in a worker, nor where there are none.
    if hasattr(config, "workerinput") or not getattr(config.option, "numprocesses", None):
        return
    tests = Path(__file__).resolve().parent
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(tests), str(tests.parent)])}
    started = [
        subprocess.Popen([sys.executable, "-c", _COMPILE, half], env=environment) for half in ("walks", "operators")
    ]
    # What does not compile is for the tests to tell.
    for process in started:
        process.wait()
