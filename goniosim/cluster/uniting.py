"""Results of the same scene and different seeds joined to a better one."""

import threading
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from goniosim.cluster.claimed import claimed
from goniosim.engine import seeds_of, unite
from goniosim.errors import UnusableResultError
from goniosim.result import Result
from goniosim.scene import Scene, differences, with_arguments
from goniosim.store import open_result, read_header, read_scene, write_result
from goniosim.writing import StrPath, explained, make_folder


def merge_results(paths: Sequence[StrPath], out: StrPath, *, overwrite: bool = False) -> Result:
    """Join results into one whose light paths are those of all of them.

    Everything is looked at before anything is joined.

    Parameters
    ----------
    paths : sequence of path-like
        Two result files or more, finished or not, in any order.
    out : path-like
        Result file.
    overwrite : bool
        Replace the result of another scene, or with more rays.

    Returns
    -------
    Result
        See `goniosim.engine.unite`.

    Raises
    ------
    UnusableResultError
        If they are of different scenes, have a seed in common, or were made by different estimators or versions.
    OutputError
        If the file cannot be written.
    """
    ordered = _sorted_out(paths)
    result = open_result(ordered[0])
    for path in ordered[1:]:
        other = open_result(path)
        try:
            result = unite(result, other)
        except UnusableResultError as error:
            raise UnusableResultError(f"{path}: cannot be merged: {error}") from error
    make_folder(Path(out).parent)
    with explained(out), claimed(Path(out), threading.Event()):
        write_result(result, out, overwrite=overwrite, rescued=False)
    return result


def _sorted_out(paths: Sequence[StrPath]) -> list[Path]:
    """The files by their seeds: so their order is of no account."""
    places = [Path(path) for path in paths]
    headers: list[Any] = [read_header(path) for path in places]
    scenes = [read_scene(path) for path in places]
    held: dict[int, Path] = {}
    wrong = []
    for path, header, scene in zip(places, headers, scenes, strict=True):
        if found := differences(_sown(scene, scenes[0]), scenes[0]):
            wrong.append(f"{path}: its scene is not that of {places[0]}: {'; '.join(found)}")
        for seed in seeds_of(int(header["seed"]), header):
            if seed in held:
                wrong.append(f"{path}: has seed {seed} in common with {held[seed]}, so that they are not independent")
            held.setdefault(seed, path)
    if wrong:
        raise UnusableResultError(
            "nothing was merged: it takes results of the same scene, simulated with a different --seed each", wrong
        )
    return [path for _, path in sorted(zip((header["seed"] for header in headers), places, strict=True))]


def _sown(scene: Scene, other: Scene) -> Scene:
    return with_arguments(scene, {"seed": other.simulation.seed})
