"""What a stack is to light: interfaces between equal indices do nothing, however rough they are."""

from dataclasses import dataclass

from goniosim.scene.layers import Dielectric, Layer
from goniosim.scene.model import Material

# Indices whose ratio is this close to 1 are equal, with room for the rounding of numbers given to 12 digits.
EQUAL = 1e-12 + 1e-15

AIR = 1.0


@dataclass(frozen=True)
class OpticalStack:
    """A material as light meets it.

    Attributes
    ----------
    material : Material
        Without the interfaces between equal indices: the media above and below such a one are in a
        row. A first or last one stays, since it tells what has entered the stack and what has left it; it
        is smooth, and its index is exactly that of the medium above.
    places : tuple of int
        Of each of its layers, the place among the layers of the scene.
    absent : tuple of int
        Places of the interfaces between equal indices, those that stay included.
    """

    material: Material
    places: tuple[int, ...]
    absent: tuple[int, ...]


def optical_stack(material: Material) -> OpticalStack:
    """Reduce a material to what light can tell.

    Parameters
    ----------
    material : Material

    Returns
    -------
    OpticalStack
    """
    outer = _outer(material)
    layers: list[Layer] = []
    places: list[int] = []
    absent: list[int] = []
    index = AIR
    for place, layer in enumerate(material.layers):
        face = layer.interface
        if isinstance(face, Dielectric):
            if abs(face.eta / index - 1.0) <= EQUAL:
                absent.append(place)
                if place not in outer:
                    continue
                layer = layer.model_copy(update={"interface": face.model_copy(update={"eta": index, "alpha": 0.0})})
            else:
                index = face.eta
        layers.append(layer)
        places.append(place)
    if absent:
        material = material.model_copy(update={"layers": tuple(layers)})
    return OpticalStack(material, tuple(places), tuple(absent))


def _outer(material: Material) -> tuple[int, int]:
    """Places of the first and the last interface."""
    faces = [place for place, layer in enumerate(material.layers) if layer.interface is not None]
    return faces[0], faces[-1]
