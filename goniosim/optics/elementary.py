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
# 1.5 * 2^52 + 1023: adding it leaves an integer-valued number, with the bias of exponents, in the low bits.
_BIASED_IN_LOW_BITS = 6755399441055744.0 + 1023.0
_EXPONENT = np.uint64(52)


def _coefficients(f, degree, low, high):
    """Coefficients of a polynomial close to f on [low, high]: Chebyshev interpolation."""
    interpolant = np.polynomial.Chebyshev.interpolate(f, degree, domain=[low, high])
    return (float(c) for c in interpolant.convert(kind=np.polynomial.Polynomial).coef)


def _series(z, first):
    """Sum of (-z)^k / (2 k + first)! over k: sines and cosines without their first terms."""
    return sum((-z) ** k / math.factorial(2 * k + first) for k in range(10))


# With z the square of the argument:
# (exp(r) - 1) / r = E0 + E1 r + ...
_E0, _E1, _E2, _E3, _E4, _E5, _E6, _E7, _E8, _E9 = _coefficients(
    lambda r: np.expm1(r) / r, 9, -0.5 * _LN_2, 0.5 * _LN_2
)
# sin(x) = x - x z (S0 + S1 z + ...)
_S0, _S1, _S2, _S3, _S4, _S5 = _coefficients(lambda z: _series(z, 3), 5, 0.0, _QUARTER_PI**2)
# cos(x) = 1 - z (C0 + C1 z + ...)
_C0, _C1, _C2, _C3, _C4, _C5 = _coefficients(lambda z: _series(z, 2), 5, 0.0, _QUARTER_PI**2)
# atan(t) = t (A0 + A1 z + ...)
_A0, _A1, _A2, _A3, _A4, _A5, _A6, _A7, _A8, _A9 = _coefficients(
    lambda z: np.arctan(np.sqrt(z)) / np.sqrt(z), 9, 0.0, _TAN_PI_8**2
)


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
    s = x - x * z * (_S0 + z * (_S1 + z * (_S2 + z * (_S3 + z * (_S4 + z * _S5)))))
    c = 1.0 - z * (_C0 + z * (_C1 + z * (_C2 + z * (_C3 + z * (_C4 + z * _C5)))))
    return s, c


@scalar
def sincos_first_quadrant(x):
    """Sine and cosine of an angle ``x`` in [0, pi/2]."""
    steep = x > _QUARTER_PI
    s, c = sincos_octants((_HALF_PI - x if steep else x) / _HALF_PI)
    return c if steep else s, s if steep else c


@scalar
def exp_nonpositive(x):
    """Exponential of x <= 0, minus infinity included; zero below -700."""
    y = max(x, -700.0)
    k = math.floor(y * _LOG2_E + 0.5)
    r = y - k * _LN_2
    # fmt: off
    p = 1.0 + r * (_E0 + r * (_E1 + r * (_E2 + r * (_E3 + r * (_E4 + r * (_E5 + r * (_E6 + r * (_E7
        + r * (_E8 + r * _E9)))))))))
    # fmt: on
    power = bits_to_float(float_to_bits(k + _BIASED_IN_LOW_BITS) << _EXPONENT)
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
        + z * (_A8 + z * _A9)))))))))
    # fmt: on
    p = p + _QUARTER_PI if steep else p
    return _HALF_PI - p if y > x else p


@scalar
def azimuth(y, x):
    """Azimuth of the point (x, y) in [0, 2 pi]; 0 for the origin."""
    p = arctan2_first_quadrant(abs(y), abs(x))
    p = math.pi - p if x < 0.0 else p
    return TWO_PI - p if y < 0.0 else p
