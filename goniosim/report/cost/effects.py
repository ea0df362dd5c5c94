"""What each effect of a scene adds to the time per ray: the scene without it, traced in turns with the whole."""

from dataclasses import dataclass

import numpy as np

from ...engine import probe
from .without import without_effects

# Turns of all scenes; the first warms up.
TURNS = 5
# Of each trial, in seconds.
SHORTEST, LONGEST = 0.02, 0.4


@dataclass(frozen=True)
class Added:
    """What one effect adds.

    Attributes
    ----------
    without : str
        What the scene was without.
    ratio : float
        Time per ray of the scene over that without the effect.
    uncertainty : float
        Standard error of ``ratio``.
    """

    without: str
    ratio: float
    uncertainty: float


def added(scene, seconds):
    """Measure what each effect adds to the time of an independent path.

    Parameters
    ----------
    scene : goniosim.scene.Scene
    seconds : float
        To be spent, about.

    Returns
    -------
    dict of str to Added
        By effect; only those that the scene has and can be without.
    """
    # Of independent paths alone a single one has a price.
    scene = scene.model_copy(update={"simulation": scene.simulation.model_copy(update={"estimator": "analog"})})
    variants = without_effects(scene)
    if not variants:
        return {}
    scenes = [scene, *(variant for _, variant in variants.values())]
    trial = float(np.clip(seconds / (TURNS * len(scenes)), SHORTEST, LONGEST))
    speeds = np.array([[probe(each, trial).rays_per_second for each in scenes] for _ in range(TURNS + 1)])
    # Within a turn the machine is the same for all.
    logs = np.log(speeds[1:, 1:] / speeds[1:, :1])
    ratios, errors = np.exp(logs.mean(axis=0)), logs.std(axis=0, ddof=1) / np.sqrt(TURNS)
    return {
        name: Added(words, float(ratio), float(ratio * error))
        for (name, (words, _)), ratio, error in zip(variants.items(), ratios, errors, strict=True)
    }
