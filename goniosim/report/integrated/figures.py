"""Figures of a file of integrated models: the models of a material side by side, and one model alone."""

from dataclasses import dataclass

import numpy as np

from ...errors import UnusableResultError
from ...result import Cells, Component
from ...scene.problems import closest
from ...writing import make_folder
from ..comparison import entries
from ..comparison.sheets import overviews, single_directions
from ..drawing import directions
from ..drawing.files import refuse_foreign, write_figure
from ..drawing.names import distinct
from ..simulation.figures import draw as draw_result

# Of so many materials, only overviews are drawn unless some are chosen.
FEW = 3


@dataclass(frozen=True)
class OneModel:
    """The slices of a model, with what figures ask of a `goniosim.result.Result`."""

    name: str
    theta_deg: np.ndarray
    channels: list[str]
    cells: Cells
    components: dict[str, Component]


def draw(models, folder, stem, *, suffix="png", theta_deg=None, materials=None, labels=None):
    """Draw the figures of a file of integrated models and write them, one after the other.

    Parameters
    ----------
    models : goniosim.store.ModelsFile
    folder : Path
        Created if it does not exist.
    stem : str
        Beginning of the file names.
    suffix : str
        ``png``, ``svg`` or ``pdf``.
    theta_deg : sequence of float, optional
        Only the figures of these directions, without overviews.
    materials : sequence of str, optional
        Only these.
    labels : sequence of str, optional
        Models, by name or with their options: each of them alone, as a result is drawn.

    Yields
    ------
    Path
        A file that was written: ``<stem>-<material>-lobes.<suffix>`` and ``-views`` with all models
        and directions; if there are few materials, or some were chosen, ``-lobes-theta_<angle>``.
        With ``labels``: ``<stem>-<material>-<model>`` and ``<stem>-<material>-<model>-theta_<angle>``.

    Raises
    ------
    UnusableResultError
        If a material, a model or an angle is not there.
    OutputError
        If a file cannot be written, or something else stands there than a figure of goniosim.
    """
    chosen = [models.material(name) for name in _chosen("material", materials, models.materials)]
    labels = _chosen("model", labels, [*dict.fromkeys(_names(chosen))])
    for material in chosen:
        directions.chosen(material.theta_deg, theta_deg)
    seen = [
        (material, entry)
        for material in chosen
        for entry in material.models
        if not labels or entry.label in labels or entry.model in labels
    ]
    for material, entry in seen:
        # Before anything is written: reading says what is wrong with them.
        models.slices(material, entry)
    make_folder(folder)
    if labels:
        parts = distinct(f"{material.name}-{entry.label}" for material, entry in seen)
        for (material, entry), part in zip(seen, parts, strict=True):
            one = _alone(models, material, entry)
            yield from draw_result(one, folder, f"{stem}-{part}", suffix=suffix, theta_deg=theta_deg)
        return
    wanted = theta_deg or materials or len(chosen) <= FEW
    for material, part in zip(chosen, distinct(material.name for material in chosen), strict=True):
        yield from _together(models, material, folder / f"{stem}-{part}", suffix, theta_deg, wanted)


def _together(models, material, stem, suffix, theta_deg, with_directions):
    name, component = material.name, material.main_component
    slices = [(entry, models.slices(material, entry, component)) for entry in material.models]
    if not slices:
        return
    numbers = directions.chosen(material.theta_deg, theta_deg)
    seen = [entries.of_models(material, slices, number) for number in numbers]
    figures = [] if theta_deg else overviews(name, component, seen, stem, [suffix])
    if with_directions:
        figures += single_directions(name, component, seen, stem, [suffix])
    refuse_foreign(f"{figure[0]}.{suffix}" for figure in figures)
    for figure in figures:
        yield from write_figure(*figure)


def _alone(models, material, entry):
    return OneModel(
        name=f"{material.name},  {entry.label}",
        theta_deg=material.theta_deg,
        channels=material.channels,
        cells=material.cells,
        components=models.slices(material, entry),
    )


def _names(materials):
    """By what the models of materials may be called: their names, and those with options."""
    for material in materials:
        for entry in material.models:
            yield entry.model
            yield entry.label


def _chosen(kind, wanted, present):
    """What somebody asks for, or everything; an error for what is not there."""
    for name in wanted or ():
        if name not in present:
            guess = closest(name, present)
            hint = f"did you mean {guess}?" if guess else "`goniosim info` lists them"
            raise UnusableResultError(f"there is no {kind} {name} in the file; {hint}")
    return wanted or (present if kind == "material" else ())
