"""Measure and write the page: ``python -m benchmarks.accuracy_and_time [--max-time 60] [--root .]``."""

import argparse
import sys
import time
from pathlib import Path

from goniosim.report.cost.figure import price_figure
from goniosim.report.cost.price_list import price_list
from goniosim.report.drawing.files import write_figure
from goniosim.scene import load_scene

from . import document

ROOT = Path(__file__).resolve().parents[2]
STACKS = ROOT / "benchmarks" / "stacks"


def main(arguments=None):
    """Parse, measure, write."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.accuracy_and_time", description=__doc__)
    parser.add_argument("--max-time", type=float, default=60.0, help="seconds for each of the four materials, about")
    parser.add_argument("--root", type=Path, default=ROOT, help="write docs/ below this folder")
    options = parser.parse_args(arguments)
    start, lists = time.perf_counter(), {}
    for name in document.CASES:
        scene = load_scene(STACKS / f"{name}.yaml")
        lists[name] = price_list(scene, options.max_time, models=True, say=lambda message, n=name: _say(n, message))
        write_figure(options.root / "docs" / document.picture(name), ["png"], price_figure, lists[name])
    document.write(lists, time.perf_counter() - start, options.root / "docs" / "accuracy_and_time.md")
    return 0


def _say(name, message):
    print(f"{name}: {message}", file=sys.stderr, flush=True)


if __name__ == "__main__":
    sys.exit(main())
