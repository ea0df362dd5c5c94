"""Help, version and imports: instant, since nothing heavy is loaded."""

import re
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pytest
from click.shell_completion import ShellComplete
from goniosim_cli.main import main

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

    functions = ["compare", "evaluate_model", "load_scene", "load_scenes", "open_result", "simulate", "simulate_study"]
    assert dir(goniosim) == sorted(["GoniosimError", "Result", "Scene", "__version__", "errors", *functions])
    assert goniosim.__version__ == version("goniosim")
    assert all(callable(getattr(goniosim, name)) for name in functions)
    assert issubclass(goniosim.errors.ConfigError, goniosim.GoniosimError)
    with pytest.raises(AttributeError, match="no attribute 'nonsense'"):
        _ = goniosim.nonsense


def test_every_command_is_listed_with_a_whole_sentence(goniosim):
    from goniosim_cli.main import main

    code, out, _ = goniosim("--help")
    assert code == 0
    for command in main.commands:
        (line,) = [line for line in out.splitlines() if line.strip().startswith(command + " ")]
        assert line.endswith(".")
        assert not line.endswith("...")


@pytest.mark.parametrize("command", sorted(set(main.commands) - {"versions"}))
def test_the_help_of_a_command_has_an_example(goniosim, command):
    _, out, _ = goniosim(command, "--help")
    assert re.search(rf"^  Examples?: goniosim {command} ", out, re.MULTILINE)


def test_exit_codes_are_the_same_in_help_readme_and_code(goniosim):
    from goniosim import errors

    _, out, _ = goniosim("--help")
    shown = set(map(int, re.findall(r"^    (\d+)  +\w", out.partition("Exit codes:")[2], re.MULTILINE)))
    readme = (Path(errors.__file__).parents[1] / "README.md").read_text(encoding="utf-8").partition("| exit code |")[2]
    rows = re.findall(r"^\| ([\d, ]+) \|", readme, re.MULTILINE)
    classes = [each for each in vars(errors).values() if isinstance(each, type) and hasattr(each, "exit_code")]
    assert {each.exit_code for each in classes} <= shown
    assert shown == {int(code) for row in rows for code in row.split(",")}


@pytest.mark.parametrize(
    "words, incomplete, found",
    [
        ([], "si", ["simulate"]),
        (["init"], "pl", ["plastic"]),
        (["simulate"], "qu", ["file"]),
        (["simulate", "a.yaml", "-o"], "", ["file"]),
        (["info", "a.h5"], "", ["file"]),
        (["compare"], "re", ["file"]),
        (["compare", "a.h5", "--models"], "ww09,belcour18_f", ["ww09,belcour18_forward"]),
    ],
)
def test_shells_complete_commands_files_and_models(words, incomplete, found):
    from click.shell_completion import BashComplete
    from goniosim_cli.main import main

    items = BashComplete(main, {}, "goniosim", "_GONIOSIM_COMPLETE").get_completions(words, incomplete)
    assert [item.value if item.type == "plain" else item.type for item in items] == found


def test_python_api_simulates_a_path_or_a_scene(folder):
    import goniosim

    by_path = goniosim.simulate(folder / "scene.yaml", rays=1000)
    by_scene = goniosim.simulate(goniosim.load_scene(folder / "scene.yaml"), rays=1000)
    assert by_path.config_hash == by_scene.config_hash
    assert by_path.rays.tolist() == by_scene.rays.tolist() == [1000]
    assert np.array_equal(
        by_path.components["reflection/internal"].energy, by_scene.components["reflection/internal"].energy
    )


@pytest.mark.parametrize(
    ("words", "begun", "names"),
    [
        (["compare", "--models"], "ww09,bati", ["ww09,bati19_ww", "ww09,bati19_belcour"]),
        (["plot", "--model"], "bati", ["bati19_ww", "bati19_belcour"]),
    ],
)
def test_names_of_models_are_completed(words, begun, names):
    completion = ShellComplete(main, {}, "goniosim", "_GONIOSIM_COMPLETE")
    assert [item.value for item in completion.get_completions(words, begun)] == names
