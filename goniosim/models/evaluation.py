"""Models by name: their options, and their values in given directions."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from goniosim.errors import ConfigError
from goniosim.scene import Scene, Source, as_scene
from goniosim.scene.problems import closest, listed

from .model import COMPONENTS, Model, Prepared
from .options import OptionInfo, describe, parse_options
from .registry import MODELS

if TYPE_CHECKING:
    from _typeshed import DataclassInstance


def find_model(name: str) -> Model:
    """The model of that name.

    Parameters
    ----------
    name : str

    Returns
    -------
    goniosim.models.Model

    Raises
    ------
    ConfigError
        There is none; the message names those that exist.
    """
    if name not in MODELS:
        raise ConfigError(f"there is no model {name!r}; {_choose(name, MODELS)}")
    return MODELS[name]


def describe_options(name: str) -> list[OptionInfo]:
    """Options of a model.

    Parameters
    ----------
    name : str

    Returns
    -------
    list of OptionInfo

    Raises
    ------
    ConfigError
        There is no such model.
    """
    return describe(find_model(name).options)


def prepare(
    name: str,
    scene: Scene,
    theta_i_deg: float,
    component: str = "reflection",
    options: Mapping[str, object] | DataclassInstance | None = None,
) -> Prepared:
    """Make a model ready for one material, one incident direction and one component.

    Parameters
    ----------
    name : str
    scene : goniosim.scene.Scene
        Only its material counts.
    theta_i_deg : float
        Of the light, which stands at azimuth 0; from 0 to below 90.
    component : str
        One of `COMPONENTS`.
    options : mapping or options dataclass, optional
        Option names to values; the defaults where left out.

    Returns
    -------
    goniosim.models.Prepared

    Raises
    ------
    ConfigError
        The model, the component or an option is unknown, the angle is out of range, or the model
        does not apply to the material.
    """
    model = find_model(name)
    if component not in COMPONENTS:
        raise ConfigError(f"there is no component {component!r}; {_choose(component, COMPONENTS)}")
    if not 0.0 <= theta_i_deg < 90.0:
        raise ConfigError(f"theta_i_deg must be 0 or more and below 90 [got {theta_i_deg:g}]")
    chosen = parse_options(name, model.options, options)
    reason = model.supports(scene, component)
    if reason is not None:
        raise ConfigError(f"model {name} {reason}")
    return model.prepare(scene, float(theta_i_deg), component, chosen)


def evaluate_model(
    name: str,
    scene: Scene | Source,
    theta_i_deg: ArrayLike,
    theta_o_deg: ArrayLike,
    phi_o_deg: ArrayLike,
    component: str = "reflection",
    options: Mapping[str, object] | DataclassInstance | None = None,
) -> np.ndarray:
    """BSDF of a material according to an analytic model.

    Parameters
    ----------
    name : str
        One of `MODELS`.
    scene : goniosim.scene.Scene, path, mapping or str
        A scene, or what `load_scene` takes; only its material counts.
    theta_i_deg : array_like
        Polar angle of the light, which stands at azimuth 0; from 0 to below 90 degrees.
    theta_o_deg, phi_o_deg : array_like
        Polar angle and azimuth of the viewer, in degrees; the mirror direction has azimuth 180. For
        transmission theta_o_deg is taken from the downward normal, and light that goes straight
        through leaves at azimuth 180. The three arguments broadcast.
    component : str
        ``reflection``, ``reflection/direct``, ``reflection/internal`` or ``transmission``.
    options : mapping or options dataclass, optional
        Options of the model, see `describe_options`.

    Returns
    -------
    ndarray, shape (3, ...)
        Value for each channel and direction, in 1/sr, without the cosine. The lobe of a smooth
        interface, which has no value per steradian, is left out: see `Prepared.mirror_energy`.

    Raises
    ------
    ConfigError
        The model, the component or an option is unknown, an angle is no number or out of range, or the
        model does not apply to the material.

    Examples
    --------
    >>> goniosim.evaluate_model("ww09", "scene.yaml", 30, [0, 40], 180).shape
    (3, 2)
    """
    scene = as_scene(scene)
    angles = {"theta_i_deg": theta_i_deg, "theta_o_deg": theta_o_deg, "phi_o_deg": phi_o_deg}
    try:
        theta_i, theta_o, phi_o = np.broadcast_arrays(*(np.asarray(angle, float) for angle in angles.values()))
    except (TypeError, ValueError) as error:
        raise ConfigError(
            f"{listed(list(angles))} must be numbers, or arrays of them that broadcast: {error}"
        ) from None
    if not np.all((theta_o >= 0.0) & (theta_o <= 90.0)):
        raise ConfigError("theta_o_deg must lie between 0 and 90, both included")
    if not np.all(np.isfinite(phi_o)):
        raise ConfigError("phi_o_deg must be finite")
    polar, azimuth = np.radians(theta_o).ravel(), np.radians(phi_o).ravel()
    x, y, z = np.sin(polar) * np.cos(azimuth), np.sin(polar) * np.sin(azimuth), np.cos(polar)
    values = np.empty((3, theta_i.size))
    for angle in np.unique(theta_i):
        prepared = prepare(name, scene, angle, component, options)
        here = theta_i.ravel() == angle
        values[:, here] = prepared.evaluate(x[here], y[here], z[here])[prepared.position]
    return values.reshape((3, *theta_i.shape))


def _choose(word: str, known: Iterable[str]) -> str:
    known = list(known)
    guess = closest(word, known)
    return f"choose {listed(known, 'or')}" + (f" (did you mean {guess}?)" if guess else "")
