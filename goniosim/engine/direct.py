"""The direct reflection off the top interface, integrated over every cell instead of sampled.

The energy of a cell is the integral over it of F D G1(l) G1(v) / (4 l_z v_z) cos(theta_v).
"""

import math
from dataclasses import dataclass

import numpy as np

from .._jit import kernel, stage
from ..integration import Grid, find_lobe, integrate_adaptively
from ..optics.fresnel import fresnel_conductor, fresnel_dielectric
from ..optics.microfacet import microfacet_reflection
from .stages import LAMBERT, ROUGH_CONDUCTOR, ROUGH_DIELECTRIC, SMOOTH_CONDUCTOR, SMOOTH_DIELECTRIC

# Difference of successive rules on a part of a cell, relative to the cell, and what does not matter; less, where the
# whole slice is so dim that it would.
RELATIVE_TOLERANCE = 1e-10
ABSOLUTE_TOLERANCE = 1e-14


@dataclass(frozen=True)
class _Reflection:
    """The `goniosim.integration.Density` of a rough top interface."""

    tables: tuple
    light: np.ndarray
    channels: int

    @property
    def kernel(self):
        return evaluate


def direct_reflection(plan, direction, pool, stop=None):
    """Energy that leaves into every cell after a single event on the top interface.

    Parameters
    ----------
    plan : goniosim.engine.plan.Plan
    direction : int
        Index of the incident direction.
    pool : goniosim.integration.Pool
    stop : threading.Event, optional
        When set, the integration is given up.

    Returns
    -------
    energy, error : ndarray, shape (distinct channels, rows, columns)
        Fraction of the incident flux, and an estimate of the error of its integration. None if it was given up.
    """
    kind, alpha, eta = int(plan.kinds[0]), float(plan.alphas[0]), float(plan.etas[0])
    spectral = plan.spectral[0]
    light = plan.light[direction]
    geometry = plan.geometry[direction]
    shape = (plan.n_distinct, plan.rows, plan.columns)
    if kind == LAMBERT:
        return spectral[0][:, None, None] * geometry.projected_solid_angle / math.pi, np.zeros(shape)
    grid = Grid(
        parametrization=plan.parametrization_name,
        rows=plan.rows,
        columns=plan.columns,
        theta_deg=float(plan.theta_deg[direction]),
        valid=geometry.valid,
        projected_solid_angle=geometry.projected_solid_angle,
    )
    if kind in (SMOOTH_DIELECTRIC, SMOOTH_CONDUCTOR):
        energy = np.zeros(shape)
        reflectance = np.empty((plan.n_distinct, 1))
        _reflectances(kind, eta, spectral, light[2:], reflectance)
        row, column = grid.cell_of((-light[0], -light[1], light[2]))
        energy[:, row, column] = reflectance[:, 0]
        return energy, np.zeros(shape)
    # The index of a dielectric is the same in all channels.
    channels = plan.n_distinct if kind == ROUGH_CONDUCTOR else 1
    density = _Reflection((kind, alpha, eta, spectral), light, channels)
    lobe = find_lobe(grid, light, alpha)
    absolute, least = np.inf, 1.0
    # What an interface of nearly equal indices reflects would not matter at all.
    while least > 0.0 and (wanted := min(ABSOLUTE_TOLERANCE, RELATIVE_TOLERANCE * least)) < 0.1 * absolute:
        absolute = wanted
        found = integrate_adaptively(
            density,
            grid,
            pool,
            grid.all_numbers,
            relative=RELATIVE_TOLERANCE,
            absolute=absolute,
            lobe=lobe,
            stop=stop,
        )
        if found is None:
            return None
        least = float(found.energy.sum(axis=1).min())
    energy, error = grid.unfold(found.energy), grid.unfold(found.error)
    # What no other cell holds may be in one whose lobe is too narrow to be seen.
    rest = np.maximum(0.0, 1.0 - energy.sum(axis=(1, 2), keepdims=True))
    error = np.where(np.isfinite(error), error, rest)
    copies = (plan.n_distinct // channels, 1, 1)
    return np.tile(energy, copies), np.tile(error, copies)


@kernel
def evaluate(tables, light, x, y, z, out):
    """Write the reflection into ``out`` [channel, n]; see `goniosim.integration.Density`."""
    kind, alpha, eta, spectral = tables
    lobe = np.empty(x.shape[0])
    cosine = np.empty(x.shape[0])
    lx = light[0]
    ly = light[1]
    lz = light[2]
    for i in range(x.shape[0]):
        value, facet = microfacet_reflection(lx, ly, lz, x[i], y[i], z[i], alpha)
        lobe[i] = value
        cosine[i] = facet
    _fresnel(kind, eta, spectral, cosine, out)
    for c in range(out.shape[0]):
        row = out[c]
        for i in range(x.shape[0]):
            row[i] *= lobe[i]


@kernel
def _reflectances(kind, eta, spectral, cosine, out):
    _fresnel(kind, eta, spectral, cosine, out)


@stage
def _fresnel(kind, eta, spectral, cosine, out):
    for c in range(out.shape[0]):
        row = out[c]
        if kind in (ROUGH_DIELECTRIC, SMOOTH_DIELECTRIC):
            for i in range(cosine.shape[0]):
                reflectance, _ = fresnel_dielectric(cosine[i], eta)
                row[i] = reflectance
        else:
            first = spectral[0, c]
            second = spectral[1, c]
            for i in range(cosine.shape[0]):
                row[i] = fresnel_conductor(cosine[i], first, second)
