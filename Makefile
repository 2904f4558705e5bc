# Holonom: set-up, the main job, the tests. `make help` lists the targets.

BIN     := .venv/bin
STAMP   := .venv/installed
TEST    := $(BIN)/pytest -q --numprocesses auto --dist loadgroup
SCENES  := $(filter-out %/printed.mac examples/hard/%,$(shell find examples -name '*.mac' | sort))
RECORDS := $(SCENES:%.mac=build/%.json)
SOURCES := $(shell find maxima harness -name '*.mac' -o -name '*.lisp' -o -name '*.py')

.DEFAULT_GOAL := paper
.DELETE_ON_ERROR:
.PHONY: paper companion check check-long mutants bench setup install pictures clean help have-maxima have-compiler have-gsl have-bubblewrap have-python

paper: setup $(RECORDS) companion ## Derive and check every scene, compare the paper as printed (the default)
	$(BIN)/holonom check $(SCENES) --json build/check.json
	$(BIN)/holonom errata --json build/errata.json
	@echo "The derivations are in build/examples/, the verdicts in build/check.json, the misprints in build/errata.json, the textbook companion in build/companion/index.html."

companion: setup ## Make the textbook companion: build/companion/index.html
	$(BIN)/holonom companion -o build/companion
	$(BIN)/python -m holonom.reference.manual build/holonom.1

check: setup ## Lint, then run the tests, Maxima's own rtest files among them
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(TEST) -m "not long"

check-long: setup ## Run the tests that take too long for every change
	$(TEST) -m long || [ $$? = 5 ]    # 5: there are none

mutants: setup ## Make wrong programs of a fixed list, one at a time, and tell which of them no test finds
	nice $(BIN)/python tests/mutants/run.py build/mutants.json

setup: have-maxima have-compiler have-gsl have-bubblewrap $(STAMP) ## Install what is missing: Maxima, a C compiler, GSL, bubblewrap, and the Python packages in .venv

install: setup ## Put Holonom into Maxima's user directory, where load(holonom) finds it
	$(BIN)/holonom maxima-path

bench: export OPENBLAS_NUM_THREADS = 1
bench: setup ## Time the motion program, the power series and simulations against their peers: tables and figures
	$(BIN)/pip install --quiet --disable-pip-version-check --constraint constraints.txt --editable '.[dev,motion,sweep,companion,bench]'
	$(BIN)/python tests/benchmarks/run.py build/benchmarks
	$(BIN)/python tests/benchmarks/series.py build/benchmarks
	$(BIN)/python tests/benchmarks/simulation.py build/benchmarks
	cp build/benchmarks/chain.svg build/benchmarks/chain.txt tests/benchmarks/
	cp build/benchmarks/series.svg build/benchmarks/series.txt tests/benchmarks/
	cp build/benchmarks/simulation.svg build/benchmarks/simulation.txt tests/benchmarks/

pictures: setup ## Draw the README's pictures and run the notebooks again
	$(BIN)/holonom errata --force --svg examples/paper/errata.svg > /dev/null
	$(BIN)/python -m holonom.figures.radius examples/paper/radius.svg
	$(BIN)/holonom stability --force --plot examples/hard/stability.svg > /dev/null
	$(BIN)/jupyter execute --inplace examples/notebooks/*.ipynb

clean: ## Remove all that make made
	rm -rf build .venv .pytest_cache .ruff_cache .hypothesis *.egg-info
	find harness tests -name __pycache__ -prune -exec rm -rf {} +

help: ## List the targets
	@sed -n 's/^\([a-z-]*\):.*## /\1\t/p' $(MAKEFILE_LIST) | expand -t 12

# The derivation of one scene: the record as JSON, and beside it its equations as text.
build/%.json: %.mac $(SOURCES) | setup
	@mkdir -p $(@D)
	$(BIN)/holonom derive $< --json $@ > $(@:.json=.txt)

# A Debian package, installed as root, or one sentence why not.
define install
{ as_root=sudo; if [ "$$(id -u)" = 0 ]; then as_root=env; fi; \
  command -v apt-get >/dev/null && command -v $$as_root >/dev/null || { \
    echo "Holonom needs $(1), and it takes apt-get and root rights to install it: please install it yourself." >&2; exit 2; }; \
  $$as_root apt-get update -qq && $$as_root DEBIAN_FRONTEND=noninteractive apt-get install -qq $(1); }
endef

have-maxima:
	@command -v maxima >/dev/null || $(call install,maxima)

have-compiler:
	@command -v cc >/dev/null || $(call install,gcc libc6-dev)

have-gsl:
	@command -v gsl-config >/dev/null || ( $(call install,libgsl-dev) ) || \
	  echo "Without the GNU Scientific Library there is no Runge-Kutta engine; all the rest works." >&2

have-bubblewrap:
	@command -v bwrap >/dev/null || ( $(call install,bubblewrap) ) || \
	  echo "Without bubblewrap a scene file is confined by limits alone and may reach your files; all works." >&2

# The first Python that is new enough; python3 is the last resort because it may be anything.
PYTHON = $(shell for python in python3.11 python3.12 python3.13 python3; do \
  $$python -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null && echo $$python && break; done)

have-python:
	@command -v python3 >/dev/null || $(call install,python3-venv)

$(STAMP): pyproject.toml constraints.txt | have-python
	@test -n "$(PYTHON)" || { echo "Holonom needs Python 3.11 or later: please install it." >&2; exit 2; }
	@$(PYTHON) -c 'import ensurepip' 2>/dev/null || $(call install,$(notdir $(PYTHON))-venv)
	$(PYTHON) -m venv --clear .venv
	$(BIN)/pip install --quiet --disable-pip-version-check --constraint constraints.txt --editable '.[dev,motion,sweep,companion]'
	@touch $@
