"""The same seed yields the same bits, however the work is shared out."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from goniosim.engine import simulate
from reference.scenes import conductor, dielectric, lambert, make_scene, medium

ROUGH = [dielectric(1.5, 0.2), medium([0.05, 0.1, 0.4]), dielectric(1.3, 0.1), dielectric(1.0, 0.2)]


def plain(values):
    return np.asarray(values).tolist()


def all_arrays(result):
    for name, component in result.components.items():
        for part in ("energy", "stderr", "bsdf", "bsdf_stderr", "hits"):
            yield f"{name}/{part}", getattr(component, part)
        for order, inner in component.orders.items():
            yield f"{name}/{order}", inner.energy
    for entry, value in result.audit.energy.items():
        yield entry, value
        yield f"{entry}_stderr", result.audit.stderr[entry]


def assert_same_bits(one, other):
    one, other = dict(all_arrays(one)), dict(all_arrays(other))
    assert one.keys() == other.keys()
    for name, value in one.items():
        np.testing.assert_array_equal(value, other[name], err_msg=name)


@pytest.mark.parametrize("thetas, rays", [([30], 2_500_000), ([0, 30, 60], 900_000), ([45, 80], 1_100_000)])
def test_threads(thetas, rays):
    """One direction of several work units, and several directions, on 1, 2 and 3 threads."""
    scene = make_scene(ROUGH, thetas, rows=45, columns=90, orders=2)
    one, two, three = (simulate(scene, rays=rays, seed=8, threads=n, estimator="analog") for n in (1, 2, 3))
    assert_same_bits(one, two)
    assert_same_bits(one, three)


@pytest.mark.parametrize("tau", [0.1, pytest.param([0.05, 0.1, 0.4], marks=pytest.mark.slow)])
def test_threads_of_replicates(tau):
    """Two rounds of an operator and of a split walk, on 1 and 3 threads."""
    layers = [dielectric(1.5, 0.2), medium(tau), dielectric(1.0, 0.001)]
    scene = make_scene(layers, [45], rows=9, columns=36)
    one, three = (simulate(scene, rays=800_000, seed=8, threads=threads) for threads in (1, 3))
    assert one.components["reflection/internal"].estimator == ["operator"]
    assert len(one.cost.rays[0]) > 1
    assert_same_bits(one, three)


def test_seeds_differ():
    scene = make_scene(ROUGH, 30, rows=45, columns=90)
    one, other = (simulate(scene, rays=100_000, seed=seed).components["transmission"] for seed in (1, 2))
    assert (one.energy != other.energy).any()


def test_directions_differ():
    """Two directions of one run do not share their random numbers.

    At 30 and 30.001 degrees, seen in 24 cells, shared numbers would give equal tallies.
    """
    scene = make_scene([dielectric(1.5, 0.2), lambert(0.9)], [30, 30.001], rows=4, columns=6)
    hits = simulate(scene, rays=100_000, seed=1).components["reflection/internal"].hits
    assert (hits[0] != hits[1]).mean() > 0.8


@pytest.mark.parametrize(
    "layers",
    [
        lambda tau, share: [dielectric(1.5), medium(tau), dielectric(1.0)],
        lambda tau, share: [dielectric(1.5), medium(tau), conductor(1.2, plain(10.0 * share))],
        lambda tau, share: [dielectric(1.5), lambert(plain(share))],
    ],
    ids=["slab", "metal", "plastic"],
)
def test_grey_scene_equals_each_channel_of_a_chromatic_one(layers):
    """Channels ride along on the same paths: bit for bit, as long as no roulette is played.

    Roulette looks at all channels; these layers keep every weight far above what is usual.
    """
    tau, share = np.array([0.01, 0.02, 0.05]), np.array([0.9, 0.95, 0.98])
    chromatic = simulate(make_scene(layers(tau.tolist(), share), 50), rays=300_000, seed=6, estimator="analog")
    assert not chromatic.audit.energy["lost_roulette"].any()
    for channel in range(3):
        grey = simulate(
            make_scene(layers(float(tau[channel]), share[channel]), 50), rays=300_000, seed=6, estimator="analog"
        )
        for name, component in chromatic.components.items():
            for part in ("energy", "stderr", "bsdf", "bsdf_stderr"):
                expected = getattr(component, part)[:, channel]
                for equal in range(3):
                    np.testing.assert_array_equal(getattr(grey.components[name], part)[:, equal], expected)
            if component.hits is not None:
                np.testing.assert_array_equal(grey.components[name].hits, component.hits)


DIGEST = """
import hashlib
from goniosim.engine import simulate
from reference.scenes import conductor, dielectric, make_scene, medium

layers = [dielectric(1.5, 0.2), medium([0.05, 0.1, 0.8]), conductor(1.45, [1.0, 0.01, 0.01], 0.2)]
result = simulate(make_scene(layers, [30, 80], rows=30, columns=60), rays=200_000, seed=1)
digest = hashlib.sha256()
for component in result.components.values():
    digest.update(component.energy.tobytes() + component.stderr.tobytes())
for entry in result.audit.energy.values():
    digest.update(entry.tobytes())
print(digest.hexdigest())
"""


@pytest.mark.slow
def test_first_run_equals_later_runs(tmp_path):
    """A run that compiles its kernels yields the same bits as one that finds them in the cache.

    A kernel fresh from the compiler is linked with other copies of the functions it calls than
    one from the cache. Where the order of a sum is the compiler's to choose, copies may differ.
    """
    tests = Path(__file__).resolve().parent.parent
    path = os.pathsep.join([str(tests), str(tests.parent)])
    environment = {**os.environ, "XDG_CACHE_HOME": str(tmp_path), "PYTHONPATH": path}
    environment.pop("NUMBA_CACHE_DIR", None)
    command = [sys.executable, "-c", DIGEST]
    first, second = (
        subprocess.run(command, env=environment, check=True, capture_output=True, text=True).stdout for _ in range(2)
    )
    assert len(first.strip()) == 64
    assert first == second
