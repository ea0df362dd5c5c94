"""The examples run: those in the docstrings of public names, and the Python in README.md and docs.

`test_store_schema.py` runs those of data_schema.md.
"""

import doctest
import re
from pathlib import Path

import pytest

import goniosim
from synthetic import write_models

ROOT = Path(__file__).parents[2]
FLAGS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE

SCENE = """\
material:
  name: coated
  layers:
    - interface: {type: dielectric, eta: 1.5, alpha: 0.2}
    - interface: {type: lambert, rho: [0.8, 0.4, 0.2]}
incident: {theta_deg: [0, 60]}
slice: {rows: 9, columns: 36}
"""
STUDY = """\
study:
  name: coats
  cross: {alpha: [0.1, 0.2, 0.3]}
  material:
    name: coat-${alpha}
    layers:
      - interface: {type: dielectric, eta: 1.5, alpha: "${alpha}"}
incident: {theta_deg: [0]}
slice: {rows: 9, columns: 36}
"""
# Public names without an example of their own.
NOT_CALLED = {"GoniosimError", "Scene", "__version__", "errors"}
DOCUMENTS = ["README.md", *sorted(path.relative_to(ROOT).as_posix() for path in (ROOT / "docs").glob("*.md"))]


@pytest.fixture(scope="module")
def prepared(tmp_path_factory):
    """A folder with the files that examples read, and the result that some of them speak of."""
    folder = tmp_path_factory.mktemp("examples")
    (folder / "scene.yaml").write_text(SCENE)
    (folder / "study.yaml").write_text(STUDY)
    (folder / "configs").symlink_to(ROOT / "configs")
    (folder / "out").mkdir()
    small = ["slice.rows=9", "slice.columns=36", "simulation.rays=1000"]
    patina = goniosim.simulate(goniosim.load_scene(ROOT / "configs" / "quickstart.yaml", small))
    for path in ("result.h5", "patina.h5", "out/metallic-patina.h5"):
        patina.save(folder / path)
    write_models(folder / "models.h5")
    return folder, goniosim.simulate(SCENE, rays=1e4)


@pytest.fixture
def result(prepared, monkeypatch):
    folder, result = prepared
    monkeypatch.chdir(folder)
    return result


def run(tests):
    """Run doctests; what fails is the message."""
    report = []
    runner = doctest.DocTestRunner(optionflags=FLAGS)
    for test in tests:
        runner.run(test, out=report.append, clear_globs=False)
    assert runner.tries > 0
    assert report == [], "".join(report)


@pytest.mark.parametrize("name", ["goniosim", *sorted(set(goniosim.__all__) - NOT_CALLED)])
def test_the_examples_of_docstrings(result, name):
    """Whatever is called is shown in use; of a result, each method."""
    thing = goniosim if name == "goniosim" else getattr(goniosim, name)
    thing = thing.compare if name == "compare" else thing
    finder = doctest.DocTestFinder(recurse=name == "Result")
    found = finder.find(thing, name, globs={"goniosim": goniosim, "result": result})
    run([test for test in found if test.examples])


@pytest.mark.parametrize("document", DOCUMENTS)
def test_the_examples_of_documents(result, document, capsys):
    """In one go, as a reader would type them; those with a prompt also print what stands there."""
    text = (ROOT / document).read_text(encoding="utf-8")
    names = {}
    for block in re.findall(r"^```python\n(.*?)^```", text, re.DOTALL | re.MULTILINE):
        if block.startswith(">>>"):
            test = doctest.DocTestParser().get_doctest(block, names, document, document, 0)
            run([test])
            names |= test.globs
        else:
            exec(compile(block, document, "exec"), names)
