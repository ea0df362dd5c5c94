"""From a result file back to a result in memory; every way in which a file can be wrong has its own error."""

import re
from collections.abc import Callable
from typing import Any

import h5py

from goniosim.result import AUDIT_ENTRIES, Audit, Component, Cost, Result
from goniosim.scene import Scene
from goniosim.store import access, validation
from goniosim.store.decoding import cells, shaped, values
from goniosim.store.earlier import Earlier
from goniosim.store.kinds import RESULT
from goniosim.store.layout import COMPONENTS, NOT_PROVENANCE, describe
from goniosim.store.manifest import Manifest, NoManifest
from goniosim.store.opening import decoding, opened, written_by
from goniosim.writing import StrPath

Ours = Manifest | NoManifest

_ORDER = re.compile(r"order_(\d{1,3})(?:_and_more)?", re.ASCII)


def open_result(path: StrPath) -> Result:
    """Read a result file and check every byte of it.

    Warns with `goniosim.errors.AnnotatedFileWarning` if something was added to the file after it was written.

    Parameters
    ----------
    path : path-like

    Returns
    -------
    Result

    Raises
    ------
    ForeignFileError
        If the file is missing or is not a goniosim result.
    DamagedFileError
        If it was truncated or altered since it was written, or says what no result can say.
    NewerSchemaError
        If its major schema version is newer than this goniosim reads.
    UnusableResultError
        If it is a file of integrated models: `goniosim.store.open_models` reads those.

    Examples
    --------
    >>> goniosim.open_result("result.h5").status
    'complete'
    """
    with opened(path, RESULT) as (file, ours), decoding(path, RESULT.remedy):
        header = _header(file, ours)
        with written_by(str(header["schema_version"]), path, RESULT):
            return _result(file, ours, header)


def read_header(path: StrPath) -> dict[str, str | int]:
    """Read the root attributes of a result file, without its data.

    The attributes are checked against their digest and the file against its
    length; damage elsewhere is left for `open_result` to find.

    Parameters
    ----------
    path : path-like

    Returns
    -------
    dict of str to str or int
        ``name``, ``status``, ``seed``, ``config_yaml``, ``schema_version``, ...

    Raises
    ------
    ForeignFileError, DamagedFileError, NewerSchemaError, UnusableResultError
        As `open_result`.
    """
    with opened(path, RESULT, whole=False) as (file, ours), decoding(path, RESULT.remedy):
        return _header(file, ours)


def read_state(path: StrPath) -> bytes | None:
    """Read what an interrupted run goes on from; every byte of the file is checked.

    Parameters
    ----------
    path : path-like

    Returns
    -------
    bytes or None
        As `goniosim.engine.simulate` takes it; None if the file has none.

    Raises
    ------
    ForeignFileError, DamagedFileError, NewerSchemaError, UnusableResultError
        As `open_result`.
    """
    with opened(path, RESULT) as (file, ours), decoding(path, RESULT.remedy):
        return _state(file, ours)


def read_scene(path: StrPath) -> Scene:
    """Read the scene of a result file, without its data.

    Parameters
    ----------
    path : path-like

    Returns
    -------
    goniosim.scene.Scene

    Raises
    ------
    ForeignFileError, DamagedFileError, NewerSchemaError, UnusableResultError
        As `open_result`.
    """
    with opened(path, RESULT, whole=False) as (file, ours), decoding(path, RESULT.remedy):
        header = _header(file, ours)
        with written_by(str(header["schema_version"]), path, RESULT):
            return validation.scene_of(str(header["config_yaml"]))


def _state(file: h5py.File, ours: Ours) -> bytes | None:
    if not ours.has("state"):
        return None
    entry = describe("state")
    found: bytes = values(shaped(file, "state", entry, {}), entry)
    return found


def _header(file: h5py.File, ours: Ours) -> dict[str, str | int]:
    header = {name: access.attribute(file, name) for name in ours.attributes("")}
    validation.check(validation.HEADER, header)
    return header


