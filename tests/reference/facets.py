"""Scalar optics of the reference tracer: Fresnel factors, GGX masking, and how directions are drawn."""

import math

import numpy as np
from numba import njit


@njit
def fresnel_dielectric(cos_i, n_i, n_t):
    sin_t = n_i / n_t * math.sqrt(max(0.0, 1.0 - cos_i * cos_i))
    if sin_t >= 1.0:
        return 1.0
    cos_t = math.sqrt(1.0 - sin_t * sin_t)
    r_s = (n_i * cos_i - n_t * cos_t) / (n_i * cos_i + n_t * cos_t)
    r_p = (n_t * cos_i - n_i * cos_t) / (n_t * cos_i + n_i * cos_t)
    return 0.5 * (r_s * r_s + r_p * r_p)


@njit
def fresnel_conductor(cos_i, n_i, n_t):
    """Reflectance where `n_t` is complex."""
    sin_t = n_i / n_t * math.sqrt(max(0.0, 1.0 - cos_i * cos_i))
    cos_t = np.sqrt(1.0 - sin_t * sin_t)
    r_s = (n_i * cos_i - n_t * cos_t) / (n_i * cos_i + n_t * cos_t)
    r_p = (n_t * cos_i - n_i * cos_t) / (n_t * cos_i + n_i * cos_t)
    return 0.5 * (abs(r_s) ** 2 + abs(r_p) ** 2)


@njit
def smith_g1(wx, wy, wz, alpha):
    tan2 = (wx * wx + wy * wy) / (wz * wz)
    return 2.0 / (1.0 + math.sqrt(1.0 + alpha * alpha * tan2))


@njit
def cosine_direction(rng):
    radius2 = rng.random()
    azimuth = 2.0 * math.pi * rng.random()
    radius = math.sqrt(radius2)
    return radius * math.cos(azimuth), radius * math.sin(azimuth), math.sqrt(1.0 - radius2)


@njit
def visible_normal(wx, wy, wz, alpha, rng):
    """Draw a GGX facet normal visible from w, with w_z > 0.

    GGX of width alpha is a hemisphere squeezed by alpha (Heitz 2018). Seen
    from w, a point of a sphere appears with the cosine between its normal and
    w, so a normal is drawn with that cosine about w and tried again if it
    belongs to the lower half of the sphere.
    """
    length = math.sqrt((alpha * wx) ** 2 + (alpha * wy) ** 2 + wz * wz)
    sx, sy, sz = alpha * wx / length, alpha * wy / length, wz / length
    # Any frame about s serves: cross s with the axis it is least aligned with.
    if abs(sx) < 0.5:
        norm = math.sqrt(sy * sy + sz * sz)
        ax, ay, az = 0.0, sz / norm, -sy / norm
    else:
        norm = math.sqrt(sx * sx + sz * sz)
        ax, ay, az = -sz / norm, 0.0, sx / norm
    bx, by, bz = sy * az - sz * ay, sz * ax - sx * az, sx * ay - sy * ax
    while True:
        a, b, c = cosine_direction(rng)
        mz = a * az + b * bz + c * sz
        if mz > 0.0:
            break
    mx = alpha * (a * ax + b * bx + c * sx)
    my = alpha * (a * ay + b * by + c * sy)
    norm = math.sqrt(mx * mx + my * my + mz * mz)
    return mx / norm, my / norm, mz / norm
