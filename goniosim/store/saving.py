"""Putting a result onto the disk, whole or not at all, and in place of nothing that is worth more."""

from goniosim.errors import FewerRaysError, OutputError
from goniosim.result import Result
from goniosim.store.keeping import check_replacement, refuse_newer
from goniosim.store.output import Reservation, rescue, reserve_output
from goniosim.store.writer import encode
from goniosim.writing import StrPath


def write_result(
    result: Result,
    path: StrPath,
    *,
    overwrite: bool = False,
    reservation: Reservation | None = None,
    rescued: bool = True,
) -> None:
    """Write a result file, whole or not at all.

    Parameters
    ----------
    result : Result
    path : path-like
        An earlier result there is replaced if it is one of the same scene without more rays, or damaged.
    overwrite : bool
        Replace any result.
    reservation : Reservation, optional
        Of the same path, made by `reserve_output` before the computation.
        It is used up.
    rescued : bool
        Whether a result that cannot be written is saved in the temporary directory instead.

    Raises
    ------
    FewerRaysError
        If the file has more rays of the same scene.
    OutputError
        If the file cannot be written there, or holds the result of another
        scene; the message says where a rescued result was saved.
    ValueError
        If the result contradicts the schema (a NaN, a wrong shape): a fault
        of the program.
    """
    parts = encode(result)

    def check() -> None:
        refuse_newer(path) if overwrite else check_replacement(path, result)

    try:
        if reservation is None:
            reservation = reserve_output(path, sum(map(len, parts)))
        with reservation:
            reservation.commit(parts, check)
    except FewerRaysError:
        raise
    except OutputError as error:
        if not rescued:
            raise
        raise OutputError(f"{error}; {rescue(parts, path)}") from error
