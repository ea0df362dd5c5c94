"""How time and noise of a run went along: what more accuracy would cost.

As in `goniosim.report.cost.fit`, time grows as p + c N with the number of light paths, and noise falls as N^-s; here
the last two checkpoints are all there is.
"""

from dataclasses import dataclass

from ...accuracy import fall


@dataclass(frozen=True)
class Trend:
    """Of one component, over all directions.

    Attributes
    ----------
    rays : float
        Light paths of a direction, mean.
    fixed, per_ray : float
        Seconds: p, and c.
    slope : float
        s.
    is_bound : bool
        Whether there is a single checkpoint: then the times that follow are the most that it can be.
    """

    rays: float
    fixed: float
    per_ray: float
    slope: float
    is_bound: bool

    def rays_for(self, factor):
        """How many times the rays an error takes that is ``factor`` times smaller."""
        return factor ** (1.0 / self.slope)

    def seconds_for(self, factor):
        """Seconds that it takes."""
        return self.fixed + self.per_ray * self.rays * self.rays_for(factor)

    @property
    def about(self):
        """The word before such a time."""
        return "at most" if self.is_bound else "about"


def trend(result, name):
    """The trend of a component.

    Parameters
    ----------
    result : goniosim.result.Result
    name : str
        Of a sampled component.

    Returns
    -------
    Trend
    """
    rays, seconds, noise = result.cost.rays.mean(axis=0), result.cost.elapsed, result.cost.noise(name)
    fixed, per_ray = 0.0, seconds[-1] / max(rays[-1], 1.0)
    grown = len(rays) > 1 and rays[-1] > rays[-2] > 0.0
    if grown:
        per_ray = min((seconds[-1] - seconds[-2]) / (rays[-1] - rays[-2]), per_ray)
        fixed = seconds[-1] - per_ray * rays[-1]
    independent = all(each == "analog" for each in result.components[name].estimator)
    slope = fall(rays, noise, independent)
    return Trend(float(rays[-1]), float(fixed), float(per_ray), slope, not (grown or independent))
