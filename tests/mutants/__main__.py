"""Try all mutants: ``python -m tests.mutants``; see `make mutants`."""

import argparse
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from queue import SimpleQueue

from goniosim.cores import available_cores

from . import document
from .catalogue import catalogue, in_words
from .running import Copy


def main():
    """Exit with 1 if one survives."""
    parser = argparse.ArgumentParser(prog="python -m tests.mutants", description=__doc__)
    parser.add_argument("only", nargs="*", help="names or patterns of names; all by default")
    parser.add_argument("--list", action="store_true", help="print name, file and tests, and run nothing")
    parser.add_argument("-j", "--jobs", type=int, default=min(2, available_cores()), help="tests at a time")
    given = parser.parse_args()
    only = " ".join(given.only).split()
    mutants = catalogue(only)
    if not mutants:
        parser.error("no mutant has such a name; --list prints them")
    if given.list:
        for mutant in mutants:
            print(f"{mutant.name:36} {mutant.file:44} {' '.join(mutant.tests)}")
        return
    with tempfile.TemporaryDirectory(prefix="mutants-") as folder:
        outcomes = _try_all(mutants, Path(folder), given.jobs)
    survivors = [mutant.name for mutant, caught_by, *_ in outcomes if caught_by is None]
    if survivors:
        sys.exit(f"{len(survivors)} of {len(outcomes)} mutants were not caught: {', '.join(survivors)}")
    print(f"all {len(outcomes)} mutants were caught")
    if not only:
        document.write(outcomes)


def _try_all(mutants, folder, jobs):
    """Outcomes as `document.write` takes them; the test is None if a mutant survives."""
    copies = SimpleQueue()
    for number in range(jobs):
        (folder / str(number)).mkdir()
        copies.put(Copy(folder / str(number)))

    def with_copy(work, *arguments):
        copy = copies.get()
        try:
            return work(copy, *arguments)
        finally:
            copies.put(copy)

    with ThreadPoolExecutor(jobs) as pool:
        tests = list(dict.fromkeys(mutant.tests for mutant in mutants))
        for names, verdict in zip(tests, pool.map(lambda names: with_copy(Copy.run, names), tests), strict=True):
            if not verdict.passed:
                pool.shutdown(cancel_futures=True)
                sys.exit(f"{verdict.output}\n{' '.join(names)}: does not pass without any mutant")
        return list(pool.map(lambda mutant: with_copy(_try, mutant), mutants))


def _try(copy, mutant):
    """Try a mutant, in smaller and smaller sizes as long as it is caught."""
    caught_by, seen = None, []
    for size in mutant.sizes or (None,):
        verdict = copy.run_with(mutant, size)
        shown = mutant.name if size is None else f"{mutant.name}: {in_words(size)}"
        print(f"{shown:40} {mutant.file:44} {verdict.caught_by or '-':70} {verdict.seconds:4.0f} s", flush=True)
        if verdict.caught_by is None:
            if not seen:
                print(verdict.output[-3000:], flush=True)
            return mutant, caught_by, seen, size
        caught_by = verdict.caught_by
        seen.append(size)
    return mutant, caught_by, seen, None


if __name__ == "__main__":
    main()
