"""`goniosim simulate` and `goniosim check` on small scenes."""

import re

import pytest

from goniosim.store import open_result


def test_the_result_is_named_after_the_material_and_summed_up(goniosim, folder):
    code, out, _ = goniosim("simulate", "scene.yaml")
    assert code == 0
    result = open_result(folder / "small.h5")
    assert result.status == "complete"
    assert result.rays.tolist() == [10_000]
    for words in ("small  (complete)", "Albedo", "Energy audit", "sampled against integrated", "small.h5  ("):
        assert words in out
    # Green and blue agree in this scene, so they share a line.
    assert re.search(r"^ +GB ", out, re.MULTILINE)


def test_options_and_set_change_the_scene_that_is_stored(goniosim, folder):
    code, _, _ = goniosim(
        "simulate",
        "scene.yaml",
        *("--rays", "2e3", "--seed", "7", "--threads", "1", "-o", "new/folder/a.h5"),
        *("--set", "material.layers[0].interface.alpha=0.3", "--set", "incident.theta_deg=[0, 60]"),
    )
    assert code == 0
    result = open_result(folder / "new" / "folder" / "a.h5")
    assert result.rays.tolist() == [2000, 2000]
    assert result.theta_deg.tolist() == [0.0, 60.0]
    assert result.seed == 7
    assert "alpha: 0.3" in result.config_yaml
    assert result.provenance["threads"] == "1"


def test_a_wrong_override_is_3(goniosim, folder):
    code, _, err = goniosim("simulate", "scene.yaml", "--set", "material.layer=3")
    assert code == 3
    assert "--set material.layer=3" in err
    assert not list(folder.glob("*.h5"))


TRAP = """\
study:
  name: traps
  cross:
    below: [10.0, 1.5]
  material:
    name: index-${below}
    layers:
      - interface: {type: dielectric, eta: 0.1}
      - interface: {type: dielectric, eta: "${below}"}
      - interface: {type: lambert, rho: 1.0}
incident: {theta_deg: [0]}
slice: {rows: 3, columns: 4}
simulation: {rays: 1e3}
"""


def test_light_lost_at_the_event_cap_is_said_where_it_is_lost(goniosim, folder):
    """Index 10 below 0.1 lets hardly a ray out again; index 1.5 does."""
    (folder / "trap.yaml").write_text(TRAP)
    code, _, err = goniosim("simulate", "trap.yaml")
    (line,) = [line for line in err.splitlines() if "event cap" in line]
    assert code == 0 and "index-10.0" in line
    assert goniosim("simulate", "trap.yaml", "-q", "--overwrite") == (0, "", "")
    said = [
        line
        for name in ("10.0", "1.5")
        for line in goniosim("info", f"traps/index-{name}.h5")[1].splitlines()
        if "event cap:" in line
    ]
    assert len(said) == 1 and "too dark" in said[0]
    code, out, _ = goniosim("check", "trap.yaml")
    (line,) = [line for line in out.splitlines() if "event cap" in line]
    assert code == 0 and "index-10.0" in line and "rays of the probe" in line


def test_a_result_is_no_stream(goniosim, folder):
    code, _, err = goniosim("simulate", "scene.yaml", "-o", "-")
    assert code == 2 and "a result is a file" in err and not (folder / "-").exists()


def test_quiet_prints_nothing(goniosim, folder):
    assert goniosim("simulate", "scene.yaml", "-q", "--rays", "1e3") == (0, "", "")


def test_verbose_tells_effects_and_compilation(goniosim, folder):
    code, _, err = goniosim("simulate", "scene.yaml", "-v", "--rays", "1e3")
    assert code == 0
    assert "rough_interfaces" in err
    assert "kernels ready after" in err


def test_a_study_fills_a_folder_of_its_name_and_resumes(goniosim, folder):
    code, out, _ = goniosim("simulate", "study.yaml", "--rays", "1e3")
    assert code == 0
    names = ["coat-0.1.h5", "coat-0.2.h5", "coat-0.3.h5"]
    assert sorted(path.name for path in (folder / "three-coats").iterdir()) == names
    assert [line.split()[:2] for line in out.splitlines() if "coat" in line] == [
        [name.removesuffix(".h5"), "complete"] for name in names
    ]

    written = {name: (folder / "three-coats" / name).stat().st_mtime_ns for name in names}
    (folder / "three-coats" / names[1]).unlink()
    damaged = folder / "three-coats" / names[2]
    damaged.write_bytes(damaged.read_bytes()[:-100])
    code, out, err = goniosim("simulate", "study.yaml", "--rays", "1e3")
    assert code == 0
    assert "1 of 3 materials are finished: skipped" in err
    assert "coat-0.1" not in out
    assert (folder / "three-coats" / names[0]).stat().st_mtime_ns == written[names[0]]
    assert open_result(damaged).status == "complete"


def test_a_finished_study_says_so_and_traces_nothing(goniosim, folder, monkeypatch):
    goniosim("simulate", "study.yaml", "-q", "--rays", "1e3")
    monkeypatch.setattr("goniosim.engine.simulate", lambda *_, **__: pytest.fail("traced again"))
    code, out, err = goniosim("simulate", "study.yaml", "--rays", "1e3")
    assert (code, out) == (0, "")
    assert "3 of 3 materials are finished: skipped" in err


def test_check_tells_effects_speed_and_size(goniosim, folder):
    code, out, err = goniosim("check", "scene.yaml", "--set", "simulation.rays=1e9")
    assert (code, err) == (0, "")
    called, absent = out.split("Absent, and so without cost")
    assert "absorption" in called
    assert "lambertian" in absent
    assert re.search(r"speed +[\d.]+ [kMG] rays/s, [\d.]+ events per ray", out)
    assert re.search(r"time +\d.* for 1 x 1e9 rays", out)
    assert re.search(r"file size +at most [\d.]+ kB", out)
    assert not list(folder.glob("*.h5"))


def test_check_of_a_study_is_a_table(goniosim, folder):
    code, out, _ = goniosim("check", "study.yaml")
    assert code == 0
    assert out.startswith("3 materials, all valid")
    assert [line.split()[:2] for line in out.splitlines() if line.startswith("  coat")] == [
        ["coat-0.1", "1e4"],
        ["coat-0.2", "1e4"],
        ["coat-0.3", "1e4"],
    ]
    assert "Together: " in out


def test_the_predicted_size_bounds_the_real_one(goniosim, folder):
    goniosim("simulate", "scene.yaml", "-q", "--set", "simulation.orders=3", "--rays", "1e5")
    from goniosim.report.simulation.forecast import file_size
    from goniosim.scene import load_scene

    real = (folder / "small.h5").stat().st_size
    predicted = file_size(load_scene(folder / "scene.yaml", ["simulation.orders=3"]))
    assert real <= predicted <= 3 * real
