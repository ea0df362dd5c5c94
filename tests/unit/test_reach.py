"""How much light can leave at all: zero where it is dark for sure, and never less than what does leave."""

import numpy as np
import pytest

from goniosim.engine.layout import DOWN, UP
from goniosim.engine.plan import make_plan
from goniosim.engine.reach import most_light
from reference.scenes import conductor, dielectric, lambert, make_scene, medium

AIR, COAT, ROUGH = dielectric(1.0), dielectric(1.5), dielectric(1.5, 0.2)
METAL = conductor(0.2, 3.9, 0.1)
# Light at 80 degrees is totally reflected, at 30 it is not.
RARE = dielectric(0.9)


def most(layers, theta, side=UP):
    return most_light(make_plan(make_scene(layers, theta, rows=3, columns=4)), side, 0)


DARK = {
    "black Lambert": ([COAT, lambert(0.0)], 30.0, UP),
    "black conductor": ([COAT, conductor(1.5, 0.0)], 30.0, UP),
    "black rough conductor": ([ROUGH, conductor(1.5, 0.0, 0.3)], 30.0, UP),
    "opaque medium": ([ROUGH, medium(400.0), METAL], 30.0, UP),
    "opaque media in a row": ([ROUGH, medium(200.0), dielectric(1.5), medium(200.0), METAL], 30.0, UP),
    "no two channels alike": ([COAT, medium([0.0, 0.0, 800.0]), lambert([0.0, 0.0, 1.0])], 30.0, UP),
    "long way": ([AIR, medium(1.0), lambert(1.0)], 89.999, UP),
    "total reflection": ([RARE, lambert(1.0)], 80.0, UP),
    "total reflection of all that would pass": ([COAT, dielectric(0.9)], 80.0, DOWN),
    "opaque slab": ([ROUGH, medium(800.0), dielectric(1.0, 0.2)], 30.0, DOWN),
    "nothing to turn back at": ([COAT, medium(0.1), dielectric(1.5)], 30.0, UP),
}

LIT = {
    "one channel of three": ([COAT, lambert([0.0, 0.0, 1e-3])], 30.0, UP, 1e-3),
    "nearly matched conductor": ([COAT, conductor(1.5 + 1e-9, 0.0)], 30.0, UP, 1.0),
    "grazing": ([COAT, METAL], 89.9999999, UP, 1.0),
    "grazing, by rough facets": ([dielectric(1.0000001, 0.2), medium(3.0), lambert(0.5)], 89.999, UP, 0.5 * np.exp(-6)),
    "first of two layers": ([ROUGH, dielectric(1.3), medium(1000.0), lambert(1.0)], 30.0, UP, 1.0),
    "rarer, but not too slanted": ([RARE, lambert(1.0)], 30.0, UP, 1.0),
    "rarer behind rough facets": ([ROUGH, dielectric(0.9), lambert(1.0)], 80.0, UP, 2.0),
    "a clear medium, at nearly 90 degrees": ([AIR, medium(1e-9), lambert(1.0)], 90.0 - 1e-12, UP, 1.0),
    "a dark slab": ([ROUGH, medium(300.0), dielectric(1.0, 0.2)], 30.0, DOWN, np.exp(-300.0)),
}


@pytest.mark.parametrize("name", DARK)
def test_dark_for_sure(name):
    assert most(*DARK[name]) == 0.0


@pytest.mark.parametrize("name", LIT)
def test_a_bound_of_what_leaves(name):
    *given, bound = LIT[name]
    assert most(*given) == pytest.approx(min(bound, 1.0), rel=1e-2)


def test_directions_differ():
    plan = make_plan(make_scene([RARE, lambert(1.0)], [30.0, 80.0], rows=3, columns=4))
    assert [most_light(plan, UP, m) > 0.0 for m in range(2)] == [True, False]
