"""`data_schema.md`, the table in the code and a written file say the same."""

import hashlib
import json
import re
import zlib
from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray as xr

from goniosim.cluster import ShardPlan
from goniosim.cluster.plan_file import MOST_SHARDS
from goniosim.result import AUDIT_ENTRIES
from goniosim.scene import parse_scene
from goniosim.store import Portion, layout, seal, write_portion, write_result
from goniosim.store.kinds import PORTION, RESULT
from goniosim.store.models import layout as models_layout
from small import SCENE
from synthetic import make_result, write_models

DOCUMENT = (Path(__file__).parents[2] / "data_schema.md").read_text(encoding="utf-8")
MODELS = DOCUMENT[DOCUMENT.index("## The file of integrated models") : DOCUMENT.index("## The files of shards")]
SHARDS = DOCUMENT[DOCUMENT.index("## The files of shards") : DOCUMENT.index("## Integrity")]
RESULTS = DOCUMENT.replace(MODELS, "").replace(SHARDS, "")
EVERYTHING = {"orders": 3, "target": "{relative_error: 1%}", "target_reached": False}


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    """A file with everything in it that a file can have."""
    path = tmp_path_factory.mktemp("schema") / "result.h5"
    result = make_result(**EVERYTHING, estimator={"reflection/internal": "split"}, status="partial")
    result.state = b"12345"
    write_result(result, path)
    return path


def rows(columns, document=RESULTS):
    """Rows of the document's tables with that number of columns, without heads and rules."""
    lines = [line.strip("| ") for line in document.splitlines() if line.startswith("| `")]
    found = [re.split(r" +\| +", line) for line in lines]
    return [row for row in found if len(row) == columns]


def walk(group, prefix=""):
    """All paths of a file, each link by itself, with what they lead to."""
    for name, node in group.items():
        yield prefix + name, node
        if isinstance(node, h5py.Group):
            yield from walk(node, f"{prefix}{name}/")


def dataset_rows(datasets):
    return [
        (
            f"`{dataset.path}`",
            f"[{', '.join(layout.SIZES[dim] for dim in dataset.dims)}]",
            dataset.dtype,
            dataset.unit,
            dataset.meaning,
        )
        for dataset in datasets
    ]


def attribute_rows(attributes):
    return [(f"`{a.group}`", f"`{a.name}`", a.dtype, a.meaning) for a in attributes]


def test_the_document_lists_the_datasets_of_the_code():
    assert [tuple(row) for row in rows(5)] == dataset_rows(layout.DATASETS)
    assert [tuple(row) for row in rows(5, MODELS)] == dataset_rows(models_layout.DATASETS)


def test_the_document_lists_the_attributes_of_the_code():
    assert [tuple(row) for row in rows(4)] == attribute_rows(layout.ATTRIBUTES)
    assert [tuple(row) for row in rows(4, MODELS)] == attribute_rows(models_layout.ATTRIBUTES)


def test_the_document_names_the_version():
    assert DOCUMENT.startswith(f"# The result file, schema {layout.SCHEMA_VERSION}\n")
    assert DOCUMENT.splitlines()[-1].startswith(f"| {layout.SCHEMA_VERSION} | ")
    assert f"{RESULT.mark.decode()}{layout.SCHEMA_VERSION}\n" in DOCUMENT
    versions = re.findall(r"^\| (\d\.\d) \| ", MODELS, re.MULTILINE)
    assert versions[-1] == models_layout.SCHEMA_VERSION


def test_every_dataset_of_a_file_is_described_and_the_reverse(path):
    lengths = {"M": 2, "C": 3, "R": 6, "K": 8, "P": 3, "R + 1": 7, "K + 1": 9, "B": 32, "Rb": 6, "Kb": 8}
    seen = set()
    with h5py.File(path) as file:
        for name, node in walk(file):
            if isinstance(node, h5py.Group):
                continue
            last = name.split("/")[-1]
            if last in layout.SCALES and "/" in name and name != layout.SCALES[last]:
                assert node == file[layout.SCALES[last]], name
                continue
            if last in ("theta_deg", "phi_deg") and not name.startswith("incident/"):
                assert node == file[f"incident/{last}"], name
                continue
            described = layout.describe(name)
            seen.add(described.path)
            assert node.shape == tuple(lengths[layout.SIZES[dim]] for dim in described.dims), name
            fixed = {"text": node.dtype, "bytes": node.dtype}
            assert node.dtype == {"bool": "int8", **fixed}.get(described.dtype, described.dtype), name
            assert (described.dtype in fixed) == (node.dtype.kind == "S"), name
            assert node.attrs["units"].decode() == described.unit
            assert node.attrs["long_name"].decode() == described.meaning
            if not described.is_scale:
                scales = [dimension[0] for dimension in node.dims]
                assert scales == [file[layout.SCALES[dim]] for dim in described.dims], name
    assert seen == {dataset.path for dataset in layout.DATASETS}


