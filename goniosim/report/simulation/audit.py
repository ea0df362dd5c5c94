"""Tables of where the energy went: albedo, audit, direct reflection sampled against integrated."""

import numpy as np

from ...accuracy import FAINTEST
from ...albedo import arrived
from ...scene.quantity import percent
from .. import text
from .losses import masking_lines

AUDIT_HEADINGS = {
    "reflected_direct": "reflected\ndirect",
    "reflected_internal": "reflected\ninternal",
    "transmitted": "transmitted",
    "absorbed_media": "absorbed\nin media",
    "absorbed_base": "absorbed\nby base",
    "lost_masked_reflection": "lost: masked\nreflection",
    "lost_masked_transmission": "lost: masked\ntransmission",
    "lost_roulette": "lost:\nroulette",
    "lost_event_cap": "lost:\nevent cap",
}

# Smaller shares of the energy, as the balance of Russian roulette, get no column of their own.
NEGLIGIBLE = 1e-6
# Deviation between sampled and integrated direct reflection that chance does not explain: as rare as 4
# sigma of a normal quantity. The sampled one has its error bar from the scatter of at least 64 parts, or 4
# if the run was stopped, so that deviations follow Student's t with 63 or 3 degrees of freedom.
ALARMING_SIGMAS = {"complete": 4.29, "partial": 32.6}
# Events that chance may keep from being seen even once, see docs/compare.md.
RULE_OF_THREE = 3.0
# The rounding of a sum over very many rays; two values closer than this agree.
ROUNDING = 1e-10


def albedos(result):
    """Albedo of each component with its standard error.

    Parameters
    ----------
    result : goniosim.result.Result

    Returns
    -------
    dict of str to (ndarray, ndarray), each of shape (M, C)
        Fraction of the incident energy in the component, and its standard error: that of the
        integration for the direct reflection, that of sums over cells that share their paths for others.
    """
    return {name: (component.albedo, component.albedo_stderr) for name, component in result.components.items()}


def albedo_lines(result):
    """Table of the albedo of each component, per direction and group of equal channels."""
    pairs = albedos(result)
    header = ["theta [deg]", "channel", *pairs]
    rows = _rows(
        result,
        [a for pair in pairs.values() for a in pair],
        [lambda i, c, name=name: _albedo(result, name, *pairs[name], i, c) for name in pairs],
    )
    return ["Albedo (fraction of the incident energy)", *text.table(header, rows)]


def _albedo(result, name, value, stderr, i, c):
    component = result.components[name]
    if component.sampled and not arrived(component)[i, c]:
        # Not seen is not zero: this is its limit at 95 % confidence.
        return f"< {unseen(result, i)}"
    if component.sampled and 0.0 < value[i, c] < FAINTEST:
        # What is stated of its error, if anything, is rounding.
        return f"about {value[i, c]:.1g}"
    return text.with_error(value[i, c], stderr[i, c])


def unseen(result, direction):
    """What may have been there in a direction though nothing was seen, at 95 % confidence, in words."""
    return f"{min(RULE_OF_THREE / max(result.rays[direction], 1), 1.0):.1g}"


def audit_lines(result):
    """Table of where the energy went, in per cent, and a plain word on what the model loses."""
    audit = result.audit
    largest = {name: np.max(np.abs(energy)) for name, energy in audit.energy.items()}
    shown = [name for name, energy in largest.items() if energy > NEGLIGIBLE]
    omitted = [AUDIT_HEADINGS[name] for name, energy in largest.items() if 0.0 < energy <= NEGLIGIBLE]
    header = ["theta [deg]", "channel", *(AUDIT_HEADINGS[name] for name in shown)]
    arrays = [a for name in shown for a in (audit.energy[name], audit.stderr[name])]
    rows = _rows(
        result,
        arrays,
        [
            lambda i, c, name=name: text.with_error(
                100.0 * audit.energy[name][i, c], 100.0 * audit.stderr[name][i, c], decimals=3
            )
            for name in shown
        ],
    )
    residual = np.max(np.abs(audit.residual[result.rays > 0]), initial=0.0)
    lines = ["Energy audit (% of the incident energy, as sampled)", *text.table(header, rows)]
    lines.append(f"  Each line sums to 100 % within {percent(residual, 1)}.")
    if omitted:
        names = ", ".join(name.replace("\n", " ") for name in omitted)
        lines.append(f"  Not shown, since below {100.0 * NEGLIGIBLE:g} %: {names}.")
    return lines + masking_lines(result)


def direct_deviation(result):
    """Deviation of the sampled from the integrated direct reflection, in standard errors.

    Parameters
    ----------
    result : goniosim.result.Result

    Returns
    -------
    ndarray, shape (M, C)
        Zero where both agree to rounding or where no ray was traced. 3/rays, which may go unseen, counts
        as a standard error.
    """
    audit = result.audit
    difference = audit.energy["reflected_direct"] - audit.direct_integrated
    # Where nearly all rays meet the same fate the few others may be missing, and no scatter tells.
    unseen = RULE_OF_THREE / np.maximum(result.rays, 1)[:, None]
    stderr = audit.stderr["reflected_direct"]
    sigma = np.sqrt(stderr**2 + audit.direct_integrated_stderr**2 + unseen**2)
    meaningful = (np.abs(difference) > ROUNDING) & (result.rays > 0)[:, None]
    return np.where(meaningful, difference / sigma, 0.0)


def direct_lines(result):
    """Say how far the sampled direct reflection lies from the integrated one."""
    if "reflection/direct" not in result.components:
        return []
    deviation = direct_deviation(result)
    i, c = np.unravel_index(np.argmax(np.abs(deviation)), deviation.shape)
    groups = text.channel_groups(result.channels, [deviation])
    lines = [
        "Direct reflection, sampled against integrated: largest of "
        f"{len(groups) * len(result.theta_deg)} deviations {abs(deviation[i, c]):.1f} sigma "
        f"(theta {text.angles(result.theta_deg)[i]}, channel {result.channels[c]})"
    ]
    if abs(deviation[i, c]) > ALARMING_SIGMAS[result.status]:
        lines.append("  Warning: chance explains such a deviation once in 16000 times; do not trust this file.")
    return lines


def _rows(result, arrays, columns):
    """One row per direction and group of channels that agree in all ``arrays``."""
    groups = text.channel_groups(result.channels, arrays)
    rows = []
    for i, theta in enumerate(text.angles(result.theta_deg)):
        if result.rays[i] == 0:
            rows.append([theta, "-", *("not traced" for _ in columns)])
            continue
        for number, (label, c) in enumerate(groups):
            angle = theta if number == 0 else ""
            rows.append([angle, label, *(column(i, c) for column in columns)])
    return rows
