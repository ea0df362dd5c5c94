"""The checksums that HDF5 keeps of every chunk: all that protects files of models of schema 1.0 and 1.1."""

import math

import h5py
import numpy as np

_MODULUS = 65535
# Words in one sum of sums: it stays far below 2^64.
_BLOCK = 1 << 20
_LENGTH = 4


def verify_all(file: h5py.File) -> None:
    """Check every dataset that has checksums; a ValueError if a chunk does not match its own."""

    def check(_: str, node: h5py.Group | h5py.Dataset) -> None:
        # What a user added has perhaps no checksum, and is no concern of ours.
        if isinstance(node, h5py.Dataset) and node.fletcher32:
            verify(node)

    # Comes once to what has several names.
    file.visititems(check)


def verify(dataset: h5py.Dataset) -> None:
    """Check every chunk of a dataset.

    Parameters
    ----------
    dataset : h5py.Dataset
        With the filter fletcher32, which HDF5 applies last.

    Raises
    ------
    ValueError
        A chunk is missing, or does not match its checksum.
    """
    present = dataset.id.get_num_chunks()
    expected = math.prod(-(-length // chunk) for length, chunk in zip(dataset.shape, dataset.chunks, strict=True))
    if present != expected:
        raise ValueError(f"the dataset {dataset.name} has {present} of {expected} chunks")
    for number in range(present):
        skipped, raw = dataset.id.read_direct_chunk(dataset.id.get_chunk_info(number).chunk_offset)
        stored = int.from_bytes(raw[-_LENGTH:], "little")
        low, high = fletcher32(raw[:-_LENGTH])
        if skipped or (stored & 0xFFFF) % _MODULUS != low or (stored >> 16) % _MODULUS != high:
            raise ValueError(f"the dataset {dataset.name} does not match its checksums")


def fletcher32(raw: bytes) -> tuple[int, int]:
    """Fletcher's checksum as HDF5 computes it: over big-endian words of 16 bits, an odd byte in front of a zero.

    Parameters
    ----------
    raw : bytes

    Returns
    -------
    low, high : int
        Sum of the words, and sum of the sums so far, both modulo 65535.
    """
    words = np.frombuffer(raw + b"\0" * (len(raw) % 2), dtype=">u2").astype(np.uint64)
    low, high = 0, 0
    for start in range(0, len(words), _BLOCK):
        sums = np.cumsum(words[start : start + _BLOCK])
        high = (high + len(sums) * low + int(sums.sum())) % _MODULUS
        low = (low + int(sums[-1])) % _MODULUS
    return low, high
