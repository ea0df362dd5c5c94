"""The rooms of the house: imports go one way, without circles, and files stay small.

CONTRIBUTING.md draws the same map for people. Imports inside functions and for type checkers count too.
"""

import ast
import graphlib
import re
import statistics
from pathlib import Path

import pytest

import goniosim
from goniosim._jit.folder import _COMPILED

ROOT = Path(goniosim.__file__).resolve().parent.parent
MODULES = {"goniosim": ROOT / "goniosim", "goniosim_cli": ROOT / "cli"}

# The ground, which every room may use; `_jit` brings numba along and is for rooms with compiled code.
GROUND = {
    "accuracy",
    "albedo",
    "claims",
    "containers",
    "cores",
    "effective",
    "errors",
    "free_memory",
    "owners",
    "parts",
    "provenance",
    "result",
    "sharing",
    "sums",
    "writing",
}
COMPILED = {"_jit"}

# For each room, the rooms that it may import besides itself and the ground. A new room is a new line.
MAY_IMPORT = {
    **dict.fromkeys(GROUND | COMPILED, set()),
    "optics": COMPILED,
    "slices": COMPILED | {"optics"},
    "integration": COMPILED | {"optics", "slices"},
    "scene": set(),
    "models": COMPILED | {"optics", "slices", "integration", "scene"},
    "engine": COMPILED | {"optics", "slices", "integration", "scene"},
    "store": {"scene"},
    "compare": COMPILED | {"optics", "slices", "integration", "scene", "models", "store"},
    "report": COMPILED | {"slices", "integration", "scene", "models", "engine", "store", "compare"},
    "cluster": COMPILED | {"scene", "engine", "store", "report"},
    "hard": {"slices", "integration", "scene", "models", "engine", "store", "compare", "report"},
    "api": {"scene", "engine", "store", "report", "cluster"},
    # The public face, which nobody inside imports, and the roof.
    "goniosim": {"scene", "models", "store", "compare", "api"},
    "goniosim_cli": COMPILED
    | {"goniosim", "scene", "models", "engine", "store", "compare", "report", "cluster", "hard"},
}

# Methods of a result that hand on to rooms above, so that people find on it what they want to do with it. Imported
# when the method is called, and nowhere else: without them a result is plain data, which needs nothing.
HANDED_ON = {
    ("goniosim.result", "goniosim.albedo"),
    ("goniosim.result", "goniosim.report.brief"),
    ("goniosim.result", "goniosim.report.simulation.figures"),
    ("goniosim.result", "goniosim.store"),
}

# Libraries that one room knows and hides from the others.
HOMES = {
    "click": {"goniosim_cli"},
    "distributed": {"cluster"},
    "h5py": {"store"},
    "llvmlite": {"_jit"},
    # A result names the type of what its method returns, for type checkers.
    "matplotlib": {"report", "result"},
    "numba": {"_jit"},
    "pydantic": {"scene"},
    "pydantic_core": {"scene"},
    "ruamel": {"scene"},
    "tqdm": {"report"},
    "xarray": {"store", "result"},
}

MAX_LINES = 400
MAX_MEDIAN = 130


def imports(packages, walk=ast.walk):
    """What each module imports, anywhere in its text.

    Parameters
    ----------
    packages : dict of str to Path
        Folder of each package by the name under which it is imported.
    walk : callable
        The nodes of a syntax tree among which to look.

    Returns
    -------
    dict of str to set of str
        Full names; of the packages' own, the names of modules.
    """
    paths = {}
    for package, folder in packages.items():
        for path in folder.rglob("*.py"):
            parts = (package, *path.relative_to(folder).with_suffix("").parts)
            paths[".".join(parts).removesuffix(".__init__")] = path
    return {name: set(_imported(name, path, paths, walk)) - {name} for name, path in paths.items()}


def _imported(name, path, known, walk):
    package = name if path.name == "__init__.py" else name.rpartition(".")[0]
    for node in walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            parents = package.split(".")[: 1 - node.level or None] if node.level else []
            base = ".".join([*parents, *filter(None, [node.module])])
            inside = {alias.name: f"{base}.{alias.name}" for alias in node.names}
            yield from (inside[each] if inside[each] in known else base for each in inside)


def ancestors(module):
    """The packages that are initialised before a module, and the module itself."""
    parts = module.split(".")
    return {".".join(parts[:n]) for n in range(1, len(parts) + 1)}


def circle(imported):
    """Modules that import each other, as a list; empty if there are none.

    A module also needs the ``__init__`` of every package on the way to what it imports, except of
    those that it lies in itself.
    """
    graph = {name: set() for name in imported}
    for name, targets in imported.items():
        for target in targets & imported.keys():
            graph[name] |= ({target} | ancestors(target) - ancestors(name)) - {name}
    try:
        graphlib.TopologicalSorter(graph).prepare()
    except graphlib.CycleError as error:
        return error.args[1]
    return []


def room(module):
    """Name of the room of a module: the folder or file right below goniosim; the whole of the command line is one."""
    parts = module.split(".")
    return parts[1] if parts[0] == "goniosim" and len(parts) > 1 else parts[0]


