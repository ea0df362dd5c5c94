"""Absorbing media: the law of Beer and Lambert."""

from .._jit import scalar
from .elementary import exp_nonpositive


@scalar
def path_length(cos_theta):
    """Way through a layer, in units of its depth: 1 / cos_theta, finite also for a parallel ray."""
    return 1.0 / max(cos_theta, 1e-300)


@scalar
def transmittance(tau, path):
    """Fraction exp(-tau path) of the flux that crosses a layer of optical depth ``tau``."""
    return exp_nonpositive(-tau * path)
