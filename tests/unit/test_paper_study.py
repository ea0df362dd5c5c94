"""The study of the paper: rules of its verdicts, names, tables, and the document that is checked in."""

import re
from pathlib import Path

import numpy as np
import pytest

from benchmarks.paper_study import errors, lobes, markdown, materials, readme, verdicts
from benchmarks.paper_study.experiments import conventions
from benchmarks.paper_study.experiments import table as experiments_table
from benchmarks.paper_study.findings import FINDINGS, rho_and_tau, slabs, smooth_base
from benchmarks.paper_study.rmse import debiased
from benchmarks.paper_study.slices import view_directions
from benchmarks.paper_study.study import Finding
from benchmarks.paper_study.verdicts import CANNOT_TELL, NO, NOT_REPRODUCED, OPEN, REPRODUCED, YES, Claim, Value
from goniosim.compare.measures import measure, rmse
from goniosim.scene import load_scenes
from goniosim.slices import PARAMETRIZATIONS, view_direction, view_row
from synthetic import make_result

ROOT = Path(__file__).resolve().parents[2]
DOCUMENT = ROOT / "docs" / "paper_study.md"


def claim(yes, no, still_open):
    answers = [YES] * yes + [NO] * no + [OPEN] * still_open
    return Claim("", dict(enumerate(answers)))


@pytest.mark.parametrize(
    "yes, no, still_open, verdict",
    [
        (12, 0, 0, REPRODUCED),
        (9, 1, 0, REPRODUCED),
        (9, 0, 1, REPRODUCED),
        (8, 1, 1, CANNOT_TELL),
        (8, 0, 2, CANNOT_TELL),
        (8, 2, 0, NOT_REPRODUCED),
        (0, 0, 3, CANNOT_TELL),
        (5, 1, 0, NOT_REPRODUCED),
        (0, 0, 0, CANNOT_TELL),
    ],
)
def test_a_claim_needs_nine_in_ten(yes, no, still_open, verdict):
    assert claim(yes, no, still_open).verdict == verdict


def test_a_finding_is_as_good_as_its_worst_claim():
    good, bad, unknown = claim(3, 0, 0), claim(0, 3, 0), claim(0, 0, 3)
    assert verdicts.overall([good, good]) == REPRODUCED
    assert verdicts.overall([good, unknown]) == CANNOT_TELL
    assert verdicts.overall([unknown, bad, good]) == NOT_REPRODUCED
    assert verdicts.overall([]) == CANNOT_TELL


def test_a_difference_is_held_against_the_sum_of_both_errors():
    a = Value(1.0, 0.1)
    assert verdicts.less(a, Value(1.41, 0.1)) == YES
    assert verdicts.less(a, Value(1.39, 0.1)) == OPEN
    assert verdicts.less(a, Value(0.61, 0.1)) == OPEN
    assert verdicts.less(a, Value(0.59, 0.1)) == NO
    assert verdicts.less(Value(1.0), Value(1.0)) == NO
    assert verdicts.over_twice(Value(2.9, 0.1), Value(1.0, 0.1)) == YES
    assert verdicts.over_twice(Value(2.3, 0.1), Value(1.0, 0.1)) == OPEN


def test_alike_is_a_distance_on_a_logarithmic_scale():
    assert verdicts.within(Value(1.0), Value(1.25), verdicts.ALIKE) == YES
    assert verdicts.within(Value(1.27), Value(1.0), verdicts.ALIKE) == NO
    assert verdicts.within(Value(1.25, 0.1), Value(1.0), verdicts.ALIKE) == OPEN
    assert verdicts.within(Value(0.0, 0.1), Value(1.0), verdicts.CLOSE) == OPEN
    assert verdicts.all_of([YES, OPEN]) == OPEN
    assert verdicts.all_of([YES, OPEN, NO]) == NO


def test_all_names_of_the_configurations_are_understood():
    found = [
        materials.parse(scene.material.name)
        for category in ("plastics", "metals", "slabs")
        for scene in load_scenes(ROOT / "configs" / "paper" / f"{category}.yaml")
    ]
    assert [len(materials.select(found, category=name)) for name in ("plastics", "metals", "slabs")] == [12, 36, 12]
    one = materials.one(found, "M1", 0.2, 0.001)
    assert (one.tau, one.base, one.is_yellow) == ("0.05_0.1_0.8", "1.9", True)
    assert materials.mean_of(one.tau) == pytest.approx(0.95 / 3)
    assert materials.parse("metallic-patina") is None
    assert materials.parse("M1") is None


def row(material, model, rmse_converged, **more):
    """A row of errors.csv as text."""
    base = dict.fromkeys(errors.NEEDED, "")
    base |= {"material": material, "model": model, "component": "reflection/internal", "channel": "mean"}
    return base | {"theta_deg": "all", "rmse_stderr": "0.001", "rmse_converged": str(rmse_converged)} | more


