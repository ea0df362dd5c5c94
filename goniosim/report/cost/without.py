"""Scenes without one of their effects, to see what it adds."""

from ...scene import effects, optical_stack
from ...scene.layers import Conductor

# A value that differs from channel to channel becomes their mean.
_PER_CHANNEL = ("tau", "eta", "kappa", "rho")


def without_effects(scene):
    """The scene without each of the effects that something can be without.

    Parameters
    ----------
    scene : goniosim.scene.Scene

    Returns
    -------
    dict of str to (str, goniosim.scene.Scene)
        By effect, as `goniosim.scene.effects` calls them, or by interface: what was done, and the scene.
    """
    found = {}
    for effect in effects(scene):
        if effect.active and effect.name in REMOVED:
            words, remove = REMOVED[effect.name]
            found[effect.name] = words, remove(scene)
    places = [place for place, layer in enumerate(scene.material.layers) if layer.interface is not None]
    absent = optical_stack(scene.material).absent
    for place in places[1:-1]:
        if place not in absent:
            layers = scene.material.layers
            # The medium below then lies below the interface above.
            left = _with_layers(scene, [*layers[:place], *layers[place + 1 :]])
            found[f"layers[{place}]"] = "without this interface", left
    return found


def _clear(scene):
    def change(part):
        return part.model_copy(update={"tau": 0.0}) if hasattr(part, "tau") else part

    return _changed(scene, change)


def _grey(scene):
    def change(part):
        means = {
            name: sum(value) / len(value)
            for name in _PER_CHANNEL
            if isinstance(value := getattr(part, name, None), tuple)
        }
        return part.model_copy(update=means)

    return _changed(scene, change)


def _smooth(scene):
    def change(part):
        return part.model_copy(update={"alpha": 0.0}) if hasattr(part, "alpha") else part

    return _changed(scene, change)


def _without_orders(scene):
    return scene.model_copy(update={"simulation": scene.simulation.model_copy(update={"orders": None})})


def _opaque(scene):
    last = max(place for place, layer in enumerate(scene.material.layers) if layer.interface is not None)
    face = scene.material.layers[last].interface
    metal = Conductor(type="conductor", eta=face.eta, kappa=1.0, alpha=face.alpha)
    layers = [*scene.material.layers[:last], scene.material.layers[last].model_copy(update={"interface": metal})]
    return _with_layers(scene, layers)


def _changed(scene, change):
    """The scene with every interface and medium changed."""
    layers = []
    for layer in scene.material.layers:
        name = "medium" if layer.interface is None else "interface"
        layers.append(layer.model_copy(update={name: change(getattr(layer, name))}))
    return _with_layers(scene, layers)


def _with_layers(scene, layers):
    return scene.model_copy(update={"material": scene.material.model_copy(update={"layers": tuple(layers)})})


# By effect: what is done, and how.
REMOVED = {
    "rough_interfaces": ("all interfaces smooth", _smooth),
    "absorption": ("tau 0", _clear),
    "transmission": ("the last interface a metal", _opaque),
    "chromatic": ("all channels alike", _grey),
    "orders": ("one slice for all orders", _without_orders),
}
