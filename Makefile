PYTHON ?= python3
CPU ?= silvermont
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed

.PHONY: setup demo test lint bench evaluate wheels clean

setup: $(STAMP)

$(STAMP): pyproject.toml constraints.txt
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e '.[dev]'
	touch $(STAMP)

demo: setup
	$(BIN)/naod demo $(ARGS)

test: setup
	$(BIN)/python -m pytest $(ARGS)

lint: setup
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

bench: setup
	$(BIN)/naod bench $(ARGS)

evaluate: setup
	$(BIN)/python -m pytest -m slow $(ARGS)

wheels: setup
	$(BIN)/python -m naod.kernels.build --cpu $(CPU)
	$(BIN)/python -m pip wheel --quiet --disable-pip-version-check -c constraints.txt -w wheels ".[naoqi]"

clean:
	rm -rf $(VENV) build dist wheels naod/kernels.tar naod/kernels.json *.egg-info ~/.cache/naod
