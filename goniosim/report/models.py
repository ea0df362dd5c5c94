"""The models that exist, as text: what they apply to, their options, and how fast they are here."""

import textwrap
import time

import numpy as np

from ..models import COMPONENTS, MODELS, describe_options, prepare
from ..scene import parse_scene

WIDTH = 100
# Directions and repetitions of the measurement: a few milliseconds for each model.
DIRECTIONS, REPEATS = 4096, 5

_COAT = {"interface": {"type": "dielectric", "eta": 1.5, "alpha": 0.2}}
_MEDIUM = {"medium": {"tau": [0.05, 0.1, 0.8]}}
# The speed of a model is measured on the first of these to which it applies.
_BASES = {
    "a rough metal": {"type": "conductor", "eta": 1.45, "kappa": [1.0, 0.01, 0.02], "alpha": 0.2},
    "a rough plastic": {"type": "lambert", "rho": [0.1, 0.6, 0.3]},
    "a rough slab": {"type": "dielectric", "eta": 1.0, "alpha": 0.2},
}


def description():
    """Describe all models.

    Returns
    -------
    str
    """
    blocks = []
    for name, model in MODELS.items():
        lines = [name, *_wrapped(model.citation), *_wrapped(f"applies to: {model.applies_to}")]
        what, prepared = _example(name)
        if prepared is not None:
            speed = f"{nanoseconds(prepared):.1f} ns per evaluation here"
            lines += _wrapped(f"{speed} (three channels, one thread, {what})")
        for option in describe_options(name):
            values = ", ".join(str(value).lower() for value in option.values)
            default = str(option.default).lower()
            lines += _wrapped(f"{option.name} = {default}  (of {values}): {option.meaning}", "    ")
        blocks.append("\n".join(lines))
    blocks.append("Options are set with goniosim compare --set MODEL.OPTION=VALUE; the defaults are shown.")
    return "\n\n".join(blocks)


def as_data():
    """Describe all models as plain data that JSON can hold.

    Returns
    -------
    list of dict
        ``name``, ``family``, ``citation``, ``applies_to``, ``components``, ``options`` and
        ``nanoseconds`` per evaluation here (None if it is not measured).
    """
    entries = []
    for name, model in MODELS.items():
        _, prepared = _example(name)
        entries.append(
            {
                "name": name,
                # A family is a folder.
                "family": model.options.__module__.split(".")[-2:][0],
                "citation": model.citation,
                "applies_to": model.applies_to,
                "components": [component for component in COMPONENTS if _applies(model, component)],
                "options": [
                    {"name": each.name, "default": each.default, "values": list(each.values), "meaning": each.meaning}
                    for each in describe_options(name)
                ],
                "nanoseconds": None if prepared is None else round(nanoseconds(prepared), 1),
            }
        )
    return entries


def nanoseconds(prepared):
    """Measured time of one evaluation of a model, all channels, on one thread.

    Parameters
    ----------
    prepared : goniosim.models.Prepared

    Returns
    -------
    float
        The fastest of some repetitions.
    """
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


def _example(name):
    """A material with an absorbing coat to which a model applies: what it is, and the model for light at 45 degrees."""
    for what, base in _BASES.items():
        scene = _scene(base)
        for component in ("reflection", "transmission"):
            if MODELS[name].supports(scene, component) is None:
                return what, prepare(name, scene, 45.0, component)
    return None, None


def _applies(model, component):
    return any(model.supports(_scene(base), component) is None for base in _BASES.values())


def _scene(base):
    layers = [_COAT, _MEDIUM, {"interface": base}]
    return parse_scene({"material": {"name": "example", "layers": layers}, "incident": {"theta_deg": [45]}})


def _wrapped(text, indent="  "):
    return textwrap.wrap(text, WIDTH, initial_indent=indent, subsequent_indent=indent + "  ")
