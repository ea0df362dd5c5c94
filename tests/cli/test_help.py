"""Help, version and imports: instant, since nothing heavy is loaded."""

from importlib.metadata import version

import numpy as np
import pytest

HEAVY = ("numpy", "numba", "matplotlib", "h5py", "pydantic", "ruamel", "tqdm")


@pytest.mark.parametrize("arguments", [["--help"], ["-h"], ["simulate", "--help"], ["--version"]])
def test_help_loads_nothing_heavy(python, arguments):
    script = f"""
import sys
from goniosim_cli.main import main
try:
    main({arguments!r})
except SystemExit:
    pass
print([name for name in {HEAVY!r} if name in sys.modules])
"""
    out, err = python(script).communicate()
    assert out.splitlines()[-1] == "[]"
    assert len(out.splitlines()) > 1
    assert err == ""


def test_importing_the_package_loads_nothing_heavy(python):
    script = f"import sys, goniosim; print([name for name in {HEAVY!r} if name in sys.modules])"
    assert python(script).communicate()[0].strip() == "[]"


def test_the_public_names_are_there_and_no_others():
    import goniosim

    names = ["__version__", "compare", "evaluate_model", "load_scene", "open_result", "simulate"]
    assert dir(goniosim) == names
    assert goniosim.__version__ == version("goniosim")
    assert callable(goniosim.load_scene)
    assert callable(goniosim.open_result)
    assert callable(goniosim.compare)
    assert callable(goniosim.evaluate_model)
    with pytest.raises(AttributeError, match="no attribute 'nonsense'"):
        _ = goniosim.nonsense


def test_every_command_is_listed_with_a_whole_sentence(goniosim):
    code, out, _ = goniosim("--help")
    assert code == 0
    for command in ("simulate", "check", "info", "plot", "schema", "versions"):
        (line,) = [line for line in out.splitlines() if line.strip().startswith(command + " ")]
        assert line.endswith(".")
        assert not line.endswith("...")


def test_python_api_simulates_a_path_or_a_scene(folder):
    import goniosim

    by_path = goniosim.simulate(folder / "scene.yaml", rays=1000)
    by_scene = goniosim.simulate(goniosim.load_scene(folder / "scene.yaml"), rays=1000)
    assert by_path.config_hash == by_scene.config_hash
    assert by_path.rays.tolist() == by_scene.rays.tolist() == [1000]
    assert np.array_equal(
        by_path.components["reflection/internal"].energy, by_scene.components["reflection/internal"].energy
    )
