"""What a simulation loses or leaves out, in words: masking, the event cap, and physics it does not know."""

import numpy as np

from ...scene.quantity import percent
from .. import text

# Share of the energy from which the loss to single scattering is said in words.
NOTEWORTHY_LOSS = 0.01
# Share of the flux from which light lost at the event cap is: the slices are too dark by more than that.
NOTEWORTHY_CAP = 1e-3
# What is on its way when the last ray of a work unit is launched is cut in the end; with so many
# rays the units have their full size, and that is some thousand rays of a quarter million.
RAYS_OF_LONG_RUN = 2e7


def masking_loss(result):
    """Energy lost to single-scattering masking, shape (M, C)."""
    energy = result.audit.energy
    return energy["lost_masked_reflection"] + energy["lost_masked_transmission"]


def masking_lines(result):
    """Say in words how much energy single-scattering masking loses, if it is noteworthy."""
    lost = masking_loss(result)
    if not lost.size or lost.max() <= NOTEWORTHY_LOSS:
        return []
    i, c = np.unravel_index(np.argmax(lost), lost.shape)
    return [
        f"  Note: up to {100.0 * lost[i, c]:.1f} % of the energy ({_place(result, i, c)}) is lost to "
        "single-scattering masking.",
        "  The GGX model used has no inter-reflection inside a rough interface: light that a facet sends",
        "  to the wrong side is gone. This is a property of the model; more rays do not reduce it.",
    ]


def event_cap(result):
    """Say how much darker the slices are for the light lost at the event cap.

    Parameters
    ----------
    result : goniosim.result.Result

    Returns
    -------
    str or None
        One line; None if less than a thousandth of the flux is lost in every direction and channel.
    """
    energy = result.audit.energy
    lost = energy["lost_event_cap"]
    if not lost.size or lost.max() < NOTEWORTHY_CAP:
        return None
    i, c = np.unravel_index(np.argmax(lost), lost.shape)
    found = energy["reflected_internal"][i, c] + energy["transmitted"][i, c]
    darker = lost[i, c] / (found + lost[i, c])
    return (
        f"Warning: event cap: {percent(lost[i, c])} of the light ({_place(result, i, c)}) was trapped between "
        f"interfaces and is lost; what left the stack is up to {percent(darker)} too dark; {cap_remedy(result.rays[i])}"
    )


def cap_remedy(rays):
    """What to do about light lost at the event cap with so many rays from a direction."""
    if rays < RAYS_OF_LONG_RUN:
        return f"{text.count(RAYS_OF_LONG_RUN)} rays per direction lose a far smaller share"
    return "more rays lose as much, so take it for an error of the slices"


def left_out_lines(result):
    """Name the physics that no result has, with what it would change."""
    lost = masking_loss(result)
    masking = "masking loses nothing here"
    if lost.size and lost.max() > 0.0:
        i, c = np.unravel_index(np.argmax(lost), lost.shape)
        masking = f"masking loses up to {percent(lost[i, c])} here ({_place(result, i, c)})"
    return [
        "Left out: polarisation, dropped at every event (five clear plates, 56 degrees: 40 % too much is reflected);",
        "  waves (thin films, diffraction); light that facets of one interface send to each other:",
        f"  {masking}.",
    ]


def _place(result, i, c):
    return f"theta {text.angles(result.theta_deg)[i]}, channel {result.channels[c]}"
