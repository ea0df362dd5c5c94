"""Cell averages of models: exact for constants, and equal to independent quadrature for lobes."""

import math
import threading
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.integrate import dblquad

from goniosim._jit import kernel
from goniosim.compare.cells import to_slice
from goniosim.compare.convergence import converge
from goniosim.integration import Grid, Pool, adaptive, find_lobe, integrate_adaptively, integrate_fixed
from goniosim.integration.subcells import make_subcells
from goniosim.optics.microfacet import microfacet_reflection
from goniosim.slices import slice_geometry


@kernel
def _constant(tables, light, x, y, z, out):
    for c in range(out.shape[0]):
        out[c] = tables[0][c]


@kernel
def _ggx(tables, light, x, y, z, out):
    for i in range(x.shape[0]):
        value, _ = microfacet_reflection(light[0], light[1], light[2], x[i], y[i], z[i], tables[0][0])
        out[:, i] = value


def make_grid(parametrization, rows, columns, theta_deg):
    geometry = slice_geometry(parametrization, rows, columns, theta_deg)
    return Grid(parametrization, rows, columns, theta_deg, geometry.valid, geometry.projected_solid_angle)


def stand_in(function, numbers, grid, channels=1, mirror_energy=None, narrowest=1.0):
    """What a model prepares, with a kernel of ours."""
    return SimpleNamespace(
        kernel=function,
        tables=(np.array(numbers, float),),
        light=grid.light,
        channels=channels,
        mirror_energy=np.zeros(channels) if mirror_energy is None else np.array(mirror_energy),
        position=list(range(channels)),
        narrowest=narrowest,
    )


@pytest.fixture(scope="module")
def pool():
    with Pool() as threads:
        yield threads


@pytest.mark.parametrize("parametrization", ["classic", "half"])
@pytest.mark.parametrize("columns", [12, 13])
@pytest.mark.parametrize("theta_deg", [0.0, 37.0, 85.0])
def test_a_constant_is_averaged_exactly(pool, parametrization, columns, theta_deg):
    """Also for an odd number of columns, whose middle one is its own mirror image."""
    grid = make_grid(parametrization, 20, columns, theta_deg)
    model = stand_in(_constant, [0.25, 3.0], grid, channels=2)
    energy = to_slice(model, grid, integrate_fixed(model, grid, 5, pool)[0])
    average = energy[:, grid.valid] / grid.projected_solid_angle[grid.valid]
    np.testing.assert_allclose(average[0], 0.25, rtol=2e-12)
    np.testing.assert_allclose(average[1], 3.0, rtol=2e-12)
    assert not energy[:, ~grid.valid].any()


@pytest.mark.parametrize("parametrization", ["classic", "half"])
def test_subcells_share_out_the_projected_solid_angle(parametrization):
    grid = make_grid(parametrization, 15, 14, 50.0)
    table = make_subcells(grid, 3)
    weight = table.row_integral @ table.column_integral.T
    cells = weight.reshape(15, 3, 7, 3).sum(axis=(1, 3))
    exact = grid.projected_solid_angle[:, :7]
    valid = grid.valid[:, :7]
    np.testing.assert_allclose(cells[valid], exact[valid], rtol=1e-11)


def _flux(parametrization, theta_deg, alpha):
    """Row coordinate and azimuth to f cos(theta_v) d omega_v, from the definitions of both slices."""
    theta = math.radians(theta_deg)
    light = np.array([math.sin(theta), 0.0, math.cos(theta)])

    def direction(axis_theta, phi):
        return np.array(
            [math.sin(axis_theta) * math.cos(phi), math.sin(axis_theta) * math.sin(phi), math.cos(axis_theta)]
        )

    def g1(z):
        return 2.0 / (1.0 + math.sqrt(1.0 + alpha**2 * (1.0 / z**2 - 1.0)))

    def flux(u, phi):
        if parametrization == "classic":
            v, jacobian = direction(u, phi), math.sin(u)
        else:
            tilt = 2.0 * u * u / math.pi
            h = direction(tilt, phi)
            v = 2.0 * (light @ h) * h - light
            jacobian = 4.0 * (light @ h) * math.sin(tilt) * 4.0 * u / math.pi
        h = (light + v) / np.linalg.norm(light + v)
        d = alpha**2 / (math.pi * (alpha**2 * h[2] ** 2 + h[0] ** 2 + h[1] ** 2) ** 2)
        return d * g1(light[2]) * g1(v[2]) / (4.0 * light[2]) * jacobian

    return flux


