"""The models that exist, as text: what they apply to, their options, and how fast they are here."""

import textwrap
import time

import numpy as np

from ..models import MODELS, describe_options, prepare
from ..scene import parse_scene

WIDTH = 100
# Directions and repetitions of the measurement: a few milliseconds for each model.
DIRECTIONS, REPEATS = 4096, 5

_COAT = {"interface": {"type": "dielectric", "eta": 1.5, "alpha": 0.2}}
_MEDIUM = {"medium": {"tau": [0.05, 0.1, 0.8]}}
_BASE = {"interface": {"type": "conductor", "eta": 1.45, "kappa": [1.0, 0.01, 0.02], "alpha": 0.2}}


def description():
    """Describe all models.

    Returns
    -------
    str
    """
    blocks = []
    for name, model in MODELS.items():
        lines = [name, *_wrapped(model.citation), *_wrapped(f"applies to: {model.applies_to}")]
        speed = f"{nanoseconds(name):.1f} ns per evaluation here"
        lines += _wrapped(f"{speed} (three channels, one thread, a rough metal)")
        for option in describe_options(name):
            values = ", ".join(str(value).lower() for value in option.values)
            default = str(option.default).lower()
            lines += _wrapped(f"{option.name} = {default}  (of {values}): {option.meaning}", "    ")
        blocks.append("\n".join(lines))
    blocks.append("Options are set with goniosim compare --set MODEL.OPTION=VALUE; the defaults are shown.")
    return "\n\n".join(blocks)


def nanoseconds(name):
    """Measured time of one evaluation of a model, all three channels, on one thread.

    Parameters
    ----------
    name : str

    Returns
    -------
    float
        The fastest of some repetitions, on a rough metal with an absorbing coat, at 45 degrees.
    """
    scene = parse_scene(
        {"material": {"name": "metal", "layers": [_COAT, _MEDIUM, _BASE]}, "incident": {"theta_deg": [45]}}
    )
    prepared = prepare(name, scene, 45.0)
    rng = np.random.default_rng(1)
    z = rng.uniform(0.05, 1.0, DIRECTIONS)
    phi = rng.uniform(0.0, 2.0 * np.pi, DIRECTIONS)
    sine = np.sqrt(1.0 - z * z)
    x, y = sine * np.cos(phi), sine * np.sin(phi)
    out = np.empty((len(prepared.mirror_energy), DIRECTIONS))
    times = []
    for _ in range(REPEATS + 1):  # the first one compiles
        started = time.perf_counter()
        prepared.kernel(prepared.tables, prepared.light, x, y, z, out)
        times.append(time.perf_counter() - started)
    return 1e9 * min(times) / DIRECTIONS


def _wrapped(text, indent="  "):
    return textwrap.wrap(text, WIDTH, initial_indent=indent, subsequent_indent=indent + "  ")
