"""Random numbers of walks as an endless stream of raw 32-bit words, for programs that test such streams.

``python -m reference.words NAME START`` writes the first 32 bits of numbers, from part START on.
"""

import os
import sys

import numpy as np

from reference.streams import analog_keys, children, numbers, replicate_keys


def _rays(part):
    """All that the rays of a work unit draw: azimuth, height, coin and roulette of each, ray by ray, stage by stage."""
    keys = analog_keys(units=[part], parts=range(4), stages=range(128), decisions=range(4))[0, 0, 0]
    return np.moveaxis(numbers(keys, 512), -1, -2)


def _relatives(part):
    """One number of each key in turn: of neighbouring seeds, then directions, counters and work units."""
    keys = analog_keys(seeds=range(64), directions=range(16), units=range(16 * part, 16 * part + 16))
    return numbers(keys[..., 0, 0, 0], 64).transpose(2, 3, 1, 0)


def _paths(part):
    """Paths of an operator, one after the other: six numbers at each of sixteen events."""
    keys = [children(replicate_keys(replicates=[part]), [1], range(1 << 13)).ravel()]
    for event in range(1, 16):
        keys.append(children(keys[-1], [6 + event % 2]).ravel())
    return numbers(np.stack(keys, axis=1), 6)


WORDS = {"rays": _rays, "relatives": _relatives, "paths": _paths}


def main():
    """Write until nobody reads any more."""
    name, part = sys.argv[1], int(sys.argv[2])
    while True:
        words = (np.ascontiguousarray(WORDS[name](part)) * 2.0**32).astype(np.uint32)
        try:
            sys.stdout.buffer.write(words.tobytes())
        except BrokenPipeError:
            os._exit(0)
        part += 1


if __name__ == "__main__":
    main()
