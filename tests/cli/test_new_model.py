"""A model is one file and one line: once registered it is listed, evaluated, compared and drawn.

Here the file is this one, and the line is an entry of `MODELS` for the time of a test.
"""

import csv
import math
from dataclasses import dataclass

import numpy as np
import pytest

from goniosim.models import MODELS, Model, Prepared, evaluate_model
from goniosim.models.options import option
from goniosim.models.stack import light_direction, make_stack
from goniosim.scene import distinct_channels, load_scene

PLASTIC = """\
material:
  name: plastic
  layers:
    - interface: {type: dielectric, eta: 1.5, alpha: 0.2}
    - interface: {type: lambert, rho: [0.6, 0.3, 0.1]}
incident: {theta_deg: [30]}
slice: {rows: 6, columns: 12}
simulation: {rays: 1e4, seed: 1}
"""


@dataclass(frozen=True)
class Options:
    """Options of the models below."""

    gain: int = option((1, 2), "factor")


def _evaluate(tables, light, x, y, z, out):
    (rho,) = tables
    out[:] = rho[:, None] / math.pi


def _only_plastics(scene, component):
    if component == "transmission" or scene.material.interfaces[-1].type != "lambert":
        return "applies to the reflection of Lambertian bases only"
    return None


def _only_slabs(scene, component):
    if not scene.material.transmits or component not in ("reflection", "transmission"):
        return "applies to slabs only"
    return None


def _prepare(scene, theta_i_deg, component, options):
    distinct, position = distinct_channels(scene)
    rho = options.gain * make_stack(scene.material).spectral[-1, 0, distinct]
    if component == "reflection/direct":
        rho = 0.0 * rho
    return Prepared(_evaluate, (rho,), light_direction(theta_i_deg), np.zeros(len(distinct)), position, 1.0)


@pytest.fixture
def registered(monkeypatch):
    for name, supports in (("flat25", _only_plastics), ("pane25", _only_slabs)):
        model = Model(name, f"Nobody, The model {name}, 2025", "some materials", Options, supports, _prepare)
        monkeypatch.setitem(MODELS, name, model)


def test_a_new_model_is_listed_with_its_speed_on_a_material_that_it_applies_to(registered, goniosim):
    code, out, err = goniosim("models")
    assert code == 0, err
    for name, example in (("flat25", "a rough plastic"), ("pane25", "a rough slab"), ("ww09", "a rough metal")):
        block = out[out.index(f"\n{name}\n" if name != "ww09" else "ww09\n") :].split("\n\n")[0]
        assert f"one thread, {example})" in " ".join(block.split())


def test_a_new_model_is_evaluated(registered, folder):
    (folder / "plastic.yaml").write_text(PLASTIC)
    values = evaluate_model("flat25", load_scene(folder / "plastic.yaml"), 30, 40, 170, options={"gain": 2})
    assert values == pytest.approx(np.array([1.2, 0.6, 0.2]) / math.pi)


def test_a_new_model_is_compared_and_drawn(registered, folder, goniosim):
    (folder / "plastic.yaml").write_text(PLASTIC)
    assert goniosim("simulate", "plastic.yaml", "-o", "plastic.h5")[0] == 0
    code, out, err = goniosim("compare", "plastic.h5", "-o", "report", "--models", "flat25,pane25")
    assert code == 0, err
    assert "n/a: pane25: applies to slabs only" in out
    with open(folder / "report" / "errors.csv", encoding="utf-8", newline="") as f:
        rows = [row for row in csv.DictReader(f) if row["model"] == "flat25"]
    assert {row["component"] for row in rows} == {"reflection/internal", "reflection"}
    drawn = {path.name for path in (folder / "report" / "figures").iterdir()}
    assert {"errors.png", "cost.png", "plastic-lobes.png", "plastic-views.png"} <= drawn


def test_new_models_do_not_look_alike(registered):
    from goniosim.compare.variants import Variant
    from goniosim.report.comparison import style

    variants = [Variant(name) for name in MODELS]
    assert len({style.of(variant).colour for variant in variants}) == len(variants)
    assert len({style.of(variant).marker for variant in variants}) == len(variants)
    assert style.spread_out(reversed(variants)) == variants