def wrong_ways(imported, may_import):
    """Imports that go against the table: pairs of modules."""
    return sorted(
        (name, target)
        for name, targets in imported.items()
        for target in targets & imported.keys()
        if room(target) not in may_import[room(name)] | GROUND | {room(name)}
    )


def outside_functions(node):
    """The nodes of a syntax tree that are met when a module is imported."""
    yield node
    for child in ast.iter_child_nodes(node):
        if not isinstance(child, ast.FunctionDef):
            yield from outside_functions(child)


@pytest.fixture(scope="module")
def everything():
    return imports(MODULES)


@pytest.fixture(scope="module")
def imported(everything):
    handed_on = {name: {target for user, target in HANDED_ON if user == name} for name in everything}
    return {name: targets - handed_on[name] for name, targets in everything.items()}


def test_what_a_result_hands_on_is_imported_by_its_methods_only(everything):
    at_once = imports(MODULES, outside_functions)
    assert [(name, target) for name, target in HANDED_ON if target in at_once[name]] == []
    assert [(name, target) for name, target in HANDED_ON if target not in everything[name]] == []


def test_every_room_is_on_the_map(imported):
    assert {room(name) for name in imported} <= MAY_IMPORT.keys()


def test_imports_go_one_way(imported):
    assert wrong_ways(imported, MAY_IMPORT) == []


def test_the_map_itself_has_no_circles():
    graphlib.TopologicalSorter(MAY_IMPORT).prepare()


def test_no_modules_import_each_other(imported):
    assert circle(imported) == []


def test_libraries_stay_in_their_rooms(imported):
    found = {(room(name), target.split(".")[0]) for name, targets in imported.items() for target in targets}
    assert [(user, library) for user, library in found if library in HOMES and user not in HOMES[library]] == []


def test_the_cache_of_compiled_code_is_keyed_by_every_room_that_has_some(imported):
    compiled = {room(name) for name, targets in imported.items() if "goniosim._jit" in targets}
    assert compiled == set(_COMPILED)


def test_a_wrong_way_and_a_circle_are_found(tmp_path):
    """The checks above can fail: on lazy, relative and aliased imports alike."""
    files = {
        "__init__.py": "",
        "errors.py": "",
        "optics/__init__.py": "from .lens import f\n",
        "optics/lens.py": "def f():\n    from ..engine.walk import g as h\n",
        "engine/__init__.py": "from goniosim import errors\nimport goniosim.optics.lens\n",
        "engine/walk.py": "from . import plan\n",
        "engine/plan.py": "if False:\n    from .walk import g\n",
        "models/__init__.py": "from goniosim import optics\n",
    }
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    made = imports({"goniosim": tmp_path})
    table = {"goniosim": set(), "errors": set(), "optics": set(), "engine": {"optics"}, "models": {"optics"}}
    assert wrong_ways(made, table) == [("goniosim.optics.lens", "goniosim.engine.walk")]
    assert wrong_ways(made, {**table, "models": set()})[0] == ("goniosim.models", "goniosim.optics")
    assert set(circle({name: made[name] for name in made if "optics" not in name})) == {
        "goniosim.engine.plan",
        "goniosim.engine.walk",
    }
    del made["goniosim.engine.plan"]
    # Through the packages: engine needs optics.lens, which needs optics and engine.walk, which needs engine.
    assert "goniosim.optics.lens" in circle(made)


GUIDE = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")


def test_the_map_for_people_is_the_same():
    rows = re.findall(r"^\| `(\w+)` \|.*\|(.*)\|$", GUIDE, re.MULTILINE)
    drawn = {name.replace("cli", "goniosim_cli"): set(re.findall(r"`(\w+)`", targets)) for name, targets in rows}
    assert drawn == {name: targets for name, targets in MAY_IMPORT.items() if name not in GROUND}


def test_what_the_guide_points_at_exists():
    """Files and folders, and the names in them: written as `path`, or as `path`, `name`."""
    folders = r"goniosim|cli|tests|benchmarks|configs|docs|\.ci"
    pointers = re.findall(rf"[`(]((?:{folders})/[\w./]+)[`)](?:,\s`(\w+)`)?", GUIDE)
    assert len(pointers) > 60
    for path, name in pointers:
        assert (ROOT / path).exists(), path
        if name:
            assert re.search(rf"^(def |class )?{name}\b", (ROOT / path).read_text(encoding="utf-8"), re.MULTILINE), name


def lengths():
    """Number of lines of every source file of the project, by path."""
    folders = [path for path in ROOT.iterdir() if path.is_dir() and path.name[0] != "."]
    kept = [folder for folder in folders if folder.name not in ("build", "dist", "out")]
    sources = [path for folder in kept for path in folder.rglob("*.py")]
    return {path.relative_to(ROOT).as_posix(): len(path.read_bytes().splitlines()) for path in sources}


def test_files_stay_small():
    found = lengths()
    assert [path for path, length in found.items() if length > MAX_LINES] == []
    for top in ("goniosim/", "cli/", "tests/"):
        assert statistics.median(length for path, length in found.items() if path.startswith(top)) <= MAX_MEDIAN
