"""From a YAML file to the raw tree, with the line of every value."""

import os
import sys
from pathlib import Path
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.error import MarkedYAMLError, YAMLError
from ruamel.yaml.nodes import MappingNode, SequenceNode
from ruamel.yaml.nodes import Node as YamlNode

from goniosim.errors import ConfigError
from goniosim.scene.problems import Problem, config_error
from goniosim.scene.tree import MAX_DEPTH, Node, Origin, show, show_path

STDIN = "<stdin>"
MAX_BYTES = 16_000_000
MAX_VALUES = 200_000
MERGE = "tag:yaml.org,2002:merge"
SCALARS = {"null", "bool", "int", "float", "str"}


def read_file(path: str | os.PathLike[str]) -> Node:
    """Read a scene or study file.

    Parameters
    ----------
    path : str or Path
        ``-`` is the standard input, which messages call ``<stdin>``.

    Returns
    -------
    Node
        A mapping.

    Raises
    ------
    ConfigError
        Unreadable, not UTF-8, not YAML, or not a mapping.
    """
    source = STDIN if str(path) == "-" else str(path)
    content = _content(path, source)
    if len(content) > MAX_BYTES:
        raise ConfigError(f"{source}: is larger than 16 MB: this is not a scene file")
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        byte = f"0x{content[error.start]:02x}"
        raise ConfigError(f"{source}:{line}: is not UTF-8 text (byte {byte}): save it as UTF-8") from None
    return read_text(text, source)


def _content(path: str | os.PathLike[str], source: str) -> bytes:
    try:
        if source == STDIN:
            if sys.stdin is None:
                raise ConfigError(f"{source}: is closed: give a file")
            return sys.stdin.buffer.read(MAX_BYTES + 1)
        with Path(path).open("rb") as stream:
            return stream.read(MAX_BYTES + 1)
    except FileNotFoundError:
        raise ConfigError(f"{source}: there is no such file: check the path") from None
    except IsADirectoryError:
        raise ConfigError(f"{source}: is a folder: give the scene file in it") from None
    except OSError as error:
        raise ConfigError(f"{source}: cannot be read: {error.strerror}") from None
    except ValueError as error:
        raise ConfigError(f"{show(source)}: cannot be the name of a file: {error}") from None


def read_text(text: str, source: str) -> Node:
    """Read the text of a scene or study file.

    Parameters
    ----------
    text : str
    source : str
        Name of the text in error messages.

    Returns
    -------
    Node
        A mapping.

    Raises
    ------
    ConfigError
        Not YAML, or not a mapping.
    """
    node = read_value(text, Origin(source, 1))
    if node is None:
        raise ConfigError(f"{source}:1: the file is empty: it needs material and incident")
    if not isinstance(node.value, dict):
        raise ConfigError(f"{source}:1: the file must be a mapping with material and incident")
    return node


def read_value(text: str, origin: Origin) -> Node | None:
    """Read any YAML value.

    Parameters
    ----------
    text : str
    origin : Origin
        Of the first line; line 0 keeps all entries at line 0.

    Returns
    -------
    Node or None
        None for text without content.

    Raises
    ------
    ConfigError
        Not YAML; names the line.
    """
    yaml = YAML(typ="safe", pure=True)
    yaml.composer.warn_double_anchors = False
    try:
        root = yaml.compose(text)
        if root is None:
            return None
        reader = _Reader(yaml, origin.line > 0)
        node = reader.node(root, origin)
    except RecursionError:
        raise ConfigError(
            f"{_place(origin, 0)}: is nested too deeply, or holds too many values, for a scene file"
        ) from None
    except MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        line = mark.line if mark else 0
        raise ConfigError(f"{_place(origin, line)}: YAML syntax: {_reason(error, text, line)}") from None
    except YAMLError as error:
        line = text.count("\n", 0, getattr(error, "position", 0))
        reason = str(getattr(error, "reason", error))
        raise ConfigError(f"{_place(origin, line)}: YAML syntax: {reason}") from None
    if reader.problems:
        raise config_error(reader.problems)
    return node


