"""The compiled models against naive twins: vectors, complex numbers, one direction at a time."""

import math

import numpy as np
import pytest

from goniosim.models import evaluate_model
from reference.closed_forms import fresnel_conductor, fresnel_dielectric, ggx, smith_g1
from reference.scenes import conductor, dielectric, lambert, make_scene, medium

N = np.array([0.0, 0.0, 1.0])
AIR = 1.0
TAUS = [0.1, 0.4]
BASES = {"lambert": lambert(0.6), "conductor": conductor(1.2, 0.7, 0.15)}
# Two coats: from thin to dense, and with total reflection at the second interface.
COATS = [((1.5, 0.05), (1.3, 0.2)), ((1.3, 0.2), (1.6, 0.1)), ((0.8, 0.1), (1.4, 0.05))]


def _direction(theta_deg, phi_deg):
    t, p = math.radians(theta_deg), math.radians(phi_deg)
    return np.array([math.sin(t) * math.cos(p), math.sin(t) * math.sin(p), math.cos(t)])


def _half(p, q):
    return (p + q) / np.linalg.norm(p + q)


def _refract(w, m, ratio):
    """Upward direction below the interface, or None under total reflection."""
    c = w @ m
    d = 1.0 - ratio**2 * (1.0 - c * c)
    return None if d <= 0.0 else ratio * w + (math.sqrt(d) - ratio * c) * m


def _masking(p, q, alpha, form, correlated):
    h = _half(p, q)
    if form == "vgroove":
        return min(1.0, 2.0 * h[2] * q[2] / (q @ h), 2.0 * h[2] * p[2] / (q @ h))
    g_p, g_q = float(smith_g1(p[2], alpha)), float(smith_g1(q[2], alpha))
    return 1.0 / (1.0 / g_p + 1.0 / g_q - 1.0) if correlated else g_p * g_q


def _lobe(base, p, q, index, alpha, correlated):
    if base["type"] == "lambert":
        return base["rho"] / math.pi
    if p[2] <= 0.0 or q[2] <= 0.0:
        return 0.0
    h = _half(p, q)
    if base["type"] == "dielectric":
        f = fresnel_dielectric(p @ h, base["eta"] / index)
    else:
        f = fresnel_conductor(p @ h, complex(base["eta"], base["kappa"]) / index)
    d = ggx((1.0 - h[2] ** 2) / h[2] ** 2, alpha)
    return float(f * d * _masking(p, q, alpha, "smith", correlated) / (4.0 * p[2] * q[2]))


def _twin(name, faces, l0, v0, options):
    """Internal part by the recursion as it is written down."""
    correlated = options.get("masking") == "correlated"
    running = options.get("ww_recursion") == "running"
    form = options.get("t_masking", "smith")
    index = [AIR, *(face["eta"] for face in faces[:-1])]
    alphas = [face.get("alpha", 0.0) for face in faces]
    if name != "ww09":
        alphas = list(np.maximum.accumulate(alphas))
    total, weight = 0.0, 1.0
    l, v = l0, v0
    before = l0, v0
    for k, face in enumerate(faces):
        pair = (l, v)
        if name == "ww09":
            pair = before if running else (l0, v0)
        if k > 0:
            total += weight * _lobe(face, *pair, index[k], alphas[k], correlated)
        if k == len(faces) - 1:
            return total
        ratio = index[k] / index[k + 1]
        start = (l, v) if name != "ww09" or running else (l0, v0)
        axis = _half(*start) if name == "ww09" else N
        inner = [_refract(w, axis, ratio) for w in start]
        if any(w is None or w[2] <= 0.0 for w in inner):
            return total
        eta = index[k + 1] / index[k]
        if name == "bati19_ww":
            crossing = np.prod([1.0 - fresnel_dielectric(w[2], eta) for w in start]) * ratio**2
        else:
            f = fresnel_dielectric(start[0] @ _half(*start), eta)
            inside = options.get("t_roughness") == "inner" and faces[k + 1]["type"] != "lambert"
            alpha = alphas[k + 1] if inside else alphas[k]
            g = _masking(*(inner if name == "ww09" else start), alpha, form, correlated)
            crossing = (1.0 - f) * ((1.0 - g) + (1.0 - f) * g)
        weight *= crossing * math.exp(-TAUS[k] * (1.0 / inner[0][2] + 1.0 / inner[1][2]))
        before = start
        l, v = inner
    return total


