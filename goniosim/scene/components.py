"""Which components of the scattered light a scene calls for."""

from goniosim.scene.model import Scene
from goniosim.scene.optical import optical_stack


def components(scene: Scene) -> list[str]:
    """Names of the components that the result of a scene has, in their order.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    list of str
    """
    found = ["reflection/direct"]
    if len(optical_stack(scene.material).material.interfaces) > 1:
        found.append("reflection/internal")
    if scene.material.transmits:
        found.append("transmission")
    return found