def _result(file: h5py.File, ours: Ours, header: dict[str, Any]) -> Result:
    scene = validation.scene_of(header["config_yaml"])
    validation.check(validation.HEADER_AND_SCENE, header, scene)
    earlier = Earlier(header)
    sizes = {**validation.sizes_of(scene), **_sizes(file, ours, earlier)}

    def read(path: str) -> Any:
        entry = earlier.describe(path)
        return values(shaped(file, path, entry, sizes), entry)

    effects = access.group(file, "effects")
    result = Result(
        config_yaml=header["config_yaml"],
        config_hash=header["config_hash"],
        name=header["name"],
        status=header["status"],
        seed=header["seed"],
        theta_deg=read("incident/theta_deg"),
        phi_deg=read("incident/phi_deg"),
        rays=read("incident/rays"),
        channels=read("channels/name"),
        cells=cells(file, read),
        components={path: _component(file, ours, path, read) for path in COMPONENTS if ours.has(path)},
        audit=Audit(
            energy={entry: read(f"audit/{entry}") for entry in AUDIT_ENTRIES},
            stderr={entry: read(f"audit/{entry}_stderr") for entry in AUDIT_ENTRIES},
            direct_integrated=read("audit/direct_integrated"),
            direct_integrated_stderr=read("audit/direct_integrated_stderr"),
            rays=read("audit/rays") if ours.has("audit/rays") else None,
        ),
        cost=_cost(ours, read),
        effects={name: access.flag(effects, name) for name in ours.attributes("effects")},
        provenance={
            name: value for name, value in header.items() if name not in NOT_PROVENANCE and isinstance(value, str)
        },
        target_reached=bool(header["target_reached"]) if "target_reached" in header else None,
        state=_state(file, ours),
    )
    validation.check(validation.GEOMETRY, result, scene)
    earlier.complete(result)
    validation.check(validation.RESULT, result, scene)
    validation.check(validation.HEADER_AND_RESULT, header, result)
    return result


def _sizes(file: h5py.File, ours: Ours, earlier: Earlier) -> dict[str, int]:
    """Lengths of the dimensions that the scene does not determine."""
    limits = {"checkpoint": (earlier.checkpoints, validation.MAX_CHECKPOINTS)}
    if ours.has("batch"):
        limits["batch"] = ("batch", validation.MAX_BATCHES)
    # Of something larger the shape is refused.
    return {dim: min(access.dataset(file, path).size or 0, most) for dim, (path, most) in limits.items()}


def _component(file: h5py.File, ours: Ours, path: str, read: Callable[[str], Any]) -> Component:
    orders = sorted((int(match[1]), match[0]) for match in map(_ORDER.fullmatch, ours.members(path)) if match)

    def there(name: str) -> Any:
        return read(f"{path}/{name}") if ours.has(f"{path}/{name}") else None

    return Component(
        energy=read(f"{path}/energy"),
        stderr=read(f"{path}/stderr"),
        bsdf=read(f"{path}/bsdf"),
        bsdf_stderr=read(f"{path}/bsdf_stderr"),
        hits=there("hits"),
        uncertain=there("uncertain"),
        albedo=there("albedo"),
        albedo_stderr=there("albedo_stderr"),
        estimator=there("estimator") or [],
        node_bias=there("node_bias"),
        batches=there("batches"),
        paths=there("paths"),
        replicates=there("replicates"),
        contains_delta=access.flag(access.group(file, path), "contains_delta"),
        orders={name: _component(file, ours, f"{path}/{name}", read) for _, name in orders},
    )


def _cost(ours: Ours, read: Callable[[str], Any]) -> Cost:
    errors = {component: f"cost/error_{component.replace('/', '_')}" for component in COMPONENTS}
    return Cost(
        rays=read("cost/rays"),
        seconds=read("cost/seconds"),
        cpu_seconds=read("cost/cpu_seconds"),
        error={component: read(path) for component, path in errors.items() if ours.has(path)},
    )
