# Everything here works from a fresh clone: the targets set up what they need.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed
LINTERS := $(VENV)/.linters

# The study of the paper: light paths per incident direction, whose noise is that of 1.6e8 independent ones or less
# (`make headline`), and the folder of its results.
RAYS ?= 3e6
PAPER := out/paper

# Tests run on all cores, but four at the most: each worker brings kernels and a few hundred megabytes.
WORKERS := -n auto --maxprocesses 4 --dist loadfile

.PHONY: demo install lint test test-all test-cluster floor hard precision bench mutants headline accuracy cluster-overhead
.PHONY: honesty paper paper-report clean

demo: $(STAMP)
	$(BIN)/goniosim simulate configs/quickstart.yaml -o out/quickstart.h5
	$(BIN)/goniosim plot out/quickstart.h5 -o out

install: $(STAMP)

$(STAMP): pyproject.toml constraints.txt
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet -c constraints.txt -e ".[test]"
	touch $@

lint: $(LINTERS)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

$(LINTERS): $(STAMP)
	$(BIN)/python -m pip install --quiet -c constraints.txt -e ".[lint]"
	touch $@

test: $(STAMP)
	$(BIN)/python -m pytest $(WORKERS) -m "not slow and not cluster"

# Without dieharder, which is installed if need be and possible, the tests that need it fail and say so.
test-all: $(STAMP)
	-tests/hard/install-dieharder
	$(BIN)/python -m pytest $(WORKERS) -m "not cluster"

# Numbers of tests, below which the suite fails: to be written when tests were added or taken away.
floor: $(STAMP)
	$(BIN)/python -m pytest --write-floor
	git diff --stat tests/floor.txt

# On a Slurm of one node, which is installed if there is none, and started by the tests for themselves.
test-cluster: $(STAMP)
	tests/cluster/install
	$(BIN)/python -m pytest tests/cluster -m cluster

# Deliberate bugs, each of which the suite has to catch; an hour or more. LIST=1 prints them, ONLY='store/*' tries some.
mutants: $(STAMP)
	$(BIN)/python -m tests.mutants $(if $(LIST),--list) '$(ONLY)'

# The catalogue of hard cases, and docs/hard_cases.md; some minutes.
hard: $(STAMP)
	$(BIN)/goniosim hard -o docs/hard_cases.md

bench: $(STAMP)
	$(BIN)/python benchmarks/throughput.py

# Time per slice for the noise of 160 million independent paths, over the 60 materials.
headline: $(STAMP)
	$(BIN)/python benchmarks/headline.py

# docs/accuracy_and_time.md, its tables and pictures; some minutes, on an idle machine.
accuracy: $(STAMP)
	$(BIN)/python -m benchmarks.accuracy_and_time

# The measured part of docs/cluster.md; some minutes, on an idle machine.
cluster-overhead: $(STAMP)
	$(BIN)/python -m benchmarks.cluster

# docs/honesty.txt: the scatter over 40 seeds against what error bars state; half an hour.
honesty: $(STAMP)
	$(BIN)/python -m benchmarks.honesty > docs/honesty.txt

# docs/precision.md: every function beside the same mathematics in 40 digits; some minutes.
precision: $(STAMP)
	$(BIN)/python -m benchmarks.precision

# Files that hold these rays or more are left alone; with more RAYS all are simulated anew. For fewer, remove the folder.
paper: $(STAMP)
	$(BIN)/goniosim simulate configs/paper/plastics.yaml --rays $(RAYS) -o $(PAPER)
	$(BIN)/goniosim simulate configs/paper/metals.yaml --rays $(RAYS) -o $(PAPER)
	$(BIN)/goniosim simulate configs/paper/slabs.yaml --rays $(RAYS) -o $(PAPER)
	$(MAKE) paper-report

# What is derived from the results: a make of its own, which sees the files that are there by now.
MODEL_CODE := $(shell find $(addprefix goniosim/,compare integration models optics scene slices) -name '*.py' 2>/dev/null)
STUDY_CODE := $(shell find benchmarks/paper_study -name '*.py')
COMPARED := $(PAPER)/comparison/.done
VARIED := $(PAPER)/experiments.csv
WRITTEN := $(PAPER)/.written

paper-report: $(WRITTEN)

$(COMPARED): $(wildcard $(PAPER)/*.h5) $(MODEL_CODE)
	$(BIN)/goniosim compare $(PAPER) -o $(PAPER)/comparison > $(PAPER)/ranking.txt
	touch $@

$(VARIED): $(COMPARED) $(wildcard benchmarks/paper_study/experiments/*.py)
	$(BIN)/python -m benchmarks.paper_study $(PAPER) --experiments

$(WRITTEN): $(VARIED) $(STUDY_CODE)
	$(BIN)/python -m benchmarks.paper_study $(PAPER)
	touch $@

clean:
	rm -rf $(VENV) out build *.egg-info
