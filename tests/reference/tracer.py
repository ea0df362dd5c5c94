"""A slow, obvious, one-ray-at-a-time tracer: the oracle the engine is tested against.

It shares no code with goniosim. Wherever there was a choice, the plainer way
was taken, even if it is slower: visible normals by rejection, Fresnel factors
from the amplitude coefficients of Snell's law, complex numbers for conductors,
one generator for all rays, no Russian roulette.

Physics: rough interfaces after Walter et al. 2007 with separable Smith GGX
masking. A facet is drawn from the normals visible from the arriving ray; a
coin flip with the Fresnel factor decides between reflection and refraction;
the ray then carries the factor G1 of its new direction. A reflection that ends
below the surface, or a refraction that ends above it, is lost.
"""

import math
from dataclasses import dataclass

import numpy as np
from numba import njit

from .facets import cosine_direction, fresnel_conductor, fresnel_dielectric, smith_g1, visible_normal

DIELECTRIC, CONDUCTOR, LAMBERT = 0, 1, 2
KINDS = {"dielectric": DIELECTRIC, "conductor": CONDUCTOR, "lambert": LAMBERT}

DIRECT, INTERNAL, TRANSMISSION, NOWHERE = 0, 1, 2, 3
COMPONENTS = ("reflection/direct", "reflection/internal", "transmission")

# Positions of the audit entries; the first three repeat the components.
IN_MEDIA, IN_BASE, LOST_REFLECTING, LOST_REFRACTING, EVENT_CAP = 3, 4, 5, 6, 7
AUDIT = (
    "reflected_direct",
    "reflected_internal",
    "transmitted",
    "absorbed_media",
    "absorbed_base",
    "lost_masked_reflection",
    "lost_masked_transmission",
    "lost_event_cap",
)
MAX_EVENTS = 1_000_000

# A direction this close below the edge of a cell, in cell widths, counts as on the edge,
# and an edge belongs to the cell above it.
TIE = 1e-9


@dataclass(frozen=True)
class Interface:
    """One interface; per-channel quantities are tuples with one value for each channel.

    Attributes
    ----------
    kind : str
        ``dielectric``, ``conductor`` or ``lambert``.
    alpha : float
        GGX width; 0 is a perfectly smooth interface.
    eta : tuple of float
        Absolute refractive index below the interface (real part).
    kappa : tuple of float
        Imaginary part of the index of a conductor.
    rho : tuple of float
        Albedo of a Lambertian base.
    """

    kind: str
    alpha: float = 0.0
    eta: tuple = (1.0,)
    kappa: tuple = (0.0,)
    rho: tuple = (0.0,)


@dataclass(frozen=True)
class Stack:
    """Interfaces from top to bottom, air above; ``tau[k]`` lies between interface k and k + 1."""

    interfaces: tuple
    tau: tuple
    channels: int = 1


@dataclass
class Trace:
    """What `trace` returns.

    Attributes
    ----------
    energy, stderr : dict of str to ndarray, shape (C, R, K)
        Per component: fraction of the incident flux per cell and its standard error.
    hits : dict of str to ndarray of int64, shape (R, K)
        Rays that left through the cell.
    orders : dict of str to list of ndarray, shape (C, R, K)
        ``energy`` split by the number of events on the top interface: entry
        ``i`` holds ``i + 1`` events, the last one that many or more.
    order_stderr : dict of str to list of ndarray, shape (C, R, K)
    audit, audit_stderr : dict of str to ndarray, shape (C,)
        Where the energy went; the keys are `AUDIT`.
    events : float
        Mean number of interface events of a ray.
    """

    energy: dict
    stderr: dict
    hits: dict
    orders: dict
    order_stderr: dict
    audit: dict
    audit_stderr: dict
    events: float


def stack_from_scene(scene):
    """Convert a goniosim ``Scene`` (duck-typed: nothing of goniosim is imported)."""

    def triple(value):
        return tuple(float(v) for v in (value if isinstance(value, list | tuple) else [value] * 3))

    interfaces = []
    for layer in scene.material.interfaces:
        kind = layer.type
        interfaces.append(
            Interface(
                kind=kind,
                alpha=float(layer.alpha) if kind != "lambert" else 0.0,
                eta=triple(layer.eta) if kind != "lambert" else triple(1.0),
                kappa=triple(layer.kappa) if kind == "conductor" else triple(0.0),
                rho=triple(layer.rho) if kind == "lambert" else triple(0.0),
            )
        )
    return Stack(tuple(interfaces), tuple(triple(t) for t in scene.material.tau), channels=3)


