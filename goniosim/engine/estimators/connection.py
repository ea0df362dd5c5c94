"""Connection of a Lambertian base to every cell: its inside radiance is one number per channel.

Every path that leaves a dielectric top over a Lambertian base has a last visit to the base. From there on it
is followed backwards: seen from v, a visible facet of the top refracts into the stack, and what stands at the end of
the line is the radiance L of the base, whatever the direction. With F and G1 at that facet, the transmittance A of
the medium and the index n below relative to above, a cell receives

    energy = L * integral over the cell of cos(theta_v) < (1 - F) G1 A > / n^2,    L = rho / pi * (energy arriving).

A base also forgets how light came to it. So the energy arriving is a series of products: the share that the top lets
in, times, for every further visit, rho and the share that comes back from the top. Every factor is a mean over light
paths of its own, hence a product of independent means without bias; so is its product with the integral, whose draws
are a cell's own. All factors are integrals in two to four dimensions, smooth but for a bend at the critical angle,
which a lattice knows well.
"""

import math
from dataclasses import replace

import numpy as np

from ...slices import CLASSIC, PARAMETRIZATIONS
from ..layout import UP
from ..rounds import SMALLEST
from ..stages import LAMBERT, ROUGH_DIELECTRIC, SMOOTH_DIELECTRIC
from ..unit import child_key
from .base_draws import BLOCK, N_SCRATCH, come_back, enter, look, uniforms

# Children of a replicate's key: the light paths, of which each visit to the base has its own, and the cells.
LIGHT, CELLS = 0, 1
# Light paths for each draw of a ring or cell, and draws of all of them for each light path, at the most.
PATHS, DRAWS = 8, 64
# Visits to the base whose energy is below this share of one path's are left to chance.
FAINT = 0.125
# Draws per call of a kernel, which cannot be interrupted: some tens of milliseconds.
CALL = 1 << 20


class Connection:
    """Reflection of a dielectric interface over a Lambertian base.

    Parameters
    ----------
    plan : goniosim.engine.plan.Plan
    sides : tuple of int
        Ways out: `UP`.
    """

    name = "connection"
    chunk = 1
    smallest = SMALLEST
    mends = False
    has_nodes = False

    @staticmethod
    def refusal(plan, sides):
        """One sentence why these ways out of a stack cannot be estimated so; None if they can."""
        kinds = tuple(plan.kinds)
        if sides == (UP,) and kinds in ((ROUGH_DIELECTRIC, LAMBERT), (SMOOTH_DIELECTRIC, LAMBERT)):
            return None
        return "it connects the base to the cells, which takes a single dielectric interface over a Lambertian base"

    @classmethod
    def tiny(cls, plan, sides):
        """One that runs the same kernels."""
        return cls(replace(plan, theta_deg=plan.theta_deg[:1], light=plan.light[:1], rows=2, columns=4), sides)

    def __init__(self, plan, sides):
        self.plan = plan
        # Cells that are told apart: rings of the same theta_v, or the first half of the columns.
        self.per_row = 1 if plan.parametrization == CLASSIC else (plan.columns + 1) // 2

    def prepare(self):
        """Do nothing: incident directions share nothing."""

    @property
    def memory(self):
        """Bytes shared by all threads, and of a workspace."""
        plan = self.plan
        cells = plan.rows * self.per_row
        numbers = (N_SCRATCH + plan.n_distinct) * BLOCK + 2 * cells
        return 0, 8 * (numbers + plan.n_distinct * (2 * cells + plan.rows * plan.width))

    def workspace(self):
        """Scratch arrays of one thread."""
        return Workspace(self.plan, self.per_row)


