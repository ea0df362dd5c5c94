"""How much memory the reports on a result take, told before any is made."""

from ..compare.variants import check_request, components_for, variants_for
from ..cores import available_cores
from ..errors import ResourceError
from ..free_memory import free_memory, resident_memory
from ..scene import CHANNELS, components
from .comparison.sheets import MOST
from .drawing.studio import MOST_PROCESSES

# Measured: the interpreter with the libraries that draw; a process that draws beside it.
_PROGRAM = 230_000_000
_PROCESS = 150_000_000
# Measured: an overview grows by this for each direction up to the seventh, a figure by slices of its direction.
_OVERVIEW, _COLUMNS = 60_000_000, 7
_FIGURE_SLICES = 4
# Measured: the levels of the two parts of the variant at work, its errors, the reference and its noise.
_IN_WORK = 18
_NUMBER = 8


def memory_to_plot(scene, overview=True):
    """Predict what `goniosim plot` takes for the result of a scene.

    Parameters
    ----------
    scene : goniosim.scene.Scene
    overview : bool
        Whether the figure of all directions is among the figures.

    Returns
    -------
    int
        Bytes, an upper estimate.
    """
    columns = min(len(scene.incident.theta_deg), _COLUMNS) if overview else 1
    return _PROGRAM + _result(scene) + columns * _OVERVIEW + _FIGURE_SLICES * _slices(scene, 1)


def memory_to_compare(scene, request=None, figures="all"):
    """Predict what `goniosim compare` takes for the result of a scene, its drawing processes included.

    Parameters
    ----------
    scene : goniosim.scene.Scene
    request : dict of str to dict, optional
        From `goniosim.compare.variants.check_request`; all models by default.
    figures : str
        See `goniosim.report.comparison.figures.EXTENTS`.

    Returns
    -------
    int
        Bytes, an upper estimate.
    """
    variants, _ = variants_for(scene, request or check_request())
    directions = len(scene.incident.theta_deg)
    # Energy and BSDF of each part: direct and internal paths apart, where a model tells them.
    kept = len(variants) * (4 if "reflection" in components_for(scene) else 2)
    bytes_here = _PROGRAM + _result(scene) + (kept + _IN_WORK) * _slices(scene, directions)
    if figures == "none" or not variants:
        return bytes_here
    shown = len(variants) + 2
    processes = min(available_cores(), MOST_PROCESSES)
    # Two figures show all directions, the others one each; what others are to draw passes through here.
    sent = min(processes, 2) * _slices(scene, min(directions, MOST)) + max(0, processes - 2) * _slices(scene, 1)
    return bytes_here + shown * (_slices(scene, directions) + sent) + processes * _PROCESS


def require_memory(name, needed, remedy):
    """Make sure that something fits into the memory that is free.

    Parameters
    ----------
    name : str or Path
        What the report is on.
    needed : int
        Bytes that this process and those that it starts will hold.
    remedy : str
        What would help.

    Raises
    ------
    ResourceError
        With the numbers; not where nothing is known of the memory.
    """
    if short := shortage(needed, remedy):
        raise ResourceError(f"{name}: not enough memory: {short}")


def shortage(needed, remedy):
    """Say what is missing, or None if it fits; arguments as for `require_memory`."""
    free = free_memory()
    if free is None:
        return None
    room = free[0] + resident_memory()
    if needed <= room:
        return None
    return f"about {needed / 1e9:.3g} GB are needed, and {room / 1e9:.3g} GB can be had ({free[1]}); {remedy}"


def _slices(scene, directions):
    """Bytes of numbers, one for each cell and channel."""
    return directions * len(CHANNELS) * scene.slice.rows * scene.slice.columns * _NUMBER


def _result(scene):
    """Bytes of a result: energies, BSDFs and their errors, hits, uncertain cells; and the geometry of the cells."""
    names = components(scene)
    groups = len(names) + (scene.simulation.orders or 0) * (len(names) - 1)
    numbers = 4 * groups * _slices(scene, 1)
    cells = scene.slice.rows * scene.slice.columns
    return len(scene.incident.theta_deg) * (numbers + cells * (_NUMBER * (groups + 2) + 1 + groups * len(CHANNELS)))
