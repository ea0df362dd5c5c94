"""The curve of a slice along the plane of incidence, phi = 0 and phi = 180 degrees.

Near the pole of a parametrization a cell is a sliver with hardly any light in it, and so is a
cell in the dark. The curve therefore runs over patches of cells: as many columns on both sides
of the plane as make a patch about as wide as it is high, two at least, and as many rows as it
takes to see something.
"""

import numpy as np

from .view import in_plane, index

# Rows are joined until the relative standard error falls below this, or the patch gets this wide.
NOISY = 0.25
WIDEST_DEG = 2.0


def plane_of_incidence(cells, direction, theta_deg, slices, stderr):
    """Follow a slice along the plane of incidence.

    Parameters
    ----------
    cells : goniosim.result.Cells
    direction : int
        Which of the incident directions.
    theta_deg : float
        Its angle.
    slices, stderr : ndarray, shape (C, R, K)
        BSDF and its standard error in 1/sr.

    Returns
    -------
    angle : ndarray, shape (P,)
        Signed angle of the patch from the normal in degrees, ascending: negative towards the
        light, positive on the side of the mirror direction.
    f, sigma : ndarray, shape (P, C)
        BSDF of the patch and its standard error.
    """
    sides = []
    for azimuth in (0.0, 180.0):
        for angle, f, sigma in _joined(_row_patches(cells, direction, theta_deg, azimuth, slices, stderr)):
            if abs(angle) < 90.0:
                sides.append((angle, f, sigma))
    sides.sort(key=lambda point: point[0])
    if not sides:
        return np.empty(0), np.empty((0, len(slices))), np.empty((0, len(slices)))
    return tuple(np.array(part) for part in zip(*sides, strict=True))


def highest(f, sigma, sigmas):
    """Highest value that the curve and its band of so many ``sigmas`` reach, where it is not mere noise."""
    clear = sigma <= NOISY * f
    return float(np.max((f + sigmas * sigma)[clear], initial=0.0)) or float(f.max(initial=0.0))


def _row_patches(cells, direction, theta_deg, azimuth, slices, stderr):
    """Patches one row high, from the pole outwards: (first, last angle, solid angle, f, sigma)."""
    n_columns = len(cells.column_edges) - 1
    middle = int(index(cells.column_edges, azimuth))
    tilts, angles = in_plane(cells, theta_deg, azimuth)
    for row, (low, high) in enumerate(zip(tilts[:-1], tilts[1:], strict=True)):
        column_width = np.sin(np.radians(0.5 * (low + high))) * 360.0 / n_columns
        pairs = max(1, round(0.5 * (high - low) / column_width))
        width = min(2 * pairs, max(1, n_columns // 2))
        columns = (middle - width // 2 + np.arange(width)) % n_columns
        if cells.valid[direction, row, columns].all():
            size = cells.projected_solid_angle[direction, row, columns].sum()
            yield angles[row], angles[row + 1], size, *_mean(slices[:, row, columns], stderr[:, row, columns])


def _mean(f, sigma):
    """Mean over the last axis and its standard error, whatever the correlation of the cells.

    For cells of equal expectation, the expected scatter between them is the mean of their
    variances less what they have in common; that common part is what averaging cannot reduce.
    Estimated from few cells, it is never too small, and for independent cells too large by a
    factor of 1.2 (two cells) to 2 (forty).
    """
    variance = np.mean(sigma**2, axis=-1)
    scatter = np.var(f, axis=-1)
    return f.mean(axis=-1), np.sqrt(np.maximum(variance - scatter, variance / f.shape[-1]))


def _joined(patches):
    """Join consecutive patches until each is seen well enough, or wide enough; yield (angle, f, sigma)."""
    group = []
    for patch in patches:
        if group and group[-1][1] != patch[0]:
            yield _join(group)
            group = []
        group.append(patch)
        angle, f, sigma = _join(group)
        best = np.argmax(f)
        seen = f[best] > 0.0 and sigma[best] < NOISY * f[best]
        if seen or abs(group[-1][1] - group[0][0]) >= WIDEST_DEG:
            yield angle, f, sigma
            group = []
    if group:
        yield _join(group)


def _join(group):
    if len(group) == 1:
        ((first, last, _, f, sigma),) = group
        return 0.5 * (first + last), f, sigma
    firsts, lasts, sizes, f, sigma = zip(*group, strict=True)
    weights = np.array(sizes)[:, None] / sum(sizes)
    return (
        0.5 * (firsts[0] + lasts[-1]),
        (weights * np.array(f)).sum(axis=0),
        np.sqrt((weights**2 * np.array(sigma) ** 2).sum(axis=0)),
    )
