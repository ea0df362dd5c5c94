"""Fresnel's equations of unpolarised light for arrays, with what is reflected and what is not each to full accuracy.

With the invariant n sin(theta) of both sides, a = n cos(theta) of one and b of the other,

    r_s = (a - b) / (a + b),    a^2 - b^2 = n_a^2 - n_b^2,    1 - r_s^2 = 4 a b / (a + b)^2,

and for the other polarisation the same of n_b^2 a and n_a^2 b: no difference of nearly equal numbers is left.
"""

import numpy as np


def dielectric(cosine: np.ndarray, eta: float) -> tuple[np.ndarray, np.ndarray]:
    """Reflected and transmitted share of light from the side of index 1 to that of ``eta``.

    Parameters
    ----------
    cosine : ndarray
        Of the angle of incidence.
    eta : float

    Returns
    -------
    reflected, transmitted : ndarray
        1 and 0 where all is reflected.
    """
    c = np.maximum(np.asarray(cosine, float), 1e-60)
    more = (eta - 1.0) * (eta + 1.0)
    square = c * c + more
    g = np.sqrt(np.maximum(square, 0.0))
    s, p = c + g, eta * eta * c + g
    # (eta^2 c)^2 - g^2 = (eta^2 - 1) ((eta^2 + 1) c^2 - 1)
    r_s, r_p = -more / s**2, more * ((eta * eta + 1.0) * c * c - 1.0) / p**2
    total = square <= 0.0
    reflected = np.where(total, 1.0, 0.5 * (r_s**2 + r_p**2))
    return reflected, np.where(total, 0.0, 2.0 * c * g * (1.0 / s**2 + eta * eta / p**2))


def conductor(cosine: np.ndarray, eta: complex) -> tuple[np.ndarray, np.ndarray]:
    """Reflected and absorbed share of light from the side of index 1 onto a conductor of index ``eta``."""
    c = np.maximum(np.asarray(cosine, float), 1e-60)
    square = complex(eta) ** 2
    # eta^2 - sin^2 without a difference near an index of 1.
    g = np.sqrt((complex(eta) - 1.0) * (complex(eta) + 1.0) + c * c)
    s, p = np.abs(c + g) ** 2, np.abs(square * c + g) ** 2
    reflected = 0.5 * (np.abs(c - g) ** 2 / s + np.abs(square * c - g) ** 2 / p)
    return reflected, 2.0 * c * (g.real / s + (square * np.conj(g)).real / p)
