"""From pixels and the plane of incidence to cells, and back."""

import numpy as np
import pytest

from goniosim.report.drawing import inplane, view
from goniosim.result import Cells
from goniosim.slices import slice_geometry
from synthetic import make_result

THETA = 40.0


@pytest.fixture(params=["classic", "half"])
def cells(request):
    geometry = slice_geometry(request.param, 30, 72, THETA)
    return Cells(
        parametrization=request.param,
        row_edges=np.linspace(0.0, 90.0, 31),
        column_edges=np.linspace(0.0, 360.0, 73),
        valid=geometry.valid[None],
        solid_angle=geometry.solid_angle[None],
        projected_solid_angle=geometry.projected_solid_angle[None],
    )


def test_the_centre_of_a_cell_lies_in_that_cell(cells):
    for number in np.flatnonzero(cells.valid[0]):
        assert view.cell_numbers(cells, 0, THETA, view.centre(cells, THETA, int(number))) == number


def test_cells_cut_by_the_horizon_and_directions_below_it_are_told_apart():
    cells = make_result(parametrization="half", theta_deg=(THETA,)).cells
    number = 5 * 8
    assert not cells.valid[0].ravel()[number]
    direction = view.centre(cells, THETA, number)
    expected = view.INVALID if direction[2] >= 0.0 else view.OUTSIDE
    assert view.cell_numbers(cells, 0, THETA, direction) == expected
    grazing = np.array([np.cos(1e-3), 0.0, np.sin(1e-3)])
    assert view.cell_numbers(cells, 0, 0.0, grazing * [-1.0, 1.0, -1.0]) == view.OUTSIDE


def test_the_light_comes_from_the_left_and_its_mirror_image_is_on_the_right():
    cells = make_result(theta_deg=(THETA,), rows=9, columns=4).cells
    numbers = view.disk(cells, 0, THETA, 101)
    left, right, top = numbers[50, 10], numbers[50, 90], numbers[10, 50]
    # Columns of 90 degrees: 0 and 3 hold the light's azimuth, 1 and 2 the opposite one.
    assert left % 4 in (0, 3)
    assert right % 4 in (1, 2)
    assert top % 4 in (2, 3)
    assert numbers[0, 0] == view.OUTSIDE
    # Pixel 90 stands at 0.79 of the radius: 52.3 degrees, in the row from 50 to 60.
    assert right // 4 == 5


def test_the_disk_shows_projected_solid_angles(cells):
    """In an orthographic view the area of a cell is its projected solid angle."""
    pixels = 800
    numbers = view.disk(cells, 0, THETA, pixels)
    area = np.bincount(numbers[numbers >= 0], minlength=cells.valid[0].size) * (2.0 / pixels) ** 2
    large = (cells.projected_solid_angle[0].ravel() > 2e-3) & cells.valid[0].ravel()
    assert large.sum() > 50
    # A few hundred pixels and more in each; the rim of a cell is known to about a pixel.
    assert area[large] == pytest.approx(cells.projected_solid_angle[0].ravel()[large], rel=0.1)


def test_the_curve_follows_the_plane_with_the_mirror_direction_on_the_positive_side(cells):
    """A slice filled with its own signed in-plane coordinate must come out as the identity."""
    rows, columns = cells.valid.shape[1:]
    centres = np.array([view.centre(cells, THETA, n) for n in range(rows * columns)])
    values = (2.0 - centres[:, 0]).reshape(1, rows, columns)
    angle, f, sigma = inplane.plane_of_incidence(cells, 0, THETA, values, np.zeros_like(values))
    assert np.all(np.diff(angle) > 0.0)
    assert angle[0] < -60.0
    assert angle[-1] > 75.0
    assert f[:, 0] == pytest.approx(2.0 + np.sin(np.radians(angle)), abs=0.03)
    assert np.all(sigma == 0.0)


@pytest.mark.false_alarm(2e-6, seeds=(7, 107))
@pytest.mark.parametrize(
    ("cells", "correlated", "low", "high"),
    [(2, True, 0.9, 1.1), (40, True, 0.9, 1.1), (2, False, 1.0, 1.35), (40, False, 1.5, 2.5)],
)
def test_the_error_of_a_patch_is_not_too_small_for_any_correlation(cells, correlated, low, high, seed):
    """Over 4000 patches, the root mean square of the stated error against that of the actual one.

    The ratio has a standard deviation of about 2 % (1 % for the actual error, as much for the
    stated one); the limits are at least 5 of those away from what is expected (1, 1, 1.22, 2.12), so
    each of the four cases raises a false alarm with a probability below 2e-6.
    """
    rng = np.random.default_rng(seed)
    n = 4000
    noise = rng.normal(0.0, 0.1, (n, 1 if correlated else cells)) * np.ones((n, cells))
    mean, error = inplane._mean(1.0 + noise, np.full((n, cells), 0.1))
    assert low < np.sqrt(np.mean(error**2)) / np.std(mean - 1.0) < high


def test_dark_rows_are_joined_until_something_is_seen():
    cells = make_result(theta_deg=(0.0,), rows=900, columns=4).cells
    f = np.full((1, 900, 4), 0.5)
    few = inplane.plane_of_incidence(cells, 0, 0.0, f, np.full_like(f, 0.4))[0]
    many = inplane.plane_of_incidence(cells, 0, 0.0, f, np.full_like(f, 0.01))[0]
    assert len(many) == 1800
    assert len(few) < 400
    assert np.all(np.diff(few) < inplane.WIDEST_DEG + 0.2)


def test_noise_does_not_decide_the_scale():
    f = np.array([[1.0], [50.0]])
    sigma = np.array([[0.1], [45.0]])
    assert inplane.highest(f, sigma, 2.0) == pytest.approx(1.2)
    assert inplane.highest(f, np.full_like(f, 60.0), 2.0) == pytest.approx(50.0)


@pytest.mark.parametrize("parametrization", ["classic", "half"])
def test_a_closer_look_is_centred_on_its_direction(parametrization):
    cells = make_result(parametrization=parametrization, theta_deg=(60.0,), rows=90, columns=360).cells
    cells.valid[:] = True
    numbers = view.magnified(cells, 0, 60.0, 62.3, 5.0, 101)
    for place, angle in ((50, 62.3), (95, 62.3 + 4.5), (5, 62.3 - 4.5)):
        tilt = np.radians(angle)
        expected = view.cell_numbers(cells, 0, 60.0, np.array([-np.sin(tilt), -1e-9, np.cos(tilt)]))
        mirrored = view.cell_numbers(cells, 0, 60.0, np.array([-np.sin(tilt), 1e-9, np.cos(tilt)]))
        assert numbers[50, place] in (expected, mirrored)
    # Beyond the horizon there is nothing.
    assert (view.magnified(cells, 0, 60.0, 89.0, 5.0, 20) == view.OUTSIDE).any()
