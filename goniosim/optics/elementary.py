"""Elementary functions that LLVM can vectorise.

``math.sin``, ``cos``, ``exp`` and ``atan2`` compile to one library call per number. These are
short polynomials without branches, accurate to a few 1e-15 in the ranges given.
"""

import math

import numpy as np

from .._jit import intrinsic, ir, scalar, types

TWO_PI = 2.0 * math.pi
_HALF_PI = 0.5 * math.pi
_QUARTER_PI = 0.25 * math.pi
_LOG2_E = 1.4426950408889634
_LN_2 = 0.6931471805599453
_TAN_PI_8 = math.sqrt(2.0) - 1.0
# 1.5 * 2^52: adding it leaves an integer-valued number in the low bits of the significand.
_INTEGER_IN_LOW_BITS = 6755399441055744.0


def _atan_coefficients(degree=10):
    """Coefficients in powers of z of atan(sqrt z) / sqrt z on [0, tan^2(pi/8)], by Chebyshev interpolation."""
    top = _TAN_PI_8**2

    def f(z):
        root = np.sqrt(z)
        return np.arctan(root) / root

    interpolant = np.polynomial.Chebyshev.interpolate(f, degree, domain=[0.0, top])
    return interpolant.convert(kind=np.polynomial.Polynomial).coef


(_A0, _A1, _A2, _A3, _A4, _A5, _A6, _A7, _A8, _A9, _A10) = (float(c) for c in _atan_coefficients())


@intrinsic
def bits_to_float(typingctx, bits):
    """The float64 whose IEEE 754 representation is the given uint64."""

    def codegen(context, builder, signature, args):
        return builder.bitcast(args[0], ir.DoubleType())

    return types.float64(types.uint64), codegen


@intrinsic
def float_to_bits(typingctx, number):
    """The IEEE 754 representation of a float64 as uint64."""

    def codegen(context, builder, signature, args):
        return builder.bitcast(args[0], ir.IntType(64))

    return types.uint64(types.float64), codegen


@intrinsic
def fma(typingctx, x, y, z):
    """``x * y + z`` of float64, rounded once."""

    def codegen(context, builder, signature, args):
        return builder.fma(*args)

    return types.float64(types.float64, types.float64, types.float64), codegen


@scalar
def sincos_turns(u):
    """Sine and cosine of ``2 pi u`` for u in [0, 1]."""
    quadrant = math.floor(4.0 * u + 0.5)
    s, c = sincos_octants(4.0 * u - quadrant)
    odd = (quadrant == 1.0) | (quadrant == 3.0)
    sine = c if odd else s
    cosine = s if odd else c
    sine = -sine if (quadrant == 2.0) | (quadrant == 3.0) else sine
    cosine = -cosine if (quadrant == 1.0) | (quadrant == 2.0) else cosine
    return sine, cosine


@scalar
def sincos_octants(t):
    """Sine and cosine of ``t`` quarter turns, t in [-1/2, 1/2]."""
    x = t * _HALF_PI
    z = x * x
    # fmt: off
    s = x * (1.0 + z * (-1.0 / 6.0 + z * (1.0 / 120.0 + z * (-1.0 / 5040.0 + z * (1.0 / 362880.0
        + z * (-1.0 / 39916800.0 + z * (1.0 / 6227020800.0 - z / 1307674368000.0)))))))
    c = 1.0 + z * (-0.5 + z * (1.0 / 24.0 + z * (-1.0 / 720.0 + z * (1.0 / 40320.0
        + z * (-1.0 / 3628800.0 + z * (1.0 / 479001600.0 - z / 87178291200.0))))))
    # fmt: on
    return s, c


@scalar
def exp_nonpositive(x):
    """Exponential of x <= 0, minus infinity included; zero below -700."""
    y = max(x, -700.0)
    k = math.floor(y * _LOG2_E + 0.5)
    r = y - k * _LN_2
    # fmt: off
    p = 1.0 + r * (1.0 + r * (1.0 / 2.0 + r * (1.0 / 6.0 + r * (1.0 / 24.0 + r * (1.0 / 120.0
        + r * (1.0 / 720.0 + r * (1.0 / 5040.0 + r * (1.0 / 40320.0 + r * (1.0 / 362880.0
        + r * (1.0 / 3628800.0 + r * (1.0 / 39916800.0 + r / 479001600.0)))))))))))
    # fmt: on
    power = bits_to_float((float_to_bits(k + _INTEGER_IN_LOW_BITS) + np.uint64(1023)) << np.uint64(52))
    return p * power if x >= -700.0 else 0.0


@scalar
def arctan2_first_quadrant(y, x):
    """Angle of the point (x, y), x >= 0 and y >= 0, in [0, pi/2]; 0 for the origin."""
    high = max(x, y)
    low = min(x, y)
    steep = low > _TAN_PI_8 * high
    t = (low - high if steep else low) / max(low + high if steep else high, 1e-300)
    z = t * t
    # fmt: off
    p = t * (_A0 + z * (_A1 + z * (_A2 + z * (_A3 + z * (_A4 + z * (_A5 + z * (_A6 + z * (_A7
        + z * (_A8 + z * (_A9 + z * _A10))))))))))
    # fmt: on
    p = p + _QUARTER_PI if steep else p
    return _HALF_PI - p if y > x else p


@scalar
def azimuth(y, x):
    """Azimuth of the point (x, y) in [0, 2 pi]; 0 for the origin."""
    p = arctan2_first_quadrant(abs(y), abs(x))
    p = math.pi - p if x < 0.0 else p
    return TWO_PI - p if y < 0.0 else p
