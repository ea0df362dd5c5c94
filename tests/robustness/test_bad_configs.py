"""Whatever is wrong with a scene file, the answer is clear lines with the place, and never a traceback."""

import copy
import errno
import random
import re
from pathlib import Path

import jsonschema
import pytest

from goniosim.errors import ConfigError
from goniosim.scene import json_schema, load_scene, load_scenes, parse_scene

SCENE = """\
material:
  name: patina
  layers:
    - interface: {type: dielectric, eta: 1.5, alpha: 0.2}
    - medium: {tau: [0.05, 0.1, 0.8]}
    - interface:
        type: conductor
        eta: 1.45
        kappa: [1.0, 0.01, 0.01]
        alpha: 0.2
incident:
  theta_deg: [0, 15, 30]
slice: {parametrization: classic}
simulation: {rays: 1e7, seed: 1}
"""


def lines_of(text):
    with pytest.raises(ConfigError) as caught:
        parse_scene(text, "f.yaml")
    assert caught.value.exit_code == 3
    assert str(caught.value) == "\n".join(caught.value.problems)
    return caught.value.problems


def test_the_scene_that_is_spoiled_below_is_sound():
    assert parse_scene(SCENE).material.name == "patina"


COATING = "interface: {type: dielectric, eta: 1.5}"
LAMBERT = "interface: {type: lambert, rho: 0.5}"
METAL = "interface: {type: conductor, eta: 1, kappa: 1}"
MEDIUM = "medium: {tau: 1}"


@pytest.mark.parametrize(
    "layers, lines",
    [
        (
            [MEDIUM, LAMBERT],
            {0: "must be an interface: the stack begins at its top interface, with air above"},
        ),
        ([MEDIUM], {0: "must be an interface: the stack begins at its top interface, with air above"}),
        (
            [COATING, MEDIUM],
            {1: "must be an interface: a medium lies between two interfaces; remove it or put an interface below it"},
        ),
        (
            [COATING, LAMBERT, MEDIUM, MEDIUM],
            {
                2: "lies under an opaque base (lambert), where no light arrives: remove this medium",
                3: "lies under an opaque base (lambert), where no light arrives: remove this medium",
            },
        ),
        (
            [COATING, METAL, COATING],
            {
                1: "must be the last layer: a conductor base is opaque, and no light gets below it; "
                "move it to the end or remove the layers below it"
            },
        ),
        (
            [LAMBERT, MEDIUM, METAL],
            {
                0: "must be the last layer: a lambert base is opaque, and no light gets below it; "
                "move it to the end or remove the layers below it"
            },
        ),
    ],
)
def test_orders_of_layers_that_make_no_sense(layers, lines):
    text = "material:\n  name: a\n  layers:\n" + "".join(f"    - {layer}\n" for layer in layers)
    expected = [f"f.yaml:{4 + index}: material.layers[{index}]: {line}" for index, line in lines.items()]
    assert lines_of(text + "incident: {theta_deg: [0]}\n") == expected


def test_no_layers_at_all():
    assert lines_of("material: {name: a, layers: []}\nincident: {theta_deg: [0]}\n") == [
        "f.yaml:1: material.layers: must hold at least one interface: "
        "a material without layers scatters no light [got []]"
    ]
    assert lines_of("material: {name: a, layers: 3}\nincident: {theta_deg: [0]}\n") == [
        "f.yaml:1: material.layers: must be a list: begin each entry with `- ` [got 3]"
    ]


def test_all_mistakes_come_at_once_sorted_by_line():
    text = SCENE
    for old, new in (
        ("alpha: 0.2}", "alhpa: 0.2}"),
        ("[0.05, 0.1, 0.8]", "-1"),
        ("type: conductor\n        eta: 1.45", "type: conductor\n        eta: -1"),
        ("incident:", "    - medium: {tau: 1}\nincident:"),
        ("[0, 15, 30]", "[95, 15, 15]"),
        ("seed: 1", "seed: x"),
    ):
        assert old in text
        text = text.replace(old, new, 1)
    assert [line.split(": ")[:2] for line in lines_of(text)] == [
        ["f.yaml:4", "material.layers[0].interface.alhpa"],
        ["f.yaml:5", "material.layers[1].medium.tau"],
        ["f.yaml:8", "material.layers[2].interface.eta"],
        ["f.yaml:11", "material.layers[3]"],
        ["f.yaml:13", "incident.theta_deg[0]"],
        ["f.yaml:15", "simulation.seed"],
    ]


@pytest.mark.parametrize(
    "text, line",
    [
        ("", "f.yaml:1: the file is empty: it needs material and incident"),
        ("# nothing but words\n", "f.yaml:1: the file is empty: it needs material and incident"),
        ("- 1\n", "f.yaml:1: the file must be a mapping with material and incident"),
        ("just words\n", "f.yaml:1: the file must be a mapping with material and incident"),
        ("a: [1,\nb: 2\n", "f.yaml:3: YAML syntax: expected ',' or ']', but got '<stream end>'"),
        (
            "a: 1\n\tb: 2\n",
            "f.yaml:2: YAML syntax: found character '\\t' that cannot start any token: indent with spaces",
        ),
        ("a: 1\nb: c: d\n", "f.yaml:2: YAML syntax: mapping values are not allowed here"),
        ("a: 1\nb: *c\n", "f.yaml:2: YAML syntax: found undefined alias 'c'"),
        (
            "a: 1\n---\nb: 2\n",
            "f.yaml:2: YAML syntax: expected a single document in the stream, but found another document",
        ),
        ("a: 1\nb: \x00\n", "f.yaml:2: YAML syntax: special characters are not allowed"),
        ("a: !!int x\n", "f.yaml:1: a: cannot be read as int: check how it is written"),
        ("a: " + "9" * 6000, "f.yaml:1: a: cannot be read as int: check how it is written"),
        ("[" * 1000, "f.yaml:1: is nested too deeply, or holds too many values, for a scene file"),
        ("a: &a [*a]\n", "f.yaml:1: is nested too deeply, or holds too many values, for a scene file"),
    ],
)
def test_what_is_not_yaml_or_not_a_scene(text, line):
    assert lines_of(text) == [line]


