"""The time of checkpoints only grows, whatever the machine does between two lines."""

import threading
import time

import numpy as np

from goniosim.engine import assembly
from goniosim.engine.drive import Drive
from goniosim.engine.plan import make_plan
from goniosim.engine.session import Session
from reference.scenes import METAL, make_scene


class Held(Drive):
    """The first call is held up, as by another process, before it looks at the clock."""

    held = False

    def do(self, *arguments, **options):
        if not self.held:
            self.held = True
            time.sleep(1.0)
        return super().do(*arguments, **options)


def test_seconds_of_checkpoints_do_not_decrease():
    """Over rounds of milliseconds, where a file with times that decrease would be called damaged."""
    scene = make_scene(METAL, 30, rows=3, columns=4, estimator="split", rays=600_000)
    plan = make_plan(scene)
    session = Session(plan, scene.simulation, Held(1, threading.Event(), lambda done, total: None))
    session.run()
    found = assembly.cost(plan, session.runs)
    assert found.checkpoints > 1
    assert (np.diff(found.seconds, axis=1) >= 0.0).all()
