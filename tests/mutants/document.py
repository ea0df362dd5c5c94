"""docs/mutants.md: what was broken, and who noticed."""

from .catalogue import ROOT, in_words

PATH = ROOT / "docs" / "mutants.md"

_HEAD = """\
# Mutants

A suite of tests is worth what it catches. `make mutants` breaks goniosim on purpose: each of the {count} bugs below is
put into a copy of the source by itself, and a test of the suite has to find it: an assertion fails, or goniosim says
what the test does not expect. Code that merely crashes does not count. It writes this page when all of them were tried.

`make mutants LIST=1` prints the list; `make mutants ONLY=name` tries one, or those that match a pattern (`ONLY='g1-*'`
or `ONLY='store/*'`). They stand in [tests/mutants](../tests/mutants), a file for each room.
"""

_SIZES = """
## The smallest bias that is seen

Of some bugs it matters how large they are. Smaller and smaller ones were tried, until one was not seen; the last
cell is empty where all of them were seen. A factor of 1 would be no bug.

| mutant | what a size is | has to be seen | smallest seen | not seen |
|---|---|---|---|---|
"""


def write(outcomes):
    """Write the page.

    Parameters
    ----------
    outcomes : list of tuple
        Mutant, test that caught it, sizes that were seen, first size that was not (or None).
    """
    text = [_HEAD.format(count=len(outcomes))]
    for room in dict.fromkeys(mutant.room for mutant, *_ in outcomes):
        text.append(f"\n## {room}\n\n| mutant | what is wrong | file | caught by |\n|---|---|---|---|\n")
        for mutant, caught_by, _, _ in outcomes:
            if mutant.room == room:
                cells = mutant.name, mutant.sentence, f"`{mutant.file}`", f"`{caught_by.removeprefix('tests/')}`"
                text.append(f"| {' | '.join(map(_cell, cells))} |\n")
    text.append(_SIZES)
    for mutant, _, seen, missed in outcomes:
        if mutant.sizes:
            sizes = [in_words(size) for size in (mutant.sizes[0], seen[-1])]
            cells = mutant.name, mutant.unit, *sizes, "" if missed is None else in_words(missed)
            text.append(f"| {' | '.join(cells)} |\n")
    PATH.write_text("".join(text))


def _cell(text):
    return text.replace("|", "\\|")
