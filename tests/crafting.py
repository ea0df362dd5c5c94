"""Files as a stranger might make them: edited at will, with digests that agree with what they hold."""

import copy
import hashlib
import json

import h5py
import numpy as np

from goniosim.store import access, manifest, seal
from goniosim.store.kinds import MODELS, RESULT


def craft(path, edit=None, *, version=None):
    """Edit a file of ours and sign it anew.

    Parameters
    ----------
    path : Path
    edit : callable, optional
        Called with the open `h5py.File`.
    version : str, optional
        The schema version that the seal claims.
    """
    head = path.read_bytes()[: seal.WINDOW]
    kind = next(kind for kind in (RESULT, MODELS) if kind.mark in head)
    place = head.find(kind.mark)
    with h5py.File(path, "r+", libver=("v110", "v110")) as file:
        if edit is not None:
            edit(file)
        text = _manifest(file)
        del file[manifest.PATH]
        file.create_dataset(manifest.PATH, data=text, dtype=h5py.string_dtype("utf-8", len(text)))
    with open(path, "r+b") as stream:
        digest = seal.digest(stream, place)
        length = stream.tell()
        block = seal.make(kind, length, digest, hashlib.sha256(text).hexdigest())
        if version is not None:
            block = reversioned(block, kind, version)
        stream.seek(place)
        stream.write(block)


def reversioned(block, kind, version):
    """A seal that claims another schema version."""
    body = block.replace(kind.mark + kind.schema_version.encode(), kind.mark + version.encode())
    body = body[:-9].rstrip(b" ").ljust(seal.SIZE - 9)
    return body + seal._checksum(body)


def _manifest(file):
    """As `goniosim.store.manifest.build`; with the digest of the file right, only the root is held against its own."""
    entries, todo = {}, [("", file)]
    while todo:
        path, node = todo.pop()
        is_group = isinstance(node, h5py.Group)
        names = [name for name in node.attrs if access.is_plain(node, name)] if is_group else []
        entries[path] = "" if path else manifest._digest(file, names), names
        for name in node if is_group and path.count("/") < 8 else ():
            link = node.get(name, getlink=True)
            if isinstance(link, h5py.HardLink) and f"{path}/{name}" != "/checksums":
                todo.append((f"{path}/{name}".lstrip("/"), node[name]))
    return json.dumps(entries).encode()


def arrays(tree, path=()):
    """Ways to the arrays of a tree, with them."""
    if isinstance(tree, np.ndarray):
        yield path, tree
    elif isinstance(tree, dict | list):
        for key, value in tree.items() if isinstance(tree, dict) else enumerate(tree):
            yield from arrays(value, (*path, key))


def changed(tree, path, value):
    """A copy of a tree with something else at the end of a way."""
    made = copy.deepcopy(tree)
    node = made
    for key in path[:-1]:
        node = node[key]
    node[path[-1]] = value
    return made
