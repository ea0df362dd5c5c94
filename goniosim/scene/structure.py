"""Which orders of layers make sense."""

from collections.abc import Sequence

from goniosim.scene.layers import INTERFACES

OPAQUE = {name for name, interface in INTERFACES.items() if interface.opaque}


def structure_mistakes(kinds: Sequence[str | None]) -> list[tuple[tuple[int, ...], str]]:
    """Find what is wrong with the order of the layers.

    Parameters
    ----------
    kinds : list of str or None
        From top to bottom ``medium``, or the type of an interface; None for a
        layer whose kind could not be made out, to which the benefit of the
        doubt is given.

    Returns
    -------
    list of (tuple of int, str)
        Index of the layer at fault (empty tuple: the list as a whole) and the
        sentence that explains it.
    """
    if not kinds:
        return [((), "must hold at least one interface: a material without layers scatters no light")]
    found: list[tuple[tuple[int, ...], str]] = []
    if kinds[0] == "medium":
        found.append(((0,), "must be an interface: the stack begins at its top interface, with air above"))
    base = next((index for index, kind in enumerate(kinds) if kind in OPAQUE), None)
    if base is None:
        if kinds[-1] == "medium" and len(kinds) > 1:
            found.append(
                (
                    (len(kinds) - 1,),
                    "must be an interface: a medium lies between two interfaces; "
                    "remove it or put an interface below it",
                )
            )
    elif any(kind != "medium" for kind in kinds[base + 1 :]):
        found.append(
            (
                (base,),
                f"must be the last layer: a {kinds[base]} base is opaque, and no light gets below it; "
                "move it to the end or remove the layers below it",
            )
        )
    else:
        message = f"lies under an opaque base ({kinds[base]}), where no light arrives: remove this medium"
        found += [((index,), message) for index in range(base + 1, len(kinds))]
    return found
