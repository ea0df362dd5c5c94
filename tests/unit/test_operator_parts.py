"""The parts of an operator: stencils, cosine series, kernels, facets, each against what is known of it."""

import math

import numpy as np
import pytest

from goniosim._jit import kernel
from goniosim.engine.estimators.operator import Operator
from goniosim.engine.layout import DOWN, UP
from goniosim.engine.operators import cells, kernels, nodes
from goniosim.engine.operators.arrivals import bin_arrivals, waiting_rays
from goniosim.engine.operators.azimuths import at_azimuths, cosines, end_weights, to_coefficients, to_values
from goniosim.engine.operators.facets import meet_facet
from goniosim.engine.plan import make_plan
from goniosim.engine.unit import child_key
from goniosim.optics.microfacet import microfacet_transmission
from goniosim.optics.random import uniform
from reference.cell_integrals import integrate_cells
from reference.closed_forms import reflection_density, transmission_density
from reference.scenes import conductor, dielectric, lambert, make_scene, medium

NODES = 90


@kernel
def _spread(x, y, z, weights, stride, bins):
    nodes.deposit(x, y, z, weights, 1.0, stride, bins)


@kernel
def _look(x, y, z, stride, values, found):
    nodes.interpolate(x, y, z, stride, values, found)


def _directions():
    """Some anywhere, at the pole, in the horizon, and at the azimuths 0 and 180."""
    rng = np.random.default_rng(1)
    theta = np.concatenate([rng.uniform(0.0, math.pi / 2, 20), [0.0, 1e-3, math.pi / 2, 1.57, 0.7, 0.7]])
    phi = np.concatenate([rng.uniform(-math.pi, math.pi, 24), [0.0, math.pi]])
    return theta, phi, np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)


@pytest.mark.parametrize("stride", [1, 2])
def test_stencils_reproduce_cubics_and_spread_what_they_look_at(stride):
    """A cubic of the polar angle exactly, harmonics of the azimuth to the fourth order; deposit is the adjoint."""
    polar = np.linspace(0.0, math.pi / 2, NODES + 1)
    around = np.linspace(0.0, math.pi, 2 * NODES + 1)
    values = np.empty((2 * NODES + 1, NODES + 1, 2))
    values[..., 0] = 1.0 + polar - 2.0 * polar**2 + 0.7 * polar**3
    values[..., 1] = (1.0 + polar**2) * np.cos(2.0 * around)[:, None]
    for theta, phi, v in zip(*_directions(), strict=True):
        found = np.empty(2)
        _look(*v, stride, values, found)
        assert found[0] == pytest.approx(1.0 + theta - 2.0 * theta**2 + 0.7 * theta**3, abs=1e-12)
        h = stride * math.pi / 180.0
        # At the pole there is no azimuth.
        harmonic = (1.0 + theta**2) * math.cos(2.0 * phi)
        assert theta == 0.0 or found[1] == pytest.approx(harmonic, abs=2.0 * (2.0 * h) ** 4)
        bins = np.zeros_like(values)
        _spread(*v, np.array([0.25, 3.0]), stride, bins)
        assert bins.sum(axis=(0, 1)) == pytest.approx([0.25, 3.0], abs=1e-12)
        assert (bins * values).sum(axis=(0, 1)) == pytest.approx([0.25, 3.0] * found, abs=1e-12)


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
    kernels.tabulate(event, 0.3, eta, kappa, 0, table)
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
        u1, u2, u3 = uniform(key, 3 * i), uniform(key, 3 * i + 1), uniform(key, 3 * i + 2)
        _, _, out[i, 0], _ = meet_facet(x, 0.0, z, alpha, u1, u2, 1.0)
        _, _, out[i, 1], out[i, 2] = meet_facet(x, 0.0, z, alpha, u1, u2, u3)


@pytest.mark.parametrize("alpha", [0.001, 0.2, 1.0])
@pytest.mark.parametrize("deg", [0.0, 60.0, 89.0])
def test_facets_of_the_mixture_have_the_plain_distribution(alpha, deg):
    """Their weights have mean 1, and moments of heights agree: 4.5 sigma of 6 differences each, false alarm 4e-5."""
    out = np.empty((40_000, 3))
    _draw(math.sin(math.radians(deg)), math.cos(math.radians(deg)), alpha, child_key(5, 0), out)
    plain, mixed, ratio = out.T
    assert ratio.max() <= 1.0 / 0.9 + 1e-9
    assert abs(ratio.mean() - 1.0) < 4.5 * ratio.std() / math.sqrt(len(ratio)) + 1e-12
    tilt, other = np.arccos(np.minimum(plain, 1.0)), np.arccos(np.minimum(mixed, 1.0)) * ratio
    assert abs(tilt.mean() - other.mean()) < 4.5 * math.sqrt((tilt.var() + other.var()) / len(ratio))


def test_a_full_pile_of_waiting_rays_costs_noise_only():
    """With room for one ray a coin chooses the branch: the same mean within 4.5 sigma of both, false alarm 7e-6."""
    layers = [dielectric(1.5, 0.3), dielectric(2.0, 0.2), dielectric(1.3, 0.2), conductor(0.2, 3.0, 0.2)]
    plan = make_plan(make_scene(layers, 40.0))
    stack = (plan.kinds, plan.alphas, plan.etas, plan.spectral, plan.taus, plan.absorbs)
    target = np.array([0, 1, 0, 1])
    totals = np.empty((2, 40))
    for i, room in enumerate((1, 64)):
        for r in range(40):
            bins = np.zeros((1, 2 * NODES + 1, NODES + 1, plan.n_distinct))
            bin_arrivals(stack, plan.light[0], target, 0, 200, child_key(i, r), waiting_rays(plan, room), bins)
            totals[i, r] = bins.sum()
    mean, error = totals.mean(axis=1), totals.std(axis=1, ddof=1) / math.sqrt(40)
    assert abs(mean[0] - mean[1]) < 4.5 * math.hypot(*error)
    assert mean[1] > 10.0


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
