"""Provenance: what it names, and that finding it out never costs a result."""

import os
import platform
import shlex
import shutil
import subprocess

import pytest

from goniosim import provenance


@pytest.fixture(autouse=True)
def forgotten():
    """Nothing is remembered from before, nor for later."""
    remembered = (provenance.processor, provenance.operating_system, provenance.git_revision)
    for function in remembered:
        function.cache_clear()
    yield
    for function in remembered:
        function.cache_clear()


def test_it_names_machine_and_versions():
    found = provenance.provenance(3)
    assert found["threads"] == "3" and int(found["cores"]) >= 1
    assert found["python_version"] == platform.python_version()
    assert platform.system() in found["operating_system"]
    assert all(isinstance(value, str) and value and "\n" not in value for value in found.values())
    assert "command" not in found


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("processor\t: 0\nmodel name\t: Some CPU @ 3 GHz\nprocessor\t: 1\nmodel name\t: Other\n", "Some CPU @ 3 GHz"),
        ("processor\t: 0\nBogoMIPS\t: 1\nModel\t\t: Raspberry Pi 4\n", "Raspberry Pi 4"),
        ("processor\t: 0\nmodel name\t:\n", None),
        (None, None),
    ],
)
def test_the_processor_is_named_by_its_model_where_the_system_tells(tmp_path, monkeypatch, text, name):
    if text is not None:
        (tmp_path / "cpuinfo").write_text(text)
    monkeypatch.setattr(provenance, "_CPUINFO", tmp_path / "cpuinfo")
    monkeypatch.setattr("platform.system", lambda: "Linux")
    monkeypatch.setattr("platform.processor", lambda: "")
    assert provenance.processor() == (name or platform.machine())


def test_on_a_mac_the_system_is_asked(tmp_path, monkeypatch):
    monkeypatch.setattr(provenance, "_CPUINFO", tmp_path / "absent")
    monkeypatch.setattr("platform.system", lambda: "Darwin")
    monkeypatch.setattr(provenance, "_said", lambda *command: "Apple M9" if "sysctl" in command[0] else None)
    assert provenance.processor() == "Apple M9"


def test_a_package_that_is_not_installed_costs_nothing():
    assert provenance.version_of("no-such-package") == "unknown"


def test_the_command_is_one_that_a_shell_understands():
    arguments = ["simulate", "my scene.yaml", "--set", "material.layers[0].interface.alpha=0.1"]
    with provenance.commanded(arguments):
        assert shlex.split(provenance.provenance(1)["command"]) == ["goniosim", *arguments]
    with provenance.commanded(["compare", "caf\udce9.h5"]):
        assert provenance.provenance(1)["command"] == r"goniosim compare 'caf\udce9.h5'"
    with provenance.commanded(["x" * 100_000]):
        assert len(provenance.provenance(1)["command"]) < 3000
    assert "command" not in provenance.provenance(1)


GIT = shutil.which("git")


@pytest.fixture
def repository(tmp_path, monkeypatch):
    """A checkout with one commit, from which goniosim seems to run."""

    def git(*arguments):
        settings = ["-c", "user.name=a", "-c", "user.email=a@b.c", "-c", "commit.gpgsign=false"]
        return subprocess.run(
            [GIT, "-C", str(tmp_path), *settings, *arguments], check=True, capture_output=True, text=True
        ).stdout.strip()

    (tmp_path / "pyproject.toml").write_text('[project]\nname = "goniosim"\n')
    git("init", "-q")
    git("add", ".")
    git("commit", "-q", "-m", "first")
    monkeypatch.setattr(provenance, "_ROOT", tmp_path)
    return git


@pytest.mark.skipif(GIT is None, reason="needs git")
def test_a_checkout_is_named_by_its_commit_and_whether_it_was_changed(repository, tmp_path, monkeypatch):
    # As in a hook of another repository.
    monkeypatch.setenv("GIT_DIR", os.fspath(tmp_path / "elsewhere"))
    monkeypatch.delenv("GIT_DIR")
    commit = repository("rev-parse", "HEAD")
    monkeypatch.setenv("GIT_DIR", os.fspath(tmp_path / "elsewhere"))
    assert provenance.provenance(1)["git_revision"] == commit
    (tmp_path / "pyproject.toml").write_text('[project]\nname = "goniosim"\n# changed\n')
    provenance.git_revision.cache_clear()
    assert provenance.git_revision() == f"{commit}-dirty"


@pytest.mark.skipif(GIT is None, reason="needs git")
def test_a_repository_that_is_not_ours_is_not_asked(repository, tmp_path, monkeypatch):
    """Goniosim installed into a virtual environment, or copied, inside somebody's repository."""
    monkeypatch.setattr(provenance, "_said", lambda *command: pytest.fail("git was asked"))
    (tmp_path / "site-packages").mkdir()
    monkeypatch.setattr(provenance, "_ROOT", tmp_path / "site-packages")
    assert provenance.git_revision() is None
    monkeypatch.setattr(provenance, "_ROOT", tmp_path)
    for text in ('[project]\nname = "mine"\n', b"\xff\xfe"):
        (tmp_path / "pyproject.toml").write_bytes(text if isinstance(text, bytes) else text.encode())
        provenance.git_revision.cache_clear()
        assert provenance.git_revision() is None


@pytest.mark.parametrize("error", [FileNotFoundError(2, "no git"), subprocess.TimeoutExpired("git", 2.0)])
def test_without_git_there_is_no_revision_and_no_error(tmp_path, monkeypatch, error):
    def fail(*arguments, **options):
        raise error

    (tmp_path / ".git").mkdir()
    (tmp_path / "pyproject.toml").write_text('[project]\nname = "goniosim"\n')
    monkeypatch.setattr(provenance, "_ROOT", tmp_path)
    monkeypatch.setattr("subprocess.run", fail)
    assert "git_revision" not in provenance.provenance(1)
