# `make demo` and `make test` set up everything they need in .venv; Python 3.11+ and make are all a machine must have.
# Bytecode is written, whatever the environment says: the tests start hundreds of programs that import the package.
unexport PYTHONDONTWRITEBYTECODE
PYTHON ?= python3
VENV   := .venv
BIN    := $(VENV)/bin

.PHONY: demo test lint warm tests quick soak urdf docs wheel check-release lock clean

demo: $(VENV)/installed
	$(BIN)/pin-metaik demo

# The sources are checked while the loops are compiled.
test: $(VENV)/developed
	$(MAKE) --jobs=2 lint warm
	$(MAKE) tests

lint: $(VENV)/developed
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

# Every loop is compiled first, on all cores: or each of the tests' processes would compile what another has begun.
warm: $(VENV)/developed
	$(BIN)/pin-metaik warm

tests: warm
	$(BIN)/python -m pytest -n 2 --dist loadgroup

quick: warm
	$(BIN)/python -m pytest -n 2 --dist loadgroup -m "not slow"

# Hours: what the tests ask a few times, asked until nothing is left to find. Pages in benchmarks/ say what came of it.
soak: $(VENV)/developed
	$(BIN)/python -m pytest -n 2 tests/properties --hypothesis-profile=deep
	$(BIN)/python benchmarks/claims.py
	$(BIN)/python benchmarks/fuzz.py
	$(BIN)/python benchmarks/faults.py
	$(BIN)/python benchmarks/load.py

urdf: $(VENV)/installed
	$(BIN)/pin-metaik urdf --all

# The site, in build/docs: every example is run, warnings are errors, internal links are checked, pictures drawn again.
docs: $(VENV)/documented
	$(BIN)/python -m sphinx -c docs -b html --fail-on-warning --keep-going --quiet . build/docs
	$(BIN)/python docs/links.py build/docs
	$(BIN)/python docs/pictures.py --check
	@echo "open build/docs/index.html"

# The sdist, and a wheel for this platform and this Python with machine code in it.
wheel: $(VENV)/developed
	rm -rf dist
	$(BIN)/python -m build --outdir dist .
	$(BIN)/python .github/wheel.py dist/*.whl

check-release: wheel
	$(BIN)/python -m twine check --strict dist/*
	$(BIN)/python .github/check_wheel.py dist/*.whl

# The versions that CI installs, of everything, for each Python and system: written anew to have newer ones.
lock:
	$(PYTHON) -m venv build/lock
	build/lock/bin/python -m pip install --quiet uv
	build/lock/bin/uv pip compile --quiet --universal --python-version 3.11 --extra dev --no-annotate \
		--custom-compile-command "make lock" --upgrade --output-file .github/constraints.txt pyproject.toml

clean:
	rm -rf $(VENV) dist build .mypy_cache .ruff_cache .pytest_cache

# Bytecode is left to the first import: to write it for all that is installed takes a third of the time.
$(VENV)/installed: pyproject.toml
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --no-compile --editable .
	touch $@

$(VENV)/developed: $(VENV)/installed
	$(BIN)/python -m pip install --quiet --no-compile --editable ".[dev]"
	touch $@

$(VENV)/documented: $(VENV)/installed
	$(BIN)/python -m pip install --quiet --editable ".[docs]"
	touch $@
