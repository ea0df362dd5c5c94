"""What is registered in one place is known wherever it is needed, and nothing is forgotten.

A new interface type or parametrization is run through these tests by itself.
"""

import importlib
import math
import typing
from pathlib import Path

import numpy as np
import pytest

import goniosim
from goniosim.engine import stages
from goniosim.models import MODELS
from goniosim.report.drawing import view
from goniosim.result import Cells
from goniosim.scene.layers import INTERFACES, Interface
from goniosim.scene.model import Slice
from goniosim.slices import PARAMETRIZATIONS, cells_of, slice_geometry, view_direction, view_row
from reference.scenes import conductor, make_scene

PACKAGE = Path(goniosim.__file__).resolve().parent
ROWS, COLUMNS, THETA = 24, 36, 40.0
LIGHT = np.array([math.sin(math.radians(THETA)), 0.0, math.cos(math.radians(THETA))])


def _modules(folder, name):
    """Modules below a folder that say ``name = ...`` or ``def name(...)`` at their top level."""
    for path in sorted(folder.rglob("*.py")):
        text = path.read_text(encoding="utf-8")
        if f"\n{name} = " in text or f"\ndef {name}(" in text:
            yield path


def test_every_model_that_is_written_is_registered():
    written = {path.stem for path in _modules(PACKAGE / "models", "MODEL")}
    assert written == set(MODELS)


def test_every_command_that_is_written_is_registered():
    from goniosim_cli.main import main

    folder = PACKAGE.parent / "cli"
    written = {path.stem for path in folder.glob("*.py") if "\n@click.command(" in path.read_text(encoding="utf-8")}
    assert written == set(main.commands)


def test_interface_types_are_known_to_scenes_and_to_the_engine():
    union, _ = typing.get_args(Interface)
    assert set(typing.get_args(union)) == set(INTERFACES.values())
    assert set(stages.LOWER) == set(INTERFACES)
    for name, (_, smooth, rough) in stages.LOWER.items():
        assert {kind in stages.OPAQUE for kind in (smooth, rough)} == {INTERFACES[name].opaque}
    scattering = {path.stem for path in _modules(PACKAGE / "engine" / "stages", "scatter")} - {"__init__"}
    assert len({kind for _, *kinds in stages.LOWER.values() for kind in kinds}) == len(scattering)


@pytest.fixture(params=PARAMETRIZATIONS)
def parametrization(request):
    return request.param


def test_parametrizations_are_known_to_scenes():
    assert set(typing.get_args(Slice.model_fields["parametrization"].annotation)) == set(PARAMETRIZATIONS)


def test_a_parametrization_offers_what_the_choosers_and_the_integration_ask_for(parametrization):
    module = PARAMETRIZATIONS[parametrization][1]
    compiled = ("cells_of", "view_row", "view_direction", "horizon_azimuth", "horizon_coordinate")
    for name in (*compiled, "directions", "coordinates", "tilt", "projected_row", "geometry"):
        assert callable(getattr(module, name)), name
    assert importlib.import_module(f"goniosim.slices.{parametrization}") is module


def _centres(parametrization):
    """View directions of the centres of all cells, and d omega_v / (du dphi)."""
    d_u, d_phi = 0.5 * math.pi / ROWS, 2.0 * math.pi / COLUMNS
    code = PARAMETRIZATIONS[parametrization][0]
    directions = []
    for row in range(ROWS):
        sine, cosine, row_factor = view_row(code, (row + 0.5) * d_u)
        for column in range(COLUMNS):
            phi = (column + 0.5) * d_phi
            x, y, z, factor = view_direction(code, sine, cosine, math.cos(phi), math.sin(phi), *LIGHT)
            directions.append((x, y, z, row_factor * factor))
    return np.array(directions), d_u * d_phi


