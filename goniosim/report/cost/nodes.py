"""What the nodes of an operator may put a slice off by: no number of rays mends it."""


def node_bias(rung):
    """Bounds of the bias over the norm of the slice, the largest of all directions that are lit.

    Parameters
    ----------
    rung : goniosim.report.cost.runs.Run

    Returns
    -------
    dict of str to float
        By component; those that no operator made are left out.
    """
    found = {}
    for name, norm in rung.norm.items():
        bias = rung.result.components[name].node_bias
        lit = norm > 0.0
        if bias is not None and lit.any():
            found[name] = float((bias[lit] / norm[lit]).max())
    return found
