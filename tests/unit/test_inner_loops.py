"""Indices of the innermost loops of compiled code: such that LLVM sees that they are not negative.

Where it does not, an index may mean an element counted from the end, and whether a loop that stores something runs as
SIMD code then depends on where arrays happen to lie in memory: sums of the same numbers differ in their last bits from
one run to the next. Loops over slices of rows have no such indices.
"""

import ast
from pathlib import Path

import numpy as np
import pytest

import goniosim
from goniosim.engine import simulate
from goniosim.hard.catalogue import SCENES
from goniosim.scene import load_scene

FOLDER = Path(goniosim.__file__).parent
# Loops over a handful of numbers, too few for SIMD code, or that only count and move numbers.
HARMLESS = {
    ("engine/operators/bins.py", "_deposit_many"),
    ("engine/operators/bins.py", "_move"),
    ("engine/splitting/queues.py", "list_alive"),
    ("engine/tally.py", "add_deposits"),
    ("engine/welford.py", "_block_sums"),
    ("integration/border.py", "_surprise"),
    ("integration/division.py", "divide"),
    ("integration/rule.py", "add_up"),
    ("models/belcour/belcour18_symmetric.py", "evaluate"),
}


def innermost_loops(function):
    for loop in (node for node in ast.walk(function) if isinstance(node, ast.For)):
        if not any(isinstance(node, ast.For) for line in loop.body for node in ast.walk(line)):
            yield loop


def names_in(node):
    return {each.id for each in ast.walk(node) if isinstance(each, ast.Name)}


def begins_anywhere(loop):
    """Whether a loop stores something, and begins at a number that is computed."""
    stores = any(isinstance(node, ast.Subscript) and isinstance(node.ctx, ast.Store) for node in ast.walk(loop))
    begin = loop.iter.args[0] if isinstance(loop.iter, ast.Call) and len(loop.iter.args) > 1 else None
    return stores and begin is not None and not isinstance(begin, ast.Constant)


def is_opaque(index, loop):
    """Whether an index is a counter, or computed of the loop's variable and of another one or backwards."""
    counted = (node.target for node in ast.walk(loop) if isinstance(node, ast.AugAssign))
    counters = {target.id for target in counted if isinstance(target, ast.Name)}
    if isinstance(index, ast.Name):
        return index.id in counters or (index.id == loop.target.id and begins_anywhere(loop))
    if not isinstance(index, ast.BinOp) or loop.target.id not in names_in(index):
        return False
    others = {name for name in names_in(index) - {loop.target.id} if not name.isupper()}
    return bool(others) or isinstance(index.op, ast.Sub)


def opaque_indices(text):
    """Functions with such indices, and one of these."""
    found = {}
    for function in (node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.FunctionDef)):
        if not {getattr(each, "id", "") for each in function.decorator_list} & {"kernel", "stage"}:
            continue
        for loop in innermost_loops(function):
            for node in (each for line in loop.body for each in ast.walk(line)):
                if isinstance(node, ast.Subscript) and isinstance(loop.target, ast.Name):
                    parts = node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]
                    if any(is_opaque(part, loop) for part in parts):
                        found[function.name] = ast.unparse(node)
    return found


def test_no_index_may_be_negative():
    found = {}
    for path in sorted(FOLDER.rglob("*.py")):
        place = path.relative_to(FOLDER).as_posix()
        found |= {(place, name): index for name, index in opaque_indices(path.read_text()).items()}
    assert found.keys() - HARMLESS == set(), found
    assert HARMLESS - found.keys() == set()


@pytest.mark.parametrize(
    "body",
    ["out[k * n + j] = row[j]", "out[j] = row[n - j]", "out[at] = row[j]\n        at += 1"],
)
def test_such_indices_are_found(body):
    text = f"@kernel\ndef f(row, out, n, k):\n    at = 0\n    for j in range(n):\n        {body}\n"
    assert list(opaque_indices(text)) == ["f"]


def test_indices_of_rows_are_not():
    text = "@stage\ndef f(row, out, n, k):\n    for j in range(n):\n        out[j] = row[j] + row[2 * j]\n"
    assert opaque_indices(text) == {}


@pytest.mark.slow
def test_the_same_bits_forty_times_over():
    """Errors of the integrated direct reflection are differences of last bits, and so magnify them."""
    scene = load_scene(SCENES / "any_number_of_threads.yaml")
    found = {
        tuple(
            np.concatenate([component.energy.ravel(), component.stderr.ravel()]).tobytes()
            for component in simulate(scene, rays=20_000, threads=threads).components.values()
        )
        for threads in 10 * [1, 2, 3, 7]
    }
    assert len(found) == 1
