"""Absorbing media."""

import numpy as np

from goniosim._jit import kernel
from goniosim.optics.medium import path_length, transmittance

from .. import grids
from ..case import Case
from ..exact import medium as exact


@kernel
def _through(p, out):
    for i in range(p.shape[1]):
        out[0, i] = transmittance(p[0, i], path_length(p[1, i]))


def _points(dense):
    tau = np.append(0.0, grids.logarithmic(1e-12, 1e4, 97 if dense else 17))
    return grids.product(tau, grids.cosines(dense))


CASES = [
    Case(
        "transmittance, path_length",
        ("tau", "cosine"),
        _points,
        "tau 0 and 1e-12 to 1e4, cos 1e-16 to 1 and 1 - 10^-k; below 1e-304 it is 0",
        _through,
        exact.transmittance,
        floor=float(np.exp(-700.0)),
    )
]
