"""Matplotlib as it comes, whatever files and variables say to it: figures are drawn off screen, in one style."""

import contextlib
import importlib
import logging
import os
import sys

from ...errors import RefusalError


def import_matplotlib():
    """Import matplotlib, if it can be imported at all.

    A backend that does not exist is nobody's business: none is ever used. The remarks that matplotlib logs about its
    files of settings are kept back as well, since `files.write_figure` does not use these settings.

    Raises
    ------
    RefusalError
    """
    if "matplotlib.figure" in sys.modules:
        return
    logger = logging.getLogger("matplotlib")
    level = logger.level
    logger.setLevel(logging.CRITICAL)
    try:
        try:
            importlib.import_module("matplotlib")
        except ValueError:
            # Parts of it that were imported know nothing of a second beginning.
            for name in [name for name in sys.modules if name.startswith("matplotlib.")]:
                del sys.modules[name]
            with _without("MPLBACKEND", "MATPLOTLIBRC"):
                importlib.import_module("matplotlib")
        importlib.import_module("matplotlib.figure")
    except (OSError, ValueError) as error:
        reason = " ".join(str(error).split())
        raise RefusalError(
            f"matplotlib cannot be loaded: {reason}; remove or correct a file matplotlibrc in this folder or in your "
            "settings, and see that MPLCONFIGDIR or TMPDIR names a folder that takes files"
        ) from error
    finally:
        logger.setLevel(level)


@contextlib.contextmanager
def _without(*names):
    """Hide environment variables."""
    hidden = {name: os.environ.pop(name) for name in names if name in os.environ}
    try:
        yield
    finally:
        os.environ.update(hidden)
