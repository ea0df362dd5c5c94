"""The comparison of published models with simulated slices: what `goniosim.compare` does."""

import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from numbers import Integral
from pathlib import Path
from typing import Any

from ..errors import ConfigError, UnusableResultError
from ..integration import Pool
from ..result import Result
from ..store import is_models_file, open_result
from ..writing import StrPath
from .material import MaterialComparison, compare_material
from .rows import error, label, material_rows
from .variants import check_request

MAX_SUBCELLS = 99

Source = Result | StrPath


@dataclass(frozen=True, eq=False)
class Comparison:
    """Models against the results of simulations.

    Attributes
    ----------
    materials : list of MaterialComparison
        One for each result, with the integrated slices.
    errors : list of dict
        The table of errors, with the keys of `goniosim.compare.rows.COLUMNS`.
    """

    materials: list[MaterialComparison]
    errors: list[dict[str, Any]]

    def __repr__(self) -> str:
        lines = [f"<Comparison with {_count(len(self.materials), 'material')}"]
        if self.materials:
            lines[0] += ": RMSE [sr^-1/2] over all directions, mean over the channels"
        for material in self.materials:
            found = [row for row in self.rows() if row["material"] == material.result.name]
            lines.append(f"  {material.result.name}, {material.components[0]}")
            lines += [f"    {label(row):<{max(map(len, map(label, found)))}}  {error(row)}" for row in found]
            lines += [f"    {name}: n/a, {reason}" for name, reason in material.not_applicable.items()]
        return "\n".join(lines) + ">"

    def rows(
        self, component: str | None = None, channel: str = "mean", theta_deg: float | str = "all"
    ) -> list[dict[str, Any]]:
        """Rows of the table in which a model applies.

        Parameters
        ----------
        component : str, optional
            The main component of each material by default.
        channel : str
        theta_deg : float or str

        Returns
        -------
        list of dict
        """
        main = {material.result.name: material.components[0] for material in self.materials}
        return [
            row
            for row in self.errors
            if row["component"] == (component or main[row["material"]])
            and row["channel"] == channel
            and row["theta_deg"] == theta_deg
            and row["note"] is None
        ]


def compare(
    results: Source | Iterable[Source],
    models: str | Sequence[str] | None = None,
    options: Mapping[str, Mapping[str, object]] | None = None,
    subcells: int = 5,
    *,
    allow_partial: bool = False,
) -> Comparison:
    """Compare published models with simulated slices.

    Each model is integrated over the very cells of the result, and its error is Eq. 4 of Bati et
    al. 2019 without the noise of the simulation.

    Parameters
    ----------
    results : Result, path, or iterable of them
        A path may be a result file or a folder of them. All their slices are kept in memory: give a
        large study piece by piece.
    models : str or sequence of str, optional
        Names from `goniosim.models.MODELS`; all by default.
    options : mapping of str to mapping, optional
        Options of models, as in ``{"ww09": {"masking": "correlated"}}``.
    subcells : int
        Sub-cells along each side of a cell.
    allow_partial : bool
        Accept results of interrupted simulations.

    Returns
    -------
    Comparison

    Raises
    ------
    ConfigError
        A model, an option or ``subcells`` is wrong.
    UnusableResultError
        A result is partial or empty, or two have the same name.
    ForeignFileError, DamagedFileError, NewerSchemaError
        A file is not a result that can be read.

    Examples
    --------
    >>> comparison = goniosim.compare(result, models=["ww09", "bati19_ww"])
    >>> comparison
    <Comparison with 1 material: RMSE [sr^-1/2] over all directions, mean over the channels
      coated, reflection/internal
        ww09       0.09536 ± 0.00080
        bati19_ww  0.0446 ± 0.0012>
    >>> [row["model"] for row in comparison.rows(theta_deg=60)]
    ['ww09', 'bati19_ww']
    """
    request = check_request([models] if isinstance(models, str) else models, options)
    check_subcells(subcells)
    found: list[Result | Path] = []
    for source in _sources(results):
        found += [source] if isinstance(source, Result) else result_files(source)[0]
    materials: list[MaterialComparison] = []
    with Pool() as pool:
        for each in found:
            result = each if isinstance(each, Result) else open_result(each)
            check_usable(result, allow_partial)
            if any(result.name == other.result.name for other in materials):
                raise UnusableResultError(
                    f"{result.name}: is the name of two results; rename one of them and simulate it anew"
                )
            materials.append(compare_material(result, request, subcells, pool))
    return Comparison(materials, [row for material in materials for row in material_rows(material)])


def _sources(results: object) -> list[Source]:
    kinds = (Result, str, os.PathLike)
    # A scene is a mapping, whose keys would pass for paths.
    single = isinstance(results, (*kinds, Mapping))
    given = list(results) if isinstance(results, Iterable) and not single else [results]
    if not given:
        raise ConfigError("there are no results to compare with")
    sources = [each for each in given if isinstance(each, kinds)]
    if len(sources) < len(given):
        raise ConfigError("what is compared must be results, or paths of result files or folders")
    return sources


def _count(number: int, what: str) -> str:
    return f"{number} {what}" + ("" if number == 1 else "s")


def check_subcells(subcells: int) -> None:
    """Raise a ConfigError if ``subcells`` is not a sensible number."""
    whole = isinstance(subcells, Integral) and not isinstance(subcells, bool)
    if not whole or not 1 <= subcells <= MAX_SUBCELLS:
        raise ConfigError(f"subcells must be a whole number from 1 to {MAX_SUBCELLS} [got {subcells!r}]")


def check_usable(result: Result, allow_partial: bool) -> None:
    """Raise an UnusableResultError if a result cannot be compared with.

    Parameters
    ----------
    result : goniosim.result.Result
    allow_partial : bool
    """
    if result.status == "partial" and not allow_partial:
        raise UnusableResultError(
            f"{result.name}: the simulation was interrupted (partial); finish it, or allow partial results"
        )
    if not (result.rays > 0).all():
        raise UnusableResultError(f"{result.name}: has incident directions without a single ray; simulate it again")


def result_files(path: StrPath) -> tuple[list[Path], list[Path]]:
    """Result files that a path stands for.

    Parameters
    ----------
    path : path-like
        A file, or a folder of which all ``*.h5`` are taken.

    Returns
    -------
    files : list of Path
    passed_over : list of Path
        Those in the folder that hold integrated models.

    Raises
    ------
    UnusableResultError
        A folder without result files.
    """
    path = Path(os.fspath(path))
    # Not `is_dir`, which fails on a name that is too long; a file that cannot be opened is explained by its reader.
    if not os.path.isdir(path):
        return [path], []
    found = sorted(path.glob("*.h5"))
    passed_over = [file for file in found if is_models_file(file)]
    files = [file for file in found if file not in passed_over]
    if not files:
        what = "files of integrated models and no result files" if passed_over else "no result files (*.h5)"
        raise UnusableResultError(f"{path}: holds {what}; give a folder of results")
    return files, passed_over
