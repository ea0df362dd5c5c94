"""What is damaged among shards is found and named, whatever happened to it, and traced anew."""

import warnings

import numpy as np
import pytest

from goniosim.cluster import Division, ShardPlan, State, merge, run_shard, standing_of
from goniosim.engine import simulate
from goniosim.errors import AnnotatedFileWarning, DamagedFileError, ForeignFileError, UnusableResultError
from goniosim.store import read_portion
from reference.scenes import dielectric, lambert, make_scene
from sameness import content

LAYERS = [dielectric(1.5, 0.1), lambert(0.5)]
SCENE = make_scene(LAYERS, [10.0, 70.0], rows=6, columns=12, rays=4000, estimator="analog")
SHARDS = 4


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """All shards of a scene, of which a test may spoil one and mend it again."""
    folder = tmp_path_factory.mktemp("shards")
    ShardPlan.make([SCENE], None, SHARDS).write(folder)
    for shard in range(1, SHARDS + 1):
        run_shard(folder, shard, threads=1)
    return folder


@pytest.fixture
def task(folder):
    """The third shard's; its file is mended afterwards."""
    (task,) = Division(ShardPlan.read(folder)).tasks(3)
    content = task.path(folder).read_bytes()
    yield task
    task.path(folder).write_bytes(content)


def named(folder, task):
    """The line on the damaged file, and the list of shards."""
    with pytest.raises(UnusableResultError) as caught:
        next(merge(folder, folder / "merged.h5"))
    assert "run these shards again: --array=3 (" in str(caught.value) and "\n" not in str(caught.value)
    (line,) = caught.value.details
    assert line.startswith(f"{task.path(folder)}: ") and not (folder / "merged.h5").exists()
    return line


def test_a_flipped_bit_at_fifty_places(folder, task):
    """Found and named, or in the slack between what HDF5 keeps: then all is as it was written, and that is told."""
    path, rng, found = task.path(folder), np.random.default_rng(1), []
    sound = path.read_bytes()
    right = read_portion(path)
    for position in rng.integers(0, len(sound), 50):
        spoilt = bytearray(sound)
        spoilt[position] ^= 1 << rng.integers(8)
        path.write_bytes(spoilt)
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            there = standing_of(task, folder, whole=True)
        if there.state is State.DAMAGED:
            assert str(path) in there.why and "run its shard again" in there.why
            found.append(bytes(spoilt))
        else:
            assert [each.category for each in told] == [AnnotatedFileWarning] and there.state is State.DONE
            with pytest.warns(AnnotatedFileWarning):
                assert read_portion(path) == right
    assert len(found) > 25
    path.write_bytes(found[0])
    named(folder, task)


def test_a_truncated_file(folder, task):
    path = task.path(folder)
    sound = path.read_bytes()
    for length in (len(sound) - 1, len(sound) // 2, 5000):
        path.write_bytes(sound[:length])
        assert f"{path}: is cut off: {length} of {len(sound)} bytes" in named(folder, task)
    for length in (0, 1, 100):
        # Nothing to know it by: whose it is, nobody can tell.
        path.write_bytes(sound[:length])
        with pytest.raises(ForeignFileError):
            read_portion(path)


def test_a_hole_of_zeros(folder, task):
    """What a file system may leave after a power cut."""
    path = task.path(folder)
    sound = path.read_bytes()
    path.write_bytes(sound[:3000] + bytes(4096) + sound[7096:])
    with pytest.raises(DamagedFileError):
        read_portion(path)
    named(folder, task)


def test_what_is_damaged_is_traced_anew(folder, task):
    """Also where its attributes are sound: the state lies behind them."""
    path, notes = task.path(folder), []
    sound = path.read_bytes()
    place = sound.index(b"PK\x03\x04") + 2000
    path.write_bytes(sound[:place] + bytes([sound[place] ^ 1]) + sound[place + 1 :])
    assert read_portion(path, whole=False)[0].is_whole
    named(folder, task)
    run_shard(folder, 3, threads=1, note=notes.append)
    assert (
        notes[0].startswith(f"to be replaced: {path}: ") and standing_of(task, folder, whole=True).state is State.DONE
    )
    ((result, _),) = merge(folder, folder / "merged.h5")
    (folder / "merged.h5").unlink()
    assert content(result) == content(simulate(SCENE))


def test_what_is_damaged_is_left_out_if_that_is_allowed(folder, task):
    """Whatever the error says, and the folder is called; directions of which nothing is there have no energy."""
    path, notes = task.path(folder), []
    path.write_bytes(path.read_bytes()[:-1])
    ((result, _),) = merge(folder, folder / "merged.h5", allow_missing=True, note=notes.append)
    (folder / "merged.h5").unlink()
    (note,) = notes
    assert note.startswith(f"left out: {path}: is cut off")
    assert result.status == "partial" and result.rays.tolist() == [4000, 2000]


@pytest.mark.parametrize("estimator", ["analog", "connection"])
def test_a_direction_of_which_nothing_is_there(tmp_path, estimator):
    scene = make_scene(LAYERS, [10.0, 70.0], rows=6, columns=12, rays=131_072, estimator=estimator)
    ShardPlan.make([scene], None, 2).write(tmp_path)
    run_shard(tmp_path, 2, threads=1)
    ((result, _),) = merge(tmp_path, tmp_path / "merged.h5", allow_missing=True)
    whole = simulate(scene)
    internal, right = (each.components["reflection/internal"] for each in (result, whole))
    assert result.rays.tolist() == [0, 131_072] and result.status == "partial"
    assert not internal.energy[0].any() and internal.uncertain[0].all()
    assert np.array_equal(internal.energy[1], right.energy[1]) and np.array_equal(internal.stderr[1], right.stderr[1])


@pytest.mark.slow
def test_error_bars_of_what_is_there_depend_on_no_order(tmp_path):
    """Those of the shards that are there, traced in one order or another."""
    found = []
    for order in ((1, 3), (3, 1)):
        folder = tmp_path / str(order[0])
        ShardPlan.make([SCENE], None, 4).write(folder)
        for shard in order:
            run_shard(folder, shard, threads=1 + shard % 2)
        ((result, _),) = merge(folder, folder / "merged.h5", allow_missing=True)
        assert result.provenance["merged"] == "4 shards, of which 2,4 are missing or not finished"
        found.append(content(result))
    assert found[0] == found[1]
