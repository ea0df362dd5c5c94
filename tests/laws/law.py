"""A law: what holds for every legal scene, tried on a few of them, and on many in the slow set."""

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis.internal.conjecture import providers

# Numbers that stand in the modules that happen to be loaded would be among the examples: others in every session.
assert providers.is_local_module_file
providers.is_local_module_file = lambda path: False

SETTINGS = settings(
    derandomize=True,
    database=None,
    deadline=None,
    print_blob=True,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much, HealthCheck.data_too_large],
)


def law(*, fast, slow, **strategies):
    """Decorator of a test that is given examples by hypothesis, always the same ones.

    Parameters
    ----------
    fast, slow : int
        Examples in `make test`, and in the slow set.
    **strategies
        By argument of the test.
    """

    def decorated(check):
        tried = given(**strategies)(check)

        @pytest.mark.parametrize("examples", [fast, pytest.param(slow, marks=pytest.mark.slow)])
        def run(examples):
            settings(SETTINGS, max_examples=examples)(tried)()

        run.__name__, run.__doc__ = check.__name__, check.__doc__
        return run

    return decorated
