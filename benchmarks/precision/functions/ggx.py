"""GGX and Smith."""

import numpy as np

from goniosim._jit import kernel
from goniosim.optics.ggx import ggx_density, smith_g1, smith_g1_scaled
from goniosim.optics.masking import height_correlation

from .. import grids
from ..case import Case
from ..exact import ggx as exact


@kernel
def _density(p, out):
    for i in range(p.shape[1]):
        out[0, i] = ggx_density(p[0, i], p[1, i], p[2, i])


@kernel
def _masking(p, out):
    for i in range(p.shape[1]):
        out[0, i] = smith_g1(p[0, i], p[1, i])


@kernel
def _scaled(p, out):
    for i in range(p.shape[1]):
        out[0, i], out[1, i] = smith_g1_scaled(p[0, i], p[1, i], p[2, i])


@kernel
def _correlation(p, out):
    for i in range(p.shape[1]):
        out[0, i] = height_correlation(p[0, i], p[1, i], True)


def _normals(dense):
    """Squared sines and cosines of normals from theta_h = 1e-12 to the horizon, and the pole."""
    theta = np.concatenate([[0.0], grids.logarithmic(1e-12, 0.5 * np.pi, 61 if dense else 13)])
    steep = grids.cosines(dense)
    sin2 = np.concatenate([np.sin(theta) ** 2, 1.0 - steep * steep])
    cosine = np.concatenate([np.cos(theta), steep])
    index, alpha = grids.product(np.arange(len(sin2)), grids.widths(dense))
    index = index.astype(int)
    return np.stack([sin2[index], cosine[index], alpha])


def _views(dense):
    return grids.product(grids.cosines(dense), grids.widths(dense))


def _scaled_views(dense):
    cosine, scale, alpha = grids.product(grids.cosines(dense), [1.0, 0.3, 1e-9], grids.widths(dense))
    return np.stack([cosine * scale, scale, alpha])


def _maskings(dense):
    g = grids.cosines(dense)[:: 1 if dense else 2]
    return grids.product(g, g)


_COSINES = "cos 1e-16 to 1 and 1 - 10^-k, alpha 1e-6 to 1"

CASES = [
    Case(
        "ggx_density",
        ("sin2_h", "cos_h", "alpha"),
        _normals,
        "theta_h 0, 1e-12 to pi/2, and cos_h 1e-16 to 1; alpha 1e-6 to 1",
        _density,
        exact.density,
    ),
    Case("smith_g1", ("cos_w", "alpha"), _views, _COSINES, _masking, exact.smith_g1),
    Case(
        "smith_g1_scaled, G1",
        ("height", "scale", "alpha"),
        _scaled_views,
        _COSINES + ", scales 1, .3 and 1e-9",
        _scaled,
        lambda height, scale, alpha: exact.smith_g1(height / scale, alpha),
    ),
    Case(
        "smith_g1_scaled, 1 / scale",
        ("height", "scale", "alpha"),
        _scaled_views,
        _COSINES + ", scales 1, .3 and 1e-9",
        _scaled,
        lambda height, scale, alpha: 1 / scale,
        1,
    ),
    Case(
        "height_correlation",
        ("g_l", "g_v"),
        _maskings,
        "both 1e-16 to 1 and 1 - 10^-k",
        _correlation,
        exact.correlated,
    ),
]