def test_errors_are_found_by_material_and_model():
    name = "M1-alpha0_0.2-alpha1_0.001-tau_0.2-eta1_1.9"
    rows = [
        row(name, "elek10", 0.2),
        row(name, "belcour18_forward", 0.3, options="refraction_scale=paper"),
        row(name, "elek10", 0.1, theta_deg="75"),
        row("something-else", "elek10", 9.0),
    ]
    table = errors.Errors(rows)
    (material,) = table.materials
    assert table.rmse(material, "elek10") == Value(0.2, 0.001)
    assert table.rmse(material, "elek10", theta=75.0) == Value(0.1, 0.001)
    assert table.models(material) == ["elek10", "belcour18_forward[refraction_scale=paper]"]
    with pytest.raises(errors.StudyError, match="has no row M1.*ww09"):
        table.rmse(material, "ww09")


def test_a_missing_table_or_column_is_named(tmp_path):
    with pytest.raises(errors.StudyError, match="make paper"):
        errors.read_rows(tmp_path / "errors.csv")
    (tmp_path / "errors.csv").write_text("material,model\nM1,ww09\n")
    with pytest.raises(errors.StudyError, match="has no options, component"):
        errors.read_rows(tmp_path / "errors.csv")


def named(label, alpha0, alpha1=None, tau="0.2", base=""):
    words = [label, f"alpha0_{alpha0}"] + ([f"alpha1_{alpha1}"] if alpha1 is not None else []) + [f"tau_{tau}"]
    return materials.parse("-".join(words + ([base] if base else [])))


def test_finding_5_needs_each_of_belcours_models():
    metals = [named(f"M{i}", alpha0, 0.001) for i in range(1, 7) for alpha0 in (0.05, 0.2)]
    table = {(m.name, model): Value(1.0, 1e-3) for m in metals for model in smooth_base.MODELS}
    assert verdicts.overall(smooth_base.claims(table, metals)) == REPRODUCED
    table |= {(m.name, "belcour18_forward"): Value(0.1, 1e-3) for m in metals}
    close, alike = smooth_base.claims(table, metals)
    assert (close.verdict, alike.verdict) == (NOT_REPRODUCED, NOT_REPRODUCED)
    assert alike.count(NO) == alike.count(YES) == 6


def test_finding_9_compares_neighbours_of_one_roughness():
    found = [named(label, a0, a1) for label, a1 in (("S2", 0.2), ("S4", 0.001)) for a0 in (0.001, 0.05, 0.2)]
    table = {(m.name, slabs.MODEL): Value(1.0 / (m.alpha0 * m.alpha1)) for m in found}
    by_alpha0, by_alpha1 = slabs.claims(table, found)
    assert (len(by_alpha0.answers), len(by_alpha1.answers)) == (4, 3)
    assert verdicts.overall([by_alpha0, by_alpha1]) == REPRODUCED


def test_finding_3_orders_colours_by_their_mean():
    bodies = {
        "P1": ("0_0_0.9", "rho_0.1"),
        "P2": ("0_0_0.9", "rho_0.3"),
        "P3": ("0.2", "rho_0.1"),
        "P4": ("0.2", "rho_0.3"),
    }
    found = [named(label, 0.05, None, *body) for label, body in bodies.items()]
    size = {"P1": 2.0, "P2": 4.0, "P3": 1.0, "P4": 3.0}
    table = {(m.name, model): Value(size[m.label]) for m in found for model in rho_and_tau.MODELS}
    assert [c.count(YES) for c in rho_and_tau.claims(table, found)] == [4, 4]
    assert "ww09, P3 to P1, α₀ = 0.05" in rho_and_tau.claims(table, found)[1].answers


def test_tables_are_markdown():
    text = markdown.table(["a", "b|c"], [["x", 1], ["y", markdown.number(Value(0.25, 0.01))]])
    assert text == "| a | b\\|c |\n|---|---:|\n| x | 1 |\n| y | 0.250 ± 0.010 |"
    assert markdown.number(Value(1234.0, 56.0)) == "1234 ± 56"
    assert markdown.number(Value(0.123456)) == "0.1235"
    assert markdown.failing(claim(1, 1, 1)) == "1 (no), 2 (open)"
    assert markdown.failing(claim(0, 3, 0), most=2) == "0 (no), 1 (no) and 1 more"


def test_the_reason_is_given_where_it_is_needed():
    good, bad = (Finding([c], [], because="of that") for c in (claim(3, 0, 0), claim(0, 3, 0)))
    assert good.verdict_line() == "Verdict: **reproduced**."
    assert bad.verdict_line() == "Verdict: **not reproduced**, because of that."


