"""What an interrupted run left, changed by a stranger: a refusal in one line, and kernels never see it."""

import threading

import numpy as np
import pytest

from crafting import arrays, changed
from goniosim.engine import checked_state, prior_of, simulate
from goniosim.engine.drive import Drive
from goniosim.engine.packing import pack, unpack
from goniosim.engine.plan import make_plan
from goniosim.engine.session import Session
from goniosim.errors import UnusableResultError
from reference.scenes import dielectric, lambert, make_scene

LAYERS = [dielectric(1.5, 0.1), lambert(0.5)]
SCENES = {
    "analog": make_scene(LAYERS, [10.0, 70.0], rows=6, columns=12, rays=4000, estimator="analog"),
    "connection": make_scene(LAYERS, [10.0, 70.0], rows=6, columns=12, rays=131_072),
    "extended": make_scene(LAYERS, [10.0, 70.0], rows=6, columns=12, rays=6000, estimator="analog"),
}


def run(scene, checkpoint=None, resumed=None, prior=None):
    drive = Drive(1, threading.Event(), lambda done, total: None)
    session = Session(make_plan(scene), scene.simulation, drive, checkpoint, resumed, prior)
    session.run()


@pytest.fixture(scope="module", params=SCENES)
def left(request):
    """A scene and a state of it, in mid-run."""
    found, scene = [], SCENES[request.param]
    prior = prior_of(scene, simulate(SCENES["analog"])) if request.param == "extended" else None
    run(scene, lambda session: found.append(pack(session.state())), prior=prior)
    return scene, unpack(found[2])


def test_arrays_of_other_shapes_and_types_are_refused(left):
    """Kernels would read behind their ends."""
    scene, tree = left
    tried = 0
    for path, array in arrays(tree):
        if not array.size:
            continue
        for wrong in (array.reshape(-1)[:-1], array[..., None], array.astype(np.float32), array.tolist(), None, "x"):
            with pytest.raises(UnusableResultError, match="does not fit the scene"):
                run(scene, resumed=changed(tree, path, wrong))
            tried += 1
    assert tried >= 24


@pytest.mark.parametrize("name", ["journal", "seconds", "done", "calls", "took", "added", "within", "spent", "runs"])
def test_what_is_missing_or_nonsense_is_refused(left, name):
    scene, tree = left
    less = {key: value for key, value in tree.items() if key != name}
    if name in ("journal", "took"):
        # Nothing was decided, and no call was finished.
        less[name] = None
    for wrong in (less, {**tree, name: None}):
        if name == "took":
            wrong = {**wrong, "calls": 1}
        with pytest.raises(UnusableResultError, match="does not fit the scene"):
            run(scene, resumed=wrong)


@pytest.mark.parametrize("left", ["extended"], indirect=True)
def test_what_was_there_before_has_no_negative_light_paths(left):
    scene, tree = left
    for path, array in arrays(tree["prior"]):
        if path[-1] in ("paths", "rays") and array.dtype == np.int64:
            with pytest.raises(UnusableResultError, match="a number of light paths is negative"):
                run(scene, resumed=changed(tree, ("prior", *path), -array))


def test_an_end_behind_the_end_is_refused(left):
    scene, tree = left
    with pytest.raises(UnusableResultError, match="behind its end"):
        run(scene, resumed={**tree, "calls": 1000, "took": [0.0] * 1000})


def test_what_is_no_state_of_this_version_is_refused(left):
    _, tree = left
    assert checked_state(pack(tree))["calls"] == tree["calls"]
    for content in (b"", b"my thesis", pack([1]), pack({**tree, "version": [0, "0.0"]}), pack(tree)[:-200]):
        with pytest.raises(UnusableResultError):
            checked_state(content)
