"""The tables of a summary, and the same as plain data."""

import dataclasses
import json

import numpy as np
import pytest

from goniosim.engine import memory_needed
from goniosim.report.simulation import audit, cost, forecast, losses, study, summary
from goniosim.scene import Simulation
from goniosim.scene.quantity import percent
from reference.scenes import lambert, make_scene
from synthetic import make_result


@pytest.fixture
def result():
    return make_result(channels=("R", "G", "B"))


def _line(lines, start):
    (found,) = [line for line in lines if line.strip().startswith(start)]
    return found


def test_albedo_of_a_sampled_component_has_the_error_of_its_sum(result):
    component = result.components["reflection/internal"]
    component.albedo[1, 2], component.albedo_stderr[1, 2] = 0.12345, 0.0003
    assert "0.1235 ± 0.0003" in audit.albedo_lines(result)[-1]


def test_albedo_of_the_direct_reflection_is_the_integrated_one(result):
    direct = result.components["reflection/direct"]
    direct.albedo[:], direct.albedo_stderr[:] = 0.0625, 0.0
    assert all("0.06250" in line for line in audit.albedo_lines(result)[2:])


def test_channels_that_agree_share_a_row(result):
    for component in result.components.values():
        for array in (component.albedo, component.albedo_stderr):
            array[:, 2] = array[:, 1]
    rows = audit.albedo_lines(result)[2:]
    assert len(rows) == 4
    assert sum("GB" in row for row in rows) == 2


def test_the_forecast_warns_of_the_event_cap():
    one = forecast.Forecast(
        name="trap",
        directions=1,
        simulation=Simulation(rays=1000),
        rays_per_second=1e6,
        events_per_ray=2.0,
        compile_seconds=0.0,
        n_bytes=1000,
        threads=1,
        memory=memory_needed(make_scene([lambert(0.5)], 0.0)),
        shortage=None,
        estimators=[],
        gains={},
        memory_to_plot=0,
        memory_to_compare=0,
        probe_rays=80_000,
        lost_event_cap=0.05,
    )
    (line,) = [line for line in forecast.cost_text([one]).splitlines() if "event cap" in line]
    assert "trap" in line and "8e4 rays of the probe" in line and "5 %" in line
    lossless = dataclasses.replace(one, lost_event_cap=0.9e-3)
    assert "event cap" not in forecast.cost_text([lossless]) and "event cap" in forecast.cost_text([lossless, one])


def test_what_is_left_out_is_said_in_three_lines(result):
    result.audit.energy["lost_masked_reflection"][:] = result.audit.energy["lost_masked_transmission"][:] = 0.0
    result.audit.energy["lost_masked_reflection"][1, 0] = 0.123
    lines = losses.left_out_lines(result)
    assert len(lines) == 3 and "polarisation" in lines[0] and "thin films" in lines[1]
    assert "12 % here (theta 60, channel R)" in lines[2]
    assert "\n".join(lines) in summary.description(result)
    result.audit.energy["lost_masked_reflection"][:] = 0.0
    assert "loses nothing here" in losses.left_out_lines(result)[2]


def test_a_direction_without_rays_is_named_so_and_divides_nothing(result):
    result.rays = np.array([100, 0])
    text = summary.summary(result)
    assert text.count("not traced") == 3 + 5
    assert "between 0 and 100" in text


def test_halving_the_noise_costs_four_times_the_last_checkpoint(result):
    result.cost.seconds[:] = [5.0, 10.0, 22.5]
    assert "4e5 per direction, about 3 min on this machine" in cost.cost_lines(result)[-1]


def test_a_long_list_of_checkpoints_is_thinned_but_keeps_its_end(result):
    n = 1000
    result.cost.rays = result.cost.seconds = result.cost.cpu_seconds = np.tile(np.arange(1.0, n + 1), (2, 1))
    result.cost.error = {"transmission": np.ones((2, n))}
    rows = cost.cost_lines(result)[3:-2]
    assert len(rows) <= cost.MOST_ROWS
    assert rows[-1].split()[0] == "1000"


def test_no_checkpoint_no_table(result):
    empty = np.empty((2, 0))
    result.cost.rays = result.cost.seconds = result.cost.cpu_seconds = empty
    assert cost.cost_lines(result) == []


def test_description_tells_status_effects_and_origin(result):
    text = summary.description(result)
    for words in (
        "synthetic  (complete)",
        "classic slices, 6 x 8 cells",
        "1e5, seed 1, estimator analog",
        "2024-05-01T12:00:00Z",
    ):
        assert words in text
    assert "Effects simulated: absorption, colour" in text
    assert "not called for: orders, transmission" in text
    assert "transmission contains a perfectly sharp (Dirac) part" in text


def test_what_is_uncertain_and_what_nodes_may_hide_are_said_in_a_line(result):
    """Only of components that have it."""
    text = summary.summary(result)
    assert "uncertain" not in text and "nodes" not in text
    few = make_result(channels=("R", "G", "B"), estimator={"transmission": "split"}, rays=200)
    lines = summary.heading_lines(few)
    (uncertain,) = [line for line in lines if line.startswith("  transmission: ") and "uncertain" in line]
    component = few.components["transmission"]
    share = component.energy[component.uncertain].sum() / component.energy.sum()
    assert f"{percent(share)} of its energy" in uncertain
    assert "  transmission: nodes may add an error of up to 1e-06 sr^-1/2, whatever the noise" in lines
    assert lines[3].endswith("estimator mixed")
    data = json.loads(json.dumps(summary.as_data(few), allow_nan=False))
    assert data["estimator"] == "mixed" and data["components"]["transmission"]["estimator"] == ["split", "split"]
    assert data["components"]["transmission"]["uncertain_energy"] == pytest.approx(share)
    assert data["components"]["reflection/direct"]["uncertain_energy"] is None


def test_plain_data_survives_json_and_agrees_with_the_result(result):
    data = json.loads(json.dumps(summary.as_data(result), allow_nan=False))
    assert data["albedo"]["transmission"]["value"] == result.components["transmission"].albedo.tolist()
    assert data["audit"]["absorbed_base"]["stderr"] == result.audit.stderr["absorbed_base"].tolist()
    assert data["cost"]["error"]["transmission"] == result.cost.error["transmission"].tolist()
    assert data["slice"] == {"parametrization": "classic", "rows": 6, "columns": 8}
    assert data["config_hash"] == result.config_hash


def test_a_study_has_one_line_for_each_material(result, tmp_path):
    path = tmp_path / "a.h5"
    path.write_bytes(bytes(1234))
    result.audit.energy["lost_masked_reflection"][:] = 0.125
    result.audit.energy["lost_masked_transmission"][:] = 0.0
    row = study.row(result, path)
    assert row[:3] == ["synthetic", "complete", "1e5"], "rays per direction, as everywhere"
    assert "12.5 %" in row
    assert row[-1] == "1.23 kB"
    assert study.study_text([row, row]).count("synthetic") == 2
