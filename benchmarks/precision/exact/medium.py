"""The law of Beer and Lambert."""

from mpmath import exp


def transmittance(tau, cosine):
    """Of a layer of optical depth ``tau``, crossed at an angle."""
    return exp(-tau / cosine)
