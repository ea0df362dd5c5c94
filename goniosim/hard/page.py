"""The page of hard cases as a file: which one it may replace."""

import re
from collections.abc import Iterable
from pathlib import Path

from ..errors import OutputError
from ..writing import StrPath, explained
from .catalogue import CASES, Case
from .table import TITLE

_NAMES = re.compile(r"^### (\w+)$", re.MULTILINE)


def refuse_loss(path: StrPath, cases: Iterable[Case]) -> None:
    """Make sure that a page of some cases replaces nothing but a page of no others.

    Parameters
    ----------
    path : path-like
        Where the page is to go.
    cases : iterable of Case
        Those that will stand on it.

    Raises
    ------
    OutputError
        Another file stands there, or a page of more cases.
    """
    # What is no file is refused by whoever writes; to read a pipe would take for ever.
    if not Path(path).is_file():
        return
    with explained(path):
        text = Path(path).read_text(encoding="utf-8", errors="replace")
    if not text.startswith(f"{TITLE}\n"):
        raise OutputError(
            f"{path}: exists and is not a page of goniosim hard, so it is not overwritten; "
            "choose another name, or give --overwrite"
        )
    lost = set(_NAMES.findall(text)) & CASES.keys() - {case.name for case in cases}
    if lost:
        raise OutputError(
            f"{path}: holds {len(lost)} of the hard cases that the new page would not, so it is not overwritten; "
            "choose another name, or give --overwrite"
        )