@njit
def walk(kind, alpha, eta, kappa, rho, tau, dx, dy, dz, rng, weight, booked):
    """Follow one ray, that travels along d, until it leaves, is lost or carries nothing.

    `weight` (per channel) and `booked` (audit entry, channel) are changed in
    place. Returns the component, the number of events on the top interface,
    the number of events in all, and the last direction of travel.
    """
    channels = weight.shape[0]
    last = kind.shape[0] - 1
    k = 0
    top_events = 0
    for event in range(1, MAX_EVENTS + 1):
        if k == 0:
            top_events += 1
        # Towards the light: w points back along the ray. The frame is flipped for a ray
        # that comes from below, so that w is always above the surface.
        from_above = dz < 0.0
        wx, wy, wz = -dx, -dy, abs(dz)
        n_above = eta[k - 1, 0] if k > 0 else 1.0
        n_below = eta[k, 0]
        rough = alpha[k] > 0.0
        lost_entry = LOST_REFLECTING

        if kind[k] == LAMBERT:
            ox, oy, oz = cosine_direction(rng)
            for c in range(channels):
                booked[IN_BASE, c] += weight[c] * (1.0 - rho[k, c])
                weight[c] *= rho[k, c]
            right_side = True
        else:
            mx, my, mz = 0.0, 0.0, 1.0
            if rough:
                mx, my, mz = visible_normal(wx, wy, wz, alpha[k], rng)
            cos_i = min(1.0, wx * mx + wy * my + wz * mz)
            reflects = True
            if kind[k] == CONDUCTOR:
                for c in range(channels):
                    reflectance = fresnel_conductor(cos_i, n_above, complex(eta[k, c], kappa[k, c]))
                    booked[IN_BASE, c] += weight[c] * (1.0 - reflectance)
                    weight[c] *= reflectance
            else:
                n_i, n_t = (n_above, n_below) if from_above else (n_below, n_above)
                reflects = rng.random() < fresnel_dielectric(cos_i, n_i, n_t)
            if reflects:
                ox = 2.0 * cos_i * mx - wx
                oy = 2.0 * cos_i * my - wy
                oz = 2.0 * cos_i * mz - wz
                right_side = oz > 0.0
            else:
                # Snell about the facet: the tangential part shrinks by n_i / n_t.
                tx, ty, tz = -(wx - cos_i * mx), -(wy - cos_i * my), -(wz - cos_i * mz)
                tx, ty, tz = tx * n_i / n_t, ty * n_i / n_t, tz * n_i / n_t
                cos_t = math.sqrt(max(0.0, 1.0 - (tx * tx + ty * ty + tz * tz)))
                ox, oy, oz = tx - cos_t * mx, ty - cos_t * my, tz - cos_t * mz
                right_side = oz < 0.0
                lost_entry = LOST_REFRACTING

        if not right_side:
            for c in range(channels):
                booked[lost_entry, c] += weight[c]
            return NOWHERE, top_events, event, dx, dy, dz
        if rough:
            visible = smith_g1(ox, oy, oz, alpha[k])
            for c in range(channels):
                booked[lost_entry, c] += weight[c] * (1.0 - visible)
                weight[c] *= visible

        dx, dy, dz = ox, oy, (oz if from_above else -oz)
        upwards = dz > 0.0
        if upwards and k == 0:
            return (DIRECT if event == 1 else INTERNAL), top_events, event, dx, dy, dz
        if not upwards and k == last:
            return TRANSMISSION, top_events, event, dx, dy, dz

        medium = k - 1 if upwards else k
        alive = False
        for c in range(channels):
            if tau[medium, c] > 0.0:
                passes = math.exp(-tau[medium, c] / abs(dz))
                booked[IN_MEDIA, c] += weight[c] * (1.0 - passes)
                weight[c] *= passes
            alive = alive or weight[c] > 0.0
        if not alive:
            return NOWHERE, top_events, event, dx, dy, dz
        k = k - 1 if upwards else k + 1

    for c in range(channels):
        booked[EVENT_CAP, c] += weight[c]
    return NOWHERE, top_events, MAX_EVENTS, dx, dy, dz


