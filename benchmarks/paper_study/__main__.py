"""Write the study: ``python -m benchmarks.paper_study out/paper [--experiments]``."""

import argparse
import shutil
import sys
import time
from pathlib import Path

from . import document, readme
from .errors import Errors, StudyError, errors_path, read_rows
from .experiments import EXPERIMENTS
from .experiments import table as experiments_table
from .study import Study

ROOT = Path(__file__).resolve().parents[2]


def main(arguments=None):
    """Parse, run, write; 1 if something is missing."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.paper_study", description=__doc__)
    parser.add_argument("results", type=Path, help="folder of the 60 results, with comparison/ below it")
    parser.add_argument("--experiments", action="store_true", help="run the experiments and nothing else")
    parser.add_argument("--root", type=Path, default=ROOT, help="write docs/ and README.md below this folder")
    options = parser.parse_args(arguments)
    try:
        if options.experiments:
            run_experiments(options.results)
        else:
            write(options.results, options.root)
    except StudyError as error:
        print(error, file=sys.stderr)
        return 1
    return 0


def run_experiments(results):
    """Run all experiments and keep their rows beside the results."""
    start, rows = time.perf_counter(), []
    for experiment in EXPERIMENTS:
        rows += [{"experiment": experiment.NAME} | row for row in experiment.run(results)]
        print(f"{time.perf_counter() - start:5.0f} s  {experiment.NAME}", flush=True)
    experiments_table.write(rows, experiments_path(results))


def write(results, root):
    """Write the document with its pictures, the joint figure, and the tables of the README."""
    errors = Errors(read_rows(errors_path(results)))
    study = Study(
        results,
        errors,
        experiments_table.read(experiments_path(results), [each.NAME for each in EXPERIMENTS]),
        root / "docs",
    )
    findings = document.measure(study)
    document.write(study, findings, root / "docs" / "paper_study.md")
    figure = results / "comparison" / "figures" / "errors.png"
    if not figure.exists():
        raise StudyError(f"{figure}: is missing; write it anew with `goniosim compare`")
    shutil.copyfile(figure, root / "docs" / "errors.png")
    readme.write(study, findings, root / "README.md")


def experiments_path(results):
    """Where the rows of the experiments are kept."""
    return results / "experiments.csv"


if __name__ == "__main__":
    sys.exit(main())
