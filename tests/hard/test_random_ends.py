"""Random numbers at the ends of their range, exactly 0 and 1 - 2^-52, wherever the walks draw one.

They come once in 2^52 draws, and a long run meets some. The hash is a bijection: keys are made here of which some
draw is known beforehand, and go through the kernels as any other.
"""

import threading

import numpy as np
import pytest

from goniosim._jit import kernel
from goniosim.engine import simulate
from goniosim.engine.estimators import ESTIMATORS
from goniosim.engine.layout import DOWN, UP
from goniosim.engine.operators.facets import choose_width
from goniosim.engine.plan import make_plan
from goniosim.engine.splitting.numbers import far_facet
from goniosim.engine.stages.smooth_dielectric import COIN
from goniosim.engine.unit import BUDGET, UNITS, Tally, Workspace
from goniosim.optics.elementary import sincos_turns
from goniosim.optics.fresnel import reflects
from goniosim.optics.ggx import sample_visible_facet, sample_visible_normal
from goniosim.optics.lambert import sample_cosine
from goniosim.optics.random import random_sincos
from reference.scenes import conductor, dielectric, lambert, make_scene, medium
from reference.splitmix import LARGEST, SMALLEST, ancestor, key_that_draws
from reference.streams import numbers

ENDS = {"0": SMALLEST, "1 - 2^-52": LARGEST}
RUNNING = threading.Event()

STACKS = {
    "rough": [dielectric(1.5, 0.3), medium(0.5), dielectric(1.0, 0.3)],
    "narrow": [dielectric(1.5, 1e-6), medium(0.5), conductor(1.45, 1.0, 1e-6)],
    "wide": [dielectric(1.5, 1.0), medium(0.5), conductor(0.2, 3.0, 1.0)],
    "smooth": [dielectric(1.5), medium([0.5, 3.0, 3.0]), dielectric(1.2), medium(0.5), lambert(0.5)],
    "matched": [dielectric(1.0, 0.3), dielectric(1.0), dielectric(1.0 + 1e-9, 1e-3), lambert([0.0, 1.0, 1.0])],
    "total reflection": [dielectric(4.0, 0.1), dielectric(1.0, 0.1), dielectric(0.5), dielectric(1.0)],
    "dark": [dielectric(1.5, 0.1), medium([50.0, 700.0, 700.0]), lambert(0.0)],
}


def key_of(bits, counter, *generations):
    """The key of whose descendant, by the numbers of its generations, a draw has these bits."""
    return np.uint64(ancestor(key_that_draws(bits, counter), *generations))


@kernel
def _sample(x, z, alpha, u, out):
    sine, cosine = sincos_turns(u)
    out[0:3] = sample_visible_facet(x, 0.0, z, alpha, cosine, sine, u)
    out[3:6] = sample_visible_normal(x, 0.0, z, alpha, cosine, sine, u)
    out[6:9] = sample_cosine(u, u)
    out[9], out[10] = far_facet(u)
    out[11] = choose_width(alpha, u)
    reflect, _ = reflects(u, z, 1.0, 1.0)
    out[12] = 1.0 if reflect else 0.0
    reflect, _ = reflects(u, min(z, 0.3), 1.0, 0.5)
    out[13] = 1.0 if reflect else 0.0


@kernel
def _azimuth(key):
    return random_sincos(key, 0)


@pytest.mark.parametrize("u", [0.0, 2.0**-52, 0.5, 1.0 - 2.0**-52])
def test_what_is_sampled_there(u):
    """Facets and directions of the upper side, of unit length; no coin falls against a certain outcome."""
    out = np.empty(14)
    for alpha in (1e-9, 1e-6, 1e-3, 0.5, 1.0):
        for z in (1e-9, 1e-3, 0.5, 1.0):
            _sample(np.sqrt(1.0 - z * z), z, alpha, u, out)
            assert np.isfinite(out).all()
            assert out[2] > 0.0 and out[5] > 0.0 and out[8] > 0.0
            assert abs(np.linalg.norm(out[3:6]) - 1.0) < 1e-14 and abs(np.linalg.norm(out[6:9]) - 1.0) < 1e-14
            assert 0.0 <= out[9] < 1.0 and out[10] > 0.0
            assert out[11] in (alpha, np.sqrt(alpha), 0.5)
            # Equal indices; total reflection.
            assert out[12] == 0.0 and out[13] == 1.0
    _sample(0.0, 1.0, 0.0, u, out)
    assert out[11] == 0.0


def test_azimuths_there():
    for bits in (0, 1, 2, 3, *(2**64 - k for k in range(1, 5))):
        sine, cosine = _azimuth(np.uint64(key_that_draws(bits, 0)))
        assert abs(sine * sine + cosine * cosine - 1.0) < 4e-15


