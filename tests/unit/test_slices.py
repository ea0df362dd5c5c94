"""Cells: numbers of directions, exact solid angles, ties and poles."""

import math

import numpy as np
import pytest

from goniosim.slices import PARAMETRIZATIONS, cells_of, half, slice_geometry


def _cells(name, directions, theta_deg, rows=90, columns=360):
    """Cell rows and columns of unit view directions, shape (n, 3)."""
    theta = math.radians(theta_deg)
    light = np.array([math.sin(theta), 0.0, math.cos(theta)])
    x, y, z = np.ascontiguousarray(np.atleast_2d(directions).T)
    cell = np.empty(len(x), np.int32)
    cells_of(PARAMETRIZATIONS[name][0], -x, -y, z, len(x), rows, columns, light, cell)
    return np.divmod(cell, columns)


def _direction(theta_deg, phi_deg):
    t, p = np.radians(theta_deg), np.radians(phi_deg)
    return np.stack(np.broadcast_arrays(np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), np.cos(t)), axis=-1)


def test_classic_cells_of_cell_centres():
    theta, phi = np.meshgrid(np.arange(90) + 0.5, np.arange(360) + 0.5, indexing="ij")
    row, column = _cells("classic", _direction(theta.ravel(), phi.ravel()), 30.0)
    assert (row == theta.ravel().astype(int)).all()
    assert (column == phi.ravel().astype(int)).all()


@pytest.mark.parametrize("theta_l", [0.0, 40.0, 85.0])
def test_half_cells_against_angles(theta_l):
    rng = np.random.default_rng(1)
    v = rng.normal(size=(20_000, 3))
    v[:, 2] = np.abs(v[:, 2])
    v /= np.linalg.norm(v, axis=1, keepdims=True)
    h = v + _direction(theta_l, 0.0)
    h /= np.linalg.norm(h, axis=1, keepdims=True)
    u = np.sqrt(np.degrees(np.arccos(np.clip(h[:, 2], -1, 1))) * 90)
    row, column = _cells("half", v, theta_l)
    assert (row == np.minimum(u.astype(int), 89)).all()
    assert (column == (np.degrees(np.arctan2(h[:, 1], h[:, 0])) % 360).astype(int)).all()


@pytest.mark.parametrize("theta", [*range(90), 12.5, 89.99])
def test_mirror_directions_fall_on_the_tie_rule_cell(theta):
    """Also after rounding has moved the direction by a few units in the last place to any side."""
    mirror = _direction(theta, 180.0)
    noise = np.array([[i, j, k] for i in (-1, 0, 1) for j in (-1, 0, 1) for k in (-1, 0, 1)]) * 3e-16
    directions = mirror + noise
    directions[:, 2] = np.abs(directions[:, 2])
    row, column = _cells("classic", directions, theta)
    assert (row == int(theta)).all()
    assert (column == (180 if theta > 0 else 0)).all()
    row, column = _cells("half", directions, theta)
    assert (row == 0).all() and (column == 0).all()


def test_azimuth_just_below_a_full_turn_belongs_to_column_zero():
    row, column = _cells("classic", np.array([[0.6, -1e-13, 0.8]]), 0.0)
    assert column[0] == 0


@pytest.mark.parametrize("rows, columns", [(90, 360), (7, 5), (1, 1), (30, 91)])
@pytest.mark.parametrize("theta", [0.0, 1e-3, 30.0, 60.0, 85.0, 89.99])
@pytest.mark.parametrize("name", ["classic", "half"])
def test_solid_angles_cover_the_hemisphere(name, theta, rows, columns):
    geometry = slice_geometry(name, rows, columns, theta)
    assert geometry.solid_angle.sum() == pytest.approx(2 * math.pi, rel=1e-12)
    assert geometry.projected_solid_angle.sum() == pytest.approx(math.pi, rel=1e-12)
    assert (geometry.solid_angle >= geometry.projected_solid_angle - 1e-15).all()
    assert (geometry.projected_solid_angle >= 0).all()


