"""How large a result file will be."""

# Measured on 90 x 360 cells of rough plastics with 1e6 and 1e7 rays (shuffle, gzip 1): the mantissas of
# Monte Carlo noise do not compress, so a float64 takes 6.4 to 6.8 bytes, and a hit count 0.7 to 1.1.
# Counts grow by a byte per factor 256 in the number of rays. Empty cells take next to nothing.
_BYTES_PER_FLOAT = 7.2
_BYTES_PER_COUNT = 2.0
# If every other cell is uncertain, at random.
_BYTES_PER_FLAG = 0.21
# Measured on slices of a single cell.
_BYTES_PER_GROUP = 13_000
_BYTES_OF_THE_REST = 45_000


def predicted_size(
    directions: int,
    channels: int,
    rows: int,
    columns: int,
    n_components: int,
    n_orders: int = 0,
    parametrization: str = "half",
) -> int:
    """Upper estimate of the size of a result file.

    Within 25 % of the size if nearly every cell is hit; narrow lobes leave
    most cells empty, and the file gets much smaller.

    Parameters
    ----------
    directions, channels, rows, columns : int
        Shape of the slices: M, C, R, K.
    n_components : int
        Components of the scene, 1 to 3.
    n_orders : int, optional
        Orders in the file, all components together.
    parametrization : str, optional
        The solid angles of ``classic`` slices repeat themselves and compress
        to nothing, those of ``half`` slices do not.

    Returns
    -------
    int
        Bytes.
    """
    cells = directions * rows * columns
    groups = n_components + n_orders
    slices = groups * cells * (channels * (4 * _BYTES_PER_FLOAT + _BYTES_PER_FLAG) + _BYTES_PER_COUNT)
    geometry = 0 if parametrization == "classic" else 2 * cells * _BYTES_PER_FLOAT
    return int(slices + geometry + groups * _BYTES_PER_GROUP + _BYTES_OF_THE_REST)
