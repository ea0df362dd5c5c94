"""The typed scene: what it offers, writing it as YAML, its fingerprint."""

import subprocess
import sys

import pydantic
import pytest

from goniosim.scene import Scene
from patina import WHITE, dielectric, layered, medium, patina


def test_defaults_are_those_of_the_format():
    scene = patina()
    assert scene.slice.model_dump() == {"parametrization": "classic", "rows": 90, "columns": 360}
    assert scene.simulation.model_dump() == {
        "rays": 10_000_000,
        "target": None,
        "max_rays": None,
        "max_time": None,
        "seed": 1,
        "estimator": "auto",
        "orders": None,
        "threads": None,
    }
    assert layered({"interface": {"type": "dielectric", "eta": 1.5}}).material.interfaces[0].alpha == 0.0


def test_interfaces_come_top_to_bottom_with_rgb():
    top, base = patina().material.interfaces
    assert (top.type, top.eta, top.alpha) == ("dielectric", 1.5, 0.2)
    assert base.eta_rgb == (1.45, 1.45, 1.45)
    assert base.kappa_rgb == (1.0, 0.01, 0.01)
    assert layered(WHITE).material.interfaces[0].rho_rgb == (1.0, 1.0, 1.0)


def test_tau_adds_up_media_in_a_row_and_is_zero_where_interfaces_touch():
    scene = layered(dielectric(), medium(0.5), medium([0.25, 0, 1]), dielectric(1.2), dielectric(), WHITE)
    assert scene.material.tau == ((0.75, 0.5, 1.5), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    assert layered(WHITE).material.tau == ()


@pytest.mark.parametrize(
    "last, transmits",
    [
        (dielectric(1.0), True),
        (WHITE, False),
        ({"interface": {"type": "conductor", "eta": 1, "kappa": 1}}, False),
    ],
)
def test_transmits_through_a_dielectric_only(last, transmits):
    assert layered(dielectric(), last).material.transmits is transmits


def test_whole_numbers_may_be_written_with_an_exponent_and_become_int():
    scene = patina(simulation={"rays": 1e7, "seed": 2**63 - 1, "threads": 2.0, "orders": 3})
    assert [type(number) for number in (scene.simulation.rays, scene.simulation.threads)] == [int, int]
    assert scene.simulation.rays == 10_000_000
    assert scene.simulation.seed == 2**63 - 1


def test_numpy_scalars_are_numbers_too():
    numpy = pytest.importorskip("numpy")
    scene = patina(simulation={"rays": numpy.int64(1000)}, incident={"theta_deg": [numpy.float32(30)]})
    assert (type(scene.simulation.rays), type(scene.incident.theta_deg[0])) == (int, float)


@pytest.mark.parametrize(
    "place, key, value",
    [
        ("incident", "theta_deg", [0.0, 89.999999]),
        ("simulation", "rays", 100),
        ("simulation", "rays", 10**15),
        ("simulation", "seed", 0),
        ("simulation", "orders", 16),
        ("slice", "rows", 1),
        ("slice", "columns", 40_000),
    ],
)
def test_the_ends_of_the_ranges_are_allowed(place, key, value):
    scene = patina(**{place: {key: value}})
    found = getattr(getattr(scene, place), key)
    assert list(found) == value if isinstance(value, list) else found == value


def test_the_ends_of_the_ranges_of_layers_are_allowed():
    scene = layered(
        dielectric(0.1, 1e-6),
        medium(1e9),
        dielectric(10, 1),
        medium(0),
        {"interface": {"type": "conductor", "eta": 0.001, "kappa": 0, "alpha": 0}},
    )
    assert [face.alpha for face in scene.material.interfaces] == [1e-6, 1.0, 0.0]


def test_a_scene_cannot_be_changed():
    with pytest.raises(pydantic.ValidationError, match="frozen"):
        patina().simulation.rays = 5


def test_models_made_directly_are_checked_too():
    with pytest.raises(pydantic.ValidationError, match="must be the last layer"):
        Scene.model_validate(
            {
                "material": {"name": "upside-down", "layers": [WHITE, dielectric()]},
                "incident": {"theta_deg": [0]},
            }
        )


def test_reading_scenes_needs_nothing_heavy():
    code = (
        "import sys, goniosim.scene; "
        "print([name for name in ('numpy', 'numba', 'h5py', 'matplotlib') if name in sys.modules])"
    )
    answer = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert answer.stdout.strip() == "[]"
