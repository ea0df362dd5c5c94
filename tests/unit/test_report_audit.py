"""The energy audit as people read it: what is shown, what raises an alarm, what is said in words."""

import numpy as np
import pytest
from scipy.stats import norm, t

from goniosim.report.simulation import audit, losses, summary
from synthetic import make_result


@pytest.fixture
def result():
    return make_result(channels=("R", "G", "B"))


def _line(lines, start):
    (found,) = [line for line in lines if line.strip().startswith(start)]
    return found


def test_audit_shows_every_entry_that_has_energy_and_only_those(result):
    for entry in result.audit.energy:
        result.audit.energy[entry][:] = 0.0
    result.audit.energy["reflected_internal"][:] = 1.0
    result.audit.energy["lost_roulette"][:] = 1e-8
    header = " ".join(audit.audit_lines(result)[1:3])
    assert "internal" in header
    assert "lost" not in header
    assert any("Not shown" in line and "lost: roulette" in line for line in audit.audit_lines(result))


def test_an_audit_that_does_not_close_is_seen(result):
    result.audit.energy["absorbed_base"][0, 0] += 0.25
    assert "within 25 %" in _line(audit.audit_lines(result), "Each line sums")


@pytest.mark.parametrize(("lost", "shown"), [(1.0, "100 %"), (0.999, "99.9 %"), (0.25, "25 %")])
def test_what_masking_loses_is_a_percentage_without_an_exponent(result, lost, shown):
    result.audit.energy["lost_masked_reflection"][:] = lost
    result.audit.energy["lost_masked_transmission"][:] = 0.0
    assert f"masking loses up to {shown} here" in " ".join(losses.left_out_lines(result))


@pytest.mark.parametrize(("lost", "said"), [(0.009, False), (0.011, True), (0.2, True)])
def test_a_loss_of_more_than_one_per_cent_is_said_in_words(result, lost, said):
    result.audit.energy["lost_masked_reflection"][:] = 0.0
    result.audit.energy["lost_masked_transmission"][:] = 0.0
    result.audit.energy["lost_masked_reflection"][1, 0] = 0.6 * lost
    result.audit.energy["lost_masked_transmission"][1, 0] = 0.4 * lost
    lines = losses.masking_lines(result)
    assert bool(lines) == said
    if said:
        assert f"{100 * lost:.1f} % of the energy (theta 60, channel R)" in lines[0]


def test_direct_reflection_is_compared_in_standard_errors(result):
    result.audit.energy["reflected_direct"][1, 1] = 0.10
    result.audit.stderr["reflected_direct"][1, 1] = 0.003
    result.audit.direct_integrated[:] = result.audit.energy["reflected_direct"]
    result.audit.direct_integrated[1, 1] = 0.12
    result.audit.direct_integrated_stderr[1, 1] = 0.004
    # 3 / rays, which may go unseen, is the third standard error.
    assert audit.direct_deviation(result)[1, 1] == pytest.approx(-0.02 / np.sqrt(0.003**2 + 0.004**2 + 3e-5**2))
    assert np.count_nonzero(audit.direct_deviation(result)) == 1
    assert "4.0 sigma (theta 60, channel G)" in audit.direct_lines(result)[0]
    assert len(audit.direct_lines(result)) == 1
    result.audit.direct_integrated[1, 1] = 0.13
    assert "Warning" in audit.direct_lines(result)[1]
    # With four parts behind the standard error, six of it are nothing unusual.
    result.status = "partial"
    assert len(audit.direct_lines(result)) == 1


@pytest.mark.parametrize(("status", "parts"), [("complete", 64), ("partial", 4)])
def test_the_alarm_is_as_rare_as_four_sigma(status, parts):
    assert audit.ALARMING_SIGMAS[status] == pytest.approx(t.isf(norm.sf(4.0), parts - 1), rel=2e-3)


def test_a_difference_without_noise_is_not_taken_for_agreement(result):
    result.rays[:] = 10**7
    result.audit.stderr["reflected_direct"][:] = 0.0
    result.audit.direct_integrated_stderr[:] = 0.0
    assert np.all(np.abs(audit.direct_deviation(result)) > audit.ALARMING_SIGMAS["complete"])


def test_rays_that_all_met_the_same_fate_are_no_proof_that_none_meets_another(result):
    """Of 2000 rays none entered, where one in 10 000 does: the sampled reflectance is 1 and has no scatter."""
    result.rays[:] = 2000
    result.audit.energy["reflected_direct"][:] = 1.0
    result.audit.stderr["reflected_direct"][:] = 0.0
    result.audit.direct_integrated[:] = 0.9999
    assert np.abs(audit.direct_deviation(result)).max() < 0.1
    result.audit.direct_integrated[:] = 0.99
    assert np.abs(audit.direct_deviation(result)).min() > audit.ALARMING_SIGMAS["complete"]


def test_the_albedo_of_what_nothing_hit_is_a_limit(result):
    component = result.components["transmission"]
    component.hits[0] = 0
    component.albedo[0] = component.albedo_stderr[0] = 0.0
    rows = audit.albedo_lines(result)[2:]
    assert rows[0].endswith("< 3e-05") and "<" not in rows[-1]


@pytest.mark.parametrize(("lost", "said"), [(0.99e-3, False), (1e-3, True), (0.05, True)])
def test_light_lost_at_the_event_cap_is_said_in_one_line(result, lost, said):
    result.audit.energy["reflected_internal"][1, 2], result.audit.energy["transmitted"][1, 2] = 0.15, 0.3
    result.audit.energy["lost_event_cap"][1, 2] = lost
    lines = [line for line in summary.summary(result).splitlines() if "event cap:" in line]
    assert len(lines) == (1 if said else 0)
    if lost == 0.05:
        assert "5 % of the light (theta 60, channel B)" in lines[0] and "up to 10 % too dark" in lines[0]
        assert "2e7 rays per direction lose a far smaller share" in lines[0]
        result.rays[:] = 10**9
        assert "more rays lose as much" in losses.event_cap(result)
