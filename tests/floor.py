"""The floor: numbers of tests, kept in a file, below which the suite has lost some.

A renamed function, an import that is skipped or a folder that is not looked at would go unseen else. Numbers that have
grown by more than `SLACK` are to be written as well, or the floor would be far below what there is.
"""

from pathlib import Path

FILE = Path(__file__).with_name("floor.txt")
RAISE = "`make floor` writes it, and the change belongs into the commit"
KINDS = ("fast", "slow")
SLACK = 0.02

_HEAD = """\
# Tests of `make test`, and those that `make test-all` runs besides. Written by `make floor`.
"""


def write(numbers, path=FILE):
    """Keep the numbers of a dict by kind."""
    path.write_text(_HEAD + "".join(f"{kind} {numbers[kind]}\n" for kind in KINDS), encoding="utf-8")


def read(path=FILE):
    """Numbers by kind."""
    lines = [line.split() for line in path.read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    return {kind: int(number) for kind, number in lines}


def faults(numbers, stored):
    """One line for each kind of which there are fewer than stored, or many more."""
    said = []
    for kind in KINDS:
        found, floor = numbers[kind], stored[kind]
        here = f"collected {found} {kind} tests, the floor in tests/floor.txt is {floor}"
        if found < floor:
            said.append(f"{here}: some were lost; if they are meant to go, {RAISE}")
        elif found > floor * (1.0 + SLACK):
            said.append(f"{here}, more than {SLACK:.0%} below: {RAISE}")
    return said
