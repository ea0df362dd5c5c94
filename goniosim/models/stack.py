"""A scene as the models see it: flat tables, one entry for each interface."""

import math
from dataclasses import dataclass

import numpy as np

from .._jit import kernel, scalar
from ..optics.fresnel import fresnel_conductor, fresnel_dielectric
from ..optics.ggx import smith_g1
from ..optics.masking import height_correlation
from ..optics.microfacet import microfacet_reflection
from ..scene import optical_stack

DIELECTRIC, CONDUCTOR, LAMBERT = range(3)
_KINDS = {"dielectric": DIELECTRIC, "conductor": CONDUCTOR, "lambert": LAMBERT}

# Narrowest lobe of the kernels: stands for alpha = 0 where the value is discarded anyway.
NARROWEST = 1e-6


@dataclass(frozen=True)
class Stack:
    """K interfaces and all channels of the scene.

    Attributes
    ----------
    kinds : ndarray of int64, shape (K,)
    alphas : ndarray, shape (K,)
        GGX widths; 0 for smooth interfaces and for a Lambertian base.
    index : ndarray, shape (K + 1,)
        Absolute index of each medium from the top; an opaque base repeats the one above it.
    spectral : ndarray, shape (K, 2, channels)
        Real and imaginary part of a conductor's index, rho of a Lambertian base.
    taus : ndarray, shape (K, channels)
        Optical depth below each interface; 0 below the last.
    """

    kinds: np.ndarray
    alphas: np.ndarray
    index: np.ndarray
    spectral: np.ndarray
    taus: np.ndarray


def make_stack(material, conductor_index="relative"):
    """Lower a material, as light meets it: see `goniosim.scene.optical`.

    Parameters
    ----------
    material : goniosim.scene.Material
    conductor_index : str
        ``relative``: divide the index of a conductor by that of the medium above it; ``absolute``:
        leave it as it is.

    Returns
    -------
    Stack
    """
    material = optical_stack(material).material
    faces = material.interfaces
    channels = 3
    index = np.ones(len(faces) + 1)
    spectral = np.zeros((len(faces), 2, channels))
    for k, face in enumerate(faces):
        index[k + 1] = index[k] if face.opaque else face.eta
        if face.type == "conductor":
            above = index[k] if conductor_index == "relative" else 1.0
            spectral[k] = np.array([face.eta_rgb, face.kappa_rgb]) / above
        elif face.type == "lambert":
            spectral[k, 0] = face.rho_rgb
    return Stack(
        kinds=np.array([_KINDS[face.type] for face in faces], np.int64),
        alphas=np.array([getattr(face, "alpha", 0.0) for face in faces]),
        index=index,
        spectral=spectral,
        taus=np.array([*material.tau, (0.0,) * channels]),
    )


def light_direction(theta_deg):
    """Unit vector to the light at azimuth 0."""
    theta = math.radians(theta_deg)
    return np.array([math.sin(theta), 0.0, math.cos(theta)])


def kernel_alphas(alphas):
    """GGX widths that a kernel can compute with."""
    return np.maximum(alphas, NARROWEST)


@scalar
def ggx_lobe(lx, ly, lz, vx, vy, vz, alpha, correlated):
    """GGX reflection without its Fresnel factor, in 1/sr, and the cosine at the microfacet."""
    value, cosine = microfacet_reflection(lx, ly, lz, vx, vy, vz, alpha)
    return value * height_correlation(smith_g1(lz, alpha), smith_g1(vz, alpha), correlated), cosine


@kernel
def add_lobe(kind, eta, spectral, lobe, cosine, weight, out):
    """Add weight * Fresnel factor * lobe of one interface to ``out``.

    ``lobe`` [n] and ``cosine`` [n] are those of `ggx_lobe`, which a Lambertian base ignores: its
    lobe is rho / pi everywhere. ``weight`` and ``out`` are [channel, n].
    """
    n = lobe.shape[0]
    for c in range(out.shape[0]):
        w = weight[c]
        o = out[c]
        first = spectral[0, c]
        second = spectral[1, c]
        if kind == DIELECTRIC:
            for i in range(n):
                reflectance, _ = fresnel_dielectric(cosine[i], eta)
                o[i] += w[i] * reflectance * lobe[i]
        elif kind == CONDUCTOR:
            for i in range(n):
                o[i] += w[i] * fresnel_conductor(cosine[i], first, second) * lobe[i]
        else:
            for i in range(n):
                o[i] += w[i] * first / math.pi
