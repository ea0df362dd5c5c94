"""Rough dielectrics in the interior of stacks, as sharply as what leaves them directly.

Every cell of what one interface reflects and refracts, met from above and from below, and score statistics of the two
numbers that decide it: the Fresnel coin (a factor on the reflectance where it is not total) and the width alpha. Each
test also asserts how sharp it is. An error of one percent of either, in any walk, fails the fast ones with a
probability of 99.9 %; an error of .2 % of the coin or .3 % of the width the slow ones. A right engine fails a score
with a probability of 1e-10.
"""

import pytest

from reference.interiors import Meeting, analog_scores, plastic_scores, split_scores
from reference.score import pooled

# Just short of total reflection, and where visible facets are on both sides of the critical angle.
NEAR_CRITICAL = 41.5
FAST = [
    Meeting(0.01, 1.5, 85.0),
    Meeting(0.1, 1.5, 85.0, parametrization="classic"),
    Meeting(0.001, 1.0 / 1.5, NEAR_CRITICAL),
    Meeting(1.0, 1.0 / 1.5, 30.0, parametrization="classic"),
]
SIDES = pytest.mark.parametrize("from_below", [False, True], ids=["above", "below"])


def assert_right(scores, coin=0.01, alpha=0.01):
    """Of pairs of scores, each and all together: within their limits, and so sharp together."""
    for number, smallest in enumerate((coin, alpha)):
        some = [each[number] for each in scores]
        assert all(each.right for each in some), [str(each) for each in some]
        together = pooled(some)
        assert together.right and together.smallest < smallest, str(together)


def moved(meetings, **changes):
    """The same meetings, changed."""
    return [Meeting(**{**vars(each), **changes}) for each in meetings]


@pytest.mark.false_alarm(1.4e-9)
@SIDES
def test_analog_walk(from_below):
    """Chi-squares within 6.5 sigma besides, false alarm 8e-11 each."""
    found = [analog_scores(each, 1_000_000, seed=21) for each in moved(FAST, from_below=from_below)]
    assert all(abs(chi_square.sigmas) < 6.5 for chi_square, _, _ in found)
    assert_right([scores for _, *scores in found])


@pytest.mark.false_alarm(1e-9)
@SIDES
def test_split_walk_goes_both_ways(from_below):
    """Inside, where it branches; from below half of it by coins instead, as in a crowd."""
    assert_right([split_scores(each, 16_384, 64, seed=22) for each in moved(FAST, from_below=from_below)])


@pytest.mark.false_alarm(1e-9)
def test_split_walk_leaves():
    """Through the interface itself, by deposits of many facets."""
    assert_right([split_scores(each, 8192, 48, seed=23) for each in moved(FAST, last=True)], 0.002, 0.003)


# Light at grazing angles decides by entering, light from a denser side by what returns to the base.
PLASTICS = [(1.5, 85.0, 0.3), (1.0 / 2.4, 10.0, 0.3)]


def assert_plastics(estimator, rays, runs, smallest, seed):
    """Both are right, and the first tells such errors of coin and width."""
    first, second = (plastic_scores(*each, estimator, rays, runs, seed=seed) for each in PLASTICS)
    assert_right([first], *smallest)
    assert_right([second], 1.0, 1.0)


@pytest.mark.false_alarm(6e-10)
@pytest.mark.parametrize(
    ("estimator", "rays", "runs"),
    [("split", 262_144, 8), ("operator", 262_144, 12), ("connection", 65_536, 12)],
)
def test_estimators_on_a_rough_plastic(estimator, rays, runs):
    """A closed form of three rows, whose light passes the interface on its way in, back, and out."""
    assert_plastics(estimator, rays, runs, (0.01, 0.01), seed=24)


ALPHAS = [0.001, 0.01, 0.1, 0.3, 1.0]
THETAS = [0.0, 30.0, 60.0, 85.0, 89.9]
INDICES = [1.5, 1.0 / 1.5, 1.05, 2.4]


def sweep(n, alpha, from_below):
    """Meetings of a width, with light paths: more where the coin is sharp."""
    for theta in [*THETAS, NEAR_CRITICAL] if n < 1.0 else THETAS:
        for parametrization in ("half", "classic"):
            rays = 3_000_000 if theta > 80.0 or theta == NEAR_CRITICAL else 1_000_000
            # Cells resolve narrow lobes less well.
            rays *= 2 if alpha < 0.05 else 1
            yield Meeting(alpha, n, theta, from_below, parametrization), rays


@pytest.mark.false_alarm(4e-7)
@pytest.mark.slow
@SIDES
@pytest.mark.parametrize("n", INDICES)
def test_all_angles_and_widths_in_the_analog_walk(n, from_below):
    """The width is told for each alpha, the coin by all. Chi-squares of each meeting: 6.2 sigma, false alarm 4e-7."""
    every = []
    for alpha in ALPHAS:
        found = [analog_scores(meeting, rays, seed=31) for meeting, rays in sweep(n, alpha, from_below)]
        assert all(abs(chi_square.sigmas) < 6.2 for chi_square, _, _ in found), [str(each[0]) for each in found]
        assert_right([scores for _, *scores in found], coin=1.0, alpha=0.003)
        every += [scores for _, *scores in found]
    assert_right(every, 0.002, 0.001)


@pytest.mark.false_alarm(1e-9)
@pytest.mark.slow
@SIDES
def test_small_errors_of_the_split_walk(from_below):
    """As `test_split_walk_goes_both_ways`, with 25 times as many paths."""
    meetings = moved(FAST, from_below=from_below)
    assert_right([split_scores(each, 262_144, 100, seed=32) for each in meetings], 0.002, 0.003)


@pytest.mark.false_alarm(6e-10)
@pytest.mark.slow
@pytest.mark.parametrize(("estimator", "rays", "runs"), [("operator", 1 << 21, 24), ("connection", 1 << 20, 24)])
def test_small_errors_on_a_rough_plastic(estimator, rays, runs):
    """As `test_estimators_on_a_rough_plastic`."""
    assert_plastics(estimator, rays, runs, (0.002, 0.003), seed=33)
