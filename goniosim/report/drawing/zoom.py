"""Where a lobe is too narrow for a plot of all angles, and what a closer look should show."""

import numpy as np

from . import panels

# A lobe is enlarged when its full width at half its height is below this, in degrees,
NARROW_DEG = 4.0
# and when it stands out of the rest of the curve by this factor.
OUTSTANDING = 20.0
# The closer look reaches this many of its widths to both sides, and over a few cells at least.
REACH, CELLS = 4.0, 3.5
# So few points are marked one by one.
FEW_POINTS = 40


def window(angle, f, sigma, tolerance=0.25):
    """Range of angles that a closer look at the peak of a curve should show.

    Parameters
    ----------
    angle, f, sigma : ndarray, shape (P,)
        From `inplane.plane_of_incidence`, of one channel; a Dirac part left out.
    tolerance : float
        A peak with a larger relative standard error is taken for noise.

    Returns
    -------
    (float, float) or None
        In degrees, between -90 and 90; None if there is no narrow lobe.
    """
    if len(f) < 5 or not f.max() > 0.0:
        return None
    peak = int(np.argmax(f))
    # Patches may crowd round the peak: the rest is what most angles show.
    rest = np.median(np.interp(np.arange(-89.0, 90.0), angle, f))
    if sigma[peak] > tolerance * f[peak] or f[peak] < OUTSTANDING * rest:
        return None
    half = 0.5 * f[peak]
    left, right = _crossing(angle, f, peak, half, -1), _crossing(angle, f, peak, half, 1)
    if right - left > NARROW_DEG:
        return None
    near = angle[max(peak - 1, 0) : peak + 2]
    reach = max(REACH * (right - left), CELLS * (near[-1] - near[0]) / (len(near) - 1))
    low, high = max(angle[peak] - reach, -90.0), min(angle[peak] + reach, 90.0)
    return float(low), float(high)


def of_channels(angle, f, sigma):
    """`window` of the brightest channel of curves of shape (P, C)."""
    if not f.size:
        return None
    brightest = int(np.argmax(f.max(axis=0)))
    return window(angle, f[:, brightest], sigma[:, brightest])


def furnish(axes, shown, theta_deg):
    """Make axes with curves a closer look at a range of angles.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        Its lines get a point for each patch of cells, if these are few.
    shown : (float, float)
        From `window`.
    theta_deg : float
        Of the light; the direction straight on is marked where it is in range.
    """
    for line in axes.lines:
        angle = line.get_xdata()
        if np.sum((angle >= shown[0]) & (angle <= shown[1])) <= FEW_POINTS and line.get_marker() == "None":
            line.set(marker=".", markersize=3.5)
    axes.set_xlim(*shown)
    axes.locator_params(axis="x", nbins=4)
    axes.ticklabel_format(axis="x", useOffset=False)
    axes.tick_params(labelsize=7.5)
    axes.grid(color="0.9", linewidth=0.6)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_color("0.7")
    if shown[0] <= theta_deg <= shown[1]:
        axes.axvline(theta_deg, zorder=1, **panels.STRAIGHT_ON)


def mark(axes, shown):
    """Shade in axes with all angles the range of the closer look."""
    axes.axvspan(*shown, zorder=0, **panels.ENLARGED)


def _crossing(angle, f, peak, half, step):
    """Where the curve falls below half its peak, going up or down from it; its last angle if it does not."""
    at = peak
    while 0 <= at + step < len(f) and f[at + step] >= half:
        at += step
    if not 0 <= at + step < len(f):
        return angle[at]
    share = (f[at] - half) / (f[at] - f[at + step])
    return angle[at] + share * (angle[at + step] - angle[at])
