"""Cells gathered from the nodes, of radiances whose energies are known."""

import itertools
import math

import numpy as np
import pytest

from goniosim.engine import simulate
from goniosim.engine.operators.gather import BLOCK, gather
from goniosim.engine.operators.stencils import padded
from goniosim.engine.unit import child_key
from goniosim.optics.fresnel import dielectric_transmittance
from goniosim.slices import PARAMETRIZATIONS, slice_geometry
from reference.scenes import dielectric, make_scene, medium

NODES, ROWS, THETA, KEYS = 30, 5, 70.0, 200
NOTHING = np.empty(0)


def gathered(radiance, parametrization, columns, exits=NOTHING, taus=(0.0,), source=NOTHING, parts=(1, 1), seed=1):
    """Energies of KEYS replicates, shape (KEYS, n, rows, width), of a radiance of shape (..., n)."""
    width = columns if columns % 2 else columns // 2
    count = np.shape(radiance)[-1]
    values = np.full((2 * NODES + 1, NODES + 1, padded(count)), np.nan)
    values[..., :count] = radiance
    light = np.array([math.sin(math.radians(THETA)), 0.0, math.cos(math.radians(THETA))])
    out = np.zeros((KEYS, count, ROWS * width))
    code = PARAMETRIZATIONS[parametrization][0]
    for k, strip in itertools.product(range(KEYS), range(parts[0])):
        given = light, exits, source, np.array(taus), child_key(seed, k)
        gather(values, code, ROWS, columns, parts, strip, *given, out[k])
    return out.reshape(KEYS, count, ROWS, width)


@pytest.mark.false_alarm(1.1e-4, seeds=(1, 101, 201))
@pytest.mark.parametrize("parametrization", PARAMETRIZATIONS)
@pytest.mark.parametrize(
    ("columns", "parts"), [(2 * BLOCK + 90, (1, 1)), (16, (1, 1)), (15, (1, 1)), (16, (2, 3)), (15, (3, 20))]
)
def test_cells_and_rows_have_their_projected_solid_angle(parametrization, columns, parts, seed):
    """As seen by a radiance of one, with blocks that are not full, a horizon that cuts cells, and slices not folded.

    Within 5.5 sigma each, of 900 cells at most, and rows with all their cells: false-alarm rate 1.1e-4, as the scatter
    is estimated (t, 199 degrees of freedom).
    """
    found = gathered(np.ones(1), parametrization, columns, parts=parts, seed=seed)[:, 0]
    width = found.shape[2]
    geometry = slice_geometry(parametrization, ROWS, columns, THETA)
    valid, exact = geometry.valid[:, :width], geometry.projected_solid_angle[:, :width]

    def deviation(some, truth):
        return (some.mean(axis=0) - truth) / (some.std(axis=0, ddof=1) / math.sqrt(KEYS) + 1e-15)

    assert parametrization == "classic" or ((exact > 0.0) & ~valid).sum() > 5
    assert np.abs(deviation(found, exact)[valid]).max() < 5.5
    assert np.abs(deviation(found.sum(axis=2), exact.sum(axis=1))).max() < 5.5
    assert (found[:, exact == 0.0] == 0.0).all()
    seen = geometry.solid_angle[:, :width] > 1e-3 * geometry.solid_angle.max()
    assert (found.mean(axis=0)[seen] > 0.0).all()


@pytest.mark.false_alarm(1e-12)
def test_numbers_do_not_mix_and_absorption_is_that_of_their_channel():
    """Six numbers in two channels, through a smooth exit, which has the closed form: rows of 50 cells to 1 %.

    Over many seeds they scatter by less than 0.07 %.
    """
    taus, eta, radiance = [0.0, 0.7], 1.5, np.array([1.0, 2.0, 0.0, 4.0, 5.0, 6.0])
    found = gathered(radiance, "classic", 100, np.array([0.0, eta]), taus).mean(axis=0).sum(axis=2)
    theta = (np.arange(ROWS * 400) + 0.5) * (0.5 * math.pi / (ROWS * 400))
    inside = np.sqrt(1.0 - (np.sin(theta) / eta) ** 2)
    passed = np.array([dielectric_transmittance(c, eta) for c in np.cos(theta)]) * np.sin(theta) * np.cos(theta)
    for e, value in enumerate(radiance):
        density = value * passed * np.exp(-taus[e % 2] / inside) / eta**2
        exact = density.reshape(ROWS, -1).mean(axis=1) * (0.5 * math.pi / ROWS) * math.pi
        assert found[e] == pytest.approx(exact, rel=0.01, abs=1e-15)


