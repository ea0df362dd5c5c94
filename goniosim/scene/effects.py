"""Which effects a scene calls for, and which layer or option asks for each."""

from dataclasses import dataclass

from goniosim.scene.layers import Interface
from goniosim.scene.model import Scene
from goniosim.scene.optical import optical_stack
from goniosim.scene.quantity import CHANNELS

_COLOURS = ("red", "green", "blue")


@dataclass(frozen=True)
class Effect:
    """One effect, and whether the walk has to execute it.

    Attributes
    ----------
    name : str
    active : bool
    why : str
        One sentence that names the layer or option that asks for it.
    """

    name: str
    active: bool
    why: str


def effects(scene: Scene) -> list[Effect]:
    """List the effects that goniosim knows, and which of them a scene calls for.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    list of Effect
        Always the same names in the same order.
    """
    optical = optical_stack(scene.material)
    layers = list(zip(optical.places, optical.material.layers, strict=True))
    interfaces = [
        (f"layers[{place}] ({_described(layer.interface, place in optical.absent)})", layer.interface)
        for place, layer in layers
        if layer.interface is not None
    ]
    facets = [(place, face) for place, face in interfaces if face.type != "lambert"]
    rough = [place for place, face in facets if face.alpha > 0]
    smooth = [place for place, face in facets if face.alpha == 0]
    lambertian = [place for place, face in interfaces if face.type == "lambert"]
    metal = [place for place, face in interfaces if face.type == "conductor"]
    absorbing = [
        f"layers[{place}] (medium, tau {_number(layer.medium.tau)})"
        for place, layer in layers
        if layer.medium is not None and any(layer.medium.tau_rgb)
    ]
    bottom = interfaces[-1][0]
    orders = scene.simulation.orders
    return [
        _asked("rough_interfaces", rough, "no interface has alpha above 0"),
        _asked("smooth_interfaces", smooth, "no interface has alpha 0"),
        _asked("lambertian", lambertian, "no interface is lambert"),
        _asked("conductor", metal, "no interface is a conductor"),
        _asked("absorption", absorbing, "no medium absorbs"),
        Effect(
            "transmission",
            scene.material.transmits,
            f"{bottom} is the last interface and " + ("lets light out below" if scene.material.transmits else "opaque"),
        ),
        Effect(
            "internal_paths",
            len(interfaces) > 1,
            f"light walks between {len(interfaces)} interfaces"
            if len(interfaces) > 1
            else f"{bottom} is the only interface",
        ),
        _chromatic(scene),
        Effect(
            "orders",
            orders is not None,
            "simulation.orders is not given" if orders is None else f"simulation.orders asks for {orders}",
        ),
    ]


def absent_interfaces(scene: Scene) -> list[str]:
    """Say which interfaces lie between equal indices, and so do nothing.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    list of str
        One sentence for each.
    """
    layers = scene.material.layers
    return [
        f"layers[{place}] ({_described(layers[place].interface)}) is optically absent: "
        "the indices above and below it are equal"
        for place in optical_stack(scene.material).absent
    ]


def distinct_channels(scene: Scene) -> tuple[list[int], list[int]]:
    """Group the channels in which all parameters of the material agree.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    list of int, list of int
        Index of one representative channel for each group, and for each
        channel the position of its group in that list.
    """
    parameters = _per_channel(scene)
    groups = list(dict.fromkeys(parameters))
    return [parameters.index(group) for group in groups], [groups.index(group) for group in parameters]


def _per_channel(scene: Scene) -> list[tuple[float, ...]]:
    material = optical_stack(scene.material).material
    triples = list(material.tau)
    for face in material.interfaces:
        if face.type == "conductor":
            triples += [face.eta_rgb, face.kappa_rgb]
        elif face.type == "lambert":
            triples.append(face.rho_rgb)
    return [tuple(triple[channel] for triple in triples) for channel in range(len(CHANNELS))]


def _chromatic(scene: Scene) -> Effect:
    representatives, positions = distinct_channels(scene)
    count = len(representatives)
    if count == 1:
        return Effect("chromatic", False, "all channels agree everywhere: 1 distinct channel is traced")
    if count == len(CHANNELS):
        return Effect("chromatic", True, "no two channels agree everywhere: 3 distinct channels are traced")
    shared = max(positions, key=positions.count)
    first, second = (name for name, position in zip(_COLOURS, positions, strict=True) if position == shared)
    return Effect("chromatic", True, f"{first} and {second} agree everywhere: {count} distinct channels are traced")


def _asked(name: str, places: list[str], absent: str) -> Effect:
    return Effect(name, bool(places), f"asked for by {', '.join(places)}" if places else absent)


def _described(face: Interface, absent: bool = False) -> str:
    if absent:
        return f"{face.type}, equal indices"
    if face.type == "lambert":
        return f"lambert, rho {_number(face.rho)}"
    return f"{face.type}, alpha {_number(face.alpha)}"


def _number(value: float | tuple[float, ...]) -> str:
    if isinstance(value, tuple):
        return "[" + ", ".join(_number(item) for item in value) + "]"
    return f"{value:g}"
