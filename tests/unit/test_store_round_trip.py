"""What is written is what is read."""

import dataclasses
import threading
import time

import h5py
import numpy as np
import pytest

from goniosim.result import AUDIT_ENTRIES
from goniosim.store import chunks, open_result, predicted_size, read_header, write_result
from goniosim.store.checksums import fletcher32
from goniosim.store.writer import encode
from synthetic import make_result


def assert_same(one, other, where="result"):
    """Equality of everything: types, shapes, dtypes, values to the last bit, keys of dictionaries."""
    assert type(one) is type(other), where
    if dataclasses.is_dataclass(one):
        for field in dataclasses.fields(one):
            assert_same(getattr(one, field.name), getattr(other, field.name), f"{where}.{field.name}")
    elif isinstance(one, dict):
        assert one.keys() == other.keys(), where
        for key in one:
            assert_same(one[key], other[key], f"{where}[{key}]")
    elif isinstance(one, np.ndarray):
        assert one.dtype == other.dtype, where
        np.testing.assert_array_equal(one, other, err_msg=where)
    else:
        assert one == other, where


@pytest.mark.parametrize(
    "options",
    [
        {},
        {"orders": 11, "parametrization": "half"},
        {"components": ("reflection/direct", "reflection/internal"), "channels": ("赤", "vert", "b l u e")},
        {"components": ("reflection/direct",), "status": "partial", "seed": 2**63 - 1},
        {"theta_deg": [30.0], "rows": 1, "columns": 1},
        {"orders": 2, "rows": 20, "columns": 37, "estimator": {"transmission": "split"}},
        {"target": "{relative_error: 1%, of: cells}", "target_reached": True},
        {"target": "{relative_error: 1%}, max_rays: 1e5", "target_reached": False},
    ],
    ids=["full", "orders", "channels", "partial", "one-cell", "batches", "reached", "missed"],
)
def test_everything_comes_back(tmp_path, options):
    """Eleven orders, because the names of order 10 and order 2 sort differently as text."""
    written = make_result(**options)
    write_result(written, tmp_path / "result.h5")
    read = open_result(tmp_path / "result.h5")
    assert_same(written, read)
    for path, component in written.components.items():
        assert list(component.orders) == list(read.components[path].orders)
    assert list(read.components) == list(written.components)
    assert list(read.audit.energy) == list(AUDIT_ENTRIES)


def test_without_a_checkpoint(tmp_path):
    """A run stopped at once has an empty cost table."""
    written = make_result(status="partial")
    empty = np.empty((2, 0))
    written.cost = dataclasses.replace(
        written.cost,
        rays=empty,
        seconds=empty,
        cpu_seconds=empty,
        error={"reflection/internal": empty, "transmission": empty},
    )
    write_result(written, tmp_path / "result.h5")
    assert_same(written, open_result(tmp_path / "result.h5"))


TEXTS = {"empty": "", "unicode": "é µ 漆 🎨\n\ttabbed", "long": "x: 1\n" * 50_000}


@pytest.mark.parametrize("text", TEXTS.values(), ids=TEXTS.keys())
def test_any_text_comes_back(tmp_path, text):
    """250 kB do not fit into an ordinary HDF5 attribute of 64 kB."""
    written = make_result()
    written.provenance["command"] = text
    write_result(written, tmp_path / "result.h5")
    assert_same(written, open_result(tmp_path / "result.h5"))
    assert read_header(tmp_path / "result.h5")["command"] == text


def test_text_that_is_not_unicode_does_not_stop_the_writing(tmp_path):
    """A file name from the shell may hold stray bytes, which Python shows as lone surrogates."""
    result = make_result()
    result.provenance["command"] = "simulate caf\udce9.yaml"
    write_result(result, tmp_path / "result.h5")
    assert open_result(tmp_path / "result.h5").provenance["command"] == "simulate caf\\udce9.yaml"
    assert read_header(tmp_path / "result.h5")["command"] == "simulate caf\\udce9.yaml"


def test_header(tmp_path):
    result = make_result(status="partial", seed=7)
    write_result(result, tmp_path / "result.h5")
    assert read_header(tmp_path / "result.h5") == {
        "filetype": "goniosim-result",
        "schema_version": "1.4",
        "config_yaml": result.config_yaml,
        "config_hash": result.config_hash,
        "seed": 7,
        "status": "partial",
        "name": "synthetic",
        "estimator": "analog",
        **result.provenance,
    }


def test_same_result_same_bytes():
    """No clock goes in; HDF5 counts time in whole seconds."""
    first = encode(make_result(orders=2))
    time.sleep(1.1)
    assert encode(make_result(orders=2)) == first


def test_different_results_different_digests():
    assert encode(make_result(seed=1))[1] != encode(make_result(seed=2))[1]


def test_the_file_begins_with_the_signature_of_hdf5(tmp_path):
    """So whatever sniffs, such as xarray, `file` and h5ls, recognises it; the seal comes soon after."""
    write_result(make_result(), tmp_path / "result.h5")
    content = (tmp_path / "result.h5").read_bytes()
    assert content.startswith(b"\x89HDF\r\n\x1a\n") and b"".join(encode(make_result())) == content
    assert content.index(b"goniosim result, schema 1.4") + 512 <= 8192


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_numbers_that_are_not_finite_are_refused(tmp_path, value):
    result = make_result()
    result.components["reflection/internal"].stderr[1, 2, 3, 4] = value
    with pytest.raises(ValueError, match="reflection/internal/stderr holds NaN or infinity"):
        write_result(result, tmp_path / "result.h5")
    assert list(tmp_path.iterdir()) == []


