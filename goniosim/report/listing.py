"""Many result files at a glance, from what stands at their head."""

import os
from pathlib import Path

from ..errors import ConfigError, DamagedFileError, ForeignFileError, GoniosimError, UnusableResultError
from ..scene import Target, parse_scene
from ..store import is_models_file, read_header
from . import text

MANY = 4


def listing(paths):
    """Look at the heads of result files; slices are neither read nor checked.

    Parameters
    ----------
    paths : sequence of path-like
        Files, and folders of which all ``*.h5`` are taken.

    Returns
    -------
    entries : list of dict
        Plain data that JSON can hold: ``file``, ``kind`` (``result``, ``models``, ``other`` or ``unreadable``),
        ``bytes``; of a result also ``name``, ``status``, what was asked for (``rays`` per direction or ``target``,
        None for the other; ``estimator``), ``theta_deg``, ``slice``, ``seed`` and ``created_utc``; of what is not a
        sound result, ``message``.
    errors : list of GoniosimError
        Of the files that cannot be read, and of those that were named and are none of ours.

    Raises
    ------
    UnusableResultError
        A folder without such files.
    """
    entries, errors = [], []
    for path in paths:
        folder = os.path.isdir(path)
        files = sorted(Path(path).glob("*.h5")) if folder else [path]
        if not files:
            raise UnusableResultError(f"{path}: holds no result files (*.h5); give a folder of results")
        for file in files:
            try:
                entries.append(_entry(file))
            except GoniosimError as error:
                # A folder may hold other things; what was named has to be what it was named for.
                other = folder and isinstance(error, ForeignFileError)
                kind = "other" if other else "unreadable"
                entries.append({"file": str(file), "kind": kind, "bytes": _size(file), "message": str(error)})
                if not other:
                    errors.append(error)
    return entries, errors


def description(entries):
    """Lay out what `listing` found.

    Parameters
    ----------
    entries : list of dict

    Returns
    -------
    str
        A table of the results; below it a line for each other file of ours or of others.
    """
    results = [entry for entry in entries if entry["kind"] == "result"]
    header = ["file", "status", "asked for\nper direction", "theta\n[deg]", "slices", "written [UTC]", "size"]
    lines = text.table(header, map(_row, results)) if results else []
    partial = sum(entry["status"] == "partial" for entry in results)
    size = text.size(sum(entry["bytes"] for entry in results))
    number = f"{len(results)} result{'' if len(results) == 1 else 's'}"
    lines.append(f"  {number}, {size}" + (f"; {partial} partial, with less than asked for" if partial else ""))
    if results:
        lines.append("  From the headers alone; `goniosim info FILE` checks every byte.")
    lines += [f"  {entry['message']}" for entry in entries if entry["kind"] in ("models", "other")]
    return "\n".join(lines)


def _entry(path):
    known = {"file": str(path), "bytes": _size(path)}
    if is_models_file(path):
        return {**known, "kind": "models", "message": f"{path}: holds integrated models: goniosim info {path}"}
    header = read_header(path)
    try:
        scene = parse_scene(header["config_yaml"], "config_yaml")
        return {
            **known,
            "kind": "result",
            **{key: header[key] for key in ("name", "status", "seed", "created_utc")},
            # Before files said so, all of them were of independent paths.
            "estimator": header.get("estimator", "analog"),
            **scene.simulation.model_dump(include={"rays", "target"}),
            "theta_deg": list(scene.incident.theta_deg),
            "slice": scene.slice.model_dump(),
        }
    except (ConfigError, LookupError, TypeError) as error:
        raise DamagedFileError(f"{path}: says what no result can say: {str(error).splitlines()[0]}") from error


def _size(path):
    return os.path.getsize(path) if os.path.isfile(path) else 0


def _row(entry):
    angles = entry["theta_deg"]
    shown = [text.degrees(angle) for angle in angles]
    name = os.path.basename(entry["file"])
    return [
        name if name == f"{entry['name']}.h5" else f"{name} ({entry['name']})",
        entry["status"],
        f"{text.count(entry['rays'])} rays" if entry["target"] is None else str(Target(**entry["target"])),
        ", ".join(shown) if len(angles) < MANY else f"{len(angles)}: {shown[0]} to {shown[-1]}",
        "{parametrization}, {rows} x {columns}".format(**entry["slice"]),
        str(entry["created_utc"])[:16].replace("T", " "),
        text.size(entry["bytes"]),
    ]
