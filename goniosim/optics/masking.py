"""Joint masking of two directions by one microsurface."""

from .._jit import scalar


@scalar
def height_correlation(g_l, g_v, correlated):
    """Factor that turns the separable Smith masking G1(l) G1(v) into the joint one.

    Parameters
    ----------
    g_l, g_v : float
        G1 = 1 / (1 + Lambda) of two directions on the same side.
    correlated : bool
        False: separable (Walter et al. 2007), the factor is 1. True: height-correlated,
        G = 1 / (1 + Lambda(l) + Lambda(v)).
    """
    # The bound keeps two directions in the horizon finite.
    return 1.0 / max(g_l + g_v - g_l * g_v, 1e-30) if correlated else 1.0