def test_aliases_cannot_blow_a_small_file_up():
    text = "a: &a0 [x, x, x, x, x, x, x, x, x, x]\n"
    for level in range(1, 12):
        text += f"b{level}: &a{level} [{', '.join([f'*a{level - 1}'] * 10)}]\n"
    assert lines_of(text) == ["f.yaml:1: is nested too deeply, or holds too many values, for a scene file"]


def test_no_object_is_ever_made_from_a_tag():
    text = SCENE.replace("patina", "!!python/object/apply:os.getcwd []")
    assert lines_of(text)[0].startswith("f.yaml:2: material.name: must be usable as a file name")


def test_files_that_cannot_be_read(tmp_path):
    missing = tmp_path / "none.yaml"
    latin = tmp_path / "latin.yaml"
    latin.write_bytes(b"material:\n  name: p\xe1tina\n")
    huge = tmp_path / "result.h5"
    huge.write_bytes(b"#" * 16_000_001)
    for path, line in (
        (missing, f"{missing}: there is no such file: check the path"),
        (tmp_path, f"{tmp_path}: is a folder: give the scene file in it"),
        (latin / "deeper", f"{latin}/deeper: cannot be read: Not a directory"),
        (latin, f"{latin}:2: is not UTF-8 text (byte 0xe1): save it as UTF-8"),
        (huge, f"{huge}: is larger than 16 MB: this is not a scene file"),
    ):
        for load in (load_scene, load_scenes):
            with pytest.raises(ConfigError) as caught:
                load(path)
            assert caught.value.problems == [line]


def test_a_file_without_permission(monkeypatch):
    def refuse(*_):
        raise PermissionError(errno.EACCES, "Permission denied")

    # Taking the permission away would not stop a test that runs as root.
    monkeypatch.setattr(Path, "open", refuse)
    with pytest.raises(ConfigError) as caught:
        load_scene("secret.yaml")
    assert caught.value.problems == ["secret.yaml: cannot be read: Permission denied"]


def test_a_dict_has_no_lines_but_the_same_sentences():
    with pytest.raises(ConfigError) as caught:
        parse_scene({"material": {"name": "a", "layers": [{"interface": {"type": "lambert", "rho": 2}}]}})
    assert caught.value.problems == [
        "material.layers[0].interface.rho: must lie between 0 and 1: "
        "it is the fraction of the light that the base sends back [got 2]",
        "incident: is missing: this key is required",
    ]
    endless = {}
    endless["material"] = endless
    with pytest.raises(ConfigError, match="nested too deeply"):
        parse_scene(endless)


def test_damaged_text_never_ends_in_a_traceback():
    rng = random.Random(1)
    place = re.compile(r"f\.yaml:\d+: ")
    refused = 0
    for _ in range(600):
        text = list(SCENE)
        for _ in range(rng.randint(1, 3)):
            at = rng.randrange(len(text))
            text[at : at + rng.randint(0, 3)] = rng.choice("[]{}:,-&*!|>'\"%@`#?\t\n 09.eEx~\x07é\ufeff")
        try:
            parse_scene("".join(text), "f.yaml")
        except ConfigError as error:
            refused += 1
            assert all(place.match(line) for line in error.problems), "".join(text)
    assert refused > 300


def paths_into(content, path=()):
    """All paths into nested dicts and lists."""
    yield path
    if isinstance(content, (dict, list)):
        for step, child in content.items() if isinstance(content, dict) else enumerate(content):
            yield from paths_into(child, (*path, step))


def test_junk_at_any_place_is_refused_or_harmless_and_the_schema_is_never_stricter():
    sound = parse_scene(SCENE).model_dump(mode="json", exclude_none=True)
    validator = jsonschema.Draft202012Validator(json_schema())
    junk = [
        None,
        True,
        -1,
        0,
        0.5,
        1e300,
        10**400,
        float("nan"),
        "x",
        "",
        "half",
        [],
        [0.5] * 3,
        {},
        {"a": 1},
    ]
    junk += [{"type": "lambert", "rho": 1}, {"interface": {"type": "lambert", "rho": 1}}, [[]], object()]
    junk += [1, 1.0, 1000.0, 45, "classic", "analog", "lambert", [1, 2, 3]]
    accepted = 0  # counted so that the test cannot pass by refusing everything
    for path in list(paths_into(sound))[1:]:
        for value in junk:
            content = copy.deepcopy(sound)
            parent = content
            for step in path[:-1]:
                parent = parent[step]
            parent[path[-1]] = copy.deepcopy(value)
            try:
                parse_scene(content, "dict")
            except ConfigError as error:
                assert all(line.startswith("dict: ") for line in error.problems)
            else:
                accepted += 1
                validator.validate(content)
    assert accepted > 50
