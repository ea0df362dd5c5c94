"""Random numbers as walks use them, before the tests of dieharder 3.31 (Marsaglia; Brown, Eddelbuettel, Bauer)."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from reference.words import WORDS

TESTS = Path(__file__).resolve().parents[1]

# Birthdays, permutations, ranks of matrices, bit streams, ones in bytes, parking lot, distances, runs, craps, serial
# patterns of up to 16 bits, permutations of five, lagged sums, Kolmogorov-Smirnov, bytes, cosine transform, trees,
# monobit. Left out, as dieharder lists them: 14 ("Do Not Use": sums) and 5, 6, 7 ("Suspect": opso, oqso, dna). For
# their time: 2, 13, 17, 201. Because 102 looks at the same: 100, 101, 200.
CHOSEN = ("0", "1", "3", "4", "8", "9", "10", "11", "12", "15", "16", "102", "202", "203 -n 2")
CHOSEN += ("204", "205", "206", "207", "208", "209")

# On either side. dieharder calls this FAILED.
BEYOND = 1e-6
_ROW = re.compile(r"^\s*([a-z]\w+)\|\s*(\d+)\|\s*\d+\|\s*\d+\|\s*([\d.]+)\|")
# Parts of the stream from one test to the next, more than any of them reads; and from there to its repetition.
_APART, _LATER = 2000, 1000


def p_values(name, test, start):
    """What a test of dieharder finds in a stream from a part on: names, as often as it gives a number, and p-values."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(TESTS), str(TESTS.parent)])}
    writer = subprocess.Popen(
        [sys.executable, "-m", "reference.words", name, str(start)], env=environment, stdout=subprocess.PIPE
    )
    try:
        done = subprocess.run(
            ["dieharder", "-g", "200", "-d", *test.split()],
            stdin=writer.stdout,
            capture_output=True,
            text=True,
            check=True,
        )
    finally:
        writer.stdout.close()
        writer.wait()
    found = [match.groups() for match in map(_ROW.match, done.stdout.splitlines()) if match]
    assert found, done.stdout
    return [(f"{name} {size}", float(p)) for name, size, p in found]


def is_beyond(p):
    return min(p, 1.0 - p) < BEYOND


@pytest.mark.slow
@pytest.mark.false_alarm(2e-10)
@pytest.mark.parametrize("name", WORDS)
def test_dieharder(name):
    """What is beyond 1e-6 must be so again with fresh numbers; 48 p-values, a false alarm in 2e-10 of the cases."""
    if shutil.which("dieharder") is None:
        pytest.fail("there is no dieharder here: `apt-get install dieharder`, or `make test-all`, which does it")
    for number, test in enumerate(CHOSEN):
        first = p_values(name, test, number * _APART)
        if any(is_beyond(p) for _, p in first):
            again = p_values(name, test, number * _APART + _LATER)
            pairs = zip(first, again, strict=True)
            assert not any(is_beyond(p) and is_beyond(q) for (_, p), (_, q) in pairs), (first, again)
