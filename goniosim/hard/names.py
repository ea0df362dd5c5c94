"""From what a user calls a case to the case."""

import difflib
from pathlib import PurePath

from ..scene.problems import listed
from .catalogue import CASES, Case

# More of them are no hint.
MOST_MEANT = 8


def chosen(names: tuple[str, ...]) -> list[Case]:
    """Return the cases of those names, or all of them if there are none.

    Parameters
    ----------
    names : tuple of str
        Each a name, or the path of a scene in ``configs/hard``.

    Raises
    ------
    ValueError
        There is no such case; one line for each name.
    """
    wanted = {_name(given) for given in names}
    unknown = [given for given in names if _name(given) not in CASES]
    if unknown:
        raise ValueError("\n".join(map(_explained, unknown)))
    return [case for name, case in CASES.items() if not names or name in wanted]


def _name(given: str) -> str:
    return PurePath(given).stem if given.endswith((".yaml", ".yml")) else given


def _explained(given: str) -> str:
    name = _name(given)
    meant = [each for each in CASES if name and name in each]
    if not 0 < len(meant) <= MOST_MEANT:
        meant = difflib.get_close_matches(name, CASES, n=1)
    remedy = f"did you mean {listed(meant, 'or')}?" if meant else "see goniosim hard --list"
    return f"{given}: no hard case has this name; {remedy}"