@pytest.mark.parametrize("exits", [NOTHING, np.array([0.0, 1.5])])
def test_what_is_linear_in_a_cell_has_next_to_no_noise(exits):
    """A radiance like the azimuth, and a measure that in the first row goes like its angle.

    Both vary by 200 % in a cell. What is left is curved: the measure, by 5 % in the row in the middle.
    """
    around = np.linspace(0.0, math.pi, 2 * NODES + 1)[:, None, None]
    found = gathered(around * np.ones((NODES + 1, 1)), "classic", 10, exits)[:, 0, ROWS // 2]
    assert (found.std(axis=0) / found.mean(axis=0)).max() < 0.04
    found = gathered(np.ones(1), "classic", 10, exits)[:, 0, 0]
    assert (found.std(axis=0) / found.mean(axis=0)).max() < 0.04


@pytest.mark.false_alarm(1e-5, seeds=(1, 101))
@pytest.mark.parametrize(
    ("exits", "share"), [(NOTHING, 1e-3), (np.array([0.0, 1.5]), 1e-3), (np.array([0.3, 1.5]), 0.15)]
)
def test_parts_take_the_noise_of_points_away(exits, share, seed):
    """Sixteen times as many: a 2000th of the variance of a smooth radiance and more, a 16th of what facets scatter.

    Means of 40 cells each; of 200 keys a variance is known to a tenth.
    """
    around = np.sin(np.linspace(0.0, math.pi, 2 * NODES + 1))[:, None, None]
    whole, parts = (
        gathered(around * np.ones((NODES + 1, 1)), "classic", 16, exits, parts=cut, seed=seed)
        for cut in ((1, 1), (4, 4))
    )
    assert parts.var(axis=0).mean() < share * whole.var(axis=0).mean()
    assert parts.mean(axis=0).sum() == pytest.approx(whole.mean(axis=0).sum(), rel=0.01)


@pytest.mark.false_alarm(1e-5, seeds=(1, 101))
@pytest.mark.parametrize(("alpha", "exit_alpha"), [(0.4, 0.3), (0.3, 0.02), (0.3, 0.0)])
def test_light_through_both_interfaces_is_that_of_independent_paths(alpha, exit_alpha, seed):
    """Of a radiance that is the light alone, through a wide exit, a narrow one and a smooth one: rows of cells.

    Against what independent paths transmit without any reflection, within 5 sigma: false-alarm rate 1e-5, as the
    scatter is estimated.
    """
    layers = [dielectric(1.5, alpha), medium(0.3), dielectric(1.0, exit_alpha)]
    scene = make_scene(layers, THETA, rows=ROWS, columns=40, orders=1)
    analog = simulate(scene, rays=2_000_000, seed=seed, estimator="analog")
    straight = analog.components["transmission"].orders["order_1"]
    exact, error2 = straight.energy[0, 0].sum(axis=1), (straight.stderr[0, 0] ** 2).sum(axis=1)
    found = gathered(np.zeros(2), "classic", 40, np.array([exit_alpha, 1.5]), [0.3], np.array([alpha, 1.5]), seed=seed)
    assert (found[:, 1] == 0.0).all()
    rows = 2.0 * found[:, 0].sum(axis=2)
    error2 += rows.var(axis=0, ddof=1) / KEYS
    assert (np.abs(rows.mean(axis=0) - exact) <= 5.0 * np.sqrt(error2)).all()


@pytest.mark.false_alarm(1e-9)
def test_light_far_from_a_narrow_exit_is_not_left_to_rare_facets():
    """Five cells in a row 50 degrees and more from where the light leaves for, through an exit of width .001.

    Over many seeds the scatter is 0.20 +- 0.01 of the mean, and the largest 1.7 +- 0.2 of it.
    """
    exits, source = np.array([0.001, 1.5]), np.array([0.05, 1.5])
    far = gathered(np.zeros(1), "classic", 40, exits, [0.0], source)[:, 0, 0, -5:].sum(axis=1)
    assert far.mean() > 0.0 and far.std(ddof=1) < 0.5 * far.mean() and far.max() < 4.0 * far.mean()
