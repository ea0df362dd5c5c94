"""Which compiled code a mutant leaves as it is: kernels of files that do not import what it breaks, nor through others.

What is taken over by mistake would be code without the bug, with which the mutant survives: that is seen.
"""

import ast
import shutil
from functools import cache
from pathlib import Path

from numba.core.caching import UserProvidedCacheLocator

from .catalogue import ROOT


def take_over(before, after, tree, broken):
    """Copy the compiled code that does not depend on a file.

    Parameters
    ----------
    before, after : Path
        Folders of compiled code of the tree, without the mutant and with it.
    tree : Path
        The copy of the source.
    broken : str
        The file, relative to the tree.
    """
    for path in (ROOT / "goniosim").rglob("*.py"):
        place = path.relative_to(ROOT)
        if ROOT / broken not in _reached(path):
            folder = UserProvidedCacheLocator.get_suitable_cache_subpath(str(tree / place))
            for compiled in (before / folder).glob(f"{path.stem}.*"):
                (after / folder).mkdir(mode=0o700, exist_ok=True)
                shutil.copy2(compiled, after / folder)


@cache
def _reached(path):
    """A file and all that it imports, through others."""
    found, waiting = set(), {path}
    while waiting:
        each = waiting.pop()
        found.add(each)
        waiting |= _imported(each) - found
    return found


@cache
def _imported(path):
    """Files of goniosim that a file imports, perhaps within a function."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom):
            home = path.parents[node.level - 1] if node.level else ROOT
            module = home.joinpath(*(node.module or "").split(".")) if node.module else home
            # Of a package, either one of its files or what stands in `__init__.py`.
            found.update(_file(module / name.name) or _file(module) for name in node.names)
        elif isinstance(node, ast.Import):
            found.update(_file(ROOT.joinpath(*name.name.split("."))) for name in node.names)
    return frozenset(file for file in found if file is not None and file.is_relative_to(ROOT / "goniosim"))


def _file(module):
    """The file of a module; None if it is none."""
    places = [Path(f"{module}.py"), module / "__init__.py"]
    return next((place for place in places if place.is_file()), None)
