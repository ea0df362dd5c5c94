"""Compare every function with its oracle and write the page: ``python -m benchmarks.precision [--root .]``."""

import argparse
import sys
from pathlib import Path

from . import document

ROOT = Path(__file__).resolve().parents[2]


def main(arguments=None):
    """Parse, measure, write."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.precision", description=__doc__)
    parser.add_argument("--root", type=Path, default=ROOT, help="write docs/ below this folder")
    options = parser.parse_args(arguments)
    text = document.page(lambda name: print(name, file=sys.stderr, flush=True))
    (options.root / "docs" / "precision.md").write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
