"""Totals of stacks that have a closed form, at 5 sigma of the number of rays."""

import math

import numpy as np
import pytest

from goniosim.engine import simulate
from reference import closed_forms
from reference.scenes import conductor, dielectric, lambert, make_scene, medium

THETAS = [0, 30, 60, 85, 89]
RAYS = 400_000


def cosines():
    return [math.cos(math.radians(theta)) for theta in THETAS]


def assert_energies(found, exact, rays=RAYS):
    """A path carries at most weight 1: the second moment of its deposit is at most the mean.

    5 sigma: a false alarm in 6e-7 of all comparisons.
    """
    found, exact = np.asarray(found), np.asarray(exact)
    error = np.sqrt(exact * (1.0 - exact) / rays) + 1.0 / rays
    assert (np.abs(found - exact) < 5.0 * error).all()


@pytest.mark.false_alarm(6e-6, seeds=(1, 101))
@pytest.mark.parametrize("tau", [0.0, 0.5])
@pytest.mark.parametrize("eta, kappa", [(1.9, 1.0), (1.45, 1.0), (1.2, 1.0), (1.9, 0.01), (1.2, 0.01)])
def test_smooth_metal(eta, kappa, tau, seed):
    layers = [dielectric(1.5), medium(tau), conductor(eta, kappa)]
    audit = simulate(make_scene(layers, THETAS, rows=9, columns=9), rays=RAYS, seed=seed).audit
    direct, internal = zip(*(closed_forms.smooth_metal(c, 1.5, eta, kappa, tau) for c in cosines()), strict=True)
    assert_energies(audit.energy["reflected_internal"][:, 0], internal)
    assert_energies(audit.energy["reflected_direct"][:, 0], direct)
    np.testing.assert_allclose(audit.direct_integrated[:, 0], direct, rtol=1e-12)


@pytest.mark.false_alarm(1.5e-5, seeds=(2, 102))
@pytest.mark.parametrize("tau", [0.0, 0.5])
@pytest.mark.parametrize("estimator", ["analog", "split"])
def test_smooth_slab_and_its_orders(tau, estimator, seed):
    layers = [dielectric(1.5), medium(tau), dielectric(1.0)]
    scene = make_scene(layers, THETAS, rows=9, columns=9, orders=4)
    result = simulate(scene, rays=RAYS, seed=seed, estimator=estimator)
    exact = [closed_forms.smooth_slab(c, 1.5, tau) for c in cosines()]
    audit = result.audit.energy
    for entry, values in zip(
        ("reflected_direct", "reflected_internal", "transmitted"), zip(*exact, strict=True), strict=True
    ):
        assert_energies(audit[entry][:, 0], values)
    internal = result.components["reflection/internal"]
    by_order = [closed_forms.smooth_slab_orders(c, 1.5, 3, tau) for c in cosines()]
    for number in (2, 3):
        energy = internal.orders[f"order_{number}"].energy[:, 0].sum(axis=(1, 2))
        assert_energies(energy, [orders[number - 1] for orders in by_order])
    split = sum(part.energy for part in internal.orders.values())
    np.testing.assert_allclose(split, internal.energy, rtol=1e-12, atol=1e-18)


@pytest.mark.false_alarm(3e-6, seeds=(3, 103))
@pytest.mark.parametrize("rho, tau", [(1.0, 0.0), (0.5, 0.0), (1.0, 0.5), (0.5, 0.5), (0.5, 1.0)])
def test_saunderson_plastic(rho, tau, seed):
    layers = [dielectric(1.5), medium(tau), lambert(rho)]
    audit = simulate(make_scene(layers, THETAS, rows=9, columns=9), rays=RAYS, seed=seed).audit
    exact = [closed_forms.plastic_albedo(c, 1.5, rho, tau) for c in cosines()]
    assert_energies(audit.energy["reflected_internal"][:, 0], exact)


@pytest.mark.parametrize("eta", [1.0, 1.33, 1.5, 2.4])
def test_white_furnace(eta):
    """A smooth coat without absorption over a white base reflects everything, path by path."""
    audit = simulate(make_scene([dielectric(eta), lambert(1.0)], THETAS), rays=RAYS, seed=4).audit
    reflected = audit.energy["reflected_direct"] + audit.energy["reflected_internal"]
    np.testing.assert_allclose(reflected, 1.0, rtol=0, atol=1e-12)


@pytest.mark.false_alarm(6e-7, seeds=(5, 105))
def test_white_ggx_at_normal_incidence(seed):
    """Albedo 1 - ln 2 of a lossless conductor of alpha = 1, sampled and integrated."""
    audit = simulate(make_scene([conductor(1.0, 1e6, 1.0)], 0), rays=RAYS, seed=seed).audit
    exact = closed_forms.WHITE_GGX_ALPHA_1_NORMAL
    # 1 - F is 4 / kappa^2 * eta at most; it does not show.
    assert_energies(audit.energy["reflected_direct"][0, 0], exact)
    assert audit.direct_integrated[0, 0] == pytest.approx(exact, abs=2e-5)


@pytest.mark.false_alarm(9e-6, seeds=(6, 106))
def test_chromatic_channels_follow_their_own_closed_forms(seed):
    tau, kappa = [0.05, 0.1, 0.8], [1.0, 0.01, 0.3]
    layers = [dielectric(1.5), medium(tau), conductor(1.45, kappa)]
    audit = simulate(make_scene(layers, THETAS, rows=9, columns=9), rays=RAYS, seed=seed).audit
    for channel in range(3):
        exact = [closed_forms.smooth_metal(c, 1.5, 1.45, kappa[channel], tau[channel])[1] for c in cosines()]
        assert_energies(audit.energy["reflected_internal"][:, channel], exact)


@pytest.mark.false_alarm(3e-6, seeds=(7, 107))
def test_media_in_a_row_add_up(seed):
    layers = [dielectric(1.5), medium(0.2), medium(0.3), dielectric(1.0)]
    audit = simulate(make_scene(layers, THETAS, rows=9, columns=9), rays=RAYS, seed=seed).audit
    exact = [closed_forms.smooth_slab(c, 1.5, 0.5)[2] for c in cosines()]
    assert_energies(audit.energy["transmitted"][:, 0], exact)
