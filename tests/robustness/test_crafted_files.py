"""Files whose digests are right and whose content is not: a stranger can write anything, and nothing comes of it."""

import re
import tracemalloc
import zlib

import h5py
import numpy as np
import pytest
from click.testing import CliRunner

from crafting import craft
from goniosim.errors import AnnotatedFileWarning, DamagedFileError
from goniosim.store import open_result, write_result
from synthetic import make_result

SLICE = (2, 3, 2, 4)
ENERGY = "reflection/internal/energy"


@pytest.fixture(scope="module")
def sound(tmp_path_factory):
    """Bytes of a sound result file."""
    path = tmp_path_factory.mktemp("sound") / "sound.h5"
    write_result(make_result(rows=2, columns=4, components=("reflection/direct", "reflection/internal")), path)
    return path.read_bytes()


@pytest.fixture
def path(tmp_path, sound, monkeypatch):
    """A sound result file in the working directory, to be edited and signed anew."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "r.h5").write_bytes(sound)
    return tmp_path / "r.h5"


def text(where, name, value):
    """Set a text attribute."""
    raw = value.encode()
    kind = h5py.string_dtype("utf-8", max(1, len(raw)))
    return lambda file: file[where].attrs.create(name, raw, dtype=kind)


def number(where, name, value):
    return lambda file: file[where].attrs.__setitem__(name, value)


def named(name):
    """Another name, in accord with the scene."""

    def edit(file):
        scene = file.attrs["config_yaml"].decode().replace("name: synthetic", f"name: {name!r}")
        text("/", "config_yaml", scene)(file)
        text("/", "name", name)(file)

    return edit


def scene(old, new):
    return lambda file: text("/", "config_yaml", file.attrs["config_yaml"].decode().replace(old, new))(file)


def values(where, change):
    def edit(file):
        file[where][...] = change(file[where][...])

    return edit


def replaced(where, make):
    """Another object in the place of a dataset: ``make(group, name)``."""

    def edit(file):
        folder, _, name = where.rpartition("/")
        del file[where]
        make(file[folder or "/"], name)

    return edit


def dataset(where, data=None, **options):
    return replaced(where, lambda group, name: group.create_dataset(name, data=data, **options))


def halved(*paths):
    def edit(file):
        for each in paths:
            file[each][...] = file[each][...] / 2

    return edit


def removed(*paths):
    def edit(file):
        for each in paths:
            del file[each]

    return edit


def virtual(group, name):
    layout = h5py.VirtualLayout(SLICE, "f8")
    layout[...] = h5py.VirtualSource("/etc/passwd", "data", SLICE)
    group.create_virtual_dataset(name, layout)


def bomb(group, name):
    """Chunks of 48 kB, as large as HDF5 lets them be, that would inflate to 48 MB."""
    made = group.create_dataset(
        name, SLICE, "f8", chunks=(1, 1, 2, 4), fletcher32=True, shuffle=True, compression=1, fillvalue=0.0
    )
    packer = zlib.compressobj(9)
    raw = b"".join([packer.compress(bytes(1 << 20)) for _ in range(48)] + [packer.flush()])
    for index in np.ndindex(2, 3):
        made.id.write_direct_chunk((*index, 0, 0), raw + bytes(4), 0)


HUGE = {"shape": (2, 3, 1 << 20, 1 << 20), "dtype": "f8", "chunks": (1, 1, 64, 64)}

CASES = {
    "name-up": (named("../../evil"), "name must be usable as a file name"),
    "name-absolute": (named("/abs/x"), "name must be usable as a file name"),
    "name-escape": (named("gold\x1b[2J"), "name must be usable as a file name"),
    "name-break": (named("gold\nsilver"), "name must be usable as a file name"),
    "name-empty": (named(""), "name must be usable as a file name"),
    "name-long": (named("x" * 300), "name must be usable as a file name"),
    "name-other": (text("/", "name", "gold"), "name must be that in config_yaml"),
    "name-number": (number("/", "name", np.int64(3)), "name must be usable as a file name"),
    "name-floating": (number("/", "name", 3.5), "name must be usable as a file name"),
    "name-variable": (number("/", "name", "synthetic"), "name must be usable as a file name"),
    "attribute-escape": (text("/", "a\x1b[2Jb", "x"), "must have a plain name"),
    "status": (text("/", "status", "banana"), "status must be complete or partial"),
    "target-reached": (number("/", "target_reached", np.uint64(2)), "target_reached must be 0 or 1, or absent"),
    "target-none": (
        number("/", "target_reached", np.uint64(1)),
        "target_reached must be there only if",
    ),
    "seed-text": (text("/", "seed", "1"), "seed must be a whole number"),
    "seed-other": (number("/", "seed", np.uint64(5)), "seed must be that in config_yaml"),
    "seed-huge": (number("/", "seed", np.uint64(2**64 - 1)), "seed must be that in config_yaml"),
    "seeds-merged": (text("/", "merged_seeds", "1; 2"), "merged_seeds must be whole numbers, or absent"),
    "estimator-name": (text("/", "estimator", "\x1b[2J"), "estimator must be a plain name"),
    "estimator-header": (text("/", "estimator", "split"), "the attribute estimator must be that of the components"),
    "hash": (text("/", "config_hash", "../x"), "config_hash must be 64 hexadecimal digits"),
    "version": (text("/", "schema_version", "one"), "schema_version must be MAJOR.MINOR"),
    "time": (number("/", "created_utc", np.int64(3)), "created_utc and goniosim_version must be texts"),
    "scene-broken": (text("/", "config_yaml", "material: [\x1b[2J"), "config_yaml"),
    "scene-empty": (text("/", "config_yaml", ""), "config_yaml:1: the file is empty"),
    "scene-wrong": (scene("eta: 1.5", "eta: banana"), "config_yaml:4: material"),
    "scene-grid": (scene("rows: 2", "rows: 20"), "has shape"),
    "scene-angles": (scene("[0.0, 60.0]", "[0.0, 61.0]"), "theta_deg must be the angles in config_yaml"),
    "scene-more-angles": (scene("[0.0, 60.0]", "[0.0, 60.0, 70.0]"), "incident/theta_deg has shape"),
    "scene-slices": (scene("classic", "half"), "cells/parametrization must be that in config_yaml"),
    "scene-transmits": (
        scene("{type: lambert, rho: 0.5}", "{type: dielectric, eta: 1.3, alpha: 0.1}"),
        "must be there",
    ),
    "scene-orders": (scene("seed: 1", "seed: 1, orders: 2"), "order_N must be there for sampled components"),
    "parametrization": (text("cells", "parametrization", "banana"), "cells/parametrization must be that"),
    "theta-100": (values("incident/theta_deg", lambda v: v + 100), "incident/theta_deg must be from 0 to below 90"),
    "theta-90": (values("incident/theta_deg", lambda v: v + 30), "incident/theta_deg must be from 0 to below 90"),
    "phi": (values("incident/phi_deg", lambda v: v + 360), "incident/phi_deg must be from 0 to below 360"),
    "rays-zero": (values("incident/rays", lambda v: 0 * v), "incident/rays must be those in config_yaml"),
    "rays-more": (values("incident/rays", lambda v: 2 * v), "incident/rays must be those in config_yaml"),
    "rays-negative": (values("incident/rays", lambda v: -v), "incident/rays must be finite and 0 or more"),
    "channel-escape": (dataset("channels/name", np.array([b"R", b"G", b"\x1b[2J"])), "channels/name must be"),
    "channel-twice": (dataset("channels/name", np.array([b"R", b"R", b"B"])), "channels/name must be different"),
    "channel-long": (dataset("channels/name", np.array([b"R" * 500, b"G", b"B"])), "channels/name must be"),
    "channel-longer": (dataset("channels/name", np.array([b"R" * 50_000, b"G", b"B"])), "channels/name has the type"),
    "channel-numbers": (dataset("channels/name", np.array([1.0, 2.0, 3.0])), "channels/name has the type float64"),
    "channel-variable": (dataset("channels/name", ["R", "G", "B"]), "channels/name has the type object"),
    "channels-two": (dataset("channels/name", np.array([b"R", b"G"])), "channels/name has shape"),
    "edges-reverse": (values("cells/row_edges", lambda v: v[::-1]), "cells/row_edges must go from 0 to 90"),
    "edges-short": (values("cells/column_edges", lambda v: v / 2), "cells/column_edges must go from 0 to 360"),
    "edges-far": (values("cells/column_edges", lambda v: v * 2), "cells/column_edges must be from 0 to 360"),
    "valid": (values("cells/valid", lambda v: v + 1), "cells/valid must be from 0 to 1"),
    "solid-angle": (values("cells/projected_solid_angle", lambda v: v * 2), "must sum to pi"),
    "nan": (values(ENERGY, lambda v: v * np.nan), f"{ENERGY} must be finite"),
    "infinite": (values("audit/absorbed_base", lambda v: v + np.inf), "audit/absorbed_base must be finite"),
    "negative": (values("reflection/direct/bsdf_stderr", lambda v: -v - 1), "direct/bsdf_stderr must be finite and 0"),
    "huge-number": (values(ENERGY, lambda v: v + 1e300), f"{ENERGY} must be finite and 0 or more, below 1e\\+100"),
    "huge-error": (values("audit/absorbed_base_stderr", lambda v: v + 1e308), "absorbed_base_stderr must be finite"),
    "huge-time": (values("cost/seconds", lambda v: v + 1e308), "cost/seconds must be finite"),
    "huge-geometry": (values("cells/projected_solid_angle", lambda v: v + 1e308), "projected_solid_angle must be fin"),
    "hits": (values("reflection/internal/hits", lambda v: -v - 1), "reflection/internal/hits must be from 0 to 1e"),
    "hits-more": (values("reflection/internal/hits", lambda v: v + (1 << 62)), "hits must be from 0 to 1e"),
    "energy-other": (values(ENERGY, lambda v: v / 2), "albedo be the sum of energy"),
    "albedo-other": (halved("reflection/internal/albedo", ENERGY), "energy must sum to what the audit says"),
    "albedo-missing": (removed("reflection/internal/albedo"), "albedo and albedo_stderr must be there"),
    "albedo-stderr": (values("reflection/internal/albedo_stderr", lambda v: -v), "albedo_stderr must be finite and 0"),
    "uncertain-missing": (removed("reflection/internal/uncertain"), "COMPONENT/uncertain must be there"),
    "uncertain-two": (values("reflection/internal/uncertain", lambda v: v + 2), "uncertain must be from 0 to 1"),
    "estimator-escape": (
        dataset("reflection/internal/estimator", np.array([b"analog", b"\x1b[2J"])),
        "be a plain name",
    ),
    "estimator-none": (removed("reflection/internal/estimator"), "estimator must be a plain name for each direction"),
    "estimator-other": (
        dataset("reflection/internal/estimator", np.array([b"analog", b"split"])),
        "hits must be there for components of independent paths, and only",
    ),
    "estimator-direct": (
        dataset("reflection/internal/estimator", np.array([b"analog", b"integrated"])),
        "`integrated` for reflection/direct alone",
    ),
    "bsdf-other": (values("reflection/direct/bsdf", lambda v: 2 * v), "bsdf must be the energy over the projected"),
    "stderr-other": (values("reflection/internal/stderr", lambda v: 2 * v), "bsdf must be the energy over the"),
    "valid-none": (values("cells/valid", lambda v: 0 * v), "bsdf must be .* and 0 elsewhere"),
    "solid-angle-zero": (values("cells/solid_angle", lambda v: 0 * v), "cells/solid_angle must sum to 2 pi"),
    "hits-missing": (removed("reflection/internal/hits"), "COMPONENT/hits must be there"),
    "audit": (values("audit/absorbed_base", lambda v: v + 0.01), "audit must sum to 1"),
    "audit-missing": (removed("audit/lost_roulette"), "audit/lost_roulette is missing"),
    "cost-back": (values("cost/seconds", lambda v: v[:, ::-1]), "cost must not decrease"),
    "cost-negative": (values("cost/cpu_seconds", lambda v: v - 1e9), "cost/cpu_seconds must be finite and 0"),
    "cost-endless": (
        dataset("cost/checkpoint", shape=(1 << 40,), dtype="i8", chunks=(1 << 20,)),
        "cost/checkpoint has shape|cost/rays has shape",
    ),
    "cost-error-missing": (removed("cost/error_reflection_internal"), "cost/error_SAMPLED must be there"),
    "effects-name": (number("effects", "\x1b]0;evil", np.int8(1)), "effects must have plain names"),
    "effects-escape": (number("effects", "\x1b]0;evil", np.int8(3)), r"the attribute \\x1b\]0;evil of /effects is 3"),
    "effects-number": (number("effects", "absorption", np.int8(7)), "absorption of /effects is 7"),
    "effects-missing": (removed("effects"), "effects is missing"),
    "delta": (number("reflection/direct", "contains_delta", np.int8(3)), "contains_delta of /reflection/direct is 3"),
    "no-direct": (removed("reflection/direct"), "must be there as the scene calls for them"),
    "no-internal": (removed("reflection/internal"), "must be there as the scene calls for them"),
    "no-cells": (removed("cells"), "cells is missing"),
    "no-scale-matters": (removed("cost"), "cost is missing"),
    "text": (dataset(ENERGY, np.full(SLICE, b"one")), f"{ENERGY} has the type"),
    "single": (dataset(ENERGY, np.zeros(SLICE, "f4")), f"{ENERGY} has the type float32"),
    "swapped": (dataset(ENERGY, np.zeros(SLICE, ">f8")), f"{ENERGY} has the type >f8"),
    "compound": (dataset(ENERGY, np.zeros(SLICE, "f8,f8")), f"{ENERGY} has the type"),
    "scalar": (dataset(ENERGY, 1.0), rf"{ENERGY} has shape \(\)"),
    "group": (replaced(ENERGY, lambda group, name: group.create_group(name)), f"{ENERGY} is not a dataset"),
    "type": (replaced(ENERGY, lambda group, name: group.__setitem__(name, np.dtype("f8"))), "neither a group nor"),
    "dataset-as-group": (dataset("cells", 1.0), "cells"),
    "huge": (dataset(ENERGY, **HUGE), f"{ENERGY} has shape"),
    "bomb": (replaced(ENERGY, bomb), "cannot be decompressed to 64 bytes"),
    "unwritten": (dataset(ENERGY, shape=SLICE, dtype="f8", chunks=(1, 1, 2, 4)), "stored as goniosim stores"),
    "filter": (dataset(ENERGY, np.zeros(SLICE), compression="lzf"), "not stored as goniosim stores them"),
    "external-link": (
        replaced(ENERGY, lambda g, n: g.__setitem__(n, h5py.ExternalLink("x.h5", "/a"))),
        "leads elsewhere",
    ),
    "soft-loop": (replaced(ENERGY, lambda g, n: g.__setitem__(n, h5py.SoftLink(f"/{ENERGY}"))), "leads elsewhere"),
    "group-elsewhere": (replaced("cells", lambda g, n: g.__setitem__(n, h5py.ExternalLink("x.h5", "/"))), "elsewhere"),
    "virtual": (replaced(ENERGY, virtual), "not in the file itself"),
    "external": (
        dataset(ENERGY, shape=SLICE, dtype="f8", external=[("/etc/passwd", 0, 384)]),
        "not in the file itself",
    ),
}


@pytest.mark.parametrize(("edit", "words"), CASES.values(), ids=CASES)
def test_each_is_refused_in_one_line(path, edit, words):
    craft(path, edit)
    with pytest.raises(DamagedFileError) as caught:
        open_result(path)
    assert re.search(words, str(caught.value)) and str(caught.value).startswith(f"{path}: ")
    assert "\n" not in str(caught.value)


BATCHES = "reflection/internal/batches"


@pytest.mark.parametrize(
    ("edit", "words"),
    [
        (values(BATCHES, lambda v: 1.5 * v), "COMPONENT/batches must be two or more, with the mean of them"),
        (values(BATCHES, lambda v: v * np.inf), f"{BATCHES} must be finite"),
        (dataset(BATCHES, np.zeros((2, 32, 3, 1, 1))), f"{BATCHES} has shape"),
        (dataset("batch", shape=(1 << 40,), dtype="i8", chunks=(1 << 20,)), f"{BATCHES} has shape"),
        (values("reflection/internal/node_bias", lambda v: -v), "node_bias must be finite and 0 or more"),
        (values("reflection/internal/paths", lambda v: v - 1), "COMPONENT/paths must be no fewer than incident/rays"),
        (dataset("reflection/internal/estimator", np.array([b"analog", b"split"])), "COMPONENT/batches must be two"),
        (lambda file: file["reflection/internal"].create_dataset("hits", data=[1]), None),
    ],
    ids=["mean", "infinite", "blocks", "endless", "bias", "paths", "analog", "added"],
)
def test_batches_belong_to_what_they_are_of(tmp_path, edit, words):
    """What was added without being announced is no part of the file."""
    path = tmp_path / "r.h5"
    components = ("reflection/direct", "reflection/internal")
    write_result(make_result(rows=2, columns=4, components=components, estimator="split"), path)
    if words is None:
        with h5py.File(path, "r+") as file:
            edit(file)
        with pytest.warns(AnnotatedFileWarning):
            assert open_result(path).components["reflection/internal"].hits is None
        return
    craft(path, edit)
    with pytest.raises(DamagedFileError, match=words):
        open_result(path)


@pytest.mark.parametrize("case", ["huge", "bomb", "cost-endless", "unwritten"])
def test_nothing_huge_is_allocated(path, case):
    """numpy and zlib tell `tracemalloc` what they take."""
    craft(path, CASES[case][0])
    tracemalloc.start()
    with pytest.raises(DamagedFileError):
        open_result(path)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 20e6


@pytest.mark.parametrize("case", ["name-up", "name-absolute", "name-escape", "scene-broken", "nan"])
def test_nothing_is_written(path, tmp_path, case):
    from goniosim_cli.main import main

    craft(path, CASES[case][0])
    before = {each: each.read_bytes() for each in tmp_path.rglob("*.h5")}
    for arguments in (
        ["info", "r.h5"],
        ["plot", "r.h5", "-o", "out"],
        ["compare", "r.h5", "-o", "out", "--figures", "none"],
    ):
        outcome = CliRunner().invoke(main, arguments)
        assert (outcome.exit_code, outcome.stdout) == (6, ""), outcome.stderr
        assert outcome.stderr.startswith("goniosim: error: r.h5: ") and outcome.stderr.count("\n") == 1
        assert outcome.stderr[:-1].isprintable()
    assert {each: each.read_bytes() for each in tmp_path.rglob("*") if each.is_file()} == before


def test_a_traceback_is_shown_harmless_too(path):
    from goniosim_cli.main import main

    craft(path, CASES["effects-escape"][0])
    with pytest.raises(DamagedFileError) as caught:
        open_result(path)
    assert str(caught.value).isprintable()
    outcome = CliRunner().invoke(main, ["info", "r.h5", "--debug"])
    assert outcome.exit_code == 6 and outcome.stderr.startswith("Traceback")
    assert "\\x1b]0;evil" in outcome.stderr and outcome.stderr.replace("\n", "").isprintable()


def test_texts_that_are_free_are_shown_harmless_and_short(path):
    from goniosim_cli.main import main

    craft(path, text("/", "processor", "\x1b[2J\x9b1m" + "very fast\n" * 1000))
    outcome = CliRunner().invoke(main, ["info", "r.h5"])
    (line,) = [line for line in outcome.stdout.splitlines() if "processor" in line]
    assert outcome.exit_code == 0 and "\\x1b[2J\\x9b1mvery fast\\nvery" in line and len(line) < 350
    assert outcome.stdout.replace("\n", "").isprintable()
    outcome = CliRunner().invoke(main, ["info", "r.h5", "--json"])
    assert outcome.exit_code == 0 and outcome.stdout.replace("\n", "").isprintable()


def test_the_name_of_a_file_is_shown_harmless(path):
    from goniosim_cli.main import main

    path.rename(path.with_name("r\x1b[2J\n.h5"))
    shown = "r\\x1b[2J\\n.h5"
    outcome = CliRunner().invoke(main, ["info", "r\x1b[2J\n.h5"])
    assert outcome.exit_code == 0 and outcome.stdout.startswith(f"{shown}  (")
    outcome = CliRunner().invoke(main, ["info", "s\x1b[2J\n.h5"])
    assert outcome.exit_code == 5 and outcome.stderr.startswith("goniosim: error: s\\x1b[2J\\n.h5: no such file")
    outcome = CliRunner().invoke(main, ["plot", "r\x1b[2J\n.h5", "--theta", "60", "--format", "svg"])
    assert outcome.exit_code == 0 and outcome.stdout == "r\\x1b[2J\\n-theta_60.svg\n"