def test_contradictions_are_refused():
    """Each of these is a fault of the program: it must not reach a file."""
    wrong_shape = make_result()
    wrong_shape.cells.valid = wrong_shape.cells.valid[:1]
    wrong_type = make_result()
    wrong_type.rays = wrong_type.rays + 0.5
    wrong_component = make_result()
    wrong_component.components["reflection/diffuse"] = wrong_component.components.pop("transmission")
    wrong_order = make_result(orders=2)
    orders = wrong_order.components["transmission"].orders
    orders["second"] = orders.pop("order_2")
    wrong_status = make_result(status="done")
    no_time = make_result()
    del no_time.provenance["created_utc"]
    clash = make_result()
    clash.provenance["seed"] = "1"
    for result, message in [
        (wrong_shape, "cells/valid has shape"),
        (wrong_type, "Cannot cast"),
        (wrong_component, "no component reflection/diffuse"),
        (wrong_order, "no dataset transmission/second/energy"),
        (wrong_status, "status is 'done'"),
        (no_time, "lacks .'created_utc'"),
        (clash, "reserved names .'seed'"),
    ]:
        with pytest.raises((ValueError, TypeError, KeyError), match=message):
            encode(result)


@pytest.mark.parametrize("parametrization", ["classic", "half"])
@pytest.mark.parametrize("orders", [0, 2])
def test_predicted_size(parametrization, orders):
    """An upper estimate, and not more than 25 % above the size when nearly every cell is hit.

    The numbers are Monte Carlo-like noise. Solid angles that vary from cell to cell stand for
    those of half slices.
    """
    components = ("reflection/direct", "reflection/internal")
    result = make_result(
        [30.0],
        rows=90,
        columns=360,
        rays=10_000_000,
        parametrization=parametrization,
        orders=orders,
        components=components,
    )
    if parametrization == "half":
        varied = np.random.default_rng(1).uniform(1, 2, (2, *result.cells.valid.shape))
        result.cells.solid_angle, result.cells.projected_solid_angle = varied
    groups = sum(len(component.orders) for component in result.components.values())
    assert groups == orders
    predicted = predicted_size(1, 3, 90, 360, len(components), groups, parametrization)
    size = sum(map(len, encode(result)))
    assert size <= predicted <= 1.25 * size


def test_every_dataset_is_protected(tmp_path):
    """Chunked with checksum, shuffle and compression, whatever the dataset."""
    write_result(make_result(orders=2), tmp_path / "result.h5")
    unprotected = []

    def look(path, node):
        if isinstance(node, h5py.Dataset) and not path.startswith("checksums/"):
            filters = (node.fletcher32, node.shuffle, node.compression)
            if filters != (True, True, "gzip"):
                unprotected.append(path)

    with h5py.File(tmp_path / "result.h5") as file:
        file.visititems(look)
        assert file["reflection/internal/energy"].chunks == (1, 1, 6, 8)
    assert unprotected == []


@pytest.mark.parametrize("words", [[0xFFFF, 0, 0, 0], [0, 0, 0, 0xFFFF], [0xFFFE, 0, 0, 1], [1, 2, 3, 4]])
def test_hdf5_accepts_checksums_that_came_round(words):
    """Of sums that are a multiple of 65535, which ones' complement calls by two names."""
    raw = np.array(words, ">u2").tobytes()
    with h5py.File("memory", "w", driver="core", backing_store=False) as file:
        dataset = file.create_dataset("values", len(raw), np.uint8, chunks=(len(raw),), fletcher32=True)
        dataset.id.write_direct_chunk((0,), raw + chunks.checksum(raw))
        assert dataset[()].tobytes() == raw


def test_checksums_of_many_words_are_those_of_a_loop(monkeypatch):
    monkeypatch.setattr("goniosim.store.checksums._BLOCK", 7)
    raw = np.random.default_rng(1).bytes(1001)
    low = high = 0
    for word in np.frombuffer(raw + b"\0", ">u2").tolist():
        low = (low + word) % 65535
        high = (high + low) % 65535
    assert fletcher32(raw) == (low, high)


def test_bytes_do_not_depend_on_threads(monkeypatch):
    """Slices that are worth threads, and where the system starts none."""
    values = np.random.default_rng(1).gamma(1.0, size=(2, 3, 90, 360))

    def written():
        with h5py.File("memory", "w", driver="core", backing_store=False) as file:
            dataset = file.create_dataset(
                "values", values.shape, values.dtype, chunks=(1, 1, 90, 360), **chunks.FILTERS
            )
            chunks.write(dataset, values)
            np.testing.assert_array_equal(dataset[()], values)
            return file.id.get_file_image()

    def refuse(*_):
        raise RuntimeError("can't start new thread")

    with_threads = written()
    monkeypatch.setattr(threading.Thread, "start", refuse)
    assert written() == with_threads


def test_other_programs_notice_damage_too(tmp_path):
    """The checksum of HDF5 itself, without the digest of the whole file."""
    write_result(make_result(), tmp_path / "result.h5")
    content = bytearray((tmp_path / "result.h5").read_bytes())
    with h5py.File(tmp_path / "result.h5") as file:
        chunk = file["transmission/bsdf"].id.get_chunk_info(0)
        start = chunk.byte_offset
    content[start + chunk.size // 2] ^= 4
    (tmp_path / "result.h5").write_bytes(content)
    with h5py.File(tmp_path / "result.h5") as file:
        assert np.isfinite(file["transmission/bsdf"][1]).all()
        with pytest.raises(OSError, match="filter returned failure"):
            file["transmission/bsdf"][0]