@pytest.mark.parametrize("base", BASES)
@pytest.mark.parametrize("coats", COATS)
@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("ww09", {}),
        ("ww09", {"ww_recursion": "running"}),
        ("ww09", {"t_roughness": "inner", "masking": "correlated"}),
        ("ww09", {"t_masking": "vgroove", "ww_recursion": "running"}),
        ("elek10", {}),
        ("elek10", {"t_roughness": "inner"}),
        ("elek10", {"t_masking": "vgroove"}),
        ("elek10", {"masking": "correlated"}),
        ("bati19_ww", {}),
        ("bati19_ww", {"masking": "correlated"}),
    ],
)
def test_weidlich_wilkie_family_on_three_layers(name, options, coats, base):
    faces = [dielectric(*coats[0])["interface"], dielectric(*coats[1])["interface"], BASES[base]["interface"]]
    layers = [{"interface": faces[0]}, medium(TAUS[0]), {"interface": faces[1]}, medium(TAUS[1]), BASES[base]]
    scene = make_scene(layers, 0)
    generator = np.random.default_rng(11)
    theta_i, theta_o, phi = (generator.uniform(0.0, top, 40) for top in (89.0, 89.0, 360.0))
    found = evaluate_model(name, scene, theta_i, theta_o, phi, "reflection/internal", options)[0]
    expected = [
        _twin(name, faces, _direction(i, 0.0), _direction(o, p), options)
        for i, o, p in zip(theta_i, theta_o, phi, strict=True)
    ]
    assert np.count_nonzero(expected) > 5
    assert found == pytest.approx(expected, rel=1e-9, abs=1e-15)


def test_absolute_index_of_a_conductor():
    layers = [dielectric(1.5, 0.05), conductor(1.2, 0.7, 0.15)]
    same = [dielectric(1.5, 0.05), conductor(1.2 * 1.5, 0.7 * 1.5, 0.15)]
    for name in ("ww09", "elek10", "bati19_ww"):
        options = {"conductor_index": "absolute"}
        absolute = evaluate_model(name, make_scene(layers, 0), 30, 40, 170, options=options)
        assert absolute == pytest.approx(evaluate_model(name, make_scene(same, 0), 30, 40, 170), rel=1e-12)


def test_transmission_lobe_points_straight_through():
    """Air below: the transmitted lobe is a reflection lobe about n, seen in the mirrored exit hemisphere."""
    from goniosim.models.belcour.lobes import Options, statistics

    scene = make_scene([dielectric(1.5, 0.2), medium([0.1, 0.2, 0.8]), dielectric(1.0, 0.1)], 0)
    theta, view = 50.0, _direction(40.0, 160.0)
    _, _, _, transmission = statistics(scene, math.cos(math.radians(theta)), Options())
    light = _direction(theta, 0.0)
    h = _half(light, view)
    alpha = transmission[3]
    lobe = ggx((1.0 - h[2] ** 2) / h[2] ** 2, alpha) * _masking(light, view, alpha, "smith", False)
    lobe /= 4.0 * light[2] * view[2]
    found = evaluate_model("belcour18_forward", scene, theta, 40.0, 160.0, "transmission")
    assert found == pytest.approx(transmission[:3] * lobe, rel=1e-12)


def test_transmission_into_a_dense_medium_follows_snell():
    """The peak of a narrow lobe stands in the refracted direction."""
    scene = make_scene([dielectric(1.5, 0.01)], 0)
    theta_o = np.linspace(20.0, 50.0, 3001)
    values = evaluate_model("belcour18_forward", scene, 50.0, theta_o, 180.0, "transmission")[0]
    snell = math.degrees(math.asin(math.sin(math.radians(50.0)) / 1.5))
    assert theta_o[values.argmax()] == pytest.approx(snell, abs=0.02)
