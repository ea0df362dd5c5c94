"""From a ladder to a law: error against rays, time against rays, and what is not known about either.

The relative error of a slice falls as N^-s with the number of light paths; s is 1/2 for independent paths, and is
fitted where paths are not. Time grows as p + c N. So the time for an error is that for the paths it takes, and the
part of a run that does not grow with it cannot bend the slope.
"""

from dataclasses import dataclass

import numpy as np

from .ladder import alike

INDEPENDENT = 0.5
# What no lattice exceeds for sums over cells, whose edges are steps.
STEEPEST = 1.0
# Fewer runs do not tell a slope.
FEWEST = 3
# No ladder of some seconds tells more about a norm over thousands of correlated cells, or about a clock.
LEAST_SCATTER = 0.02


@dataclass(frozen=True)
class Law:
    """Error and time of one component with one estimator, in each of M directions.

    Attributes
    ----------
    slope, slope_error : float
        s above, and its standard error: 0 where it is known.
    scatter : float
        Of the logarithm of the error around the law.
    level : ndarray, shape (M,)
        Logarithm of the relative error in the middle of the ladder; NaN where there is no light.
    middle, spread : float
        Logarithms of rays on the ladder: their mean, and the root of the sum of their squared deviations.
    rungs : int
    fewest, most : float
        Rays of the first and of the last rung.
    fixed, per_ray : ndarray, shape (2, M)
        p and c, of seconds and of CPU seconds.
    clock : float
        Scatter of the logarithm of the time, of the worse of the two clocks.
    overhead : ndarray, shape (2,)
        Time of a run besides tracing, in seconds and CPU seconds.
    """

    slope: float
    slope_error: float
    scatter: float
    level: np.ndarray
    middle: float
    spread: float
    rungs: int
    fewest: float
    most: float
    fixed: np.ndarray
    per_ray: np.ndarray
    clock: float
    overhead: np.ndarray

    @property
    def used_slope(self):
        """The slope to predict with: more replicates instead of larger ones always give that of independent paths."""
        return min(max(self.slope, INDEPENDENT), STEEPEST)

    def error(self, rays):
        """Relative errors with so many rays, shape (M,)."""
        return np.exp(self.level - self.used_slope * (np.log(rays) - self.middle))

    def rays(self, error):
        """Rays that an error takes, and the relative standard error of that number, each of shape (M,)."""
        away = (self.level - np.log(error)) / self.used_slope
        unknown = np.hypot(self.scatter / np.sqrt(self.rungs), np.abs(away) * self.slope_error) / self.used_slope
        return np.exp(self.middle + away), unknown

    def time(self, rays):
        """Seconds and CPU seconds of tracing so many rays from each direction, shape (2, M)."""
        return self.fixed + self.per_ray * rays


def fit(rungs, component, norm, independent):
    """Fit a ladder.

    Parameters
    ----------
    rungs : list of Run
        Those by other means than the last are left out.
    component : str
    norm : ndarray, shape (M,)
        Of the slices, from the best run there is.
    independent : bool
        Whether paths are, so that the slope is known.

    Returns
    -------
    Law
    """
    rungs = alike(rungs, component)
    noise = np.array([rung.noise[component] for rung in rungs])
    lit = (norm > 0.0) & (noise[-1] > 0.0)
    # A run that met no light in some direction tells nothing of it.
    seen = (noise[:, lit] > 0.0).all(axis=1)
    rungs, noise = [rung for rung, told in zip(rungs, seen, strict=True) if told], noise[seen]
    x = np.log([rung.rays.mean() for rung in rungs])
    y = np.log(np.where(lit, noise, 1.0) / np.where(lit, norm, 1.0))
    level = np.where(lit, y.mean(axis=0), np.nan)
    middle, spread = x.mean(), float(np.sqrt(((x - x.mean()) ** 2).sum()))
    fitted = len(rungs) >= FEWEST and not independent
    falls = -((x - middle) @ (y - level)[:, lit]) / spread**2 if fitted else np.zeros(0)
    slope = float(falls.mean()) if len(falls) else INDEPENDENT
    left = (y - level)[:, lit] + slope * (x - middle)[:, None]
    # Directions share the seed and the estimator: their deviations are taken to be one and the same.
    known = max(len(rungs) - 1 - bool(len(falls)), 1)
    scatter = max(float(np.sqrt((left**2).sum(axis=0).mean() / known)), LEAST_SCATTER) if lit.any() else LEAST_SCATTER
    fixed, per_ray, clock = _times(rungs, np.exp(x))
    return Law(
        slope=slope,
        slope_error=scatter / spread if len(falls) else 0.0,
        scatter=scatter,
        level=level,
        middle=float(middle),
        spread=spread,
        rungs=len(rungs),
        fewest=float(np.exp(x[0])),
        most=float(np.exp(x[-1])),
        fixed=fixed,
        per_ray=per_ray,
        clock=clock,
        overhead=np.array([min(rung.overhead for rung in rungs), min(rung.cpu_overhead for rung in rungs)]),
    )


def _times(rungs, rays):
    """The p and c of the law, each of shape (2, M), and the scatter around it."""
    seconds = np.array([[rung.seconds, rung.cpu_seconds] for rung in rungs])
    totals = seconds.sum(axis=2)
    # A clock errs like a count: what takes longer is known better, relative to its length.
    weight = (1.0 / totals)[..., None]
    rays = rays[:, None, None]
    mean = (weight * rays).sum(axis=0) / weight.sum(axis=0)
    spread = (weight * (rays - mean) ** 2).sum(axis=0)
    # A single run: all of it is taken to grow.
    grows = (weight * (rays - mean) * seconds).sum(axis=0) / spread if len(rungs) > 1 else seconds[0] / rays[0]
    fixed = (weight * (seconds - grows * rays)).sum(axis=0) / weight.sum(axis=0)
    # It cannot be less than nothing, or more than the shortest run took.
    fixed = np.clip(fixed, 0.0, seconds.min(axis=0))
    per_ray = (weight * rays * (seconds - fixed)).sum(axis=0) / (weight * rays**2).sum(axis=0)
    off = np.log(totals / (fixed + per_ray * rays).sum(axis=2))
    share = totals / totals.sum(axis=0)
    return fixed, per_ray, max(float(np.sqrt((share * off**2).sum(axis=0).max())), LEAST_SCATTER)