def test_the_readme_is_changed_between_its_markers_only():
    text = f"before\n{readme.BEGIN}\nold\n{readme.END}\nafter\n"
    assert readme.replaced(text, "new \\1") == text.replace("old", "new \\1")
    with pytest.raises(errors.StudyError, match="once each"):
        readme.replaced("no markers\n", "new")


def test_experiments_survive_a_round_trip(tmp_path):
    cell = experiments_table.cell("s", "m", "ww09", "rmse", Value(0.1, 0.02))
    experiments_table.write([{"experiment": "e"} | cell], tmp_path / "e.csv")
    (found,) = experiments_table.read(tmp_path / "e.csv", ["e"])["e"]
    assert experiments_table.value_of(found) == Value(0.1, 0.02)
    assert experiments_table.settings_of([found]) == {"s": {("m", "ww09"): Value(0.1, 0.02)}}
    with pytest.raises(errors.StudyError, match="lacks other"):
        experiments_table.read(tmp_path / "e.csv", ["e", "other"])


def test_the_error_is_that_of_compare():
    result = make_result(components=("reflection/internal",))
    truth = result.components["reflection/internal"]
    rng = np.random.default_rng(3)
    model = truth.bsdf * rng.uniform(0.5, 1.5, truth.bsdf.shape)
    size = np.where(result.cells.valid, result.cells.projected_solid_angle, 0.0)
    found = debiased(model - truth.bsdf, truth.bsdf_stderr, size)
    measures = measure(model, truth.bsdf, truth.bsdf_stderr, result.cells)
    for channel, value in enumerate(found):
        expected = rmse(measures, channel=channel)
        assert value.value == pytest.approx(expected.rmse, rel=1e-12)
        assert value.stderr == pytest.approx(expected.stderr, rel=1e-12)


@pytest.mark.parametrize("parametrization", PARAMETRIZATIONS)
def test_centres_of_cells_are_those_of_the_parametrization(parametrization):
    result = make_result(theta_deg=(50.0,), parametrization=parametrization)
    code, theta = PARAMETRIZATIONS[parametrization][0], np.radians(50.0)
    light = np.array([np.sin(theta), 0.0, np.cos(theta)])
    rows, columns = np.radians(result.cells.row_edges), np.radians(result.cells.column_edges)
    found = view_directions(result.cells, 50.0)
    for i in (0, 2, 5):
        for j in (0, 3, 7):
            u, phi = 0.5 * (rows[i] + rows[i + 1]), 0.5 * (columns[j] + columns[j + 1])
            sine, cosine, _ = view_row(code, u)
            x, y, z, _ = view_direction(code, sine, cosine, np.cos(phi), np.sin(phi), *light)
            assert found[:, i, j] == pytest.approx([-x, y, z], abs=1e-12)


def test_the_document_has_eleven_findings_with_one_verdict_each():
    text = DOCUMENT.read_text(encoding="utf-8")
    sections = re.split(r"^## ", text, flags=re.MULTILINE)[1:]
    assert [section.split("\n")[0] for section in sections] == [
        f"{number}. {module.TITLE}" for number, module in enumerate(FINDINGS, 1)
    ]
    for section in sections:
        assert len(re.findall(r"\*\*(?:reproduced|not reproduced|cannot tell)\*\*", section)) == 1
    for picture in re.findall(r"!\[[^]]*\]\(([^)]+)\)", text):
        assert (DOCUMENT.parent / picture).exists()


def test_conventions_reduce_the_table_as_they_say():
    name = "P4-alpha0_0.05-tau_0.2-rho_0.5"
    by_theta = {"0": 0.3, "75": 0.4, "85": 1.2, "all": 0.75}
    rows = [
        row(name, "ww09", value, channel=channel, theta_deg=theta, rmse="1", rmse_eq4="1", rmse_relative="")
        for theta, value in by_theta.items()
        for channel in ("R", "G", "mean")
    ]
    table = errors.Errors(rows)
    found = dict(conventions._from_table(table, table.materials[0], "ww09"))
    assert found[conventions.TABLE] == Value(0.75, 0.001)
    assert found["without 85°"].value == pytest.approx(np.sqrt((0.3**2 + 0.4**2) / 2))
    assert found["without 85°"].stderr == pytest.approx(0.5e-3 / 2 / found["without 85°"].value)
    assert found["without 75° and 85°"].value == pytest.approx(0.3)
    assert found["mean of the errors of the directions"].value == pytest.approx(1.9 / 3)
    assert found["root of the mean square of the channels"].value == pytest.approx(0.75)
    assert "relative to the norm of the simulation" not in found


def test_the_interquartile_range_ignores_the_tails():
    x = np.linspace(-1.0, 1.0, 2001)[::-1]
    assert lobes.interquartile_range(x, np.ones_like(x)) == pytest.approx(1.0, abs=2e-3)
    assert lobes.interquartile_range(x, np.abs(x) < 0.1) == pytest.approx(0.1, abs=2e-3)
