"""The folder of a report: over an earlier report, and over nothing else; as a whole, or not at all."""

import json
import os

import pytest
from matplotlib.figure import Figure

from goniosim.errors import OutputError
from goniosim.report.comparison import report
from goniosim.report.comparison.files import FILETYPE
from goniosim.report.comparison.folder import ReportFolder, listed_files
from goniosim.report.drawing.files import write_figure
from goniosim.store import write_result
from synthetic import make_result


def build(folder, figures=("gold-lobes.png",), text="new"):
    """A report that was written but is not in place."""
    place = ReportFolder(folder, ["gold", "zinc"])
    (place.building / "figures").mkdir()
    names = ["errors.csv", "models.h5", *(f"figures/{name}" for name in figures)]
    for name in names:
        (place.building / name).write_bytes(text.encode("latin-1"))
    manifest = {"filetype": FILETYPE, "results": [{"material": "gold"}], "files": [*place.names(), "errors.json"]}
    (place.building / "errors.json").write_text(json.dumps(manifest))
    return place


def content(folder):
    """Text of every file by its name, but for what is in the making."""
    files = [path for path in folder.rglob("*") if path.is_file() and ".part" not in str(path)]
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in files}


def refusal(action):
    with pytest.raises(OutputError) as caught:
        action()
    message = str(caught.value)
    assert "\n" not in message and "another folder" in message
    return message


def test_a_report_appears_at_once(tmp_path):
    place = build(tmp_path / "report")
    assert not (tmp_path / "report").exists()
    (hidden,) = tmp_path.iterdir()
    assert hidden.name.startswith(".report.") and hidden.suffix == ".part"
    place.commit()
    place.discard()
    assert [path.name for path in tmp_path.iterdir()] == ["report"]
    assert sorted(content(tmp_path / "report")) == ["errors.csv", "errors.json", "figures/gold-lobes.png", "models.h5"]


def test_a_report_that_is_given_up_leaves_all_as_it_was(tmp_path):
    build(tmp_path / "report").discard()
    assert list(tmp_path.iterdir()) == []
    build(tmp_path / "report", text="old").commit()
    before = content(tmp_path / "report")
    build(tmp_path / "report").discard()
    assert content(tmp_path / "report") == before


def test_a_report_that_cannot_begin_leaves_nothing(tmp_path, monkeypatch):
    def full(*_):
        raise OutputError("the disk is full")

    monkeypatch.setattr(report, "ModelsWriter", full)
    with pytest.raises(OutputError, match="full"):
        report.Report(tmp_path / "report", ["gold"], {}, 1)
    assert list(tmp_path.iterdir()) == []


def test_a_last_figure_that_comes_while_a_report_is_given_up(tmp_path, monkeypatch):
    """The processes that draw are not waited for."""
    place = build(tmp_path / "report")
    rmdir = os.rmdir

    def late(path, **options):
        if not late.drawn:
            late.drawn = True
            (place.building / "figures" / "late.png").write_text("new")
        rmdir(path, **options)

    late.drawn = False
    monkeypatch.setattr(os, "rmdir", late)
    place.discard()
    assert late.drawn and list(tmp_path.iterdir()) == []


def test_a_rerun_replaces_what_the_earlier_report_lists_and_nothing_else(tmp_path):
    folder = tmp_path / "report"
    build(folder, ("gold-lobes.png", "gold-views.png"), "old").commit()
    (folder / "notes.txt").write_text("mine")
    (folder / "figures" / "holiday.png").write_text("mine")
    build(folder, ("gold-lobes.png", "errors.svg")).commit()
    found = content(folder)
    assert {name for name, text in found.items() if text == b"mine"} == {"notes.txt", "figures/holiday.png"}
    assert {name for name, text in found.items() if text == b"new"} == listed_files(folder) - {"errors.json"}
    assert "figures/gold-views.png" not in found
    assert sorted(path.name for path in folder.iterdir() if path.name.startswith(".")) == []


def test_a_file_of_the_user_that_has_a_name_of_the_report_is_kept(tmp_path):
    """At the start where the name can be foreseen, in the end in any case; before anything is moved."""
    folder = tmp_path / "report"
    build(folder, (), "old").commit()
    late = build(folder, ("zinc-views.png",))
    (folder / "figures" / "zinc-views.png").write_text("mine")
    before = content(folder)
    assert "zinc-views.png: exists and is not overwritten" in refusal(late.commit)
    late.discard()
    assert "zinc-views.png: exists and is not overwritten" in refusal(lambda: ReportFolder(folder, ["zinc"]))
    assert content(folder) == before
    # What goniosim drew there is no loss: perhaps a killed run put it there.
    write_figure(folder / "figures" / "zinc-views", ["png"], Figure)
    build(folder, ("zinc-views.png",)).commit()
    assert content(folder)["figures/zinc-views.png"] == b"new"


@pytest.mark.parametrize("name", ["notes.txt", "errors.csv", "models.h5", "figures/a.png", "errors.json"])
def test_foreign_content_is_refused(tmp_path, name):
    folder = tmp_path / "report"
    (folder / name).parent.mkdir(parents=True)
    (folder / name).write_text('{"filetype": "something else"}')
    assert name.split("/")[0] in refusal(lambda: ReportFolder(folder, ["gold"]))
    assert list(content(tmp_path)) == [f"report/{name}"]


