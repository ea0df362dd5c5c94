"""The command that compares all functions with their oracles, its page, and what the comparison itself can see."""

import importlib
import pkgutil
from pathlib import Path

import numpy as np
import pytest
from mpmath import mp, mpf

from benchmarks.precision import __main__ as command
from benchmarks.precision import cells, outcome, table
from benchmarks.precision.functions import GROUPS
from goniosim import optics

ROOT = Path(__file__).resolve().parents[2]
NAMES = [case.name for case in (*(case for cases in GROUPS.values() for case in cases), *cells.CASES)]
# By another name, or of whole numbers.
ELSEWHERE = {"sample_cosine": ["cosine_direction"], "sincos_octants": ["random_sincos"]}
NO_REAL_NUMBERS = {"bits_to_float", "float_to_bits", "fma", "mix", "derive_key", "uniform"}


def test_every_public_function_of_optics_has_an_oracle():
    found = set()
    for module in pkgutil.iter_modules(optics.__path__):
        loaded = importlib.import_module(f"goniosim.optics.{module.name}")
        found |= {
            name
            for name, value in vars(loaded).items()
            if hasattr(value, "py_func") and value.py_func.__module__ == loaded.__name__ and not name.startswith("_")
        }
    found -= NO_REAL_NUMBERS | {name for others in ELSEWHERE.values() for name in others}
    assert found
    assert {name for name in found if not any(name in told for told in NAMES)} == set()


def _named(page):
    """What the table of a page is about, line by line."""
    lines = [line for line in page.splitlines() if line.startswith("| ")]
    return [line.split(" | ")[0].removeprefix("| ") for line in lines[2:]]


def test_the_page_is_written_by_the_command_and_says_the_same_each_time(tmp_path, monkeypatch):
    monkeypatch.setattr(table, "GROUPS", {"horizon": GROUPS["horizon"][:1]})
    monkeypatch.setattr(cells, "CASES", cells.CASES[:2])
    monkeypatch.setattr(table, "deviations", lambda dense: (1e-29, 1e-30))
    pages = []
    for name in ("one", "other"):
        (tmp_path / name / "docs").mkdir(parents=True)
        assert command.main(["--root", str(tmp_path / name)]) == 0
        pages.append((tmp_path / name / "docs" / "precision.md").read_text(encoding="utf-8"))
    assert pages[0] == pages[1]
    assert _named(pages[0]) == [case.name for case in (GROUPS["horizon"][0], *cells.CASES)]


def test_the_page_in_docs_has_a_line_for_each_case():
    """Whoever adds or renames one runs `make precision` again."""
    assert _named((ROOT / "docs" / "precision.md").read_text(encoding="utf-8")) == NAMES


@pytest.mark.parametrize("found, beyond", [(2.0, 0), (2.0 + 1e-12, 0), (2.0 + 4e-12, 1), (np.nan, 1), (np.inf, 1)])
def test_an_error_above_the_limit_is_seen(found, beyond):
    result = outcome.compare([(1.0,), (2.0,)], [1.0, found], [mpf(1), mpf(2)], lambda i: mpf(0))
    assert result.beyond == beyond
    assert (result.units == np.inf) is bool(beyond)


def test_what_should_be_0_is_0():
    assert outcome.compare([(1.0,)], [0.0], [mpf(0)], lambda i: mpf(0)).beyond == 0
    assert outcome.compare([(1.0,)], [1e-300], [mpf(0)], lambda i: mpf(0)).beyond == 1


def test_the_spread_is_the_condition_number_and_finite_at_a_root():
    with mp.workdps(outcome.DIGITS):
        found = outcome.spread(lambda x, y: x**3 / y, [mpf(2), mpf(5)])
        assert float(found / (mpf(8) / 5) / outcome.UNITS * 2**53) == pytest.approx(4.0, rel=1e-12)
        root = outcome.spread(lambda x: mp.sqrt(max(mpf(0), x - 1)), [mpf(1)])
        assert float(root) == pytest.approx(np.sqrt(outcome.UNITS * 2.0**-53))