@pytest.mark.false_alarm(4e-4, seeds=(2, 102, 202))
@pytest.mark.parametrize("name", ["classic", "half"])
@pytest.mark.parametrize("theta", [0.0, 30.0, 75.0])
def test_solid_angles_by_counting(name, theta, seed):
    """Uniform and cosine-distributed directions counted in 216 coarse cells, 5 sigma: false alarm 4e-4.

    As cells are normally distributed, it is 1.2e-4; the smallest have some 25 counts.
    """
    rng = np.random.default_rng(seed)
    n, rows, columns = 400_000, 9, 12
    geometry = slice_geometry(name, rows, columns, theta)
    phi = rng.uniform(0, 360, n)
    for cosine, total, exact in (
        (rng.uniform(0, 1, n), 2 * math.pi, geometry.solid_angle),
        (np.sqrt(rng.uniform(0, 1, n)), math.pi, geometry.projected_solid_angle),
    ):
        row, column = _cells(name, _direction(np.degrees(np.arccos(cosine)), phi), theta, rows, columns)
        counts = np.bincount(row * columns + column, minlength=rows * columns).reshape(rows, columns)
        p = exact / total
        assert (np.abs(counts - n * p) <= 5 * np.sqrt(n * p * (1 - p)) + 1e-9 * n).all()


@pytest.mark.parametrize("theta", [0.0, 30.0, 85.0])
def test_valid_half_cells_lie_above_the_horizon(theta):
    rows, columns = 45, 60
    valid = slice_geometry("half", rows, columns, theta).valid
    light = _direction(theta, 0.0)
    inside = np.linspace(0.0, 1.0, 9)
    for row in range(rows):
        u = (row + inside) * 90 / rows
        for column in range(columns):
            t, p = np.meshgrid(u**2 / 90, (column + inside) * 360 / columns, indexing="ij")
            h = _direction(t, p)
            height = 2 * (h @ light) * h[..., 2] - light[2]
            assert valid[row, column] == (height.min() > -1e-12)


def _reduced(fine, rows, columns):
    return fine.reshape(rows, fine.shape[0] // rows, columns, fine.shape[1] // columns).sum(axis=(1, 3))


@pytest.mark.parametrize("theta", [0.0, 37.0, 89.9])
@pytest.mark.parametrize("shape", [(1, 1), (1, 4), (2, 2), (6, 1), (30, 3), (40, 8)])
def test_coarse_half_slices_hold_what_fine_ones_do(shape, theta):
    coarse = slice_geometry("half", *shape, theta)
    # Rows u: those of 120 rows lie within them.
    fine = slice_geometry("half", 120, 24, theta)
    for name in ("solid_angle", "projected_solid_angle"):
        np.testing.assert_allclose(getattr(coarse, name), _reduced(getattr(fine, name), *shape), rtol=0, atol=2e-13)
    assert coarse.projected_solid_angle.sum() == pytest.approx(math.pi, abs=1e-12)


@pytest.mark.parametrize("shape", [(1, 1), (1, 50), (9, 1), (2, 2)])
def test_coarse_half_slices_take_few_evaluations(monkeypatch, shape):
    calls = []
    ring = half._ring
    monkeypatch.setattr(half, "_ring", lambda *arguments: calls.append(1) or ring(*arguments))
    half.geometry(*shape, math.radians(60.0))
    assert len(calls) < 500


def test_cells_in_blocks_are_the_cells(monkeypatch):
    whole = half.geometry(20, 31, 1.0)
    monkeypatch.setattr(half, "_BLOCK", 100)
    for one, other in zip(whole, half.geometry(20, 31, 1.0), strict=True):
        assert np.array_equal(one, other)


def test_fine_slices_are_not_kept():
    assert slice_geometry("classic", 90, 360, 1.0) is slice_geometry("classic", 90, 360, 1.0)
    assert slice_geometry("classic", 300, 300, 1.0) is not slice_geometry("classic", 300, 300, 1.0)


@pytest.mark.parametrize("name", ["classic", "half"])
@pytest.mark.parametrize("away", [1e-8, -1e-8])
def test_edges_are_where_they_belong(name, away):
    """A hundred-millionth of a cell to each side: ten times as far as the tie rule reaches."""
    module, light = PARAMETRIZATIONS[name][1], _direction(80.0, 0.0)
    side = 0 if away > 0.0 else -1
    rows, columns = np.arange(1, 20), np.arange(1, 360)
    for row in rows:
        v = module.directions((row + away) * np.pi / 180.0, (columns + 0.5) * np.pi / 180.0, light)
        found, _ = _cells(name, v[v[:, 2] > 0.1], 80.0)
        assert (found == row + side).all() and len(found) > 40
        v = module.directions((row + 0.5) * np.pi / 180.0, (columns + away) * np.pi / 180.0, light)
        _, found = _cells(name, v[v[:, 2] > 0.1], 80.0)
        assert (found == (columns + side)[v[:, 2] > 0.1]).all()
