"""What a result holds, as text for a person and as plain data for a program."""

import dataclasses
import os

import numpy as np

from ...scene import parse_scene
from ...scene.quantity import percent
from .. import text
from . import accuracy, audit, cost, losses, target

# A smaller share of the energy in uncertain cells is not worth a word.
NEGLIGIBLE = 1e-3


def summary(result, path=None):
    """Describe a result in the words and tables shown after a simulation.

    Parameters
    ----------
    result : goniosim.result.Result
    path : path, optional
        File that holds the result; its name and size are then added.

    Returns
    -------
    str
    """
    blocks = [
        heading_lines(result),
        audit.albedo_lines(result),
        audit.audit_lines(result),
        audit.direct_lines(result),
        [line for line in [losses.event_cap(result)] if line],
        cost.cost_lines(result),
        accuracy.accuracy_lines(result),
    ]
    if path is not None:
        blocks.append([f"{path}  ({text.size(os.path.getsize(path))})"])
    return "\n\n".join("\n".join(lines) for lines in blocks if lines)


def description(result):
    """Describe a result file: its summary, the effects simulated and left out, and where it came from.

    Parameters
    ----------
    result : goniosim.result.Result

    Returns
    -------
    str
    """
    present = [name for name, active in result.effects.items() if active]
    absent = [name for name, active in result.effects.items() if not active]
    effects = [f"Effects simulated: {', '.join(present) or 'none'}"]
    if absent:
        effects.append(f"  not called for: {', '.join(absent)}")
    left_out = losses.left_out_lines(result)
    origin = ["Origin", *text.pairs(result.provenance)]
    return "\n\n".join([summary(result), *("\n".join(lines) for lines in (effects, left_out, origin))])


def heading_lines(result):
    """Name, status, directions, slices and rays of a result."""
    rows, columns = result.cells.valid.shape[1:]
    slices = f"{result.cells.parametrization} slices, {rows} x {columns} cells"
    lines = [
        f"{result.name}  ({result.status})",
        f"  incident theta [deg]: {', '.join(text.angles(result.theta_deg))}",
        f"  {slices}, channels {', '.join(result.channels)}",
        f"  rays per direction: {text.counts(result.rays)}, seed {result.seed}, estimator {result.estimator}",
    ]
    if result.target_reached is not None:
        outcome = "reached" if result.target_reached else "not reached"
        lines.append(f"  {target.asked(parse_scene(result.config_yaml).simulation)}: {outcome}")
    for name, component in result.components.items():
        if component.contains_delta:
            lines.append(f"  {name} contains a perfectly sharp (Dirac) part; its cell holds a cell average")
        if component.orders:
            lines.append(f"  {name} is also split by order: {', '.join(component.orders)}")
        lines += _doubts(result, name)
    return lines


def _doubts(result, name):
    """What to beware of in a component: cells that few paths reached, and what its nodes may be off by."""
    component = result.components[name]
    held = _uncertain_energy(component)
    lines = []
    if held is not None and held > NEGLIGIBLE:
        lines.append(f"  {name}: {percent(held)} of its energy lies in uncertain cells, which too few paths reached")
    if component.node_bias is not None and component.node_bias.any():
        lines.append(
            f"  {name}: nodes may add an error of up to {component.node_bias.max():.1g} sr^-1/2, whatever the noise"
        )
    return lines


def as_data(result):
    """Everything `description` tells, as plain data that JSON can hold.

    Parameters
    ----------
    result : goniosim.result.Result

    Returns
    -------
    dict
        Arrays over directions and channels are nested lists ``[direction][channel]``, those of the cost
        ``[direction][checkpoint]``.
    """
    rows, columns = result.cells.valid.shape[1:]
    return {
        "name": result.name,
        "status": result.status,
        "seed": int(result.seed),
        "estimator": result.estimator,
        "theta_deg": result.theta_deg.tolist(),
        "phi_deg": result.phi_deg.tolist(),
        "rays": result.rays.tolist(),
        "target_reached": result.target_reached,
        "channels": list(result.channels),
        "slice": {"parametrization": result.cells.parametrization, "rows": rows, "columns": columns},
        "components": {
            name: {
                "contains_delta": bool(component.contains_delta),
                "orders": list(component.orders),
                "estimator": list(component.estimator),
                "uncertain_energy": _uncertain_energy(component),
                "node_bias": None if component.node_bias is None else component.node_bias.tolist(),
            }
            for name, component in result.components.items()
        },
        "albedo": {
            name: {"value": value.tolist(), "stderr": stderr.tolist()}
            for name, (value, stderr) in audit.albedos(result).items()
        },
        "audit": {
            name: {"energy": energy.tolist(), "stderr": result.audit.stderr[name].tolist()}
            for name, energy in result.audit.energy.items()
        },
        "audit_residual": float(np.max(np.abs(result.audit.residual))),
        "direct_deviation_sigma": audit.direct_deviation(result).tolist(),
        "cost": {field.name: _lists(getattr(result.cost, field.name)) for field in dataclasses.fields(result.cost)},
        "effects": {name: bool(active) for name, active in result.effects.items()},
        "provenance": dict(result.provenance),
        "config_yaml": result.config_yaml,
        "config_hash": result.config_hash,
    }


def _uncertain_energy(component):
    """Share of the energy of a component that lies in uncertain cells; None if nothing is sampled or arrived."""
    if not component.sampled or not component.energy.any():
        return None
    return float(component.energy[component.uncertain].sum() / component.energy.sum())


def _lists(value):
    if isinstance(value, dict):
        return {name: array.tolist() for name, array in value.items()}
    return value.tolist()
