"""What models are held against."""

import numpy as np

from goniosim.compare.material import reference
from synthetic import make_result


def test_all_reflection_is_what_its_parts_add_up_to():
    """Values add up, and so do the squares of independent errors."""
    result = make_result()
    parts = [result.components[f"reflection/{part}"] for part in ("direct", "internal")]
    parts[0].bsdf_stderr = 0.5 * parts[1].bsdf_stderr
    bsdf, stderr = reference(result, "reflection")
    np.testing.assert_allclose(bsdf, parts[0].bsdf + parts[1].bsdf, rtol=1e-14)
    np.testing.assert_allclose(stderr, np.hypot(parts[0].bsdf_stderr, parts[1].bsdf_stderr), rtol=1e-14)
    assert (stderr > parts[1].bsdf_stderr).any()


def test_one_part_of_it_is_that_part():
    result = make_result()
    bsdf, stderr = reference(result, "reflection/internal")
    np.testing.assert_array_equal(bsdf, result.components["reflection/internal"].bsdf)
    np.testing.assert_allclose(stderr, result.components["reflection/internal"].bsdf_stderr, rtol=1e-15)
