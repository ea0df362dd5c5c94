"""Finding 9: Belcour's transmission through slabs."""

import numpy as np

from ..curves import plane_figure
from ..lobes import peak, width
from ..markdown import number, table
from ..materials import SLABS, one, select
from ..rmse import debiased
from ..study import Finding, name_of
from ..verdicts import ALIKE, Claim, Value, less, within
from .grazing import LIGHTS

TITLE = "Belcour's error on slabs: grows with decreasing α₀ and α₁; smaller in blue; the lobe too wide and misplaced"
PAPER = (
    "On slabs the RMSE of the transmission markedly increases with decreasing α₀ and/or α₁. With a yellow τ the error "
    "in the blue channel is smaller than that in luminance. Around normal incidence the transmitted lobe is right; "
    "towards grazing angles it is wider than the simulated one and points elsewhere (Section 4.2, Figs. 4c and 9)."
)
MODEL = "belcour18_forward"
SNELL = f"{MODEL}[jacobian=snell]"
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
# A lobe is misplaced if its peak is off by more than this, in degrees: half the window that finds it.
MISPLACED = 5.0
# The material of Fig. 9.
SHOWN = ("S1", 0.001, 0.2)
PICTURE = "paper-slab.png"


def claims(table, materials, model=MODEL):
    """Claims on the growth of errors; a table of errors is a dict of (material name, model) to `Value`."""
    slabs = select(materials, category=SLABS)

    def grows(pairs):
        return {
            f"{name_of(smooth)} and {name_of(rough)}": less(table[rough.name, model], table[smooth.name, model])
            for smooth, rough in pairs
        }

    return [
        Claim("grows with decreasing α₀", grows(_neighbours(slabs, "alpha0"))),
        Claim("grows with decreasing α₁", grows(_neighbours(slabs, "alpha1"))),
    ]


def measure(study):
    """The `Finding`."""
    slabs = select(study.materials, category=SLABS)
    blue, blue_rows = {}, []
    for m in (m for m in slabs if m.is_yellow):
        errors = study.errors.rmse(m, MODEL, channel="B"), _luminance(study.slices(m))
        blue[name_of(m)] = less(*errors)
        blue_rows.append([name_of(m), *map(number, errors)])
    right, wide, elsewhere, rows = {}, {}, {}, []
    for m in select(slabs, alpha1=0.2):
        slices = study.slices(m)
        truth, model, snell = slices.reference(m.component), *(slices.model(x, m.component) for x in (MODEL, SNELL))
        for theta in (0, 30, 60, *LIGHTS) if m == one(slabs, *SHOWN) else (0, *LIGHTS):
            widths = [width(slices, part, theta) for part in (truth, model, snell)]
            peaks = [peak(slices, part, theta) for part in (truth, model)]
            rows.append([name_of(m), f"{theta}°", *map(number, [*widths, *peaks])])
            if theta == 0:
                right[f"{name_of(m)} at 0°"] = within(widths[0], widths[1], ALIKE)
            if theta in LIGHTS:
                what = f"{name_of(m)} at {theta}°"
                wide[what] = less(*widths[:2])
                off = Value(abs(peaks[0].value - peaks[1].value), peaks[0].stderr)
                elsewhere[what] = less(Value(MISPLACED), off)
    plane_figure(
        study.slices(one(slabs, *SHOWN)), LIGHTS[0], {"green": 1, "blue": 2}, (MODEL,), study.pictures / PICTURE
    )
    growth = claims(study.errors.table(), study.materials)
    return Finding(
        [
            *growth,
            Claim("yellow τ: blue < luminance", blue),
            Claim("at 0° the width of the lobe alike", right),
            Claim(f"lobe wider at {LIGHTS[0]}° and {LIGHTS[1]}°", wide),
            Claim(f"its peak off by more than {MISPLACED:g}°", elsewhere),
        ],
        [
            study.rmse_table(slabs, [MODEL, SNELL]),
            "RMSE [sr^-1/2] in blue and of the luminance:",
            table(["material", "blue", "luminance"], blue_rows),
            "Transmitted lobe of the green channel: interquartile range of the sine of the angle in the plane of "
            "incidence, and direction of the peak in degrees.",
            table(["material", "light", "width", MODEL, SNELL, "peak", MODEL], rows),
            f"![In the plane of incidence at {LIGHTS[0]} degrees: the transmitted lobe]({PICTURE})",
        ],
        because=_BECAUSE,
        remarks=[_REMARK],
    )


_BECAUSE = (
    "the published sweep applies an inverted Jacobian to the spread of the light that goes down: what the upper "
    "interface scatters is not widened on leaving, so the lobe of α₀ = α₁ = 0.2 is somewhat too narrow already at "
    "normal incidence, and its error exceeds that of smoother upper interfaces. With the Jacobian of Snell's law "
    "(`jacobian=snell`, second column) the error grows with decreasing α₀ and α₁ throughout"
)
_REMARK = (
    "It also does with `refraction_scale=normal` and the published Jacobian, but then the errors are several times as "
    "large and the lobe at grazing angles is too narrow, not too wide (table at the end). No option that we know of "
    "gives all six claims with the published recursion. The plug-in for slabs that the authors ran could not be read "
    "for our models, and may differ in just this."
)


def _neighbours(slabs, attribute):
    """Pairs (smoother, rougher) that differ in one roughness only, by one step."""
    other = "alpha1" if attribute == "alpha0" else "alpha0"
    label = {m: (m.tau, getattr(m, other)) for m in slabs}
    pairs = []
    for group in dict.fromkeys(label.values()):
        chain = sorted((m for m in slabs if label[m] == group), key=lambda m: getattr(m, attribute))
        pairs += list(zip(chain, chain[1:], strict=False))
    return pairs


def _luminance(slices):
    """RMSE of the luminance; the noise of the channels, which share their paths, adds up."""
    component, cells = slices.material.component, slices.result.cells
    size = np.where(cells.valid, cells.projected_solid_angle, 0.0)
    scale = np.where(size > 0.0, 1.0 / np.maximum(size, 1e-300), 0.0)[:, None]
    truth, model = slices.reference(component), slices.model(MODEL, component)
    difference = (model.energy - truth.energy) * scale
    weights = LUMINANCE[:, None, None]
    mixed = [(weights * each).sum(axis=1, keepdims=True) for each in (difference, truth.stderr * scale)]
    return debiased(*mixed, size)[0]
