"""Where directions limit: how far a slice is from the mean of its two neighbours when there are M incident angles."""

import numpy as np

from .norms import difference
from .runs import sampled

COUNTS = (7, 15, 30)
# Gaps between neighbours that are looked at for each number of directions.
GAPS = 3
# A scene with one direction says nothing of the range.
USUAL = (0.0, 85.0)


def gaps(scene):
    """Angles to be simulated: for each number of directions, some gaps of two neighbours and the angle between.

    Parameters
    ----------
    scene : goniosim.scene.Scene

    Returns
    -------
    dict of int to list of (float, float, float)
        In degrees, by number of directions.
    """
    angles = scene.incident.theta_deg
    low, high = (min(angles), max(angles)) if len(angles) > 1 else USUAL
    found = {}
    for count in COUNTS:
        # Exact for equal angles to be equal.
        nodes = [round(float(node), 9) for node in np.linspace(low, high, count)]
        places = sorted({round(place) for place in np.linspace(0, count - 2, GAPS)})
        found[count] = [(nodes[i], round(0.5 * (nodes[i] + nodes[i + 1]), 9), nodes[i + 1]) for i in places]
    return found


def dense_scene(scene):
    """The scene with all angles of `gaps`."""
    angles = sorted({angle for several in gaps(scene).values() for gap in several for angle in gap})
    return lit_from(scene, angles)


def lit_from(scene, theta_deg):
    """The scene with other incident angles."""
    return scene.model_copy(update={"incident": scene.incident.model_copy(update={"theta_deg": tuple(theta_deg)})})


def lost_between(scene, result):
    """Error of linear interpolation between incident directions, cell by cell.

    Parameters
    ----------
    scene : goniosim.scene.Scene
    result : goniosim.result.Result
        Of `dense_scene`.

    Returns
    -------
    dict of str to list of dict
        For each sampled component and number of directions: ``directions``, ``error`` (norm of the difference over
        that of the slice, the largest of some gaps) and its standard error ``uncertainty``.
    """
    angles = result.theta_deg.tolist()
    places = {
        count: [[angles.index(angle) for angle in gap] for gap in several] for count, several in gaps(scene).items()
    }
    return {
        name: [
            {"directions": count} | max((_off(component, result.cells, gap) for gap in several), key=_error)
            for count, several in places.items()
        ]
        for name, component in sampled(result).items()
    }


def _error(found):
    return found["error"]


def _off(component, cells, gap):
    before, between, after = gap
    size = np.where(cells.valid[list(gap)].all(axis=0), cells.projected_solid_angle[between], 0.0)
    weights = {before: -0.5, between: 1.0, after: -0.5}
    away = sum(weight * component.bsdf[m] for m, weight in weights.items())
    variance = sum(weight**2 * component.bsdf_stderr[m] ** 2 for m, weight in weights.items())
    own = component.bsdf[between] ** 2 - component.bsdf_stderr[between] ** 2
    error, unknown = difference(away, variance, own, size)
    return {"error": error, "uncertainty": unknown}
