"""The light itself, as it leaves the interface that it came through, seen through a narrow exit.

Both lobes are narrow, and a cell may lie far from where they lead: then the rare facet of the exit that meets the
lobe of the light carries all of it. So directions are drawn from either lobe, and weighted by the squares of both
densities (the power heuristic of Veach and Guibas 1995).
"""

from ..._jit import scalar, stage
from ...optics.elementary import sincos_turns
from ...optics.fresnel import dielectric_transmittance, fresnel_dielectric
from ...optics.ggx import sample_visible_normal, smith_g1
from ...optics.microfacet import microfacet_transmission
from ..lattice import coordinate

# Directions of a cell that are drawn from the light.
LIGHTS = 2
# What their density counts beside that of the exit: little, for they serve cells far from both lobes. Where the lobes
# meet, few of them would hit the narrower one, and the few would carry much.
COUNT = 0.01
_LEAST_COSINE = 1e-9
_LEAST = 1e-300


@stage
def see_light(x, y, z, vx, vy, vz, n, light, source, exits, seen):
    """Radiance of the light in directions that were drawn from the exit, times their shares.

    Parameters
    ----------
    x, y, z : ndarray, shape (>= n,)
        Inside the exit, as it sees them.
    vx, vy, vz : ndarray, shape (>= n,)
        Outside.
    n : int
    light : ndarray, shape (3,)
    source, exits : ndarray, shape (2,)
        Width of the interface that the light comes through, and of the exit; with the index inside over outside.
    seen : ndarray, shape (>= n,)
        Overwritten.
    """
    lx = light[0]
    ly = light[1]
    lz = light[2]
    eta = source[1]
    for i in range(n):
        lit, cosine, from_light = _lobe(x[i], y[i], z[i], lx, ly, lz, source[0], eta)
        share = 1.0
        if exits[0] > 0.0:
            _, _, from_exit = _lobe(-x[i], -y[i], z[i], vx[i], vy[i], vz[i], exits[0], exits[1])
            share = _share(from_exit, COUNT * from_light)
        seen[i] = share * lit * eta * eta * dielectric_transmittance(cosine, eta)


@scalar
def _lobe(bx, by, bz, x, y, z, alpha, eta):
    """As `microfacet_transmission`, and the density of directions inside that visible facets refract (x, y, z) into."""
    value, cosine = microfacet_transmission(bx, by, bz, x, y, z, alpha, eta)
    return value, cosine, value * eta * eta * bz / smith_g1(bz, alpha)


@scalar
def _share(one, other):
    """Of a direction drawn with density ``one``, beside ``other``."""
    ratio = other / max(one, _LEAST)
    return 1.0 / (1.0 + ratio * ratio)


@stage
def draw_light(azimuths, heights, number, n, light, source, x, y, z):
    """Directions inside that the light refracts into.

    Parameters
    ----------
    azimuths, heights : ndarray, shape (>= n,)
        What facets are drawn from, in [0, 1).
    number : int
        Which of the `LIGHTS` of a cell.
    n : int
    light : ndarray, shape (3,)
    source : ndarray, shape (2,)
    x, y, z : ndarray, shape (>= n,)
        Overwritten: as the exit sees them.
    """
    alpha = source[0]
    eta = source[1]
    lx = light[0]
    ly = light[1]
    lz = light[2]
    turn = number / LIGHTS
    for i in range(n):
        sine, cosine = sincos_turns(coordinate(azimuths[i], 1, turn))
        mx, my, mz = sample_visible_normal(lx, ly, lz, alpha, cosine, sine, coordinate(heights[i], 1, turn))
        cosine_l = min(1.0, max(0.0, lx * mx + ly * my + lz * mz))
        _, cos_t = fresnel_dielectric(cosine_l, eta)
        along = cosine_l / eta - cos_t
        x[i] = along * mx - lx / eta
        y[i] = along * my - ly / eta
        # What would go back up is nowhere near a lobe, and of no value.
        z[i] = max(lz / eta - along * mz, _LEAST_COSINE)


@stage
def weigh_light(x, y, z, vx, vy, vz, n, light, source, exits, measure, gain):
    """What looks in directions that were drawn from the light are worth.

    Parameters
    ----------
    x, y, z, vx, vy, vz, n, light, source, exits
        As in `see_light`.
    measure : ndarray, shape (>= n,)
        cos(theta_v) d omega_v of the points outside, times the cell.
    gain : ndarray, shape (>= n,)
        Overwritten.
    """
    lx = light[0]
    ly = light[1]
    lz = light[2]
    eta = source[1]
    for i in range(n):
        lit, cosine_l, from_light = _lobe(x[i], y[i], z[i], lx, ly, lz, source[0], eta)
        met, cosine_v, from_exit = _lobe(-x[i], -y[i], z[i], vx[i], vy[i], vz[i], exits[0], exits[1])
        from_light *= COUNT
        radiance = lit * eta * eta * dielectric_transmittance(cosine_l, eta)
        passed = met * z[i] * dielectric_transmittance(cosine_v, exits[1])
        weight = COUNT / LIGHTS * _share(from_light, from_exit) / max(from_light, _LEAST)
        gain[i] = measure[i] * radiance * passed * weight
