"""Measure what shards cost, on an idle machine: ``python -m benchmarks.cluster [--rays 3e7] [--root .]``."""

import argparse
import sys
from pathlib import Path

from . import document
from .measure import measure

ROOT = Path(__file__).resolve().parents[2]


def main(arguments=None):
    """Parse, measure, write."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.cluster", description=__doc__)
    parser.add_argument("--rays", type=float, default=3e7, help="light paths of each direction")
    parser.add_argument("--shards", type=int, nargs="+", default=[1, 8, 32])
    parser.add_argument("--root", type=Path, default=ROOT, help="write docs/ below this folder")
    options = parser.parse_args(arguments)
    measured = measure(int(options.rays), options.shards, lambda line: print(line, file=sys.stderr, flush=True))
    document.write(measured, options.root / "docs" / "cluster.md")
    return 0


if __name__ == "__main__":
    sys.exit(main())
