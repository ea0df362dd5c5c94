"""Reflection and transmission of a rough surface."""

import numpy as np

from goniosim._jit import kernel
from goniosim.optics.microfacet import microfacet_reflection, microfacet_transmission

from .. import grids
from ..case import Case
from ..exact import microfacet as exact


@kernel
def _reflection(p, out):
    for i in range(p.shape[1]):
        out[0, i], out[1, i] = microfacet_reflection(p[0, i], p[1, i], p[2, i], p[3, i], p[4, i], p[5, i], p[6, i])


@kernel
def _transmission(p, out):
    for i in range(p.shape[1]):
        value, cosine = microfacet_transmission(p[0, i], p[1, i], p[2, i], p[3, i], p[4, i], p[5, i], p[6, i], p[7, i])
        out[0, i] = value
        # Where no facet connects the directions, the cosine means nothing.
        out[1, i] = cosine if value > 0.0 else 0.0


def _direction(cosine, phi):
    sine = np.sqrt((1.0 - cosine) * (1.0 + cosine))
    return [sine * np.cos(phi), sine * np.sin(phi), cosine]


def _heights(dense):
    return grids.cosines(dense)[:: 4 if dense else 3]


def _offsets(dense):
    """Of azimuths from the plane of incidence."""
    return np.concatenate([[0.0], grids.logarithmic(1e-9, 0.5, 7 if dense else 2), [2.0, 3.0]])


def _pairs(dense):
    """Any two directions, and such as are next to each other's mirror image: where a narrow lobe is bright."""
    z_l, z_v, phi, alpha = grids.product(_heights(dense), _heights(dense), _offsets(dense), grids.widths(dense)[::4])
    theta, shift, sign, phi_near, width = grids.product(
        np.radians([0.0, 1e-3, 30.0, 60.0, 89.0, 89.99]),
        grids.logarithmic(1e-12, 1e-2, 11 if dense else 3),
        [-1.0, 1.0],
        [0.0, 1e-6],
        grids.widths(dense)[::4],
    )
    steep = np.cos(np.clip(theta + sign * shift, 0.0, np.radians(89.999)))
    light = _direction(np.append(z_l, np.cos(theta)), 0.0)
    view = _direction(np.append(z_v, steep), np.pi - np.append(phi, phi_near))
    return np.stack([*light, *view, np.append(alpha, width)])


def _through(dense):
    """Directions to a light below and to a viewer above, and such as are next to straight refraction."""
    eta = np.array([0.4, 1.0 / 1.5, 0.99, 1.0 + 1e-6, 1.33, 1.5, 2.4])[:: 1 if dense else 3]
    z_b, z_v, phi, alpha, index = grids.product(
        _heights(dense)[::2], _heights(dense)[::2], _offsets(dense)[::2], grids.widths(dense)[::8], eta
    )
    # eta sin(b) = sin(v); the smaller angle is given, so that both exist.
    theta, shift, sign, width, near = grids.product(
        np.radians([0.0, 1e-3, 30.0, 60.0, 89.0, 89.99]),
        grids.logarithmic(1e-12, 1e-2, 11 if dense else 3),
        [-1.0, 1.0],
        grids.widths(dense)[::4],
        eta,
    )
    inside = np.arcsin(np.sin(theta) * np.where(near > 1.0, 1.0 / near, near))
    b, v = np.where(near > 1.0, inside, theta), np.where(near > 1.0, theta, inside)
    v = np.clip(v + sign * shift, 0.0, np.radians(89.999))
    light = _direction(np.append(z_b, np.cos(b)), 0.0)
    view = _direction(np.append(z_v, np.cos(v)), np.pi - np.append(phi, np.zeros_like(v)))
    return np.stack([*light, *view, np.append(alpha, width), np.append(index, near)])


def _cosine(lx, ly, lz, vx, vy, vz, alpha):
    return exact.reflection_cosine(lx, ly, lz, vx, vy, vz)


def _cosine_through(bx, by, bz, vx, vy, vz, alpha, eta):
    return exact.transmission_cosine(bx, by, bz, vx, vy, vz, eta)


_PAIR = ("l_x", "l_y", "l_z", "v_x", "v_y", "v_z", "alpha")
_THROUGH = ("b_x", "b_y", "b_z", "v_x", "v_y", "v_z", "alpha", "eta")
_REFLECTION = "cos_l and cos_v 1e-16 to 1, 1e-12 to 1e-2 rad from mirror directions; alpha 1e-6 to 1"
_TRANSMISSION = "the same about refracted directions; eta .4 to 2.4"

CASES = [
    Case("microfacet_reflection, value", _PAIR, _pairs, _REFLECTION, _reflection, exact.reflection),
    Case("microfacet_reflection, cosine", _PAIR, _pairs, _REFLECTION, _reflection, _cosine, 1),
    Case("microfacet_transmission, value", _THROUGH, _through, _TRANSMISSION, _transmission, exact.transmission),
    Case("microfacet_transmission, cosine", _THROUGH, _through, _TRANSMISSION, _transmission, _cosine_through, 1),
]
