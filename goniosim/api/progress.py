"""What Python users may give as ``progress``."""

from collections.abc import Callable
from contextlib import AbstractContextManager, closing
from typing import Any

from ..errors import ConfigError

Progress = bool | Callable[[int, int | None], object] | None


def progress_of(progress: Progress, total_rays: int | None) -> AbstractContextManager[Any]:
    """Choose how to show progress.

    Parameters
    ----------
    progress : bool, callable or None
        True for a bar, which notebooks show as a widget; or ``progress(done_rays, total_rays)``.
    total_rays : int or None
        Rays of all materials together, None where targets decide.

    Returns
    -------
    context manager
        Of an object with the verbs of `goniosim.report.progress`.

    Raises
    ------
    ConfigError
        It is something else.
    """
    from ..report.progress import Bar, Silent

    if progress is None or progress is False:
        return closing(Silent())
    if progress is True:
        return closing(Bar(total_rays))
    if not callable(progress):
        raise ConfigError(f"progress must be True, False or a function of done and total rays [got {progress!r}]")
    return closing(_Calls(progress, total_rays))


class _Calls:
    """Calls a function with the rays of all materials so far and in all."""

    def __init__(self, function: Callable[[int, int | None], object], total_rays: int | None) -> None:
        self._function = function
        self._total_rays = total_rays
        self._earlier_rays = 0
        self._rays = 0
        self._passed_over = 0

    def begin(self, description: str, inherited: int = 0) -> None:
        """A new material: earlier rays stay done."""
        self._earlier_rays = self._rays

    def pass_over(self, rays: int | None) -> None:
        """Leave so many rays of all materials to others: they are done."""
        self._rays += (rays or 0) - self._passed_over
        self._passed_over = rays or 0

    def update(self, done_rays: int, total_rays: int | None) -> None:
        """Say how far this material has come."""
        self._rays = self._earlier_rays + done_rays
        self._function(self._rays, self._total_rays)

    def note(self, message: str) -> None:
        """Leave out what is no number of rays."""

    def close(self) -> None:
        """Nothing more to call."""
