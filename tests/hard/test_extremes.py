"""Numerically hard scenes: everything stays finite, in range, and accounted for."""

import numpy as np
import pytest

from goniosim.engine import simulate
from reference import exact_fresnel
from reference.scenes import conductor, dielectric, lambert, make_scene, medium

THETAS = [0, 1e-6, 45, 89, 89.99]
RAYS = 20_000

COAT = dielectric(1.5, 0.2)
SCENES = {
    "alpha 1e-6": [dielectric(1.5, 1e-6), medium(0.1), conductor(1.45, 1.0, 1e-6)],
    "alpha 1": [dielectric(1.5, 1.0), medium(0.1), conductor(1.45, 1.0, 1.0)],
    "alpha 1 slab": [dielectric(1.5, 1.0), medium(0.1), dielectric(1.0, 1.0)],
    "alpha 1e-6 slab": [dielectric(1.5, 1e-6), medium(0.1), dielectric(1.0, 1e-6)],
    "indices nearly equal": [dielectric(1.0 + 1e-9, 0.2), dielectric(1.0, 0.2)],
    "indices equal": [dielectric(1.0, 0.2), dielectric(1.0), lambert(1.0)],
    "index 10": [dielectric(10.0, 0.2), medium(0.01), dielectric(1.0, 0.2)],
    "index 0.1": [dielectric(0.1, 0.2), medium(0.01), dielectric(1.0, 0.2)],
    "index 10 over white": [dielectric(10.0), lambert(1.0)],
    "kappa huge": [COAT, conductor(0.05, 1e6, 0.2)],
    "kappa 0": [COAT, conductor(1.0, 0.0, 0.2)],
    "matched conductor": [COAT, conductor(1.5, 0.0, 0.2)],
    "matched smooth conductor": [dielectric(1.5), conductor(1.5, 0.0)],
    "tau 50": [COAT, medium(50.0), dielectric(1.0, 0.2)],
    "tau 700": [COAT, medium([0.0, 50.0, 700.0]), dielectric(1.0, 0.2)],
    "tau 700 in all channels": [COAT, medium(700.0), lambert(1.0)],
    "tau tiny": [COAT, medium(1e-300), lambert(1.0)],
    "rho 0": [COAT, lambert(0.0)],
    "rho 1": [COAT, lambert(1.0)],
    "rho 0 and 1": [COAT, lambert([0.0, 1.0, 0.5])],
    "ten interfaces": [dielectric(1.5 if k % 2 == 0 else 1.0, 0.1) for k in range(10)],
    "ten smooth interfaces": [dielectric(1.9 if k % 2 == 0 else 1.0) for k in range(10)],
    "bare Lambertian": [lambert(0.5)],
    "bare smooth interface": [dielectric(1.5)],
    "bare rough interface": [dielectric(1.5, 0.2)],
}


@pytest.mark.parametrize("parametrization", ["classic", "half"])
@pytest.mark.parametrize("name", SCENES)
def test_everything_is_finite_and_accounted_for(name, parametrization):
    result = simulate(make_scene(SCENES[name], THETAS, parametrization, 30, 60, orders=2), rays=RAYS, seed=1)
    for array in arrays_of(result):
        assert np.isfinite(array).all()
    for component in result.components.values():
        assert (component.energy >= 0.0).all()
        assert (component.stderr >= 0.0).all()
        assert (component.bsdf >= 0.0).all()
        assert (component.energy.sum(axis=(2, 3)) <= 1.0 + 1e-9).all()
    audit = result.audit
    assert np.abs(audit.residual).max() < 1e-12
    for entry, energy in audit.energy.items():
        # An entry may be the difference of two sums: zero to rounding.
        assert entry == "lost_roulette" or (energy >= -1e-15).all(), entry


def arrays_of(result):
    for component in result.components.values():
        for part in (component, *component.orders.values()):
            yield from (part.energy, part.stderr, part.bsdf, part.bsdf_stderr)
    yield from result.audit.energy.values()
    yield from result.audit.stderr.values()
    yield from (result.audit.direct_integrated, result.audit.direct_integrated_stderr)
    yield from (result.cells.solid_angle, result.cells.projected_solid_angle)
    yield from result.cost.error.values()


def total(name, *entries):
    audit = simulate(make_scene(SCENES[name], THETAS, rows=9, columns=9), rays=RAYS, seed=2).audit.energy
    return sum(audit[entry] for entry in entries)


def test_nothing_comes_through_an_opaque_medium():
    assert total("tau 50", "transmitted").max() < 1e-20
    assert not total("tau 700 in all channels", "reflected_internal").any()


def test_black_base():
    assert not total("rho 0", "reflected_internal").any()


def test_perfect_mirror_below_a_rough_coat_absorbs_nothing():
    assert total("kappa huge", "absorbed_base").max() < 1e-6


def test_a_good_mirror_absorbs_to_the_last_digit():
    """1 - R of kappa 1e6 is 4e-12 at normal incidence; the difference of the weights would know it to 1e-4."""
    audit = simulate(make_scene([conductor(1.0, 1e6)], THETAS, rows=9, columns=9), rays=1000).audit
    for theta, absorbed in zip(THETAS, audit.energy["absorbed_base"][:, 0], strict=True):
        _, exact = exact_fresnel.conductor(np.cos(np.radians(theta)), 1.0, 1e6)
        assert absorbed == pytest.approx(float(exact), rel=1e-12)


def test_matched_conductor_reflects_nothing():
    """An index-matched conductor without extinction is a black base."""
    assert total("matched smooth conductor", "reflected_internal").max() < 1e-12


def test_white_base_below_index_10():
    """Long paths: every ray comes out in the end."""
    reflected = total("index 10 over white", "reflected_direct", "reflected_internal")
    np.testing.assert_allclose(reflected, 1.0, rtol=0, atol=1e-12)


def test_nearly_equal_indices_do_not_deflect():
    """Straight through except for what the masking of the facets loses."""
    lost = total("indices nearly equal", "lost_masked_transmission", "lost_masked_reflection")
    through = total("indices nearly equal", "transmitted")
    np.testing.assert_allclose(through[:3] + lost[:3], 1.0, rtol=0, atol=1e-9)
    assert (through[:3] > 0.9).all()


@pytest.mark.false_alarm(5.2e-6, seeds=(3, 103))
@pytest.mark.parametrize("theta", [1e-6, 1e-3])
def test_almost_normal_incidence_is_normal_incidence(theta, seed):
    """No jump between theta = 0, where the azimuth is undefined, and just beside it.

    Differences of two runs of 2e6 paths each at 5 sigma, largest of 9 rows: false alarm 5e-6.
    """
    layers = [dielectric(1.5, 0.2), medium(0.1), conductor(1.45, 1.0, 0.2)]
    scene = make_scene(layers, [0, theta], rows=9, columns=1)
    internal = simulate(scene, rays=2_000_000, seed=seed, estimator="analog").components["reflection/internal"]
    difference = internal.energy[0, 0] - internal.energy[1, 0]
    error = np.hypot(internal.stderr[0, 0], internal.stderr[1, 0])
    assert (np.abs(difference) < 5.0 * error).all()


def test_orders_of_a_single_interface():
    """With one interface every path meets the top once: there is nothing to decompose."""
    result = simulate(make_scene([dielectric(1.5, 0.2)], 30, orders=3), rays=RAYS)
    through = result.components["transmission"]
    split = sum(part.energy for part in through.orders.values())
    np.testing.assert_allclose(split, through.energy, rtol=1e-12, atol=0)
