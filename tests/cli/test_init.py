"""`goniosim init`: every example is whole, valid, measured in a moment, and never written over anything."""

import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import jsonschema
import pytest
from goniosim_cli.init import NAMES

import goniosim as package
from goniosim.scene import example, json_schema, parse_scene
from goniosim.scene.reading import read_text
from goniosim.scene.tree import plain

ROOT = Path(package.__file__).resolve().parent.parent
SMALL = ("--set", "slice.rows=6", "--set", "slice.columns=12", "--set", "incident.theta_deg=[30]")


def test_every_example_is_listed(goniosim):
    assert {path.stem for path in (ROOT / "goniosim" / "scene" / "examples").iterdir()} == set(NAMES)
    _, out, _ = goniosim("init", "--help")
    for name in NAMES:
        assert f"\n    {name} " in out


@pytest.mark.parametrize("name", NAMES)
def test_an_example_teaches_and_satisfies_the_schema(name):
    text = example(name)
    jsonschema.validate(plain(read_text(text, name)), json_schema(), jsonschema.Draft202012Validator)
    assert f"goniosim simulate {name}.yaml" in text
    flat = " ".join(text.replace("#", " ").split())
    for lesson in ("absolute", "GGX width", "roughness", "degrees from the normal", "per incident direction"):
        assert lesson in flat
    assert ("ptical depth" in flat) == ("tau" in flat)


def test_what_the_first_example_has_in_comments_is_right():
    text = example("quickstart").replace("  rays: 2e5 ", "  # ")
    for commented in ("#   target:", "#   max_time:", "# estimator:"):
        assert f"  {commented}" in text
        text = text.replace(commented, commented.lstrip("# "))
    schema, content = json_schema(), plain(read_text(text, "quickstart"))
    jsonschema.validate(content, schema, jsonschema.Draft202012Validator)
    simulation = parse_scene(text).simulation
    assert (str(simulation.target), simulation.max_time, simulation.estimator) == ("1 % of slice", 600.0, "analog")
    for wrong in ({"target": {"relative_error": "1%"}, "rays": 1000}, {"rays": 1000, "max_time": 60}):
        with pytest.raises(jsonschema.ValidationError):
            jsonschema.validate({**content, "simulation": wrong}, schema, jsonschema.Draft202012Validator)


def test_the_default_is_the_configuration_of_the_repository(goniosim, folder):
    code, out, err = goniosim("init")
    assert (code, err) == (0, "")
    assert out == "quickstart.yaml is written. Next:\n\n  goniosim simulate quickstart.yaml\n"
    assert (folder / "quickstart.yaml").read_bytes() == (ROOT / "configs" / "quickstart.yaml").read_bytes()


@pytest.mark.parametrize("name", NAMES)
def test_an_example_simulates(goniosim, folder, name):
    assert goniosim("init", name, "-o", "my scenes/first.yaml")[1].endswith(
        "\n  goniosim simulate 'my scenes/first.yaml'\n"
    )
    code, out, err = goniosim("simulate", "my scenes/first.yaml", "--rays", "100", *SMALL)
    assert code == 0, err
    files = sorted(path.name for path in folder.rglob("*.h5"))
    text = example(name)
    if name == "study":
        assert len(files) == 6
        assert (folder / "coats").is_dir()
    else:
        assert len(files) == 1
        assert f"writes {files[0]}" in text


def test_nothing_is_overwritten(goniosim, folder):
    (folder / "metal.yaml").write_text("mine")
    (folder / "link.yaml").symlink_to("nowhere")
    for arguments in (["metal"], ["metal", "-o", "link.yaml"], ["metal", "-o", "."]):
        code, out, err = goniosim("init", *arguments)
        assert (code, out) == (4, "")
        assert err.startswith("goniosim: error: ")
        assert err.endswith("exists, and is not overwritten; choose another name with -o, or remove it\n")
    assert (folder / "metal.yaml").read_text() == "mine"
    assert not (folder / "nowhere").exists()


def test_the_command_that_follows_works_for_any_name(goniosim, folder):
    assert goniosim("init", "-o", "-x.yaml")[1].endswith("  goniosim simulate ./-x.yaml\n")
    assert (folder / "-x.yaml").exists()


def test_a_dash_prints_it(goniosim, folder):
    assert goniosim("init", "slab", "-o", "-") == (0, example("slab"), "")
    assert not (folder / "slab.yaml").exists()


@pytest.mark.slow
def test_an_installed_wheel_has_the_examples_and_batch_scripts(tmp_path):
    source, wheels, site = tmp_path / "source", tmp_path / "wheels", tmp_path / "site"
    ignored = shutil.ignore_patterns("__pycache__", ".*", "build", "out", "*.egg-info", "tests", "docs")
    shutil.copytree(ROOT, source, ignore=ignored)
    build = [sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "--wheel-dir", wheels, source]
    done = subprocess.run(build, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    (wheel,) = wheels.glob("*.whl")
    archive = zipfile.ZipFile(wheel)
    assert {f"goniosim/scene/examples/{name}.yaml" for name in NAMES} <= set(archive.namelist())
    assert {f"goniosim/cluster/slurm/{name}.sbatch" for name in ("shards", "merge")} <= set(archive.namelist())
    archive.extractall(site)
    script = f"import sys; sys.path.insert(0, {str(site)!r}); from goniosim_cli.main import main; main()"
    for name in NAMES:
        command = [sys.executable, "-c", script, "init", name, "-o", "-"]
        shown = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path)
        assert (shown.returncode, shown.stdout) == (0, example(name)), shown.stderr
