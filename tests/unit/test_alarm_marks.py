"""Every test of random numbers says how often a right program fails it, and none is random anew in each run.

What a test is about is told by its words, those of its docstring and of the functions of its file that it calls: it
speaks of deviations as statisticians do, and of random numbers. Where it is none of them all the same, it is marked
with a rate of 0.
"""

import ast
import re
from pathlib import Path

import pytest

pytestmark = pytest.mark.false_alarm(0)

TESTS = Path(__file__).resolve().parent.parent
FILES = sorted(path for path in TESTS.glob("*/test_*.py"))

# Limits and measures of statistics, and comparisons in the tests' own reference code.
JUDGED = re.compile(
    r"\bsigmas?\b|chi.?squar|\bchi2|kstest|ddof|poisson\(|standard (deviations?|errors)|"
    r"many_seeds|_deviations\(|\bdeviations\(|analog_blocks|[0-9]\.?[0-9]* \* [^\n]*(stderr|std\()",
    re.IGNORECASE,
)
DRAWN = re.compile(r"default_rng|simulate\(|trace\(|replicates\(|\bseeds?\b|uniform\(|\brays=|sampled")
STATED = re.compile(r"false.alarm|p_?values?\b", re.IGNORECASE)
ANEW = re.compile(r"default_rng\(\)|\bRandom\(\)|(?<![\w.])random\.(random|uniform|choice|randrange)\(")


def called(name, functions, met):
    """Names of functions and fixtures of a file that one leads to, itself included."""
    met.add(name)
    for node in ast.walk(functions[name]):
        other = node.id if isinstance(node, ast.Name) else node.arg if isinstance(node, ast.arg) else None
        if other in functions and other not in met:
            called(other, functions, met)
    return met


def source(lines, node):
    return "\n".join(lines[node.lineno - 1 : node.end_lineno])


def unmarked(text):
    """Tests of a file that judge random numbers and do not say how often they fail."""
    tree, lines = ast.parse(text), text.splitlines()
    functions = {node.name: node for node in tree.body if isinstance(node, ast.FunctionDef | ast.ClassDef)}
    named = {ast.unparse(node.targets[0]): node for node in tree.body if isinstance(node, ast.Assign)}
    if "pytestmark" in named and "false_alarm" in ast.unparse(named["pytestmark"]):
        return []
    # Marks may have a name of their own.
    marks = {name for name, node in (named | functions).items() if "mark.false_alarm(" in ast.unparse(node)}
    found = []
    for name, node in functions.items():
        said = " ".join(ast.unparse(each) for each in node.decorator_list)
        if not name.startswith("test_") or "mark.false_alarm" in said or marks & set(re.findall(r"\w+", said)):
            continue
        words = "\n".join(source(lines, functions[each]) for each in called(name, functions, set()))
        if STATED.search(words) or (JUDGED.search(words) and DRAWN.search(words)):
            found.append(name)
    return found


def test_every_test_of_random_numbers_states_its_rate():
    """See tests/alarms.py."""
    found = {path.name: unmarked(path.read_text(encoding="utf-8")) for path in FILES}
    assert {name: tests for name, tests in found.items() if tests} == {}


def test_the_same_random_numbers_are_drawn_in_every_run():
    assert [path.name for path in FILES if ANEW.search(path.read_text(encoding="utf-8"))] == []


SUSPECT = """
def runs(seed):
    return default_rng(seed)

def test_it():
    \"\"\"Within 5 sigma.\"\"\"
    assert runs(1)
"""


@pytest.mark.parametrize(
    ("head", "body", "found"),
    [
        ("", SUSPECT, ["test_it"]),
        ("", SUSPECT.replace("sigma", "digits"), []),
        ("", SUSPECT.replace("runs(1)", "runs(1).std(ddof=1) < 1").replace("sigma", "digits"), ["test_it"]),
        ("", SUSPECT.replace("def test_it", "@pytest.mark.false_alarm(1e-9)\ndef test_it"), []),
        (
            "often = pytest.mark.false_alarm(0.1)",
            SUSPECT.replace("def test_it", "@often\ndef test_it"),
            [],
        ),
        ("pytestmark = [pytest.mark.slow, pytest.mark.false_alarm(1e-9)]", SUSPECT, []),
    ],
    ids=["words", "none", "called", "marked", "named mark", "whole file"],
)
def test_what_states_no_rate_is_found(head, body, found):
    assert unmarked(head + body) == found


def test_random_numbers_without_a_seed_are_found():
    drawn = "rng = np.random.default_rng({})".format
    assert ANEW.search(drawn("")) and not ANEW.search(drawn(1))
