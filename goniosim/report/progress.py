"""Progress of a long computation: a bar on a terminal, slow log lines elsewhere, or nothing.

The three classes have the same verbs: ``begin`` one material, ``update`` with the rays done in
it, ``pass_over`` those of other processes, say a ``note``, ``close``.
"""

import sys
import time

from ..writing import printable
from . import text

FIRST_LINE = 5.0
SLOWEST_PACE = 60.0


def make_progress(total_rays, quiet=False):
    """Choose how to show progress.

    Parameters
    ----------
    total_rays : int or None
        Rays of all materials together, None where targets decide.
    quiet : bool
        Show nothing.

    Returns
    -------
    Silent, Bar or LogLines
        A bar if both standard output and standard error are terminals, log lines on standard
        error otherwise.
    """
    if quiet:
        return Silent()
    if sys.stderr.isatty() and sys.stdout.isatty():
        return Bar(total_rays)
    return LogLines(total_rays)


class Silent:
    """Shows nothing."""

    def begin(self, description, inherited=0):
        """Name the material whose rays come next; so many of them are there since before."""

    def update(self, done_rays, total_rays):
        """Say how far this material has come."""

    def pass_over(self, rays):
        """Leave so many rays of all materials to others."""

    def note(self, message):
        """Show a line of text."""

    def close(self):
        """Show nothing more."""


class _Shown:
    """What is common to everything shown: rays of earlier materials, and a stream that may vanish."""

    def __init__(self, total_rays, stream):
        self.total_rays = total_rays
        self.earlier_rays = 0
        self.rays = 0
        self.inherited = 0
        self.passed_over = 0
        self.stream = stream

    def begin(self, description, inherited=0):
        """Name the material whose rays come next; so many of them are there since before, and say nothing of speed."""
        self.earlier_rays = self.rays
        self.inherited += inherited
        self.description = description

    def pass_over(self, rays):
        """Leave so many rays of all materials to others, between two of ours: they say nothing of speed."""
        more = (rays or 0) - self.passed_over
        self.rays += more
        self.inherited += more
        self.passed_over += more

    def _try(self, show, *arguments, **options):
        # A terminal that is closed, or a log on a full disk, must not end hours of tracing.
        if self.stream is None:
            return
        try:
            show(*arguments, **options)
        except (OSError, ValueError):
            self.stream = None


class Bar(_Shown):
    """One tqdm bar over the rays of all materials.

    Parameters
    ----------
    total_rays : int or None
    stream : text stream, optional
        Standard error by default.
    """

    FORMAT = "{desc}{percentage:3.0f}%|{bar}| {n_fmt}/{total_fmt} rays [{elapsed}<{remaining}, {rate_fmt}]"
    WITHOUT_TOTAL = "{desc}{n_fmt} rays [{elapsed}, {rate_fmt}]"

    def __init__(self, total_rays, stream=None):
        super().__init__(total_rays, stream or sys.stderr)
        self._bar = None

    def begin(self, description, inherited=0):
        """Name the material whose rays come next; so many of them are there since before."""
        super().begin(description, inherited)
        self._try(self._show_description)
        if self._bar is not None:
            # Left out of the rate.
            self._bar.initial = self.inherited

    def _show_description(self):
        if self._bar is None:
            # In a notebook, a widget.
            from tqdm.auto import tqdm

            # Made only now, so that compilation before the first ray does not spoil the rate.
            self._bar = tqdm(
                total=self.total_rays,
                desc=f"{self.description}: ",
                unit=" rays",
                unit_scale=True,
                dynamic_ncols=True,
                bar_format=self.WITHOUT_TOTAL if self.total_rays is None else self.FORMAT,
                file=self.stream,
            )
        else:
            self._bar.set_description_str(f"{self.description}: ")

    def update(self, done_rays, total_rays):
        """Say how far this material has come."""
        self.rays = self.earlier_rays + done_rays
        if self._bar is not None:
            self._try(self._bar.update, self.rays - self._bar.n)

    def note(self, message):
        """Show a line of text."""
        message = printable(message)
        if self._bar is None:
            self._try(print, message, file=self.stream, flush=True)
        else:
            self._try(self._bar.write, message, file=self.stream)

    def close(self):
        """Show nothing more."""
        if self._bar is not None:
            self._try(self._bar.close)


class LogLines(_Shown):
    """Log lines with the time of day: the first after a few seconds, then fewer and fewer.

    Parameters
    ----------
    total_rays : int or None
    stream : text stream, optional
        Standard error by default.
    clock : callable
        Seconds from an arbitrary start.
    """

    def __init__(self, total_rays, stream=None, clock=time.monotonic):
        super().__init__(total_rays, stream or sys.stderr)
        self._clock = clock
        self._started = None
        self._pace = FIRST_LINE

    def begin(self, description, inherited=0):
        """Name the material whose rays come next; so many of them are there since before."""
        super().begin(description, inherited)
        if self._started is None:
            self._started = self._clock()
            self._next_line = self._started + self._pace

    def update(self, done_rays, total_rays):
        """Say how far this material has come."""
        self.rays = self.earlier_rays + done_rays
        now = self._clock()
        if now < self._next_line:
            return
        self._pace = min(2.0 * self._pace, SLOWEST_PACE)
        self._next_line = now + self._pace
        per_second = (self.rays - self.inherited) / (now - self._started)
        line = f"{self.description}: {self._share()} rays"
        if per_second > 0.0:
            line += f", {text.rate(per_second)}"
            if self.total_rays is not None:
                line += f", about {text.duration((self.total_rays - self.rays) / per_second)} left"
        self.note(line)

    def _share(self):
        if self.total_rays is None:
            return text.count(self.rays)
        return f"{100.0 * self.rays / self.total_rays:.3g} % of {text.count(self.total_rays)}"

    def note(self, message):
        """Show a line of text."""
        self._try(self._write, f"{time.strftime('%Y-%m-%d %H:%M:%S')}  {printable(message)}\n")

    def _write(self, line):
        self.stream.write(line)
        self.stream.flush()

    def close(self):
        """Show nothing more."""
