"""Published models against numbers of an independent implementation, to the digits printed there."""

import math

import pytest

from goniosim.models import evaluate_model
from goniosim.models.belcour.lobes import Options, statistics
from reference.scenes import conductor, dielectric, lambert, make_scene, medium


def _statistics(layers, theta_deg, scale="paper", jacobian="published"):
    options = Options(fgd="fresnel", refraction_scale=scale, jacobian=jacobian)
    energy, alpha, reflection, transmission = statistics(
        make_scene(layers, theta_deg), math.cos(math.radians(theta_deg)), options
    )
    return energy[:, 0], alpha, reflection[[0, 3]], transmission[[0, 3]]


def _digits(places):
    return {"rel": 0.0, "abs": 0.5000001 * 10.0**-places}


@pytest.mark.parametrize(
    ("theta", "alpha0", "alpha1", "tau", "scale", "first", "second"),
    [
        (0, 0.05, 0.2, 0.0, "paper", (0.04, 0.05), (0.095618, 0.278854)),
        (0, 0.05, 0.2, 0.0, "normal", (0.04, 0.05), (0.095618, 0.278854)),
        (0, 0.2, 0.001, 0.5, "paper", (0.04, 0.2), (0.035084, 0.090028)),
        (0, 0.2, 0.001, 0.5, "normal", (0.04, 0.2), (0.035084, 0.090028)),
        (60, 0.05, 0.2, 0.0, "paper", (0.089187, 0.05), (0.096811, 0.393842)),
        (60, 0.05, 0.2, 0.0, "normal", (0.089187, 0.05), (0.096811, 0.381329)),
        (60, 0.2, 0.001, 0.5, "paper", (0.089187, 0.2), (0.028239, 0.233404)),
        (60, 0.2, 0.001, 0.5, "normal", (0.089187, 0.2), (0.028239, 0.113763)),
    ],
)
def test_lobes_of_metals(theta, alpha0, alpha1, tau, scale, first, second):
    layers = [dielectric(1.5, alpha0), medium(tau), conductor(1.45, 1.0, alpha1)]
    energy, alpha, _, _ = _statistics(layers, theta, scale)
    assert [energy[0], alpha[0], energy[1], alpha[1]] == pytest.approx([*first, *second], **_digits(6))


@pytest.mark.parametrize(
    ("theta", "alpha0", "alpha1", "tau", "scale", "jacobian", "expected"),
    [
        (0, 0.05, 0.2, 0.0, "paper", "published", (0.076923, 0.923077, 0.177618, 0.054199)),
        (0, 0.05, 0.2, 0.0, "normal", "published", (0.076923, 0.923077, 0.177618, 0.054199)),
        (0, 0.05, 0.2, 0.0, "paper", "snell", (0.076923, 0.923077, 0.177618, 0.059361)),
        (0, 0.001, 0.2, 0.5, "paper", "published", (0.053569, 0.559308, 0.092309, 0.050145)),
        (60, 0.05, 0.2, 0.0, "paper", "published", (0.163768, 0.836232, 0.248054, 0.149029)),
        (60, 0.05, 0.2, 0.0, "normal", "published", (0.163768, 0.836232, 0.239201, 0.053297)),
        (60, 0.05, 0.2, 0.0, "paper", "snell", (0.163768, 0.836232, 0.248054, 0.168774)),
        (60, 0.001, 0.2, 0.5, "paper", "published", (0.110978, 0.450739, 0.112553, 0.145163)),
    ],
)
def test_reflection_and_transmission_of_slabs(theta, alpha0, alpha1, tau, scale, jacobian, expected):
    layers = [dielectric(1.5, alpha0), medium(tau), dielectric(1.0, alpha1)]
    _, _, reflection, transmission = _statistics(layers, theta, scale, jacobian)
    found = [reflection[0], transmission[0], reflection[1], transmission[1]]
    assert found == pytest.approx(expected, **_digits(6))


_THREE = [dielectric(1.5, 0.05), medium(0.1), dielectric(1.3, 0.1), medium(0.2)]


@pytest.mark.parametrize(
    ("theta", "jacobian", "energies", "alphas", "reflection"),
    [
        (0, "published", (0.04, 0.00385, 0.070013), (0.05, 0.153124, 0.257988), (0.113863, 0.194107)),
        (0, "snell", (0.04, 0.00385, 0.070013), (0.05, 0.153124, 0.261340), (0.113863, 0.196575)),
        (40, "published", (0.045734, 0.003992, 0.066854), (0.05, 0.179541, 0.286352), (0.11658, 0.207203)),
        (40, "snell", (0.045734, 0.003992, 0.066854), (0.05, 0.179541, 0.292119), (0.11658, 0.211357)),
    ],
)
def test_lobes_of_a_metal_under_two_coats(theta, jacobian, energies, alphas, reflection):
    energy, alpha, total, _ = _statistics([*_THREE, conductor(1.2, 1.0, 0.2)], theta, jacobian=jacobian)
    assert energy == pytest.approx(energies, **_digits(6))
    assert alpha == pytest.approx(alphas, **_digits(6))
    assert total == pytest.approx(reflection, **_digits(6))


@pytest.mark.parametrize(
    ("theta", "jacobian", "expected"),
    [
        (0, "published", (0.052374, 0.695933, 0.100927, 0.038740)),
        (0, "snell", (0.052374, 0.695933, 0.101768, 0.046840)),
        (40, "published", (0.059178, 0.661486, 0.108886, 0.056911)),
        (40, "snell", (0.059178, 0.661486, 0.110399, 0.071610)),
    ],
)
def test_slab_of_two_plates(theta, jacobian, expected):
    _, _, reflection, transmission = _statistics([*_THREE, dielectric(1.0, 0.2)], theta, jacobian=jacobian)
    found = [reflection[0], transmission[0], reflection[1], transmission[1]]
    assert found == pytest.approx(expected, **_digits(6))


@pytest.mark.parametrize(
    ("angles", "base", "expected"),
    [
        ((30, 40, 170), lambert(0.5), (6.900026e-02, 7.583280e-02, 7.607942e-02, 3.376744e-02)),
        ((30, 40, 170), conductor(1.45, 1.0, 0.2), (6.900026e-02, 1.009612e-01, 9.771772e-02, 4.337149e-02)),
        ((60, 20, 60), lambert(0.5), (1.322643e-04, 6.491692e-02, 7.452287e-02, 3.146549e-02)),
        ((60, 20, 60), conductor(1.45, 1.0, 0.2), (1.322643e-04, 1.928660e-03, 6.434422e-03, 2.716780e-03)),
    ],
)
def test_weidlich_wilkie_family(angles, base, expected):
    scene = make_scene([dielectric(1.5, 0.05), medium(0.3), base], 30)
    names = ("ww09", "elek10", "bati19_ww")
    direct = [evaluate_model(name, scene, *angles, component="reflection/direct")[0] for name in names]
    internal = [evaluate_model(name, scene, *angles, component="reflection/internal")[0] for name in names]
    assert direct == pytest.approx([expected[0]] * 3, rel=6e-7)
    assert internal == pytest.approx(expected[1:], rel=6e-7)
