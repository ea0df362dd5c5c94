"""Other ways to reduce slices to one error: all 60 materials, all models; for findings 1, 3 to 6 and 9."""

import numpy as np

from ..errors import Errors, errors_path, read_rows
from ..rmse import debiased, mean_of
from ..slices import Slices
from ..verdicts import Value
from .table import cell

NAME = "conventions"
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])[:, None, None]
TABLE = "as in this study"


def run(results):
    """Yield rows for every convention, material and model."""
    errors = Errors(read_rows(errors_path(results)))
    for material in errors.materials:
        models = errors.models(material)
        for model in models:
            for setting, found in _from_table(errors, material, model):
                yield cell(setting, material.name, model, "rmse", found)
        slices = Slices(results, material)
        for model in models:
            for setting, found in _from_slices(slices, model):
                yield cell(setting, material.name, model, "rmse", found)


def _from_table(errors, material, model):
    """Conventions for which errors.csv is enough."""
    row = errors.row(material, model)
    stderr = float(row["rmse_stderr"])
    yield TABLE, errors.rmse(material, model)
    yield "5 × 5 sub-cells, never converged", Value(float(row["rmse"]), stderr)
    yield "Eq. 4 with the noise left in", Value(float(row["rmse_eq4"]), stderr)
    if row["rmse_relative"]:
        norm = float(row["reference_norm"])
        yield "relative to the norm of the simulation", Value(float(row["rmse_converged"]) / norm, stderr / norm)
    mine = [r for r in errors.rows if r["material"] == material.name and r["component"] == material.component]
    thetas = list(dict.fromkeys(r["theta_deg"] for r in mine if r["theta_deg"] != "all"))
    channels = list(dict.fromkeys(r["channel"] for r in mine if r["channel"] != "mean"))
    by_place = {
        (theta, channel): errors.rmse(material, model, channel=channel, theta=theta)
        for theta in thetas
        for channel in channels
    }
    yield "without 85°", _joint(by_place, thetas, channels, below=80.0)
    yield "without 75° and 85°", _joint(by_place, thetas, channels, below=70.0)
    alone = [mean_of([by_place[theta, channel] for channel in channels]) for theta in thetas]
    mean = float(np.mean([v.value for v in alone]))
    yield (
        "mean of the errors of the directions",
        Value(mean, float(np.hypot.reduce([v.stderr for v in alone])) / len(alone)),
    )
    roots = [errors.rmse(material, model, channel=channel) for channel in channels]
    square = float(np.sqrt(np.mean([v.value**2 for v in roots])))
    bound = sum(v.value * v.stderr for v in roots) / len(roots) / max(square, 1e-300)
    yield "root of the mean square of the channels", Value(square, bound)


def _joint(by_place, thetas, channels, below):
    """Eq. 4 over some of the directions, mean over the channels."""
    chosen = [theta for theta in thetas if float(theta) < below]
    roots = []
    for channel in channels:
        found = [by_place[theta, channel] for theta in chosen]
        root = float(np.sqrt(np.mean([v.value**2 for v in found])))
        stderr = float(np.hypot.reduce([v.value * v.stderr for v in found])) / len(found)
        roots.append(Value(root, stderr / root if root > 0.0 else 0.0))
    return mean_of(roots)


def _from_slices(slices, model):
    """Conventions that need the slices; the models with 5 x 5 sub-cells."""
    cells, component = slices.result.cells, slices.material.component
    projected = np.where(cells.valid, cells.projected_solid_angle, 0.0)
    scale = np.where(projected > 0.0, 1.0 / np.maximum(projected, 1e-300), 0.0)[:, None]
    truth, found = slices.reference(component), slices.model(model, component)
    difference, sigma = (found.energy - truth.energy) * scale, truth.stderr * scale
    mixed = [(LUMINANCE * each).sum(axis=1, keepdims=True) for each in (difference, sigma)]
    yield "luminance instead of the mean of the channels", debiased(*mixed, projected)[0]
    solid = np.where(cells.valid, cells.solid_angle, 0.0)
    yield "without the cosine of Eq. 4", mean_of(debiased(difference, sigma, solid))
    if cells.parametrization == "half":
        # Both slices get the mean of the three neighbours in the next row, so the difference does too.
        difference, sigma = difference.copy(), sigma.copy()
        difference[..., 0, :] = _neighbours(difference[..., 1, :])
        sigma[..., 0, :] = np.sqrt(_neighbours(sigma[..., 1, :] ** 2) / 3.0)
    yield "first row of half slices replaced by its neighbours", mean_of(debiased(difference, sigma, projected))


def _neighbours(row):
    return (np.roll(row, 1, axis=-1) + row + np.roll(row, -1, axis=-1)) / 3.0
