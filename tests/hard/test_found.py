"""What the laws of `tests/laws` have found among random scenes."""

import numpy as np
import pytest

from goniosim.engine import simulate
from goniosim.errors import ConfigError
from goniosim.slices import slice_geometry
from reference.scenes import conductor, dielectric, lambert, make_scene


@pytest.mark.parametrize("layers", [[lambert(0.5)], [conductor(1.45, 1.0, 0.2)]])
@pytest.mark.parametrize("estimator", ["split", "operator", "connection"])
def test_replicates_of_nothing_are_refused(layers, estimator):
    """A bare base sends back nothing but its direct reflection; the split walk tried to stack no slices at all."""
    scene = make_scene(layers, 30, rows=2, columns=3)
    with pytest.raises(ConfigError, match="nothing but the direct reflection leaves; use auto"):
        simulate(scene, rays=100, estimator=estimator)


@pytest.mark.parametrize("theta", [5e-324, 1e-308, 1e-300])
def test_half_cells_of_light_that_all_but_comes_from_above(theta):
    """The cosine of the azimuth where the horizon begins is a quotient by sin(theta), which overflowed."""
    found, expected = (slice_geometry("half", 4, 6, angle) for angle in (theta, 0.0))
    np.testing.assert_array_equal(found.valid, expected.valid)
    for field in ("solid_angle", "projected_solid_angle"):
        np.testing.assert_allclose(getattr(found, field), getattr(expected, field), rtol=1e-12, atol=1e-15)
    simulate(make_scene([dielectric(1.5)], theta, "half", 1, 1), rays=100)
