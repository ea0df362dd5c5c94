# Everything here works from a fresh clone: the targets set up what they need.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed
LINTERS := $(VENV)/.linters

.PHONY: demo install lint test test-all bench clean

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
	$(BIN)/python -m pytest -m "not slow"

test-all: $(STAMP)
	$(BIN)/python -m pytest

bench: $(STAMP)
	$(BIN)/python benchmarks/throughput.py

clean:
	rm -rf $(VENV) out build *.egg-info
