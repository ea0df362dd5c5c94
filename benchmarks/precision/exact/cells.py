"""Solid angles of cells, plain and times cos(theta_v), from the definitions of the slices.

Classic cells are linear in theta_v and phi_v. Half cells are linear in u, with theta_h = 2 u^2 / pi, and in phi_h; the
viewer stands at v = 2 (l.h) h - l, so that d omega_v = 4 (l.h) d omega_h, and what counts is the part with v_z > 0.
"""

from mpmath import acos, cos, mp, mpc, mpf, pi, quad, sin


def classic(rows, columns, row):
    """Solid and projected solid angle of any cell of a row."""
    low, high = pi / 2 * row / rows, pi / 2 * (row + 1) / rows
    width = 2 * pi / columns
    return width * (cos(low) - cos(high)), width * (sin(high) ** 2 - sin(low) ** 2) / 2


def half_edges(rows, columns, row, column):
    """The least and largest theta_h and phi_h of a half cell."""
    tilts = (pi / 2 * (mpf(edge) / rows) ** 2 for edge in (row, row + 1))
    return *tilts, *(2 * pi * edge / columns for edge in (column, column + 1))


def half(theta, low, high, start, end):
    """Solid and projected solid angle of a half cell, of the part above the horizon, for light at ``theta``."""
    sine, cosine = sin(theta), cos(theta)
    bounds = sorted({low, high, *(k for k in _kinks(start, end, sine, cosine) if low < k < high)})
    # One quadrature for both, as a complex number.
    whole = sum(
        quad(lambda t: mpc(*_ring(t, start, end, sine, cosine)) * sin(t), list(piece))
        for piece in zip(bounds[:-1], bounds[1:], strict=True)
    )
    return whole.real, whole.imag


def _kinks(start, end, sine, cosine):
    """theta_h at which the horizon meets the sides of a cell, or its middle where that is the plane of incidence."""
    for phi in (start, end, pi, mpf(0)):
        if start <= phi <= end:
            # v_z = sine sin(2 t) cos(phi) + cosine cos(2 t) = 0
            yield mp.atan2(cosine, -sine * cos(phi)) / 2


def _ring(t, start, end, sine, cosine):
    """Integrals of 4 (l.h) and 4 (l.h) v_z over the visible azimuths from ``start`` to ``end``, at theta_h = t."""
    # l.h = p cos(phi) + q, v_z = a cos(phi) + b
    p, q = sine * sin(t), cosine * cos(t)
    a, b = sine * sin(2 * t), cosine * cos(2 * t)
    if b >= abs(a):
        spans = [(start, end)]
    elif b <= -abs(a):
        spans = []
    else:
        edge = acos(-b / a)
        spans = [(max(start, low), min(end, high)) for low, high in ((mpf(0), edge), (2 * pi - edge, 2 * pi))]
    solid = projected = mpf(0)
    for i, j in spans:
        if j > i:
            first, second = sin(j) - sin(i), (j - i) / 2 + (sin(2 * j) - sin(2 * i)) / 4
            solid += 4 * (p * first + q * (j - i))
            projected += 4 * (p * a * second + (p * b + q * a) * first + q * b * (j - i))
    return solid, projected
