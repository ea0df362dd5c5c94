"""The parts of an operator: stencils, cosine series, kernels, facets, each against what is known of it."""

import math

import numpy as np
import pytest

from goniosim._jit import kernel
from goniosim.engine.estimators.operator import Operator
from goniosim.engine.layout import DOWN, UP
from goniosim.engine.operators import cells, kernels, nodes, rays, stencils
from goniosim.engine.operators.arrivals import bin_arrivals
from goniosim.engine.operators.azimuths import at_azimuths, cosines, end_weights, to_coefficients, to_values
from goniosim.engine.operators.bins import deposit, move_bins
from goniosim.engine.operators.facets import MOST, SHARE, choose_width, draw, meet_facet, meet_facets
from goniosim.engine.plan import make_plan
from goniosim.engine.sorting import LANES
from goniosim.engine.unit import BATCH, child_key
from goniosim.optics.microfacet import microfacet_transmission
from goniosim.optics.random import derive_key, random_sincos, uniform
from reference.cell_integrals import integrate_cells
from reference.closed_forms import reflection_density, transmission_density
from reference.scenes import conductor, dielectric, lambert, make_scene, medium

NODES = 90


@kernel
def _spread(directions, ratios, weights, bins):
    n = directions.shape[1]
    x, y, z = directions
    polar, around, first = np.empty((4, n)), np.empty((4, n)), np.empty((2, n), np.int64)
    nodes.stencils(x, y, z, ratios, n, bins.shape[1] // 2, bins.shape[1] - 1, polar, around, first)
    deposit(weights, np.zeros(n), n, polar, around, first, bins)


@kernel
def _look_at(x, y, z, values, weights, places, found):
    stencils.find_stencils(x, y, z, 1, values, weights, places)
    stencils.interpolate(values, weights, places, 1, found)


def _look(x, y, z, stride, values, found):
    some = values[::stride, ::stride]
    table = np.full((*some.shape[:2], stencils.padded(len(found))), np.nan)
    table[..., : len(found)] = some
    lanes = np.empty((table.shape[2] // stencils.LANES, 1, stencils.LANES))
    direction = (np.array([w]) for w in (x, y, z))
    _look_at(*direction, table, np.empty((stencils.WEIGHTS, 1)), np.empty((4, 1), np.int64), lanes)
    found[:] = lanes.reshape(-1)[: len(found)]


def _directions():
    """Some anywhere, at the pole, in the horizon, and at the azimuths 0 and 180."""
    rng = np.random.default_rng(1)
    theta = np.concatenate([rng.uniform(0.0, math.pi / 2, 20), [0.0, 1e-3, math.pi / 2, 1.57, 0.7, 0.7]])
    phi = np.concatenate([rng.uniform(-math.pi, math.pi, 24), [0.0, math.pi]])
    return theta, phi, np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)


def _functions():
    """Two at all nodes, shape (2 NODES + 1, NODES + 1, 2)."""
    polar = np.linspace(0.0, math.pi / 2, NODES + 1)
    around = np.linspace(0.0, math.pi, 2 * NODES + 1)
    values = np.empty((2 * NODES + 1, NODES + 1, 2))
    values[..., 0] = 1.0 + polar - 2.0 * polar**2 + 0.7 * polar**3
    values[..., 1] = (1.0 + polar**2) * np.cos(2.0 * around)[:, None]
    return values


@pytest.mark.parametrize("stride", [1, 2])
def test_stencils_reproduce_cubics(stride):
    """A cubic of the polar angle exactly, harmonics of the azimuth to the fourth order."""
    values = _functions()
    for theta, phi, v in zip(*_directions(), strict=True):
        found = np.empty(2)
        _look(*v, stride, values, found)
        assert found[0] == pytest.approx(1.0 + theta - 2.0 * theta**2 + 0.7 * theta**3, abs=1e-12)
        h = stride * math.pi / 180.0
        # At the pole there is no azimuth.
        harmonic = (1.0 + theta**2) * math.cos(2.0 * phi)
        assert theta == 0.0 or found[1] == pytest.approx(harmonic, abs=2.0 * (2.0 * h) ** 4)


@pytest.mark.parametrize("channels", [1, 2, 3, 5])
def test_deposits_spread_what_stencils_look_at(channels):
    """Whatever the number of channels, for each of which there is code; and nothing else."""
    values = _functions()
    directions = _directions()[2]
    weights = np.random.default_rng(4).random((channels, len(directions)))
    expected = np.zeros((channels, 2))
    sums = np.zeros(channels)
    for number, v in enumerate(directions):
        found = np.empty(2)
        _look(*v, 1, values, found)
        expected += 3.0 * weights[:, number, None] * found
        sums += 3.0 * weights[:, number]
    bins = np.zeros((1, 2 * NODES + 1, (NODES + 1) * channels))
    ratios = np.full(len(directions), 3.0)
    _spread(np.ascontiguousarray(directions.T), ratios, weights, bins)
    bins = bins.reshape(2 * NODES + 1, NODES + 1, channels)
    assert bins.sum(axis=(0, 1)) == pytest.approx(sums, rel=1e-12)
    assert np.einsum("jic,jif->cf", bins, values) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize(("groups", "channels"), [(1, 1), (1, 2), (1, 3), (1, 5), (3, 1)])
def test_bins_move_to_where_products_expect_them(groups, channels):
    made = np.random.default_rng(5).random((4, 7, 40, groups, channels))
    arrivals = np.empty((groups, 7, 40, 4, channels))
    move_bins(made, 0.5, arrivals)
    assert np.array_equal(arrivals, 0.5 * made.transpose(3, 1, 2, 0, 4))


def test_series_convolve():
    """An even function and folded arrivals against the sum over all pairs."""
    n = 24
    rng = np.random.default_rng(2)
    even, folded = rng.random(n + 1), rng.random((n + 1, 3))
    matrix = cosines(n)
    a, b, found = np.empty((n + 1, 1)), np.empty((n + 1, 3)), np.empty((n + 1, 3))
    to_coefficients(matrix * end_weights(n), even[:, None].copy(), a)
    to_coefficients(matrix, folded.copy(), b)
    to_values(at_azimuths(n, np.arange(n + 1)), a * b, found)
    full = np.concatenate([even, even[-2:0:-1]])
    for i in range(n + 1):
        # An arrival at azimuth j stands for one half each at j and -j.
        pairs = [0.5 * (full[(i - j) % (2 * n)] + full[(i + j) % (2 * n)]) for j in range(n + 1)]
        assert found[i] == pytest.approx(np.array(pairs) @ folded, rel=1e-12)


# Event, index or indices, exact density; angle of the light, and error of the slice relative to its norm.
TO_DENSE = (kernels.TRANSMISSION, 1.0 / 1.5, 0.0, lambda: transmission_density(0.3, 1.5))
TO_THIN = (kernels.TRANSMISSION, 1.5, 0.0, lambda: transmission_density(0.3, 1.0 / 1.5))
METALLIC = (kernels.CONDUCTOR, 1.45, 1.0, lambda: reflection_density(0.3, 1.45 + 1.0j))
INSIDE = (kernels.INTERNAL, 1.5, 0.0, lambda: reflection_density(0.3, 1.0 / 1.5))
CLOSED_FORMS = [
    (TO_DENSE, 0, 5e-5),
    (TO_DENSE, 40, 1e-3),
    (TO_THIN, 0, 1e-5),
    (TO_THIN, 40, 1e-6),
    (TO_THIN, 80, 0.03),
    (METALLIC, 40, 1e-7),
    (INSIDE, 0, 0.01),
    (INSIDE, 80, 1e-4),
]


@pytest.mark.parametrize(("kind", "number", "tolerance"), CLOSED_FORMS)
def test_kernels_and_cells_have_the_closed_form(kind, number, tolerance):
    """Energies of light at a node, in cells two degrees wide, against adaptive integration.

    Simpson's rule over half a degree is nearly exact for so wide a lobe, but for corners: at the critical angle, which
    a reflected lobe crosses, and beyond which only tilted facets let light pass.
    """
    event, eta, kappa, density = kind
    fine = 180
    plan = make_plan(make_scene([lambert(1.0)], 30.0, rows=45, columns=60))
    # A single column of the kernel: the table of all nodes is not needed.
    rows = cells.CellRows(plan, fine)
    table = np.empty((2 * fine + 1, fine + 1, fine + 1))
    kernels.tabulate(event, 0.3, eta, kappa, fine, 0, table)
    column = rows.combine(0, table[:, :, 2 * number : 2 * number + 1])[:, :, 0]
    found = np.empty((2 * fine + 1, 45))
    to_coefficients(cosines(2 * fine) * end_weights(2 * fine), column, found)
    energy = np.empty((30, 45))
    to_values(cells.column_matrix(plan, fine, at_azimuths), found, energy)
    exact = integrate_cells(density(), float(number), 45, 60, absolute=1e-9)
    assert cells.fits(plan, fine)
    error = np.linalg.norm(energy.T - exact[:, :30]) / np.linalg.norm(exact[:, :30])
    assert error < tolerance


def test_transmission_is_reciprocal():
    """Seen from the other side it is the same but for the square of the index: f(b, v) n^2 = f(v, b)."""
    rng = np.random.default_rng(3)
    compared = 0
    for _ in range(200):
        eta, alpha = rng.uniform(0.5, 2.0), rng.uniform(0.1, 1.0)
        b, v = rng.normal(size=(2, 3)) * [1.0, 1.0, 2.0]
        b, v = (np.append(w[:2], abs(w[2])) / np.linalg.norm(w) for w in (b, v))
        there, cosine = microfacet_transmission.py_func(*b, *v, alpha, eta)
        back, _ = microfacet_transmission.py_func(*v, *b, alpha, 1.0 / eta)
        assert back == pytest.approx(there * eta * eta, rel=1e-10)
        compared += there > 0.0 and cosine > 0.0
    assert compared > 50


@kernel
def _draw(x, z, alpha, key, out):
    for i in range(out.shape[0]):
        sine, cosine = random_sincos(key, 3 * i)
        u = uniform(key, 3 * i + 1)
        width = choose_width(alpha, uniform(key, 3 * i + 2))
        _, _, out[i, 0], _ = meet_facet(x, 0.0, z, alpha, alpha, cosine, sine, u)
        _, _, out[i, 1], out[i, 2] = meet_facet(x, 0.0, z, alpha, width, cosine, sine, u)


@pytest.mark.false_alarm(1.4e-5, seeds=(5, 105))
@pytest.mark.parametrize("alpha", [0.001, 0.2, 1.0])
@pytest.mark.parametrize("deg", [0.0, 60.0, 89.0])
def test_facets_of_the_mixture_have_the_plain_distribution(alpha, deg, seed):
    """Their weights have mean 1, and mean heights agree: two differences at 4.5 sigma, false alarm 1.4e-5."""
    out = np.empty((40_000, 3))
    _draw(math.sin(math.radians(deg)), math.cos(math.radians(deg)), alpha, child_key(seed, 0), out)
    plain, mixed, ratio = out.T
    assert ratio.max() <= 1.0 / 0.9 + 1e-9
    assert abs(ratio.mean() - 1.0) < 4.5 * ratio.std() / math.sqrt(len(ratio)) + 1e-12
    tilt, other = np.arccos(np.minimum(plain, 1.0)), np.arccos(np.minimum(mixed, 1.0)) * ratio
    assert abs(tilt.mean() - other.mean()) < 4.5 * math.sqrt((tilt.var() + other.var()) / len(ratio))


@kernel
def _meet_many(batch, n, alpha, events, scratch):
    keys = batch[rays.KEY].view(np.uint64)
    for i in range(n):
        keys[i] = derive_key(keys[i], 0)
    for _ in range(events):
        draw(batch, n, alpha, scratch)
        meet_facets(batch, n, alpha, scratch)
        for i in range(n):
            keys[i] = derive_key(keys[i], 1)


@pytest.mark.false_alarm(7e-6, seeds=(0, 100))
@pytest.mark.parametrize("alpha", [0.001, 0.05, 0.5])
def test_weights_of_long_paths_are_bounded(alpha, seed):
    """After 300 facets, as where light is caught, the ratios still have mean 1: within 4.5 sigma, false alarm 7e-6."""
    n = 4000
    batch, scratch = np.zeros((rays.WEIGHT + 1, n)), np.empty((rays.N_SCRATCH, n))
    batch[rays.X], batch[rays.Z], batch[rays.RATIO] = 0.6, 0.8, 1.0
    batch[rays.KEY].view(np.uint64)[:] = [child_key(seed, i) for i in range(n)]
    _meet_many(batch, n, alpha, 300, scratch)
    ratio = batch[rays.RATIO]
    assert ratio.max() < MOST / (1.0 - 2.0 * SHARE)
    assert abs(ratio.mean() - 1.0) < 4.5 * ratio.std() / math.sqrt(n)


FOUR = [dielectric(1.5, 0.3), dielectric(2.0, 0.2), dielectric(1.3, 0.2), conductor(0.2, 3.0, 0.2)]


def _bin(layers, size, keys, crowd=rays.CROWD * BATCH, budget=1 << 20):
    """Arrivals at the top of each replicate."""
    plan = make_plan(make_scene(layers, 40.0))
    stack = (plan.kinds, plan.alphas, plan.etas, plan.spectral, plan.taus, plan.absorbs)
    bins = np.empty((len(keys), 2 * NODES + 1, (NODES + 1) * plan.n_distinct))
    space = rays.workspace(plan)
    target = np.array([0, 1, 0])
    highest = 0
    while not bin_arrivals(stack, plan.light[0], target, size, np.array(keys), crowd, budget, space, bins):
        highest = max(highest, space[1].max())
    assert highest <= space[2].shape[2] - LANES
    return bins


@pytest.mark.false_alarm(7e-6, seeds=(0, 100))
def test_a_crowd_of_waiting_rays_costs_noise_only(seed):
    """Where a coin chooses every branch: the same mean within 4.5 sigma of both, false alarm 7e-6."""
    totals = np.empty((2, 640))
    for i, crowd in enumerate((-1, rays.CROWD * BATCH)):
        keys = [child_key(seed + i, r) for r in range(640)]
        totals[i] = _bin(FOUR, 200, keys, crowd).sum(axis=(1, 2))
    mean, error = totals.mean(axis=1), totals.std(axis=1, ddof=1) / math.sqrt(640)
    assert abs(mean[0] - mean[1]) < 4.5 * math.hypot(*error)
    assert mean[1] > 10.0
    # Both branches tell more than one: by 0.83 +- 0.024 over many seeds.
    assert error[1] < error[0]


def test_paths_depend_neither_on_batches_nor_on_calls():
    """One call or many: the same bits; alone or beside other replicates: the same rays, summed in another order."""
    layers = [FOUR[0], FOUR[1], FOUR[3]]
    keys = [child_key(9, r) for r in range(3)]
    together = _bin(layers, 700, keys)
    assert np.array_equal(_bin(layers, 700, keys, budget=1), together)
    for key, expected in zip(keys, together, strict=True):
        assert _bin(layers, 700, [key])[0] == pytest.approx(expected, rel=1e-9, abs=1e-12)


TAU = medium(0.1)
NARROW, WIDE = dielectric(1.5, 0.001), dielectric(1.5, 0.2)
METAL = [conductor(0.2, 3.0, a) for a in (0.001, 0.2)]
AIR = [dielectric(1.0, a) for a in (0.001, 0.2)]
CHOICES = [
    ([WIDE, METAL[0]], UP, (0, "out")),
    ([WIDE, METAL[1]], UP, (0, "out")),
    ([dielectric(1.5, 0.05), METAL[1]], UP, (1, "through")),
    ([NARROW, METAL[1]], UP, (1, "in")),
    ([WIDE, lambert(0.5)], UP, (0, "out")),
    ([NARROW, AIR[1]], DOWN, (1, "out")),
    ([NARROW, AIR[1]], UP, (1, "in")),
    ([WIDE, AIR[0]], DOWN, (0, "in")),
    ([WIDE, AIR[0]], UP, (0, "out")),
    ([WIDE, dielectric(1.8), TAU, AIR[1]], DOWN, (2, "out")),
    ([NARROW, METAL[0]], UP, "narrower"),
    ([NARROW, lambert(0.5)], UP, "narrower"),
    ([NARROW, AIR[0]], DOWN, "and the other interface is narrow as well"),
    ([dielectric(1.1, 0.5), METAL[0]], UP, "within 15%"),
    ([WIDE, dielectric(1.4, 0.3), AIR[0]], DOWN, "the last interface"),
    ([WIDE, METAL[0]], DOWN, "no light"),
    ([WIDE], UP, "no light"),
]


@pytest.mark.parametrize(("layers", "side", "expected"), CHOICES)
def test_the_variant_follows_from_widths(layers, side, expected):
    plan = make_plan(make_scene(layers, 30.0))
    if isinstance(expected, str):
        assert expected in Operator.refusal(plan, (side,))
    else:
        variant = Operator(plan, (side,)).variant
        assert Operator.refusal(plan, (side,)) is None
        assert (variant.interface, variant.leaves) == expected


@pytest.mark.parametrize(("alpha", "base", "polar"), [(0.05, 0.001, 360), (0.05, 0.2, 180), (0.11, 0.001, 180)])
def test_arrivals_at_a_narrow_exit_have_finer_nodes(alpha, base, polar):
    """But not those at a wide base, from which what arrives at the exit is interpolated nowhere."""
    made = Operator(make_plan(make_scene([dielectric(1.5, alpha), conductor(1.9, 1.0, base)], 30.0)), (UP,))
    assert (made.nodes, made.application.polar) == (180, polar)
    shared, own = made.memory
    coarse, less = Operator(made.plan, (UP,), polar=180).memory
    assert (shared > 1.8 * coarse, own > 1.8 * less) == (polar == 360, polar == 360)


@pytest.mark.parametrize(
    ("layers", "rows", "columns", "size", "parts"),
    [
        ([WIDE, METAL[0]], 90, 360, 1 << 14, (1, 1)),
        ([WIDE, METAL[0]], 90, 360, 1 << 16, (1, 2)),
        ([WIDE, METAL[0]], 90, 360, 1 << 17, (2, 2)),
        ([NARROW, METAL[1]], 90, 360, 1 << 17, (1, 1)),
        ([WIDE, METAL[0]], 12, 24, 1 << 13, (5, 5)),
        ([WIDE, METAL[0]], 1, 1, 1 << 13, (64, 64)),
        ([WIDE, METAL[0]], 90, 360, 1 << 30, (182, 182)),
    ],
)
def test_looks_are_no_more_than_light_paths_once_each_cell_has_its_own(layers, rows, columns, size, parts):
    """So that they take no more than a share of the time; replicates of usual slices begin with one look a point."""
    made = Operator(make_plan(make_scene(layers, 30.0, "half", rows, columns)), (UP,))
    assert made.parts(size) == parts
    assert parts == (1, 1) or 0.5 * size < math.prod(parts) * made.looks <= size


def test_one_operator_serves_one_way_out():
    plan = make_plan(make_scene([WIDE, AIR[1]], 30.0))
    assert "one way" in Operator.refusal(plan, (UP, DOWN))


@pytest.mark.parametrize(("layers", "side", "variant"), [CHOICES[0], CHOICES[3]], ids=["cells", "nodes"])
def test_the_smallest_operator_runs_the_same_kernels(layers, side, variant):
    """What is compiled ahead serves all sizes: numbers of rows that blocks do not divide, and a single block."""
    plan = make_plan(make_scene(layers, [40.0, 60.0], rows=15, columns=60))
    few = Operator.tiny(plan, (side,))
    assert few.application.sums_cells == Operator(plan, (side,)).application.sums_cells == (variant[1] == "out")
    for made in (few, Operator(plan, (side,), nodes=30)):
        made.prepare()
    assert len(kernels.tabulate.signatures) == 1
