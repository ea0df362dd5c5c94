"""Materials of a command, shared with other processes that simulate the same ones."""

from goniosim.errors import InUseError
from goniosim.scene import total_rays


def rays_of_others(sharing):
    """Rays of all materials that others have finished or are at work on."""
    return total_rays(job.scene for job in [*sharing.finished, *(job for job, _ in sharing.owners)])


def leave_to_others(sharing, note):
    """Say what was left to other processes.

    Parameters
    ----------
    sharing : goniosim.sharing.Sharing
        Of jobs, after its end.
    note : callable
        Called with a line of text.

    Raises
    ------
    InUseError
        If it is a scene by itself, and so all that was asked for.
    """
    if sharing.finished:
        note(f"{_materials(len(sharing.finished))} finished by others meanwhile")
    if not sharing.owners:
        return
    job, owner = sharing.owners[0]
    if not job.of_study:
        raise InUseError(
            f"{job.path}: another process is at work on it ({owner}); wait for its end, or choose another place with -o"
        )
    who = dict.fromkeys(f"host {owner.host}, pid {owner.pid}" for _, owner in sharing.owners)
    note(f"{_materials(len(sharing.owners))} being simulated by others ({'; '.join(who)})")


def _materials(number):
    return "1 material is" if number == 1 else f"{number} materials are"
