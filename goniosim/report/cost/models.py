"""Models as points beside the price list: their errors against the best slices of the ladder, and their times."""

from ...compare.material import compare_material
from ...compare.measures import rmse
from ...compare.variants import check_request
from ...integration import Pool
from .norms import norm_of
from .runs import sampled

# As in `goniosim compare`.
SUBCELLS = 5


def model_points(result):
    """Compare all models that apply, with their default options.

    Parameters
    ----------
    result : goniosim.result.Result

    Returns
    -------
    dict of str to dict of str to dict
        By sampled component and model: ``error`` (relative, noise taken out), its standard error ``uncertainty``,
        ``seconds`` for all directions, and whether it is ``significant``: told from noise.
    """
    with Pool() as pool:
        compared = compare_material(result, check_request(), SUBCELLS, pool).compared
    found = {}
    for each in compared:
        component = sampled(result).get(each.component)
        if component is None or each.variant.options:
            continue
        norm = float((norm_of(component, result.cells) ** 2).mean() ** 0.5)
        if norm > 0.0:
            error = rmse(each.converged)
            found.setdefault(each.component, {})[each.variant.model] = {
                "error": error.rmse / norm,
                "uncertainty": error.stderr / norm,
                "seconds": each.seconds * len(result.theta_deg),
                "significant": error.significant,
            }
    return found
