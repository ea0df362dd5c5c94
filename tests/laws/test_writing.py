"""The same material, written otherwise, is simulated to the same bits."""

from hypothesis import strategies as st

from goniosim.engine import simulate
from goniosim.scene import load_scene, parse_scene
from laws.alike import in_parts, in_triples, places, with_nothing
from laws.law import law
from laws.strategies import alphas, many_faced, parts, scenes, with_layers
from sameness import content


def same(scene, other):
    """Bit for bit."""
    assert content(simulate(parse_scene(scene))) == content(simulate(parse_scene(other)))


def alike(scene, other):
    """Bit for bit, and known to be."""
    assert parse_scene(scene).config_hash() == parse_scene(other).config_hash()
    same(scene, other)


@law(fast=3, slow=120, scene=scenes(), name=st.sampled_from(["y", "other", "-", "1_000"]))
def test_renamed(scene, name):
    alike(scene, {**scene, "material": {**scene["material"], "name": name}})


@law(fast=5, slow=150, scene=scenes())
def test_three_equal_numbers_for_one(scene):
    """And read from the text that results hold it is the same scene."""
    alike(scene, with_layers(scene, in_triples(scene["material"]["layers"])))
    assert load_scene(parse_scene(scene).to_yaml()) == parse_scene(scene)


@law(fast=5, slow=180, scene=scenes(many_faced()), parts=parts, data=st.data())
def test_a_medium_in_parts(scene, parts, data):
    """Media in a row add up, from the top: the first of them and what follows have the bits of their sum."""
    layers = scene["material"]["layers"]
    whole, pieces = in_parts(layers, data.draw(st.sampled_from(places(layers))), parts)
    alike(with_layers(scene, whole), with_layers(scene, pieces))


@law(
    fast=5,
    slow=180,
    scene=scenes(many_faced()),
    shift=st.sampled_from([0.0, 9e-13, -9e-13]),
    alpha=alphas,
    data=st.data(),
)
def test_an_interface_between_equal_indices(scene, shift, alpha, data):
    """It does nothing, wherever it stands within the stack and however rough it is."""
    layers = scene["material"]["layers"]
    at = data.draw(st.sampled_from(places(layers)))
    same(scene, with_layers(scene, with_nothing(layers, at, shift, alpha)))
