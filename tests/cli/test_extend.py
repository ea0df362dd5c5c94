"""More rays, or a tighter target, asked of a file that is there: the command goes on from it."""

import pytest

from goniosim import simulate_study
from goniosim.engine import prior_of, simulate
from goniosim.report.text import counts
from goniosim.scene import parse_scene
from goniosim.store import open_result, read_state
from impatient import IMPATIENT, wait_for
from sameness import content
from small import SCENE

ANALOG = ("simulate", "scene.yaml", "--estimator", "analog")


def test_more_rays_are_added_to_those_that_are_there(goniosim, folder):
    assert goniosim(*ANALOG, "-q", "--rays", "2e3")[0] == 0
    first = open_result(folder / "small.h5")
    code, out, err = goniosim(*ANALOG, "--rays", "5e3")
    assert code == 0 and err.splitlines()[0].endswith("small.h5: goes on from 2000 rays per direction")
    found = open_result(folder / "small.h5")
    assert found.rays.tolist() == [5000] and found.provenance["extended_from"].startswith("2000 rays per direction")
    scene = parse_scene(SCENE.replace("rays: 1e4", "rays: 5e3, estimator: analog"))
    assert content(simulate(scene, prior=prior_of(scene, first))) == content(found)
    code, _, err = goniosim(*ANALOG, "--rays", "6e3", "--overwrite")
    assert code == 0 and "goes on" not in err
    assert "extended_from" not in open_result(folder / "small.h5").provenance


def test_studies_go_on(folder):
    for rays in (1000, 3000):
        paths = simulate_study([parse_scene(SCENE)], folder="out", rays=rays)
    found = open_result(paths["small"])
    assert found.rays.tolist() == [3000] and found.provenance["extended_from"].startswith("1000 rays")


@pytest.mark.slow
def test_stopped_in_the_middle_it_goes_on_to_the_same_numbers(python, goniosim, folder):
    """The file that was there is replaced by more only, and what is left knows what it began with."""
    assert goniosim(*ANALOG, "-q", "--rays", "2e6")[0] == 0
    first = open_result(folder / "small.h5")
    asked = (*ANALOG, "--rays", "1e8")
    scene = parse_scene(SCENE.replace("rays: 1e4", "rays: 1e8, estimator: analog"))
    whole = simulate(scene, prior=prior_of(scene, first))
    process = python(IMPATIENT, *asked)
    wait_for(process, "small.h5: goes on from 2e6 rays per direction")
    wait_for(process, "% of 1e8 rays")
    process.terminate()
    process.communicate()
    assert process.returncode == 75
    left = open_result(folder / "small.h5")
    assert left.status == "partial" and left.rays[0] > 2e6 and read_state(folder / "small.h5") is not None
    code, _, err = goniosim(*asked, "--threads", "1")
    assert code == 0 and f"small.h5: goes on from {counts(left.rays)} rays per direction" in err
    assert content(open_result(folder / "small.h5")) == content(whole)
