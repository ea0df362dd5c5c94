"""Every model that applies to a stack, with any options: finite, not negative, reciprocal where that is promised."""

import numpy as np
from hypothesis import assume
from hypothesis import strategies as st

from goniosim.integration import Grid, Pool, integrate_fixed
from goniosim.models import COMPONENTS, MODELS, describe_options, evaluate_model, prepare
from goniosim.scene import parse_scene
from goniosim.slices import slice_geometry
from laws.alike import in_order, in_parts, in_triples, places, with_nothing
from laws.law import law
from laws.strategies import GRIDS, alphas, many_faced, often, parts, spread, stacks, unequal

RECIPROCAL = ("ww09", "elek10", "bati19_ww", "belcour18_symmetric")
# Their lobes keep to the energy that arrives; the others lack the factor of solid angles, as published.
CONSERVING = ("bati19_ww", "belcour18_forward", "belcour18_symmetric", "bati19_belcour")
PER_CHANNEL = ("ww09", "elek10", "bati19_ww")

light_angles = often([0.0, 1e-9, 45.0, 89.0, 89.999], st.floats(0.0, 89.999))
views = st.lists(
    st.tuples(
        often([0.0, 1e-9, 89.999, 90.0 - 1e-9, 90.0], st.floats(0.0, 90.0)),
        often([0.0, 90.0, 180.0, 180.0 + 1e-9], st.floats(0.0, 360.0)),
    ),
    min_size=1,
    max_size=8,
)
orders = st.sampled_from([[0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]])


def scene_of(layers):
    """A scene of which only the material counts."""
    return parse_scene({"material": {"name": "x", "layers": layers}, "incident": {"theta_deg": [0.0]}})


@st.composite
def cases(draw, layers=None, models=tuple(MODELS)):
    """Layers, a model that applies to them, a component and options."""
    layers = draw(stacks() if layers is None else layers)
    scene = scene_of(layers)
    able = [(name, part) for name in models for part in COMPONENTS if MODELS[name].supports(scene, part) is None]
    assume(able)
    name, component = draw(st.sampled_from(able))
    options = {info.name: draw(st.sampled_from(info.values)) for info in describe_options(name)}
    return layers, name, component, options


@law(fast=20, slow=400, case=cases(), theta=light_angles, views=views, grid=st.sampled_from(GRIDS), half=st.booleans())
def test_values_and_energies_are_finite_and_not_negative(case, theta, views, grid, half):
    """Up to the horizon; what leaves in exactly one direction is no more than what arrives, where that is promised."""
    layers, name, component, options = case
    scene = scene_of(layers)
    theta_o, phi_o = np.transpose([*views, (theta, 180.0)])
    values = evaluate_model(name, scene, theta, theta_o, phi_o, component, options)
    assert np.isfinite(values).all() and (values >= 0.0).all()
    prepared = prepare(name, scene, theta, component, options)
    assert np.isfinite(prepared.mirror_energy).all() and (prepared.mirror_energy >= 0.0).all()
    assert (prepared.mirror_energy <= 1.0 + 1e-12).all() or name not in CONSERVING
    assert 0.0 < prepared.narrowest <= 1.0
    parametrization = "half" if half else "classic"
    geometry = slice_geometry(parametrization, *grid, theta)
    cells = Grid(parametrization, *grid, theta, geometry.valid, geometry.projected_solid_angle)
    with Pool(1) as pool:
        energy, _ = integrate_fixed(prepared, cells, 5, pool)
    assert np.isfinite(energy).all() and (energy >= 0.0).all()


@law(
    fast=12,
    slow=300,
    case=cases(stacks(alphas=often([0.0, 1e-3, 1.0], spread(1e-3, 1.0))), RECIPROCAL),
    theta=light_angles,
    views=views,
)
def test_light_and_view_may_change_places(case, theta, views):
    """To 1e-9 of the value, where a half vector is known well enough: no lobe is narrower than 1e-3."""
    layers, name, component, options = case
    for theta_o, phi_o in views:
        theta_o = min(theta_o, 89.9999)
        there, back = (
            evaluate_model(name, scene_of(layers), *pair, phi_o, component, options)
            for pair in ((theta, theta_o), (theta_o, theta))
        )
        np.testing.assert_allclose(there, back, rtol=1e-9, atol=1e-300)


@law(
    fast=16,
    slow=200,
    case=cases(many_faced()),
    theta=light_angles,
    views=views,
    parts=parts,
    alpha=alphas,
    data=st.data(),
)
def test_the_same_stack_written_otherwise(case, theta, views, parts, alpha, data):
    """A number for three equal ones, a medium in parts and an interface that is none: bit for bit."""
    layers, *rest = case
    at = data.draw(st.sampled_from(places(layers)))
    whole, pieces = in_parts(layers, at, parts)
    values = evaluated(layers, rest, theta, views)
    np.testing.assert_array_equal(evaluated(in_triples(layers), rest, theta, views), values)
    np.testing.assert_array_equal(evaluated(with_nothing(layers, at, 9e-13, alpha), rest, theta, views), values)
    np.testing.assert_array_equal(evaluated(pieces, rest, theta, views), evaluated(whole, rest, theta, views))


@law(fast=8, slow=200, case=cases(stacks(fewest=2, colours=unequal)), theta=light_angles, views=views, order=orders)
def test_permuted_channels_give_permuted_values(case, theta, views, order):
    """Bit for bit in each channel of its own; to rounding where widths are means over the channels."""
    layers, name, *rest = case
    found = evaluated(in_order(layers, order), [name, *rest], theta, views)
    expected = evaluated(layers, [name, *rest], theta, views)[order]
    if name in PER_CHANNEL:
        np.testing.assert_array_equal(found, expected)
    else:
        np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-300)


def evaluated(layers, case, theta, views):
    """Values and energies of Dirac lobes, shape (3, views + 1)."""
    name, component, options = case
    theta_o, phi_o = np.transpose(views)
    scene = scene_of(layers)
    prepared = prepare(name, scene, theta, component, options)
    values = evaluate_model(name, scene, theta, theta_o, phi_o, component, options)
    return np.column_stack([values, prepared.mirror_energy[prepared.position]])
