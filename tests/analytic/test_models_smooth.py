"""Dirac lobes of the models: smooth interfaces alone make them, and their energies are exact where the model is."""

import math

import numpy as np
import pytest

import goniosim
from goniosim.models import MODELS, prepare
from reference.closed_forms import fresnel_dielectric, smooth_metal, smooth_slab
from reference.scenes import conductor, dielectric, make_scene, medium

AFTER_BELCOUR = ("belcour18_forward", "belcour18_symmetric", "bati19_belcour")
SOMEWHERE = np.array([[0.1, 0.0], [0.2, 0.0], [math.sqrt(0.95), 1.0]])


@pytest.mark.parametrize("name", AFTER_BELCOUR)
@pytest.mark.parametrize(
    ("eta", "kappa", "at_0", "at_60"),
    [
        (1.9, 1.0, 0.12543, 0.17239),
        (1.45, 1.0, 0.13562, 0.18600),
        (1.2, 1.0, 0.16182, 0.21569),
        (1.9, 0.01, 0.05277, 0.10215),
        (1.45, 0.01, 0.04028, 0.08950),
        (1.2, 0.01, 0.05140, 0.10483),
    ],
)
def test_smooth_metals_have_their_exact_totals(name, eta, kappa, at_0, at_60):
    """The energies to rounding, in each component; the totals also as printed elsewhere."""
    scene = make_scene([dielectric(1.5), conductor(eta, kappa)], 0)
    for theta, total in ((0.0, at_0), (60.0, at_60)):
        exact = smooth_metal(math.cos(math.radians(theta)), 1.5, eta, kappa)
        for component, energy in zip(("reflection/direct", "reflection/internal"), exact, strict=True):
            prepared = prepare(name, scene, theta, component)
            assert prepared.mirror_energy == pytest.approx([energy], rel=1e-11)
            assert not prepared.evaluate(*SOMEWHERE).any()
        assert prepare(name, scene, theta).mirror_energy[0] == pytest.approx(total, abs=6e-6)


@pytest.mark.parametrize("theta", [0.0, 60.0, 85.0])
@pytest.mark.parametrize("options", [{}, {"fgd": "exact"}, {"jacobian": "snell"}, {"normalise_lobes": True}])
def test_a_window_pane_has_its_exact_energies(theta, options):
    scene = make_scene([dielectric(1.5), medium(0.1), dielectric(1.0)], 0)
    direct, internal, through = smooth_slab(math.cos(math.radians(theta)), 1.5, 0.1)
    for component, energy in (("reflection", direct + internal), ("transmission", through)):
        prepared = prepare("belcour18_forward", scene, theta, component, options)
        assert prepared.mirror_energy == pytest.approx([energy], rel=1e-11)
        assert not prepared.evaluate(*SOMEWHERE).any()


@pytest.mark.false_alarm(2e-5, seeds=(1, 101))
@pytest.mark.parametrize("parametrization", ["classic", "half"])
@pytest.mark.parametrize(
    "layers",
    [
        [dielectric(1.5), medium([0.1, 0.2, 0.5]), dielectric(1.0)],
        [dielectric(1.5), medium(0.1), dielectric(1.3)],
        [dielectric(1.5), medium([0.1, 0.2, 0.5]), conductor(1.45, [1.0, 0.1, 0.01])],
    ],
    ids=["pane", "into water", "metal"],
)
def test_the_comparison_finds_no_error_where_the_model_is_exact(layers, parametrization, seed):
    """All energy in the very cell of the simulation, and right within 5 standard errors.

    Up to 36 deviations of a case, few of them independent: false alarm below 2e-5.
    """
    scene = make_scene(layers, [0.0, 20.5, 60.0, 80.0], parametrization, rays=50_000)
    (material,) = goniosim.compare(goniosim.simulate(scene, seed=seed), models=list(AFTER_BELCOUR)).materials
    assert material.compared
    for found in material.compared:
        label, component = found.variant.label, found.component
        model = material.bsdf(label, component)
        reference, stderr = material.reference(component)
        assert (np.count_nonzero(model, axis=(2, 3)) == 1).all()
        assert ((model > 0.0) == (reference > 0.0)).all()
        assert (np.abs(model - reference) <= 5.0 * stderr + 1e-12 * reference).all()
        assert found.measures.squared == pytest.approx(found.converged.squared, rel=1e-12)
    assert all(part.contains_delta for part in material.slices.values())


@pytest.mark.parametrize("name", AFTER_BELCOUR)
def test_smooth_above_rough_mixes_both(name):
    """Two smooth interfaces over a rough base: two Dirac lobes, and a third one with values."""
    layers = [dielectric(1.5), medium(0.1), dielectric(1.3), conductor(1.45, 1.0, 0.2)]
    smooth = [dielectric(1.5), medium(0.1), dielectric(1.3), conductor(1.45, 1.0)]
    mixed, all_smooth = make_scene(layers, 0), make_scene(smooth, 0)
    c = math.cos(math.radians(50.0))
    found = prepare(name, mixed, 50.0)
    direct, inner, inside = fresnel_dielectric(c, 1.5), *_inner_reflection(c)
    assert found.mirror_energy == pytest.approx([direct + inner], rel=1e-11)
    assert (found.evaluate(*SOMEWHERE) > 0.0).all()
    assert prepare(name, all_smooth, 50.0).mirror_energy[0] > found.mirror_energy[0]
    assert prepare(name, mixed, 50.0, "reflection/internal").mirror_energy == pytest.approx([inner], rel=1e-11)
    assert 0.0 < inside < 1.0


