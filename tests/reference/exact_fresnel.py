"""Fresnel's equations as they stand in the books, in decimal arithmetic of 80 digits.

Nothing here uses goniosim. Arguments are floats and are taken for exact.
"""

from decimal import Decimal, localcontext

_DIGITS = 80


def dielectric(cos_i, eta):
    """Reflectance, transmittance and refracted cosine of a relative index; Decimals."""
    with localcontext(prec=_DIGITS):
        c, n = Decimal(cos_i), Decimal(eta)
        cos2_t = 1 - (1 - c * c) / (n * n)
        if cos2_t <= 0:
            return Decimal(1), Decimal(0), Decimal(0)
        t = cos2_t.sqrt()
        s, p = (c - n * t) / (c + n * t), (n * c - t) / (n * c + t)
        reflectance = (s * s + p * p) / 2
        return reflectance, 1 - reflectance, t


def conductor(cos_i, eta, kappa):
    """Reflectance and absorptance of the relative index eta + i kappa; Decimals."""
    with localcontext(prec=_DIGITS):
        c, n, k = Decimal(cos_i), Decimal(eta), Decimal(kappa)
        real, imaginary = n * n - k * k, 2 * n * k
        g2 = real - (1 - c * c)
        modulus = (g2 * g2 + imaginary * imaginary).sqrt()
        # g = a + i b
        a, b = (max((modulus + g2) / 2, Decimal(0)).sqrt(), max((modulus - g2) / 2, Decimal(0)).sqrt())
        s = ((c - a) ** 2 + b * b) / ((c + a) ** 2 + b * b)
        x, y = real * c, imaginary * c
        p = ((x - a) ** 2 + (y - b) ** 2) / ((x + a) ** 2 + (y + b) ** 2)
        reflectance = (s + p) / 2
        return reflectance, 1 - reflectance
