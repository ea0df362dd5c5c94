"""Smooth stacks with and without polarisation: s and p waves tracked apart, added incoherently.

Smooth interfaces keep s and p apart, so a stack is solved for each of them and the mean is what
unpolarised light does. goniosim averages the reflectances at every event instead: the same formulas
with the mean reflectance.
"""

import cmath
import math


def reflectances(cos_i, n):
    """Reflectance of s and of p waves at a surface of relative index n, which may be complex."""
    sine = math.sqrt(1.0 - cos_i * cos_i)
    cos_t = cmath.sqrt(1.0 - (sine / n) ** 2)
    r_s = (cos_i - n * cos_t) / (cos_i + n * cos_t)
    r_p = (n * cos_i - cos_t) / (n * cos_i + cos_t)
    return abs(r_s) ** 2, abs(r_p) ** 2


def stack(theta_deg, indices, taus, polarised):
    """Flux that a stack of smooth interfaces reflects and transmits.

    Parameters
    ----------
    theta_deg : float
        In the medium above, of index 1.
    indices : list of complex
        Absolute index below each interface; only the last one may be complex, and then nothing is transmitted.
    taus : list of float
        Optical depth of each medium between two interfaces.
    polarised : bool
        Whether s and p waves are told apart.

    Returns
    -------
    reflected, transmitted : float
    """
    sine = math.sin(math.radians(theta_deg))
    above = [1.0, *indices[:-1]]
    cosines = [math.sqrt(1.0 - (sine / n) ** 2) for n in above]
    pairs = [reflectances(c, below / n) for c, n, below in zip(cosines, above, indices, strict=True)]
    if not polarised:
        pairs = [(0.5 * (s + p),) * 2 for s, p in pairs]
    through = [math.exp(-tau / c) for tau, c in zip(taus, cosines[1:], strict=True)]
    waves = [_solve([pair[wave] for pair in pairs], through) for wave in range(2)]
    return tuple(0.5 * sum(values) for values in zip(*waves, strict=True))


def _solve(surfaces, through):
    """Adding from the bottom up: what lies below a layer reflects and transmits as a whole."""
    reflected, transmitted = surfaces[-1], 1.0 - surfaces[-1]
    for r, a in zip(reversed(surfaces[:-1]), reversed(through), strict=True):
        series = 1.0 / (1.0 - r * a * a * reflected)
        transmitted = (1.0 - r) * a * transmitted * series
        reflected = r + (1.0 - r) ** 2 * a * a * reflected * series
    return reflected, transmitted