@pytest.mark.parametrize("parametrization", ["classic", "half"])
@pytest.mark.parametrize("theta_deg", [30.0, 70.0])
def test_lobes_agree_with_adaptive_quadrature(pool, parametrization, theta_deg):
    """A lobe of width 0.1 in cells of 6 by 30 degrees: sub-cells to 2 %, refined ones to 1e-3 of the lobe."""
    alpha = 0.1
    grid = make_grid(parametrization, 15, 12, theta_deg)
    model = stand_in(_ggx, [alpha], grid, narrowest=alpha)
    coarse, spread = integrate_fixed(model, grid, 15, pool)
    levels = converge(model, grid, 15, pool, coarse, spread)
    coarse, refined = (to_slice(model, grid, energy)[0] for energy in (levels.coarse, levels.converged))
    flux = _flux(parametrization, theta_deg, alpha)
    strongest = np.argsort(refined.ravel())[-12:]
    for row, column in zip(*np.divmod(strongest, 12), strict=True):
        u, phi = np.radians(6.0 * row), np.radians(30.0 * column)
        exact, _ = dblquad(
            lambda b, a: flux(a, b),
            u,
            u + math.radians(6.0),
            phi,
            phi + math.radians(30.0),
            epsabs=1e-8,
            epsrel=1e-6,
        )
        assert refined[row, column] == pytest.approx(exact, rel=2e-3, abs=1e-4 * refined.max())
        assert coarse[row, column] == pytest.approx(exact, rel=2e-2, abs=1e-3 * refined.max())


@pytest.mark.parametrize("theta_deg", [0.0, 40.0, 85.0])
@pytest.mark.parametrize("alpha", [1e-3, 1e-5])
def test_spikes_are_found_by_refinement(pool, theta_deg, alpha):
    """A white lobe far narrower than the cells carries its energy G1(l), though sub-cells lose it."""
    grid = make_grid("classic", 90, 360, theta_deg)
    model = stand_in(_ggx, [alpha], grid, narrowest=alpha)
    coarse, spread = integrate_fixed(model, grid, 5, pool)
    levels = converge(model, grid, 5, pool, coarse, spread)
    refined = to_slice(model, grid, levels.converged)
    assert levels.integration == "adaptive"
    assert abs(coarse.sum() * 2.0 - 1.0) > 0.1
    assert refined.sum() == pytest.approx(1.0, abs=3e-3)


def test_a_slice_is_symmetric_and_holds_the_dirac_energy_once(pool):
    grid = make_grid("classic", 18, 36, 42.0)
    model = stand_in(_ggx, [0.3], grid, mirror_energy=[0.5])
    smooth = stand_in(_ggx, [0.3], grid)
    energy, _ = integrate_fixed(model, grid, 3, pool)
    difference = to_slice(model, grid, energy) - to_slice(smooth, grid, energy)
    assert np.count_nonzero(difference) == 1 and difference.sum() == pytest.approx(0.5)
    # 180 degrees is an edge of the columns and belongs to the higher one; theta 42 lies in row 8.
    assert difference[0, 8, 18] > 0.0
    symmetric = to_slice(smooth, grid, energy)
    np.testing.assert_array_equal(symmetric, symmetric[..., ::-1])


def test_chosen_cells_get_the_same_values(pool):
    grid = make_grid("half", 30, 40, 60.0)
    model = stand_in(_ggx, [0.2], grid)
    energy, spread = integrate_fixed(model, grid, 4, pool)
    some = np.arange(3, len(grid.numbers), 17)
    part, part_spread = integrate_fixed(model, grid, 4, pool, grid.numbers[some])
    np.testing.assert_allclose(part, energy[:, some], rtol=1e-13)
    np.testing.assert_allclose(part_spread, spread[some], rtol=1e-10)


@kernel
def _dust(tables, light, x, y, z, out):
    """Different at all places and scales."""
    for i in range(x.shape[0]):
        far = 1e7 * (x[i] + 3.0 * y[i])
        out[:, i] = far - math.floor(far)


