"""Adding-doubling on directional statistics (Belcour 2018): one sweep from the top to the base.

Every interface is a set of atoms: energies R and T of both sides and variances of the lobes they
send out, in the "linear" space f(alpha) = alpha^1.1 / (1 - alpha^1.1) where variances of successive
events add up. The sweep adds one interface after the other to the stack above it. Lobe i holds the
light that interface i adds to the reflection of the stack, inter-reflections included.
"""

import math

import numpy as np

from ..._jit import kernel, scalar
from ...optics.fresnel import dielectric_transmittance, fresnel_conductor, fresnel_dielectric
from ..stack import CONDUCTOR
from .albedo import WHITE, directional_albedo

_EXPONENT = 1.1
_WIDEST = 0.9999
# A lossless stack under total reflection would echo for ever.
_LEAST_DENOMINATOR = 1e-6


@scalar
def _variance(alpha):
    a = min(alpha, _WIDEST) ** _EXPONENT
    return a / (1.0 - a)


@scalar
def _roughness(variance):
    return (variance / (1.0 + variance)) ** (1.0 / _EXPONENT)


@kernel
def sweep(kinds, alphas, etas, spectral, taus, cosine, flags, energy, lobe_alpha, total):
    """Statistics of all lobes for light at one angle.

    Parameters
    ----------
    kinds, alphas : ndarray, shape (K,)
    etas : ndarray, shape (K,)
        Index below over above.
    spectral : ndarray, shape (K, 2, C)
        Relative eta and kappa of conductors.
    taus : ndarray, shape (K, C)
    cosine : float
        At which the light meets the top interface.
    flags : tuple of bool
        Exact albedo, refraction scale at normal incidence, Jacobian by Snell, correlated masking,
        lobes normalised to carry their energy.
    energy : ndarray, shape (K, C), out
        Energy of the lobe of every interface; 0 where no light arrives.
    lobe_alpha : ndarray, shape (K,), out
        GGX width of every lobe; 0 if all interfaces that it has met are smooth.
    total : ndarray, shape (2, C + 1), out
        Energies and GGX width of all reflection (0) and all transmission (1).
    """
    exact, normal_scale, snell, correlated, normalised = flags
    n_channels = taus.shape[1]
    inverse_channels = 1.0 / n_channels
    r0 = np.zeros(n_channels)
    ri = np.zeros(n_channels)
    t0 = np.ones(n_channels)
    ti = np.ones(n_channels)
    r12 = np.empty(n_channels)
    s_r0 = s_ri = s_t0 = s_ti = 0.0
    j0 = ji = 1.0
    energy[:] = 0.0
    lobe_alpha[:] = alphas
    c = max(cosine, 1e-9)
    for k in range(kinds.shape[0]):
        n12 = etas[k]
        fresnel, ct = fresnel_dielectric(c, n12)
        through = dielectric_transmittance(c, n12)
        transmissive = (kinds[k] != CONDUCTOR) & (ct > 0.0)
        s_r = _variance(alphas[k])
        seen_alpha = _roughness(s_t0 + s_r)
        # The albedo of what light sees as smooth is the Fresnel reflectance.
        by_facets = exact & (seen_alpha > 0.0)
        for b in range(n_channels):
            if kinds[k] == CONDUCTOR:
                r12[b] = fresnel_conductor(c, spectral[k, 0, b], spectral[k, 1, b])
                if by_facets:
                    r12[b] = directional_albedo(
                        kinds[k], c, seen_alpha, spectral[k, 0, b], spectral[k, 1, b], correlated
                    )
            elif b == 0:
                r12[b] = fresnel
                if by_facets:
                    r12[b] = directional_albedo(kinds[k], c, seen_alpha, n12, 0.0, correlated)
            else:
                r12[b] = r12[0]
        s_t12 = s_t21 = 0.0
        j12 = j21 = 1.0
        if transmissive:
            # A rough refraction counts as a rough reflection of scaled width.
            # n12 ct - c without the difference
            tilt = 0.5 * abs((n12 - 1.0) * (n12 + 1.0)) / (n12 * ct + c)
            tilt_in = 0.5 * abs(n12 - 1.0) / n12 if normal_scale else tilt / (n12 * ct)
            tilt_out = 0.5 * abs(n12 - 1.0) if normal_scale else tilt / c
            s_t12 = _variance(tilt_in * alphas[k])
            s_t21 = _variance(tilt_out * alphas[k])
            j12 = n12 * ct / c
            j21 = 1.0 / j12
        # How variances cross: the published recursion moves light going down with the factor of
        # light going up, and the other way round.
        down = j21 if snell else j12
        up = j0 if snell else ji

        mean_rr = mean_mr = mean_mri = mean_r0 = mean_r21 = 0.0
        for b in range(n_channels):
            t12 = 1.0 - r12[b] if by_facets else through
            t12 = t12 if transmissive else 0.0
            inverse = 1.0 / max(1.0 - ri[b] * r12[b], _LEAST_DENOMINATOR)
            m_r = t0[b] * r12[b] * ti[b] * inverse
            m_ri = t12 * ri[b] * t12 * inverse
            mean_rr += ri[b] * r12[b] * inverse * inverse_channels
            mean_mr += m_r * inverse_channels
            mean_mri += m_ri * inverse_channels
            mean_r0 += r0[b] * inverse_channels
            mean_r21 += r12[b] * inverse_channels
            energy[k, b] = m_r
            r0[b] += m_r
            t0[b] *= t12 * inverse
            ti[b] *= t12 * inverse
            ri[b] = r12[b] + m_ri

        echo = mean_rr * (s_r + s_ri)
        s_lobe = s_ti + j0 * (s_t0 + s_r + echo)
        s_r0 = (mean_r0 * s_r0 + mean_mr * s_lobe) / max(mean_r0 + mean_mr, 1e-300)
        s_t0 = down * (s_t0 + echo) + s_t12
        s_ri = (mean_r21 * s_r + mean_mri * (s_t12 + down * (s_t21 + s_ri + echo))) / max(mean_r21 + mean_mri, 1e-300)
        s_ti += up * (s_t21 + echo)
        lobe_alpha[k] = _roughness(s_lobe)
        j0 *= j12
        ji *= j21
        if not transmissive:
            break
        c = ct
        for b in range(n_channels):
            a = math.exp(-taus[k, b] / c)
            t0[b] *= a
            ti[b] *= a
            ri[b] *= a * a

    for b in range(n_channels):
        total[0, b] = r0[b]
        total[1, b] = t0[b]
    total[0, n_channels] = _roughness(s_r0)
    total[1, n_channels] = _roughness(s_t0)
    if normalised:
        for k in range(kinds.shape[0]):
            energy[k] /= directional_albedo(WHITE, cosine, lobe_alpha[k], 1.0, 0.0, correlated)