def test_every_attribute_of_a_file_is_described_and_the_reverse(path):
    described = {(a.group, a.name) for a in layout.ATTRIBUTES}
    seen = set()
    with h5py.File(path) as file:
        for group, node in [("", file), *walk(file)]:
            if isinstance(node, h5py.Dataset):
                continue
            if re.fullmatch(r"(reflection/(direct|internal)|transmission)(/order_\w+)?", group):
                group = "COMPONENT"
            for name, value in node.attrs.items():
                name = "EFFECT" if group == "effects" else name
                name = "PROVENANCE" if group == "" and name in ("processor", "threads") else name
                seen.add((group or "/", name))
                assert isinstance(value, bytes | np.int8 | np.uint64), name
    assert seen == described


def test_each_dataset_finds_its_row():
    assert layout.describe("audit/lost_roulette").path == "audit/lost_roulette"
    for entry in AUDIT_ENTRIES:
        assert layout.describe(f"audit/{entry}_stderr").path == "audit/ENTRY_stderr"
    for unknown in (
        "energy",
        "reflection/energy",
        "reflection/internal/order_2/order_3/energy",
        "transmission/order_x/energy",
        "audit/ENTRY_stderr",
        "cost/error_reflection_direct2",
    ):
        with pytest.raises(KeyError, match="no dataset"):
            layout.describe(unknown)


EXAMPLES = re.findall(r"```python\n(.*?)```", RESULTS, re.DOTALL)


@pytest.mark.parametrize("example", EXAMPLES, ids=["goniosim", "h5py", "xarray"])
def test_the_examples_run(example, path, monkeypatch, capsys):
    monkeypatch.chdir(path.parent)
    exec(compile(example, "data_schema.md", "exec"), {})
    assert capsys.readouterr().out


def test_the_digests_are_what_the_document_says(path):
    content = path.read_bytes()
    with h5py.File(path) as file:
        text = file["checksums/file"][()].decode()
        manifest = file["checksums/content"][()]
        energy = file["transmission/energy"]
        assert energy.attrs["sha256"].decode() == hashlib.sha256(energy[()].tobytes()).hexdigest()
    place = content.index(text.encode())
    assert len(text) == seal.SIZE and text.encode() in path.read_bytes()[: seal.WINDOW]
    without = content[:place] + content[place + seal.SIZE :]
    assert f"\nsha256: {hashlib.sha256(without).hexdigest()}\n" in text
    assert f"\ncontent-sha256: {hashlib.sha256(manifest).hexdigest()}\n" in text
    assert f"\nbytes: {len(content)}\n" in text
    assert text[503:] == f"{zlib.crc32(text[:503].encode()):08x}\n"
    for line in text.splitlines()[:2]:
        assert f"\n    {line}\n" in DOCUMENT
    listed = json.loads(manifest)
    node = ["coordinates", "theta_deg phi_deg"], ["long_name", "BSDF averaged over the cell"]
    digest, names = listed["transmission/bsdf"]
    with h5py.File(path) as file:
        found = file["transmission/bsdf"]
        values = [[name, found.attrs[name].decode()] for name in names]
        canonical = json.dumps([*values, "<f8", list(found.shape)])
    assert all(each in values for each in node) and hashlib.sha256(canonical.encode()).hexdigest() == digest
    assert listed["transmission/row"] == "cells/row"


@pytest.mark.parametrize("engine", [None, "h5netcdf"])
@pytest.mark.parametrize("group", [*layout.COMPONENTS, "reflection/internal/order_2"])
def test_xarray_opens_a_component(path, group, engine):
    """Named axes, with coordinates, and the numbers of the result; the engine need not be named."""
    component = make_result(orders=3).components[group.partition("/order")[0]]
    component = component.orders["order_2"] if "order" in group else component
    with xr.open_dataset(path, group=group, engine=engine) as slices:
        assert slices.bsdf.dims == ("direction", "channel", "row", "column")
        np.testing.assert_array_equal(slices.bsdf.values, component.bsdf)
        np.testing.assert_array_equal(slices.stderr.values, component.stderr)
        assert list(slices.channel.values) == ["red", "green", "blue"]
        np.testing.assert_allclose(slices.row.values, 7.5 + 15 * np.arange(6), rtol=1e-15)
        np.testing.assert_allclose(slices.column.values, 22.5 + 45 * np.arange(8), rtol=1e-15)
        assert list(slices.theta_deg.values) == [0, 60] and list(slices.phi_deg.values) == [0, 0]
        blocks = {"batch", "row_block", "column_block"} if group.startswith("reflection/internal") else set()
        assert set(slices.coords) == {"direction", "channel", "row", "column", "theta_deg", "phi_deg"} | blocks
        assert slices.row.attrs["units"] == "degree"
        assert slices.bsdf.attrs["long_name"] == "BSDF averaged over the cell"
        assert slices.attrs["contains_delta"] == component.contains_delta