def white_total(theta_deg, alpha, parametrization, rows=30, columns=60, **tolerance):
    """Energy of a white GGX lobe over all cells, and the error that is stated for it."""
    grid = make_grid(parametrization, rows, columns, theta_deg)
    model = stand_in(_ggx, [alpha], grid)
    lobe = find_lobe(grid, grid.light, alpha)
    with Pool() as pool:
        found = integrate_adaptively(model, grid, pool, grid.all_numbers, lobe=lobe, **tolerance)
    assert not found.exhausted.any()
    return grid.unfold(found.energy).sum(), grid.unfold(found.error).sum()


@pytest.mark.parametrize("parametrization", ["classic", "half"])
@pytest.mark.parametrize("columns", [12, 13])
@pytest.mark.parametrize("theta_deg", [0.0, 37.0, 85.0])
def test_the_horizon_is_integrated_to_the_tolerance(pool, parametrization, columns, theta_deg):
    """A constant gives the projected solid angle, also of cells that the horizon cuts."""
    grid = make_grid(parametrization, 20, columns, theta_deg)
    model = stand_in(_constant, [1.0], grid)
    found = integrate_adaptively(model, grid, pool, grid.all_numbers, relative=1e-10, absolute=1e-14)
    energy = grid.unfold(found.energy)[0]
    np.testing.assert_allclose(energy, grid.projected_solid_angle, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("theta_deg", [5.0, 60.0, 85.0, 89.9])
@pytest.mark.parametrize("alpha", [0.3, 1e-3, 1e-6])
def test_both_slices_hold_the_same_energy(theta_deg, alpha):
    """Once parts were settled by dividing along one side alone, and errors along the other stayed unseen."""
    tolerance = {"relative": 1e-10, "absolute": 1e-14}
    classic, classic_error = white_total(theta_deg, alpha, "classic", **tolerance)
    half, half_error = white_total(theta_deg, alpha, "half", **tolerance)
    assert classic == pytest.approx(half, abs=classic_error + half_error)
    # The narrowest lobe at the lowest light is limited by the rounding of the half vector.
    assert classic_error < (1e-7 if alpha == 1e-6 and theta_deg == 89.9 else 5e-8)


@pytest.mark.parametrize("parametrization", ["classic", "half"])
@pytest.mark.parametrize("relative", [1e-3, 1e-6, 1e-9])
def test_the_stated_tolerance_is_kept(pool, parametrization, relative):
    grid = make_grid(parametrization, 18, 24, 55.0)
    for alpha in (0.5, 0.02):
        model = stand_in(_ggx, [alpha], grid)
        lobe = find_lobe(grid, grid.light, alpha)
        best = integrate_adaptively(model, grid, pool, grid.all_numbers, relative=1e-12, lobe=lobe, nodes=8)
        found = integrate_adaptively(model, grid, pool, grid.all_numbers, relative=relative, lobe=lobe)
        off = np.abs(found.energy - best.energy)
        assert (off <= 10.0 * relative * best.energy + 1e-15).all()
        assert (off <= 2.0 * found.error + best.error + 1e-15).all()


def test_a_needle_is_found_however_narrow():
    """At 89.999 degrees a lobe of width 1e-6 covers an azimuth of 3.5e-11 rad."""
    theta = math.radians(89.999)
    total, _ = white_total(89.999, 1e-6, "classic", relative=1e-6, absolute=1e-9)
    # Of a mirror this rough nearly nothing is masked, and what is seen is G1(l).
    g1 = 2.0 / (1.0 + math.sqrt(1.0 + (1e-6 * math.tan(theta)) ** 2))
    assert total == pytest.approx(g1, abs=2e-3)


@pytest.mark.parametrize("theta_deg", [20.0, 45.0, 60.0])
@pytest.mark.parametrize("parametrization", ["classic", "half"])
def test_a_lobe_as_wide_as_the_light_is_low_has_an_extent(theta_deg, parametrization):
    """A facet tilted by theta sends the light back to where it came from, which once made the extent 0."""
    grid = make_grid(parametrization, 90, 360, theta_deg)
    lobe = find_lobe(grid, grid.light, math.tan(math.radians(theta_deg)))
    assert lobe.scale_u > 0.1 and lobe.scale_psi > 0.1


@pytest.mark.parametrize("columns", [1, 4])
@pytest.mark.parametrize("theta_deg", [60.0, 89.9, 89.999])
@pytest.mark.parametrize("alpha", [0.05, 1e-3, 1e-5])
def test_a_single_row_holds_as_much_as_many(columns, theta_deg, alpha):
    """Once a peak counted as that of every azimuth in a row that reached from the pole to it, and was missed."""
    tolerance = {"relative": 1e-9, "absolute": 1e-13}
    one, one_error = white_total(theta_deg, alpha, "classic", rows=1, columns=columns, **tolerance)
    many, many_error = white_total(theta_deg, alpha, "classic", rows=30, columns=60, **tolerance)
    assert one == pytest.approx(many, abs=one_error + many_error + 1e-12)


def test_cells_that_are_divided_too_much_at_a_time_are_taken_by_fewer(monkeypatch, pool):
    grid = make_grid("classic", 9, 12, 60.0)
    model = stand_in(_ggx, [0.01], grid)
    lobe = find_lobe(grid, grid.light, 0.01)
    whole = integrate_adaptively(model, grid, pool, grid.all_numbers, relative=1e-9, lobe=lobe)
    monkeypatch.setattr(adaptive, "MOST_PENDING", 5)
    parts = integrate_adaptively(model, grid, pool, grid.all_numbers, relative=1e-9, lobe=lobe)
    np.testing.assert_array_equal(parts.energy, whole.energy)
    np.testing.assert_array_equal(parts.error, whole.error)


def test_what_cannot_be_integrated_is_given_up_and_marked(pool):
    grid = make_grid("classic", 9, 12, 30.0)
    model = stand_in(_dust, [], grid)
    found = integrate_adaptively(model, grid, pool, np.array([3, 20]), relative=1e-9)
    assert found.exhausted.all()
    assert (found.error > 0.0).all()
    # A cell that is easy stays so.
    easy = integrate_adaptively(stand_in(_constant, [1.0], grid), grid, pool, np.array([3, 20]), relative=1e-9)
    assert not easy.exhausted.any()


def test_a_lobe_that_the_coordinates_cannot_hold_is_marked(pool):
    grid = make_grid("classic", 9, 12, 30.0)
    alpha = 1e-18
    model = stand_in(_ggx, [alpha], grid)
    found = integrate_adaptively(
        model, grid, pool, grid.all_numbers, relative=1e-3, lobe=find_lobe(grid, grid.light, alpha)
    )
    assert found.exhausted.any()
    assert np.isinf(found.error[:, found.exhausted]).all() and np.isfinite(found.error[:, ~found.exhausted]).all()


def test_the_same_bits_for_any_number_of_threads_and_chunks(monkeypatch):
    grid = make_grid("half", 12, 21, 70.0)
    model = stand_in(_ggx, [0.01], grid)
    found = []
    for threads, chunk in ((1, adaptive.CHUNK), (3, adaptive.CHUNK), (2, 17)):
        monkeypatch.setattr(adaptive, "CHUNK", chunk)
        with Pool(threads) as pool:
            found.append(
                integrate_adaptively(
                    model, grid, pool, grid.all_numbers, relative=1e-8, lobe=find_lobe(grid, grid.light, 0.01)
                )
            )
    for other in found[1:]:
        np.testing.assert_array_equal(other.energy, found[0].energy)
        np.testing.assert_array_equal(other.error, found[0].error)


def test_an_integration_stops_when_told(pool):
    grid = make_grid("classic", 9, 12, 30.0)
    stop = threading.Event()
    stop.set()
    model = stand_in(_constant, [1.0], grid)
    assert integrate_adaptively(model, grid, pool, grid.all_numbers, stop=stop) is None


@pytest.mark.parametrize("theta_deg", [20.0, 45.0, 89.999])
@pytest.mark.parametrize("alpha", [1e-3, 1e-6])
def test_the_extent_of_a_lobe(theta_deg, alpha):
    """A half vector tilted by alpha turns v by 2 alpha, its azimuth by 2 alpha cot(theta); theta_h is the tilt."""
    theta = math.radians(theta_deg)
    classic = make_grid("classic", 9, 12, theta_deg)
    lobe = find_lobe(classic, classic.light, alpha)
    assert (lobe.u, lobe.psi) == (pytest.approx(theta), 0.0)
    assert lobe.scale_u == pytest.approx(0.5 * alpha, rel=0.01)
    assert lobe.scale_psi == pytest.approx(0.5 * alpha / math.tan(theta), rel=0.01)
    half = make_grid("half", 9, 12, theta_deg)
    lobe = find_lobe(half, half.light, alpha)
    assert lobe.u == 0.0
    assert lobe.scale_u == pytest.approx(0.25 * math.sqrt(alpha * 0.5 * math.pi), rel=0.01)