@njit
def cell_of(dx, dy, dz, lx, ly, lz, half, rows, columns):
    """Row and column of the cell that holds the outgoing direction d."""
    if half:
        hx, hy, hz = lx + dx, ly + dy, lz + abs(dz)
        in_plane = math.sqrt(hx * hx + hy * hy)
        if in_plane < 1e-12 * hz:
            return 0, 0
        position = math.sqrt(math.atan2(in_plane, hz) / (0.5 * math.pi))
        azimuth = math.atan2(hy, hx)
    else:
        in_plane = math.sqrt(dx * dx + dy * dy)
        if in_plane < 1e-12:
            return 0, 0
        position = math.atan2(in_plane, abs(dz)) / (0.5 * math.pi)
        azimuth = math.atan2(dy, dx)
    turn = azimuth / (2.0 * math.pi) % 1.0
    row = min(int(position * rows + TIE), rows - 1)
    return row, int(turn * columns + TIE) % columns


@njit
def trace_rays(kind, alpha, eta, kappa, rho, tau, theta, rays, half, rng, moment1, moment2, hits, audit1, audit2):
    """Trace and tally; the moments are ``[component, order, channel, row, column]``."""
    channels = tau.shape[1]
    n_orders, rows, columns = moment1.shape[1], moment1.shape[3], moment1.shape[4]
    lx, ly, lz = math.sin(theta), 0.0, math.cos(theta)
    weight = np.empty(channels)
    booked = np.empty((audit1.shape[0], channels))
    events = 0
    for _ in range(rays):
        weight[:] = 1.0
        booked[:] = 0.0
        component, top_events, n_events, dx, dy, dz = walk(
            kind, alpha, eta, kappa, rho, tau, -lx, -ly, -lz, rng, weight, booked
        )
        events += n_events
        if component != NOWHERE:
            row, column = cell_of(dx, dy, dz, lx, ly, lz, half, rows, columns)
            order = min(top_events, n_orders) - 1
            hits[component, row, column] += 1
            for c in range(channels):
                moment1[component, order, c, row, column] += weight[c]
                moment2[component, order, c, row, column] += weight[c] ** 2
                booked[component, c] += weight[c]
        audit1 += booked
        audit2 += booked * booked
    return events


def trace(stack, theta_deg, rays, seed, rows=90, columns=360, parametrization="classic", orders=1):
    """Trace rays from one incident direction (phi = 0) through a stack.

    Parameters
    ----------
    stack : Stack
    theta_deg : float
        Polar angle of the light in degrees.
    rays, seed : int
    rows, columns : int
        Cells of the slices.
    parametrization : str
        ``classic`` or ``half``.
    orders : int
        Number of bins for the events on the top interface; the last is open.

    Returns
    -------
    Trace
    """
    channels = stack.channels
    n = len(stack.interfaces)

    def per_channel(value):
        return list(value) if len(value) == channels else list(value) * channels

    kind = np.array([KINDS[i.kind] for i in stack.interfaces])
    alpha = np.array([i.alpha for i in stack.interfaces], dtype=float)
    eta = np.array([per_channel(i.eta) for i in stack.interfaces], dtype=float)
    kappa = np.array([per_channel(i.kappa) for i in stack.interfaces], dtype=float)
    rho = np.array([per_channel(i.rho) for i in stack.interfaces], dtype=float)
    tau = np.zeros((n, channels))
    for k, value in enumerate(stack.tau):
        tau[k] = per_channel(value)

    moment1 = np.zeros((3, orders, channels, rows, columns))
    moment2 = np.zeros_like(moment1)
    hits = np.zeros((3, rows, columns), dtype=np.int64)
    audit1 = np.zeros((len(AUDIT), channels))
    audit2 = np.zeros_like(audit1)
    events = trace_rays(
        kind, alpha, eta, kappa, rho, tau, math.radians(theta_deg), rays, parametrization == "half",
        np.random.default_rng(seed), moment1, moment2, hits, audit1, audit2,
    )  # fmt: skip

    def mean_and_error(first, second):
        mean = first / rays
        return mean, np.sqrt(np.maximum(0.0, second / rays - mean * mean) / rays)

    by_order, by_order_error = mean_and_error(moment1, moment2)
    # A ray leaves once, so the moments of different orders add up.
    energy, error = mean_and_error(moment1.sum(axis=1), moment2.sum(axis=1))
    booked, booked_error = mean_and_error(audit1, audit2)
    return Trace(
        energy=dict(zip(COMPONENTS, energy, strict=True)),
        stderr=dict(zip(COMPONENTS, error, strict=True)),
        hits=dict(zip(COMPONENTS, hits, strict=True)),
        orders={name: list(by_order[i]) for i, name in enumerate(COMPONENTS)},
        order_stderr={name: list(by_order_error[i]) for i, name in enumerate(COMPONENTS)},
        audit=dict(zip(AUDIT, booked, strict=True)),
        audit_stderr=dict(zip(AUDIT, booked_error, strict=True)),
        events=events / rays,
    )