@pytest.mark.parametrize("engine", [None, "h5netcdf"])
def test_xarray_opens_the_rest(path, engine):
    result = make_result(**EVERYTHING)
    with xr.open_datatree(path, engine=engine) as tree:
        assert tree["cells/valid"].dtype == bool
        assert tree["cells/valid"].dims == ("direction", "row", "column")
        assert tree["audit/absorbed_base"].dims == ("direction", "channel")
        absorbed = result.audit.energy["absorbed_base"]
        np.testing.assert_array_equal(tree["audit/absorbed_base"].values, absorbed)
        np.testing.assert_array_equal(tree["cost/seconds"].sel(checkpoint=1).values, result.cost.seconds[:, 1])
        assert tree.attrs["config_yaml"] == result.config_yaml
        assert tree["effects"].attrs["absorption"] == 1


def test_every_piece_of_a_models_file_is_described_and_the_reverse(tmp_path):
    """Datasets and attributes, each link by itself; what `MATERIAL/MODEL` shares is that of `MATERIAL`."""
    write_models(tmp_path / "models.h5")
    lengths = {"M": 2, "C": 3, "R": 6, "K": 8, "R + 1": 7, "K + 1": 9}
    material, model = "synthetic", "belcour18_forward[jacobian=snell]"
    datasets, attributes = set(), set()
    with h5py.File(tmp_path / "models.h5") as file:
        for path, node in [("", file), *walk(file)]:
            if path.startswith("checksums"):
                datasets |= {path} if isinstance(node, h5py.Dataset) else set()
                continue
            below = path.removeprefix(material).removeprefix("/")
            if below.startswith("ww09"):
                continue
            of_model = below == model or below.startswith(f"{model}/")
            group = "MATERIAL/MODEL" if of_model else "MATERIAL"
            below = below.removeprefix(model).removeprefix("/")
            if isinstance(node, h5py.Group):
                place = re.sub("reflection/direct|reflection/internal|transmission", "COMPONENT", below)
                for name in node.attrs:
                    name = "PROVENANCE" if path == "" and name == "subcells" else name
                    attributes.add(("/" if path == "" else f"{group}/{place}".rstrip("/"), name))
                continue
            last = below.split("/")[-1]
            coordinate = last if last in models_layout.COORDINATES else f"incident/{last}"
            if last in (*models_layout.COORDINATES, "theta_deg", "phi_deg") and (of_model or below != coordinate):
                assert node == file[material][coordinate], path
                continue
            if of_model and below.split("/")[0] in models_layout.FOLDERS:
                assert node == file[material][below], path
                continue
            described = models_layout.describe(below)
            datasets.add(f"{group}/{described.path}")
            assert node.shape == tuple(lengths[layout.SIZES[dim]] for dim in described.dims), path
            assert node.fletcher32 and node.attrs["units"].decode() == described.unit
    assert datasets == {dataset.path for dataset in models_layout.DATASETS}
    assert attributes == {(a.group, a.name) for a in models_layout.ATTRIBUTES}


def test_the_example_of_the_models_file_runs(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    write_models("models.h5")
    (example,) = re.findall(r"```python\n(.*?)```", MODELS, re.DOTALL)
    exec(compile(example, "data_schema.md", "exec"), {})
    assert capsys.readouterr().out.splitlines()[0] == "synthetic ww09 (2, 3, 6, 8)"


def test_every_piece_of_a_portion_file_is_described_and_the_reverse(tmp_path):
    texts = {
        "goniosim_version": "0",
        "created_utc": "now",
        "name": "coat",
        "config_yaml": "a: 1",
        "config_hash": "f",
        "noise": "2e-4",
    }
    numbers = {"shard": 3, "shards": 16, "first": 4, "end": 9, "done_rays": 5, "total_rays": 7, "milliseconds": 2}
    write_portion(Portion(**texts, **numbers), b"12345", tmp_path / "portion.h5")
    described = {(name.strip("`"), kind) for _, name, kind, _ in rows(4, SHARDS)}
    with h5py.File(tmp_path / "portion.h5") as file:
        kinds = {name: "text" if isinstance(value, bytes) else value.dtype.name for name, value in file.attrs.items()}
        assert set(kinds.items()) == described
        datasets = {path for path, node in walk(file) if isinstance(node, h5py.Dataset)}
        assert file["state"][()].tobytes() == b"12345"
    assert {row[0].strip("`") for row in rows(5, SHARDS)} == datasets
    assert f"### Portion files, schema {PORTION.schema_version}\n" in SHARDS and f"`{PORTION.filetype}`" in SHARDS
    assert "goniosim portion" in SHARDS and PORTION.mark.startswith(b"goniosim portion")


def test_every_entry_of_a_plan_is_described_and_the_reverse(tmp_path):
    ShardPlan.make([parse_scene(SCENE)], None, 16).write(tmp_path)
    content = json.loads((tmp_path / "plan.json").read_text())
    assert [row[0].strip("`") for row in rows(3, SHARDS)] == list(content)
    assert f"always `{content['filetype']}`" in SHARDS and f"now {content['schema_version']}" in SHARDS
    assert f"1 to {MOST_SHARDS}" in SHARDS