def _inner_reflection(c):
    """What the interface from 1.5 to 1.3 adds, echoes with the top included; and the cosine in the coat."""
    inside = math.sqrt(1.0 - (1.0 - c * c) / 2.25)
    r, r_2 = fresnel_dielectric(c, 1.5), fresnel_dielectric(inside, 1.3 / 1.5)
    a2 = math.exp(-0.2 / inside)
    return (1.0 - r) ** 2 * r_2 * a2 / (1.0 - r * r_2 * a2), inside


@pytest.mark.parametrize("name", AFTER_BELCOUR)
def test_rough_above_smooth_leaves_no_dirac_lobe(name):
    """The beam is already blurred where it meets the mirror."""
    scene = make_scene([dielectric(1.5, 0.1), conductor(1.45, 1.0)], 0)
    assert not prepare(name, scene, 50.0).mirror_energy.any()
    assert (prepare(name, scene, 50.0, "reflection/internal").evaluate(*SOMEWHERE) > 0.0).all()


def _albedo(prepared, theta_deg, alpha):
    """Energy of a narrow lobe about the mirror direction, by midpoints in t^2 / (1 + t^2), t = tan(theta_h) / alpha."""
    n = 400
    u = (np.arange(n) + 0.5) / n
    tan = alpha * np.sqrt(u / (1.0 - u))
    cosine = 1.0 / np.sqrt(1.0 + tan * tan)
    phi = 2.0 * math.pi * (np.arange(n) + 0.5) / n
    sine = tan * cosine
    h = np.stack([np.outer(sine, np.cos(phi)), np.outer(sine, np.sin(phi)), np.outer(cosine, np.ones(n))])
    l = np.array([math.sin(math.radians(theta_deg)), 0.0, math.cos(math.radians(theta_deg))])
    facet = np.tensordot(l, h, 1)
    v = 2.0 * facet * h - l[:, None, None]
    # tan dtan / cosine^-3 is the solid angle; alpha^2 du = 2 tan dtan (1 - u)^2
    weight = (
        alpha**2 * cosine[:, None] ** 3 / (2.0 * (1.0 - u[:, None]) ** 2) * 4.0 * facet * v[2] * 2.0 * math.pi / n**2
    )
    seen = (v[2] > 0.0) & (facet > 0.0)
    return float(prepared.evaluate(*v[:, seen])[0] @ weight[seen])


@pytest.mark.parametrize("name", ["ww09", "elek10", "bati19_ww"])
@pytest.mark.parametrize("theta", [0.0, 50.0])
def test_a_smooth_base_is_the_limit_of_a_narrow_one(name, theta):
    """Under a rough coat: Dirac in ww09; as rough as the coat in the others, which have no Dirac lobe then."""
    smooth, narrow = (make_scene([dielectric(1.5, 0.2), medium(0.1), conductor(1.45, 1.0, a)], 0) for a in (0.0, 1e-4))
    found = prepare(name, smooth, theta, "reflection/internal")
    limit = prepare(name, narrow, theta, "reflection/internal")
    if name == "ww09":
        assert not found.evaluate(*SOMEWHERE).any()
        assert found.mirror_energy[0] == pytest.approx(_albedo(limit, theta, 1e-4), rel=1e-2)
    else:
        assert not found.mirror_energy.any()
        np.testing.assert_array_equal(found.evaluate(*SOMEWHERE), limit.evaluate(*SOMEWHERE))


@pytest.mark.parametrize("name", ["elek10", "bati19_ww"])
@pytest.mark.parametrize("theta", [0.0, 50.0])
def test_a_smooth_stack_is_the_limit_of_a_narrow_one(name, theta):
    """Refraction compresses the lobe in solid angle: the Dirac energy must follow."""
    smooth, narrow = (make_scene([dielectric(1.5, a), medium(0.1), conductor(1.45, 1.0, a)], 0) for a in (0.0, 1e-4))
    for component in ("reflection/direct", "reflection/internal"):
        energy = prepare(name, smooth, theta, component).mirror_energy[0]
        assert energy == pytest.approx(_albedo(prepare(name, narrow, theta, component), theta, 2e-4), rel=1e-2)


def test_every_model_names_its_dirac_lobes_alike():
    scene = make_scene([dielectric(1.5), conductor(1.45, 1.0, 0.2)], 0)
    energies = [prepare(name, scene, 30.0, "reflection/direct").mirror_energy[0] for name in MODELS]
    assert energies == pytest.approx([float(fresnel_dielectric(math.cos(math.radians(30.0)), 1.5))] * 6, rel=1e-12)
