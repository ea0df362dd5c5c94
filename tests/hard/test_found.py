"""What the laws of `tests/laws` have found among random scenes."""

import threading

import numpy as np
import pytest

from goniosim.engine import simulate
from goniosim.engine.estimators.split import Split
from goniosim.engine.splitting.effort import ROUNDS
from goniosim.errors import ConfigError
from goniosim.slices import slice_geometry
from reference.closed_forms import fresnel_dielectric
from reference.replicates import keys, make_replicates, prepared, totals
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


def alternating(count, low, high):
    """Smooth interfaces above a white base, with nothing that absorbs: all light leaves upwards again."""
    return [dielectric(low if number % 2 else high) for number in range(count)] + [lambert(1.0)]


def test_fifteen_interfaces_that_branch_for_ever():
    """Each branch is another ray to follow, over and over: a replicate of the split walk never ended."""
    layers = alternating(15, 0.5, 2.0)
    plan, split = prepared(Split, make_scene(layers, 1e-9, rows=6, columns=12))
    out = np.empty((1, 1, plan.n_distinct, plan.rows, plan.width))
    events = split.workspace().run(0, 256, keys(3, 1), out, threading.Event())
    assert events < ROUNDS * (2 * len(layers) + 1) * 256
    assert split.effort.crowds[0] == -1


@pytest.mark.slow
@pytest.mark.false_alarm(3e-6)
def test_light_whose_end_is_out_of_sight_is_not_called_dark():
    """One photon in 10^4 that the base scatters gets out again. Paths were so few that none was left, and no error.

    What is inside at the event cap is lost, and told by the audit. The mean of 32 replicates lies between all that
    leaves and that without what the audit loses, within 5.7 standard errors: by Student's t of 31 degrees of freedom
    a false alarm in 3e-6.
    """
    scene = make_scene(alternating(3, 0.1, 10.0), 0.0, rows=6, columns=12)
    plan, split = prepared(Split, scene)
    found = totals(plan, make_replicates(plan, split, 1024, seed=1))[:, 0]
    audit = simulate(scene, rays=20_000, estimator="analog", seed=1).audit
    leaves = 1.0 - fresnel_dielectric(1.0, 10.0)
    lost, of_lost = (getattr(audit, name)["lost_event_cap"][0, 0] for name in ("energy", "stderr"))
    error = found.std(ddof=1) / np.sqrt(len(found))
    assert found.min() > 0.0
    assert leaves - lost - 5.7 * np.hypot(error, of_lost) < found.mean() < leaves + 5.7 * error


def test_operators_follow_what_little_enters():
    """Next to the horizon every ray was faint: the few that lived on were missed, and half of the light with them.

    What leaves is as little as what enters, and nearly as its cosine; two albedos with errors of .1 % agree to 1 %.
    """
    scene = make_scene([dielectric(1.5), conductor(0.2, 3.9, 0.1)], [89.99, 89.9999999], rows=9, columns=18)
    found = simulate(scene, rays=1 << 17, estimator="operator", seed=1).components["reflection/internal"]
    over_cosine = found.albedo[:, 0] / np.cos(np.radians(scene.incident.theta_deg))
    assert over_cosine[1] == pytest.approx(over_cosine[0], rel=0.01)
