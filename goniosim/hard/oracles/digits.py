"""Fresnel's transmittance with 40 digits, for angles that differ from the critical one in their last."""

from decimal import Decimal, localcontext

PI = Decimal("3.14159265358979323846264338327950288419716939937510")


def transmitted(theta_deg: float, eta: float) -> float:
    """1 - R of a dielectric for unpolarised light; 0 where all is reflected. The numbers are taken at their word."""
    with localcontext() as context:
        context.prec = 45
        n, angle = Decimal(eta), Decimal(theta_deg) * PI / 180
        sine = _sine(angle)
        c, square = (1 - sine * sine).sqrt(), n * n - sine * sine
        if square <= 0:
            return 0.0
        g = square.sqrt()
        return float(2 * c * g * (1 / (c + g) ** 2 + n * n / (n * n * c + g) ** 2))


def _sine(angle: Decimal) -> Decimal:
    term = total = angle
    for k in range(1, 40):
        term *= -angle * angle / ((2 * k) * (2 * k + 1))
        total += term
    return total