def test_keys_lead_to_the_ends():
    for u, bits in ((0.0, SMALLEST), (1.0 - 2.0**-52, LARGEST)):
        for counter in (0, 1, 511):
            assert numbers([key_that_draws(bits, counter)], [counter])[0, 0] == u


@pytest.mark.parametrize("theta", [0.0, 60.0, 89.999])
@pytest.mark.parametrize("name", STACKS)
def test_every_decision_of_the_analog_walk(name, theta):
    """The first ray of each batch: its facet, its coin, its roulette. All energy is accounted for."""
    plan = make_plan(make_scene(STACKS[name], theta, rows=9, columns=12))
    # Roulette for all that a medium has dimmed.
    workspace = Workspace(plan, np.full((1, 2 * len(plan.kinds), plan.n_distinct), 0.5))
    tally, rays = Tally(plan), 60
    cells = workspace.cells(0, plan.rows, plan.columns, tally.histogram)
    for bits in ENDS.values():
        for stage in range(12):
            for decision in range(4):
                tally.clear()
                workspace.begin(rays)
                ledger = tally.ledgers[0]
                while not workspace.advance(0, key_of(bits, 0, stage, decision), BUDGET, ledger, cells):
                    pass
                assert np.isfinite(tally.histogram).all() and (tally.histogram >= 0.0).all()
                assert np.abs(ledger.sum(axis=0) / rays - 1.0).max() < 1e-12, (stage, decision)


# Which draws of a replicate: numbers of generations, and the counters below them.
SHIFTS = ((0,), range(6))
SPLIT = [SHIFTS, *(((1, stage, child), (0,)) for stage in range(1, 16) for child in range(5))]
OPERATOR = [
    SHIFTS,
    *(((1, path, *branches), range(6)) for path in (0, 7) for branches in ((), (6,), (6, 6), (7,), (6, 7))),
    *(((2, dimension), (0, 5)) for dimension in range(8)),
]
CONNECTION = [*(((0, visit), range(4)) for visit in range(6)), *(((1, cell), range(4)) for cell in range(8))]

METAL = [dielectric(1.5, 0.3), medium(0.5), conductor(1.45, 1.0, 0.3)]
REPLICATES = {
    "split": ("split", UP, STACKS["rough"], SPLIT),
    "split, no base": ("split", DOWN, STACKS["rough"], SPLIT),
    "split, a base": ("split", UP, STACKS["smooth"], SPLIT),
    "split, narrow": ("split", UP, STACKS["narrow"], SPLIT),
    "operator": ("operator", UP, METAL, OPERATOR),
    "operator, inside": ("operator", UP, [dielectric(1.5, 0.001), *METAL[1:]], OPERATOR),
    "operator, light": ("operator", DOWN, [METAL[0], medium(0.5), dielectric(1.0, 0.001)], OPERATOR),
    "connection": ("connection", UP, [METAL[0], medium(0.5), lambert(0.5)], CONNECTION),
}


@pytest.mark.parametrize("parametrization", ["classic", "half"])
@pytest.mark.parametrize("name", REPLICATES)
def test_every_decision_of_a_replicate(name, parametrization):
    """Shifts of lattices, points, coins, roulettes, points of cells: each estimate is near that of other keys."""
    kind, side, layers, draws = REPLICATES[name]
    plan = make_plan(make_scene(layers, 40, parametrization, rows=4, columns=8))
    few = {"nodes": 24} if kind == "operator" else {}
    estimator = ESTIMATORS[kind](plan, (side,), **few)
    estimator.prepare()
    workspace = estimator.workspace()
    out = np.empty((1, 1, plan.n_distinct, plan.rows, plan.width))

    def total(key):
        workspace.run(0, 128, np.array([key], np.uint64), out, RUNNING)
        # What is interpolated between nodes may fall a little below 0.
        assert np.isfinite(out).all() and (out >= -1e-3 * out.sum()).all()
        return out.sum(axis=(-2, -1)).ravel()

    usual = np.array([total(key) for key in range(64)])
    low, high = usual.min(axis=0), usual.max(axis=0)
    for bits in ENDS.values():
        for generations, counters in draws:
            for counter in counters:
                found = total(key_of(bits, counter, *generations))
                assert (found > 0.5 * low).all() and (found < 2.0 * high).all(), (generations, counter)


def test_a_seed_that_draws_the_ends():
    """As a user would meet them: through `simulate`, by a seed of which a coin of a ray is known."""
    for bits in ENDS.values():
        seeds = (int(key_of(bits, ray, UNITS, 0, 0, 0, 0, COIN)) for ray in range(512))
        seed = next(seed for seed in seeds if seed < 2**63)
        result = simulate(make_scene(STACKS["rough"], 60, rows=9, columns=12), rays=2000, seed=seed, estimator="analog")
        assert np.abs(result.audit.residual).max() < 1e-12
        assert all(np.isfinite(part.energy).all() for part in result.components.values())
