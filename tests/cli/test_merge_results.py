"""`goniosim merge A.h5 B.h5 -o OUT`: results of different seeds, and what is refused."""

import pytest

from goniosim.store import open_result


@pytest.fixture
def seeds(goniosim, folder):
    """Results of the seeds 1 and 2."""
    for seed in ("1", "2"):
        asked = ("--estimator", "analog", "--rays", "2e3", "--seed", seed, "-o", f"{seed}.h5")
        assert goniosim("simulate", "scene.yaml", "-q", *asked)[0] == 0
    return folder


def test_two_seeds_make_a_better_result(goniosim, seeds):
    code, out, err = goniosim("merge", "2.h5", "1.h5", "-o", "both.h5")
    assert (code, err) == (0, "") and "both.h5" in out
    found = open_result("both.h5")
    assert found.rays.tolist() == [4000] and found.provenance["merged_seeds"] == "1, 2" and found.seed == 1
    # It is a result of the scene as any other, with the smaller seed.
    asked = ("simulate", "scene.yaml", "--estimator", "analog", "-o", "both.h5", "--rays")
    assert "stays as it is" in goniosim(*asked, "4e3")[2]
    assert "goes on from 4000 rays per direction" in goniosim(*asked, "5e3")[2]
    assert open_result("both.h5").rays.tolist() == [5000]


def test_what_is_not_to_be_merged_is_refused(goniosim, seeds):
    goniosim("merge", "1.h5", "2.h5", "-o", "both.h5")
    code, _, err = goniosim("merge", "both.h5", "2.h5", "-o", "more.h5")
    assert code == 8 and "2.h5: has seed 2 in common with both.h5, so that they are not independent" in err
    options = ("--estimator", "analog", "--rays", "2e3", "--seed", "3", "--set", "slice.rows=5")
    assert goniosim("simulate", "scene.yaml", "-q", *options, "-o", "other.h5")[0] == 0
    code, _, err = goniosim("merge", "1.h5", "other.h5", "2.h5", "-o", "more.h5")
    assert code == 8 and "other.h5: its scene is not that of 1.h5: slice.rows: 5 in the file, 6 asked for" in err
    assert "different --seed each" in err.splitlines()[-1] and not (seeds / "more.h5").exists()
    code, _, err = goniosim("merge", "1.h5", "-o", "more.h5")
    assert code == 2 and "1.h5 is a single file" in err
    code, _, err = goniosim("merge", "1.h5", "2.h5", "--allow-missing", "-o", "more.h5")
    assert code == 2 and "go with a folder of shards" in err


def test_a_stream_is_refused(goniosim, folder):
    before = sorted(folder.iterdir())
    code, out, err = goniosim("merge", "a.h5", "b.h5", "-o", "-")
    assert code == 2 and "a result is a file, not a stream" in err
    assert sorted(folder.iterdir()) == before