def test_coordinates_of_a_parametrization_lead_back(parametrization):
    module = PARAMETRIZATIONS[parametrization][1]
    directions, _ = _centres(parametrization)
    found = np.stack(module.coordinates(directions[:, :3], LIGHT), axis=1)
    u = (np.arange(ROWS) + 0.5) * 0.5 * math.pi / ROWS
    phi = (np.arange(COLUMNS) + 0.5) * 2.0 * math.pi / COLUMNS
    lit = directions[:, 3] > 0.0
    same = module.directions(u[:, None], phi, LIGHT).reshape(-1, 3)
    assert np.allclose(same[lit], directions[lit, :3], rtol=0.0, atol=1e-12)
    assert np.allclose(found[lit, 0], np.repeat(u, COLUMNS)[lit], rtol=0.0, atol=1e-9)
    from_the_mirror = np.tile(np.abs(math.pi - phi), ROWS)
    assert np.allclose(np.abs(found[lit, 1]), from_the_mirror[lit], rtol=0.0, atol=1e-9)


def test_rows_of_a_parametrization_hold_their_projected_solid_angle(parametrization):
    module = PARAMETRIZATIONS[parametrization][1]
    directions, _ = _centres(parametrization)
    u = (np.arange(ROWS) + 0.5) * 0.5 * math.pi / ROWS
    phi = (np.arange(COLUMNS) + 0.5) * 2.0 * math.pi / COLUMNS
    a, b, c = (part[:, None] for part in module.projected_row(u, LIGHT))
    density = a * np.cos(phi) ** 2 + b * np.cos(phi) + c
    exact = (directions[:, 2] * directions[:, 3]).reshape(ROWS, COLUMNS)
    above = directions[:, 2].reshape(ROWS, COLUMNS) > 0.0
    assert np.allclose(density[above], exact[above], rtol=0.0, atol=1e-12)


def test_directions_and_cell_numbers_of_a_parametrization_agree(parametrization):
    directions, size = _centres(parametrization)
    x, y, z, jacobian = np.ascontiguousarray(directions.T)
    found = np.empty(len(x), np.int32)
    cells_of(PARAMETRIZATIONS[parametrization][0], -x, -y, z, len(x), ROWS, COLUMNS, LIGHT, found)
    geometry = slice_geometry(parametrization, ROWS, COLUMNS, THETA)
    valid = geometry.valid.ravel()
    assert valid.sum() > 0.4 * valid.size
    assert (found == np.arange(len(x)))[valid].all()
    # The midpoint rule, on cells of 4 degrees.
    projected = geometry.projected_solid_angle.ravel()
    assert np.allclose((jacobian * z * size)[valid], projected[valid], rtol=0.05, atol=1e-4)
    assert np.isclose(projected.sum(), math.pi, rtol=1e-9)


def test_figures_know_a_parametrization(parametrization):
    geometry = slice_geometry(parametrization, ROWS, COLUMNS, THETA)
    cells = Cells(
        parametrization=parametrization,
        row_edges=np.linspace(0.0, 90.0, ROWS + 1),
        column_edges=np.linspace(0.0, 360.0, COLUMNS + 1),
        valid=geometry.valid[None],
        solid_angle=geometry.solid_angle[None],
        projected_solid_angle=geometry.projected_solid_angle[None],
    )
    directions, _ = _centres(parametrization)
    numbers = np.flatnonzero(geometry.valid)
    assert (view.cell_numbers(cells, 0, THETA, directions[numbers, :3]) == numbers).all()
    drawn = np.array([view.centre(cells, THETA, int(number)) for number in numbers])
    assert np.allclose(drawn, directions[numbers, :3], rtol=0.0, atol=1e-12)


def test_simulation_and_comparison_agree_on_the_cells_of_a_parametrization(parametrization):
    """One rough conductor: the direct reflection is integrated by the engine, and is what a model says exactly."""
    scene = make_scene([conductor(1.5, 1.0, 0.5)], [0.0, THETA], parametrization, ROWS, COLUMNS, rays=1000)
    result = goniosim.simulate(scene)
    comparison = goniosim.compare(result, models=["bati19_ww"])
    (material,) = comparison.materials
    model, exact = material.bsdf("bati19_ww", "reflection"), result.components["reflection/direct"].bsdf
    assert exact.max() > 0.05
    assert np.allclose(model, exact, rtol=3e-3, atol=1e-5)