def test_a_file_in_the_place_of_the_folder(tmp_path):
    (tmp_path / "report").write_text("mine")
    assert "is not a folder" in refusal(lambda: ReportFolder(tmp_path / "report", []))
    assert content(tmp_path) == {"report": b"mine"}


def test_content_that_appears_meanwhile_is_kept(tmp_path):
    place = build(tmp_path / "report")
    (tmp_path / "report").mkdir()
    (tmp_path / "report" / "notes.txt").write_text("mine")
    refusal(place.commit)
    place.discard()
    assert content(tmp_path) == {"report/notes.txt": b"mine"}


def test_an_empty_folder_and_one_of_results_will_do(tmp_path):
    (tmp_path / "figures").mkdir()
    (tmp_path / ".DS_Store").write_text("")
    write_result(make_result(), tmp_path / "gold.h5")
    before = (tmp_path / "gold.h5").read_bytes()
    build(tmp_path).commit()
    build(tmp_path).commit()
    assert (tmp_path / "gold.h5").read_bytes() == before and (tmp_path / "models.h5").read_text() == "new"


def test_two_at_once_one_after_the_other(tmp_path):
    """Each is whole; the later one replaces the earlier."""
    first = build(tmp_path / "report", ("gold-lobes.png",), "first")
    second = build(tmp_path / "report", ("gold-views.png",), "second")
    first.commit()
    second.commit()
    found = content(tmp_path / "report")
    assert found.pop("errors.json") and set(found.values()) == {b"second"}
    assert "figures/gold-lobes.png" not in found


def test_a_report_without_a_list_is_known_by_its_tables(tmp_path):
    folder = tmp_path / "report"
    build(folder, ("gold-lobes.png", "gold-lobes-theta_60.svg", "cost.png"), "old").commit()
    manifest = json.loads((folder / "errors.json").read_text())
    del manifest["files"]
    (folder / "errors.json").write_text(json.dumps(manifest))
    (folder / "figures" / "golden-lobes.png").write_text("mine")
    build(folder, ()).commit()
    assert sorted(content(folder)) == ["errors.csv", "errors.json", "figures/golden-lobes.png", "models.h5"]


def test_a_list_cannot_name_files_elsewhere(tmp_path):
    (tmp_path / "precious.png").write_text("mine")
    folder = tmp_path / "report"
    build(folder).commit()
    manifest = json.loads((folder / "errors.json").read_text())
    manifest["files"] += [
        "../precious.png",
        "figures/../../precious.png",
        str(tmp_path / "precious.png"),
        "notes.txt",
        7,
    ]
    for files in (manifest["files"][:-1], manifest["files"]):
        (folder / "errors.json").write_text(json.dumps({**manifest, "files": files}))
        assert not any("precious" in name or "notes" in name for name in listed_files(folder))
    (folder / "errors.json").write_text(json.dumps({**manifest, "files": manifest["files"][:-1]}))
    build(folder).commit()
    assert (tmp_path / "precious.png").read_text() == "mine"


@pytest.mark.parametrize("earlier", [True, False])
def test_a_run_that_is_killed_while_it_puts_its_report_in_place(tmp_path, monkeypatch, earlier):
    """At each move and each removal: every file is whole, and the next run finds nothing in its way."""
    mark = "\x89PNG tEXtSoftware\0goniosim"
    for deadly in range(20):
        folder = tmp_path / str(deadly)
        folder.mkdir()
        if earlier:
            build(folder, ("gold-lobes.png", "gold-views.png"), "old").commit()
            (folder / "notes.txt").write_text("mine")
        before = content(folder)
        place = build(folder, ("gold-lobes.png", "zinc-lobes.png"), mark)
        after = {path: (place.building / path).read_bytes() for path in place.names()}
        killed = commit_until(place, deadly, monkeypatch)
        for name, text in content(folder).items():
            assert text in (before.get(name), after.get(name))
        # The system closes what a dead process had open.
        if killed:
            os.close(place._part.descriptor)
        build(folder, ("gold-lobes.png",)).commit()
        mine = {"notes.txt"} if earlier else set()
        stray = {"figures/zinc-lobes.png"} if killed and earlier else set()
        assert mine <= content(folder).keys() <= listed_files(folder) | mine | stray
        assert not [path for path in folder.iterdir() if path.name.startswith(".")]
        if not killed:
            break
    assert 3 < deadly < 19


def commit_until(place, deadly, monkeypatch):
    """Commit, but die at a certain call that changes the folder; whether that came."""
    calls = []

    def dying(call):
        def made(*arguments, **options):
            calls.append(call)
            if len(calls) > deadly:
                raise KeyboardInterrupt
            return call(*arguments, **options)

        return made

    with monkeypatch.context() as patch:
        for name in ("replace", "unlink"):
            patch.setattr(os, name, dying(getattr(os, name)))
        try:
            place.commit()
        except KeyboardInterrupt:
            return True
    return False