def _place(origin: Origin, line: int) -> str:
    return f"{origin.source}:{origin.line + line}" if origin.line else origin.source


def _reason(error: MarkedYAMLError, text: str, line: int) -> str:
    parts = [part for part in (error.context, error.problem) if part]
    # The context leads up to the problem only where the latter goes on with "but".
    reason = ", ".join(parts) if parts[-1].startswith("but") else parts[-1]
    if "\\t" in reason:
        return f"{reason}: indent with spaces"
    if "${" in "".join(text.splitlines()[line : line + 1]):
        return f"{reason}: write ${{...}} between quotes"
    return reason


class _Reader:
    """Turns composed YAML nodes into a tree and notes what YAML alone cannot forbid."""

    def __init__(self, yaml: YAML, with_lines: bool) -> None:
        self.problems: list[Problem] = []
        self.values = 0
        self._construct = yaml.constructor
        self._with_lines = with_lines

    def node(self, composed: YamlNode, origin: Origin) -> Node:
        self._count(origin)
        if isinstance(composed, MappingNode):
            entries = self._entries(composed, origin).items()
            return Node(
                {key: self.node(value, self._below(origin, key, written)) for key, (written, value) in entries}, origin
            )
        if isinstance(composed, SequenceNode):
            return Node([self._item(item, origin, i) for i, item in enumerate(composed.value)], origin)
        return Node(self._scalar(composed, origin), origin)

    def _count(self, origin: Origin) -> None:
        # An alias repeats its anchor at every use, so the content may be far larger than the file,
        # or endless.
        self.values += 1
        if len(origin.path) > MAX_DEPTH or self.values > MAX_VALUES:
            raise RecursionError

    def _entries(self, composed: MappingNode, origin: Origin) -> dict[str, tuple[YamlNode, YamlNode]]:
        """Keys and values of a mapping, those that it takes over by ``<<`` included."""
        found: dict[str, tuple[YamlNode, YamlNode]] = {}
        for key_node, value_node in composed.value:
            key = key_node.value
            if key_node.tag == MERGE:
                continue
            if not isinstance(key, str):
                self._note(self._below(origin, "?", key_node), "a key must be a single word")
            elif key in found:
                first = found[key][0].start_mark.line + 1
                also = f" (the other is on line {first})" if self._with_lines else ""
                self._note(self._below(origin, key, key_node), f"this key is there twice{also}: remove one")
            else:
                found[key] = (key_node, value_node)
        for key_node, bases in composed.value:
            if key_node.tag == MERGE:
                for base in bases.value if isinstance(bases, SequenceNode) else [bases]:
                    self._count(origin)
                    self._take_over(base, found, self._below(origin, "<<", key_node))
        return found

    def _take_over(self, base: YamlNode, found: dict[str, tuple[YamlNode, YamlNode]], origin: Origin) -> None:
        if not isinstance(base, MappingNode):
            self._note(origin, "takes over the entries of a mapping, or of a list of them: write <<: *name")
            return
        for key, entry in self._entries(base, origin).items():
            self._count(origin)
            found.setdefault(key, entry)

    def _item(self, composed: YamlNode, origin: Origin, index: int) -> Node:
        return self.node(composed, self._below(origin, index, composed))

    def _scalar(self, composed: YamlNode, origin: Origin) -> Any:
        kind = (composed.tag or "").rpartition(":")[2]
        if kind not in SCALARS or kind == "str":
            return composed.value
        try:
            return getattr(self._construct, f"construct_yaml_{kind}")(composed)
        except (ValueError, KeyError):
            self._note(origin, f"cannot be read as {kind}: check how it is written")
            return None

    def _below(self, origin: Origin, step: int | str, composed: YamlNode) -> Origin:
        line = composed.start_mark.line + 1 if self._with_lines else 0
        return Origin(origin.source, line, (*origin.path, step))

    def _note(self, origin: Origin, message: str) -> None:
        self.problems.append(Problem(origin.source, origin.line, show_path(origin.path), message))