class Workspace:
    """Makes replicates, one after the other.

    Parameters
    ----------
    plan : goniosim.engine.plan.Plan
    per_row : int
        Cells of a row that are told apart.
    """

    def __init__(self, plan, per_row):
        self.plan = plan
        self.per_row = per_row
        self.scratch = np.empty((N_SCRATCH, BLOCK))
        self.flat = np.empty((plan.n_distinct, BLOCK))
        self.interface = (float(plan.alphas[0]), float(plan.etas[0]))

    def run(self, direction, size, keys, out, stop):
        """Make one replicate for each key.

        Parameters
        ----------
        direction : int
        size : int
            Light paths that start; as many leave the base for every further visit, until too little is left. Every
            eighth comes with a draw in each ring or cell; fewer do where these are many.
        keys : ndarray of uint64
        out : ndarray, shape (len(keys), slots, distinct channels, rows, width)
            Overwritten: the energy in every cell, as a fraction of the incident flux.
        stop : threading.Event

        Returns
        -------
        int or None
            Draws of facets, each as good as an event; None if it was stopped.
        """
        cells = self._cells(direction)
        draws = max(1, min(size // PATHS, DRAWS * size // len(cells)))
        events = 0
        for replicate, key in zip(out, keys, strict=True):
            arriving = self._arriving(direction, size, child_key(key, LIGHT), len(replicate), stop)
            leaving = None if arriving is None else self._leaving(direction, cells, draws, child_key(key, CELLS), stop)
            if leaving is None:
                return None
            energy, generations = arriving
            radiance = energy * self.plan.spectral[1, 0] / math.pi
            np.multiply(radiance[:, :, None, None], leaving, out=replicate)
            events += generations * size + draws * len(cells)
        return events

    def _cells(self, direction):
        """Numbers ``row * per_row + column`` of the cells that light can reach."""
        if self.per_row == 1:
            return np.arange(self.plan.rows)
        above = self.plan.geometry[direction].projected_solid_angle[:, : self.per_row] > 0.0
        return np.flatnonzero(above.ravel())

    def _arriving(self, direction, size, key, slots, stop):
        """Energy (slots, channels) that arrives at the base before it leaves, by order; and how often it was drawn."""
        plan = self.plan
        sine, height = plan.light[direction, ::2]
        found = np.zeros((slots, plan.n_distinct))
        light = np.ones(plan.n_distinct)
        generation = 0
        while light.any():
            shifts = uniforms(child_key(key, generation), 4)
            sums = np.zeros(plan.n_distinct)
            for first in range(0, size, CALL):
                if stop.is_set():
                    return None
                n = min(CALL, size - first)
                if generation == 0:
                    enter(self.interface, plan.taus[0], sine, height, first, n, shifts, self.scratch, sums)
                else:
                    come_back(self.interface, plan.taus[0], first, n, shifts, self.scratch, sums)
            light *= sums / size
            slot = min(generation, slots - 1)
            found[slot] += light
            light *= plan.spectral[1, 0]
            generation += 1
            if slot == slots - 1:
                light = _gamble(light, found[slot] * (FAINT / size), shifts[3])
        return found, generation

    def _leaving(self, direction, cells, draws, key, stop):
        """Energy (channels, rows, width) that leaves into every cell, for a base of unit radiance."""
        plan = self.plan
        code, module = PARAMETRIZATIONS[plan.parametrization_name]
        tilt = module.tilt(np.linspace(0.0, 0.5 * math.pi, plan.rows + 1))
        slices = (code, np.sin(0.5 * tilt) ** 2, self.per_row, plan.columns, plan.light[direction])
        sums = np.zeros((plan.n_distinct, len(cells)))
        many, deep = max(BLOCK, CALL // draws), CALL // BLOCK
        for start in range(0, len(cells), many):
            end = min(start + many, len(cells))
            for first in range(0, draws, deep):
                if stop.is_set():
                    return None
                n = min(deep, draws - first)
                place = (start, end, first, n)
                look(self.interface, plan.taus[0], slices, cells, *place, key, self.scratch, self.flat, sums)
        found = np.zeros((plan.n_distinct, plan.rows * self.per_row))
        # In solid angle of the axis: twice the step of the squared sine, times the step of the azimuth.
        area = module.AXIS_JACOBIAN * 2.0 * (2.0 * math.pi / plan.columns)
        found[:, cells] = sums * (area / (draws * plan.etas[0] ** 2))
        # A ring has one number for all its cells; the second half of an odd number of columns mirrors the first.
        columns = np.arange(plan.width)
        columns = np.minimum(np.minimum(columns, plan.columns - 1 - columns), self.per_row - 1)
        return found.reshape(plan.n_distinct, plan.rows, self.per_row)[:, :, columns]


def _gamble(light, threshold, chance):
    """Russian roulette with what is faint in all channels: ends it, or restores it to where it is not."""
    bright = np.max(light / np.maximum(threshold, np.finfo(float).tiny))
    if bright >= 1.0:
        return light
    return light / bright if chance < bright else np.zeros_like(light)
