"""How the noise of cells hangs together, so that sums over cells get honest standard errors.

A sum of g_i E_i over cells with energies E_i, standard errors s_i and given weights g_i has the variance

    sum g_i^2 s_i^2  +  sum over i != j of g_i g_j cov(E_i, E_j).

* `Paths`. An independent path leaves in one cell, so cov(E_i, E_j) = -E_i E_j / (N - 1) for N paths. This is exact:
  with it the variance is that of the mean over the paths of what each brings to the sum.
* `Batches`. Estimators whose paths share events or deposits keep sums over blocks of cells, one for each of B
  independent batches of their replicates. The variance of a sum is that of the sums of the batches, with g replaced by
  its mean in each block (weights s_i^2), plus sum (g_i - mean)^2 s_i^2 for what g varies within the blocks. Exact if
  the cells of a block are independent of each other, or g does not vary; else an approximation, whose second part is
  small for smooth g. Slices that are their own mirror images hold each number twice, and their twins count as one.

Squares add up too. The noise of sum E_i^2 / w_i, and so of an RMSE, needs the sum over i != j of cov(E_i, E_j)^2 /
(w_i w_j). In batches the covariance of two cells is taken to be that of their blocks, shared out as s_i s_j; the
square of an estimated covariance is too large on average, and the bias is taken out.
"""

import numpy as np

from .result import Component

BATCHES = 32
# At most so many blocks along rows and columns.
BLOCKS = (15, 30)


def block_starts(cells: int, most: int) -> np.ndarray:
    """First cell of each block along an axis, in blocks as equal as they can be.

    Parameters
    ----------
    cells : int
        Along the axis.
    most : int
        Blocks at most: one of `BLOCKS`.

    Returns
    -------
    ndarray of int64
    """
    blocks = min(cells, most)
    return np.arange(blocks) * cells // blocks


def block_sums(cells: np.ndarray) -> np.ndarray:
    """Sums over the blocks of slices, shape (..., R, K), as `goniosim.result.Component.batches` holds them.

    Returns
    -------
    ndarray, shape (..., row blocks, column blocks)
    """
    rows, columns = (block_starts(n, most) for n, most in zip(cells.shape[-2:], BLOCKS, strict=True))
    return np.add.reduceat(np.add.reduceat(cells, rows, axis=-2), columns, axis=-1)


def _spread(blocks: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    """Values of blocks in each of their cells; ``shape`` is (R, K)."""
    for axis, (cells, most) in enumerate(zip(shape, BLOCKS, strict=True), -2):
        blocks = np.repeat(blocks, np.diff(block_starts(cells, most), append=cells), axis=axis)
    return blocks


def _total(values: np.ndarray) -> np.ndarray:
    return values.sum(axis=(-2, -1))


def _ratio(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """``a / b``, and 0 where b is 0."""
    return np.divide(a, b, out=np.zeros(np.broadcast(a, b).shape), where=b > 0.0)


class Paths:
    """Noise of independent paths in one direction.

    Parameters
    ----------
    energy : ndarray, shape (C, R, K)
    rays : int
    """

    # How well the noise itself is known, as degrees of freedom of its variance: what each hit brings counts.
    freedom = np.inf

    def __init__(self, energy: np.ndarray, rays: int) -> None:
        self._energy = energy
        self._rays = max(int(rays) - 1, 1)

    def of_sum(self, weights: np.ndarray, shift: np.ndarray | float = 0.0) -> np.ndarray:
        """What the covariance of cells adds to the variance of a sum.

        Parameters
        ----------
        weights : ndarray, shape (C, R, K) or less
            g above.
        shift : ndarray, shape (C,)
            What the weighted sum of the energies falls short of its mean by, where the weights hold the same noise.

        Returns
        -------
        ndarray, shape (C,)
        """
        carried = weights * self._energy
        return -((_total(carried) + shift) ** 2 - _total(carried**2)) / self._rays

    def of_squares(self, size: np.ndarray) -> np.ndarray:
        """Sum of cov(E_i, E_j)^2 / (w_i w_j) over pairs of different cells, shape (C,).

        Parameters
        ----------
        size : ndarray, shape (R, K)
            w; cells where it is 0 do not count.
        """
        squares = _ratio(self._energy**2, size)
        return (_total(squares) ** 2 - _total(squares**2)) / float(self._rays) ** 2


class Batches:
    """Noise of any estimator in one direction, by its batches.

    Parameters
    ----------
    energy, stderr : ndarray, shape (C, R, K)
    batches : ndarray, shape (B, C, row blocks, column blocks)
    """

    def __init__(self, energy: np.ndarray, stderr: np.ndarray, batches: np.ndarray) -> None:
        self._stderr = stderr
        self._s2 = stderr**2
        self._batches = batches
        self.freedom = len(batches) - 1.0
        # Cells whose mirror image is another cell that holds the same number.
        self._twins = np.full(energy.shape[-1], bool((energy == energy[..., ::-1]).all()))
        if energy.shape[-1] % 2:
            self._twins[energy.shape[-1] // 2] = False

    def of_sum(self, weights: np.ndarray, shift: np.ndarray | float = 0.0) -> np.ndarray:
        """As `Paths.of_sum`; ``shift`` is of no use here."""
        s2, shape = self._s2, self._s2.shape
        weights = np.broadcast_to(weights, shape)
        in_block = _ratio(block_sums(weights * s2), block_sums(s2))
        sums = _total(self._batches * in_block)
        rest = weights - _spread(in_block, shape[-2:])
        within = _total(s2 * rest * (rest + self._twins * rest[..., ::-1]))
        return sums.var(axis=0, ddof=1) / len(sums) + within - _total(weights**2 * s2)

    def of_squares(self, size: np.ndarray) -> np.ndarray:
        """As `Paths.of_squares`."""
        each = _ratio(self._s2, size)
        scale = _ratio(np.sqrt(block_sums(each)), block_sums(self._stderr))
        deviations = (self._batches - self._batches.mean(axis=0)) * scale
        n = self.freedom
        deviations = np.moveaxis(deviations, 1, 0).reshape(len(scale), len(deviations), -1)
        products = deviations @ np.swapaxes(deviations, 1, 2) / (n * (n + 1.0))
        trace = np.trace(products, axis1=1, axis2=2)
        shared = n**2 / ((n - 1.0) * (n + 2.0)) * (_total(products**2) - trace**2 / n)
        return np.maximum(shared, 0.0) + _total(self._twins * each**2)


def noise_of(component: Component, direction: int, rays: int) -> Paths | Batches | None:
    """How the noise of a sampled component hangs together in one direction.

    Parameters
    ----------
    component : goniosim.result.Component
    direction : int
    rays : int
        Traced from the direction.

    Returns
    -------
    Paths or Batches or None
        None if nothing tells: an estimator that kept no batches.
    """
    if component.estimator[direction] == "analog":
        return Paths(component.energy[direction], rays)
    if component.batches is None:
        return None
    return Batches(component.energy[direction], component.stderr[direction], component.batches[direction])


def sum_and_error(
    energy: np.ndarray, stderr: np.ndarray, noise: Paths | Batches | None
) -> tuple[np.ndarray, np.ndarray]:
    """Sum over all cells with its standard error.

    Parameters
    ----------
    energy, stderr : ndarray, shape (C, R, K)
    noise : Paths or Batches or None

    Returns
    -------
    value, stderr : ndarray, shape (C,)
        Without ``noise`` the cells are taken to be independent.
    """
    variance = _total(stderr**2)
    if noise is not None:
        variance = variance + noise.of_sum(np.ones(1))
    return _total(energy), np.sqrt(np.maximum(variance, 0.0))
