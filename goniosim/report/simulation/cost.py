"""What accuracy cost in time, and what more of it would cost."""

import numpy as np

from .. import text
from .trend import trend

# Rows shown of a long list of checkpoints.
MOST_ROWS = 6


def cost_lines(result):
    """Table of rays, times and noise at some checkpoints, and the price of half the noise.

    Parameters
    ----------
    result : goniosim.result.Result

    Returns
    -------
    list of str
    """
    cost = result.cost
    if not cost.checkpoints:
        return []
    noise = {name: cost.noise(name) for name in cost.error}
    rays, elapsed, cpu_seconds = cost.rays.mean(axis=0), cost.elapsed, cost.cpu_seconds.sum(axis=0)
    header = ["rays per direction", "seconds", "CPU seconds", *(f"noise {name}\n[sr^-1/2]" for name in noise)]
    rows = [
        [
            text.count(round(rays[p])),
            f"{elapsed[p]:.2f}",
            f"{cpu_seconds[p]:.2f}",
            *(f"{error[p]:.2e}" for error in noise.values()),
        ]
        for p in _spread(cost.checkpoints)
    ]
    lines = ["Cost (noise: standard error integrated over the slice, the floor of an RMSE, in sr^-1/2)"]
    lines += text.table(header, rows)
    total = float(result.rays.sum())
    seconds, cpu_seconds = float(elapsed[-1]), float(cpu_seconds[-1])
    if seconds > 0.0 and cpu_seconds > 0.0:
        lines.append(
            f"  {text.count(total)} rays in {text.duration(seconds)}: {text.rate(total / seconds)}, "
            f"{text.rate(total / cpu_seconds, per='CPU-second')}."
        )
        # Where there is no noise, nothing was seen, or all paths are alike.
        courses = [trend(result, name) for name, error in noise.items() if error[-1] > 0.0]
        lines += [_half(result, max(courses, key=lambda course: course.seconds_for(2.0)))] if courses else []
    return lines


def _half(result, hardest):
    times = hardest.rays_for(2.0)
    return (
        f"  Half the noise takes {times:.2g} times the rays: {text.count(round(times * result.rays.max()))} "
        f"per direction, {hardest.about} {text.duration(hardest.seconds_for(2.0))} on this machine."
    )


def _spread(n):
    """At most `MOST_ROWS` indices of n checkpoints, evenly in the logarithm, with the last."""
    if n <= MOST_ROWS:
        return range(n)
    return sorted({round(p) - 1 for p in np.geomspace(1, n, MOST_ROWS)})
