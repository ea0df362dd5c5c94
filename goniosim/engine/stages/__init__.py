"""What happens at an interface: one file per type, one straight-line loop each.

Every type offers ``lower`` (scene object to a row of the interface table; rough and smooth
variants share one) and ``scatter`` (a batch of rays meets the interface). A new type is one new
file, a line in `LOWER` and a line in `scatter`.
"""

from ..._jit import stage
from . import lambert, rough_conductor, rough_dielectric, smooth_conductor, smooth_dielectric

ROUGH_DIELECTRIC, SMOOTH_DIELECTRIC, ROUGH_CONDUCTOR, SMOOTH_CONDUCTOR, LAMBERT = range(5)
OPAQUE = (ROUGH_CONDUCTOR, SMOOTH_CONDUCTOR, LAMBERT)

# Interface type in the scene: how to lower it, and its kinds when smooth and when rough.
LOWER = {
    "dielectric": (smooth_dielectric.lower, SMOOTH_DIELECTRIC, ROUGH_DIELECTRIC),
    "conductor": (smooth_conductor.lower, SMOOTH_CONDUCTOR, ROUGH_CONDUCTOR),
    "lambert": (lambert.lower, LAMBERT, LAMBERT),
}


def lower(interface, index_above):
    """Row of the interface table for an interface of the scene.

    Parameters
    ----------
    interface : goniosim.scene interface
    index_above : float
        Absolute refractive index of the medium above.

    Returns
    -------
    kind : int
    alpha, eta : float
        GGX width; index below relative to above, 1 for an opaque interface.
    spectral : list of sequences of float
        Up to two rows of one number per channel of the scene.
    """
    row, smooth, rough = LOWER[interface.type]
    alpha, eta, spectral = row(interface, index_above)
    return (rough if alpha > 0.0 else smooth), alpha, eta, spectral


@stage
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
