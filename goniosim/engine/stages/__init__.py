"""What happens at an interface: one file per type, one straight-line loop each.

Every type offers ``lower`` (scene object to a row of the interface table) and ``scatter``
(a batch of rays meets the interface). A new type is one new file, a line in `LOWER` and a line
in `scatter`.
"""

from ..._jit import kernel
from . import rough_conductor, rough_dielectric, lambert, smooth_conductor, smooth_dielectric

ROUGH_DIELECTRIC, SMOOTH_DIELECTRIC, ROUGH_CONDUCTOR, SMOOTH_CONDUCTOR, LAMBERT = range(5)


@kernel
def scatter(kind, batch, n, alpha, eta, spectral, key, scratch, ledger):
    """Let the first ``n`` rays of ``batch`` meet an interface of the given kind.

    On return X, Y, Z hold the view vectors at the next interface (for a ray that leaves, minus
    its direction in X and Y and its height above or below the horizon in Z), the weights are
    multiplied, `GAIN` and `TRANSMITTED` of ``scratch`` are set, and the losses are booked.
    """
    if kind == ROUGH_DIELECTRIC:
        rough_dielectric.scatter(batch, n, alpha, eta, key, scratch, ledger)
    elif kind == SMOOTH_DIELECTRIC:
        smooth_dielectric.scatter(batch, n, eta, key, scratch)
    elif kind == ROUGH_CONDUCTOR:
        rough_conductor.scatter(batch, n, alpha, spectral, key, scratch, ledger)
    elif kind == SMOOTH_CONDUCTOR:
        smooth_conductor.scatter(batch, n, spectral, scratch, ledger)
    elif kind == LAMBERT:
        lambert.scatter(batch, n, spectral, key, scratch, ledger)
