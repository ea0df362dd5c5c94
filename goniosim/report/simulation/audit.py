"""Tables of where the energy went: albedo, audit, direct reflection sampled against integrated."""

import numpy as np

from .. import text

# The audit entry whose standard error is that of a sampled component's albedo.
SAMPLED_ENTRY = {
    "reflection/internal": "reflected_internal",
    "transmission": "transmitted",
}

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
# Share of the energy from which the loss to single scattering is said in words.
NOTEWORTHY_LOSS = 0.01
# Deviation between sampled and integrated direct reflection that chance does not explain.
ALARMING_SIGMAS = 4.0
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
        integration for the direct reflection, that of the audit for sampled components.
    """
    audit = result.audit
    pairs = {}
    for name in result.components:
        if name in SAMPLED_ENTRY:
            entry = SAMPLED_ENTRY[name]
            pairs[name] = (audit.energy[entry], audit.stderr[entry])
        else:
            pairs[name] = (audit.direct_integrated, audit.direct_integrated_stderr)
    return pairs


def albedo_lines(result):
    """Table of the albedo of each component, per direction and group of equal channels."""
    pairs = albedos(result)
    header = ["theta [deg]", "channel", *pairs]
    rows = _rows(
        result,
        [a for pair in pairs.values() for a in pair],
        [lambda i, c, pair=pair: text.with_error(pair[0][i, c], pair[1][i, c]) for pair in pairs.values()],
    )
    return ["Albedo (fraction of the incident energy)", *text.table(header, rows)]


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
    lines.append(f"  Each line sums to 100 % within {100.0 * residual:.0e} %.")
    if omitted:
        names = ", ".join(name.replace("\n", " ") for name in omitted)
        lines.append(f"  Not shown, since below {100.0 * NEGLIGIBLE:g} %: {names}.")
    return lines + loss_lines(result)


def loss_lines(result):
    """Say in words how much energy single-scattering masking loses, if it is noteworthy."""
    energy = result.audit.energy
    lost = energy["lost_masked_reflection"] + energy["lost_masked_transmission"]
    if not lost.size or lost.max() <= NOTEWORTHY_LOSS:
        return []
    i, c = np.unravel_index(np.argmax(lost), lost.shape)
    return [
        f"  Note: up to {100.0 * lost[i, c]:.1f} % of the energy (theta {text.degrees(result.theta_deg[i])}, "
        f"channel {result.channels[c]}) is lost to single-scattering masking.",
        "  The GGX model used has no inter-reflection inside a rough interface: light that a facet sends",
        "  to the wrong side is gone. This is a property of the model; more rays do not reduce it.",
    ]


def direct_deviation(result):
    """Deviation of the sampled from the integrated direct reflection, in standard errors.

    Parameters
    ----------
    result : goniosim.result.Result

    Returns
    -------
    ndarray, shape (M, C)
        Zero where both agree to rounding or where no ray was traced.
    """
    audit = result.audit
    difference = audit.energy["reflected_direct"] - audit.direct_integrated
    sigma = np.hypot(audit.stderr["reflected_direct"], audit.direct_integrated_stderr)
    meaningful = (np.abs(difference) > ROUNDING) & (result.rays > 0)[:, None]
    # A difference beyond rounding between two values without noise must not pass for agreement.
    return np.where(meaningful, difference / np.maximum(sigma, ROUNDING), 0.0)


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
        f"(theta {text.degrees(result.theta_deg[i])}, channel {result.channels[c]})"
    ]
    if abs(deviation[i, c]) > ALARMING_SIGMAS:
        lines.append("  Warning: chance explains this only once in 16000 times; do not trust this file.")
    return lines


def _rows(result, arrays, columns):
    """One row per direction and group of channels that agree in all ``arrays``."""
    groups = text.channel_groups(result.channels, arrays)
    rows = []
    for i, theta in enumerate(result.theta_deg):
        if result.rays[i] == 0:
            rows.append([text.degrees(theta), "-", *("not traced" for _ in columns)])
            continue
        for number, (label, c) in enumerate(groups):
            angle = text.degrees(theta) if number == 0 else ""
            rows.append([angle, label, *(column(i, c) for column in columns)])
    return rows
