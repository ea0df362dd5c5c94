"""Which shard is meant: `3/16`, or `auto/16` in a task of a job array."""

import os
import re
from collections.abc import Mapping

from goniosim.errors import ConfigError, RefusalError

VARIABLE = "SLURM_ARRAY_TASK_ID"
_FORM = re.compile(r"(auto|\d{1,7})(?:/(\d{1,7}))?", re.ASCII)


def parse_shard(text: str, planned: int | None = None, environment: Mapping[str, str] = os.environ) -> tuple[int, int]:
    """Number and count of a shard.

    Parameters
    ----------
    text : str
        ``k/n`` with k from 1 to n; or ``auto`` in the place of k, for the number of the task of a Slurm array.
    planned : int, optional
        The count that a plan says, where the text says none.
    environment : mapping of str to str

    Returns
    -------
    int, int

    Raises
    ------
    ConfigError
        If it is no such text, or contradicts the plan.
    RefusalError
        If there is no task of an array.
    """
    match = _FORM.fullmatch(text)
    if match is None:
        raise ConfigError(f"--shard must be k/n, such as 3/16, or auto/16 in a task of a job array [got {text!r}]")
    count = planned if match[2] is None else int(match[2])
    if count is None:
        # Not from the size of the array: one that reruns two missing tasks has a size of 2.
        raise ConfigError(f"--shard {text}: how many shards are there? Write {text}/16, or make a plan first")
    number = _task(environment) if match[1] == "auto" else int(match[1])
    if not 1 <= number <= count:
        also = f" (from {VARIABLE})" if match[1] == "auto" else ""
        raise ConfigError(f"--shard must be from 1/{count} to {count}/{count} [got {number}/{count}{also}]")
    return number, count


def _task(environment: Mapping[str, str]) -> int:
    found = environment.get(VARIABLE, "")
    if not found.isascii() or not found.isdigit():
        what = f"is {found!r}" if found else "is not set"
        raise RefusalError(
            f"--shard auto: {VARIABLE} {what}: this is no task of a Slurm array; submit it with sbatch --array=1-16, "
            "or name the shard, such as --shard 3/16"
        )
    return int(found)


def array_list(numbers: list[int]) -> str:
    """Numbers as a job array takes them: ``2,5-7``."""
    parts: list[list[int]] = []
    for number in sorted(set(numbers)):
        if parts and parts[-1][1] == number - 1:
            parts[-1][1] = number
        else:
            parts.append([number, number])
    return ",".join(str(first) if first == last else f"{first}-{last}" for first, last in parts)
