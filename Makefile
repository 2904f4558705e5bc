# Holonom: set-up, the main job, the tests. `make help` lists the targets.

BIN     := .venv/bin
STAMP   := .venv/installed
TEST    := $(BIN)/pytest -q --numprocesses auto --dist loadgroup --no-loadscope-reorder
SCENES  := $(filter-out %/printed.mac %/by_hand.mac examples/hard/%,$(shell find examples -name '*.mac' | sort))
RECORDS := $(SCENES:%.mac=build/%.json)
SOURCES := $(shell find maxima harness -type f -not -path '*/__pycache__/*')
PRINTED := examples/paper/printed.mac
HARD    := $(shell find examples/hard -name '*.mac')

# Where Python writes no bytecode, each of the hundreds of processes of a run compiles the package again.
unexport PYTHONDONTWRITEBYTECODE

.DEFAULT_GOAL := paper
.DELETE_ON_ERROR:
.PHONY: paper companion book catalog check check-long check-lisps mutants tampering bench dist setup install pictures clean help have-programs have-chinese-letters

paper: $(RECORDS) build/check.json build/errata.json companion ## Derive and check every scene, compare the paper as printed (the default)
	@echo "The derivations are in build/examples/, the verdicts in build/check.json, the misprints in build/errata.json, the book and the manual in build/site/index.html."

companion: build/site/index.html build/holonom.1 ## Make the book and the manual: build/site/index.html, in Chinese build/site/zh/index.html

build/check.json: $(SCENES) $(SOURCES) | setup
	$(BIN)/holonom check $(SCENES) --json $@

build/errata.json: $(PRINTED) $(SCENES) $(SOURCES) | setup
	$(BIN)/holonom errata --json $@

build/site/index.html: $(PRINTED) $(SCENES) $(HARD) $(SOURCES) | setup
	$(BIN)/holonom companion --language en --language zh -o $(@D)

book: build/book.pdf ## Print the textbook companion, with Chromium: build/book.pdf, build/book.zh.pdf

build/book.pdf: $(PRINTED) $(SCENES) $(HARD) $(SOURCES) | setup have-chinese-letters
	$(BIN)/holonom companion --language en --language zh -o build/site --pdf $@

catalog: setup ## Collect the messages to be translated: harness/locale/, and say which have no translation yet
	$(BIN)/python tests/catalog.py

build/holonom.1: build/site/index.html
	$(BIN)/sphinx-build -q -W -b man -D language=en -d build/site/.doctrees harness/companion $(@D)

check: setup ## Lint, then run the tests, Maxima's own rtest files among them
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(TEST) -m "not long"

check-long: setup ## Run the tests that take too long for every change
	$(TEST) -m long || [ $$? = 5 ]    # 5: there are none

check-lisps: setup ## Ask Debian's Maxima on ECL, maxima-sage, for the same programs as the first Maxima
	HOLONOM_TEST_MAXIMAS="$$(command -v maxima-sage)" $(TEST) tests/test_lisps.py

mutants: setup ## Make wrong programs at random, one at a time, and count those that no test finds: SEED=... COUNT=... JOBS=...
	$(BIN)/pip install --quiet --disable-pip-version-check --constraint constraints.txt --editable '.[dev,motion,sweep,companion,mutants]'
	nice $(BIN)/python tests/mutants/run.py build/mutants.json $(SEED:%=--seed %) $(COUNT:%=--count %) $(JOBS:%=--jobs %)

tampering: setup ## Make wrong records of twenty scenes, and tell how many of each class `holonom check` finds
	nice $(BIN)/python tests/crosscheck/tampering/tamper.py $(SEED)

setup: have-programs $(STAMP) ## Install what is missing: Maxima, a C compiler, bubblewrap, and the Python packages in .venv

install: setup ## Put Holonom into Maxima's user directory, where load(holonom) finds it
	$(BIN)/holonom maxima-path

dist: setup ## Build the sdist and the wheel, check them, install the wheel on each Python at hand: dist/
	$(BIN)/pip install --quiet --disable-pip-version-check build twine
	rm -rf dist && $(BIN)/python -m build --outdir dist .
	$(BIN)/twine check --strict dist/*
	for python in python3.11 python3.12 python3.13 python3.14; do \
	  $$python -c '' 2>/dev/null || continue; \
	  rm -rf build/dist-venv && $$python -m venv build/dist-venv && \
	  build/dist-venv/bin/pip install --quiet --disable-pip-version-check --constraint constraints.txt dist/*.whl && \
	  build/dist-venv/bin/holonom --help > /dev/null && echo "$$python: installed" || exit 1; done
	cd dist && sha256sum *.whl *.tar.gz > SHA256SUMS && cat SHA256SUMS

bench: export OPENBLAS_NUM_THREADS = 1
bench: setup ## Time the motion program, power series, simulations and sweeps against their peers: tables and figures
	$(BIN)/pip install --quiet --disable-pip-version-check --constraint constraints.txt --editable '.[dev,motion,sweep,companion,bench]'
	$(BIN)/python tests/benchmarks/run.py build/benchmarks
	$(BIN)/python tests/benchmarks/size.py build/benchmarks
	$(BIN)/python tests/benchmarks/ring.py build/benchmarks
	$(BIN)/python tests/benchmarks/tree.py build/benchmarks
	$(BIN)/python tests/benchmarks/commands.py build/benchmarks
	$(BIN)/python tests/benchmarks/series.py build/benchmarks
	$(BIN)/python tests/benchmarks/simulation.py build/benchmarks
	$(BIN)/python tests/benchmarks/sweep.py build/benchmarks
	$(BIN)/python tests/benchmarks/sensitivities.py build/benchmarks
	cp build/benchmarks/chain.svg build/benchmarks/chain.txt tests/benchmarks/
	cp build/benchmarks/size.txt build/benchmarks/ring.txt build/benchmarks/tree.txt build/benchmarks/commands.txt tests/benchmarks/
	cp build/benchmarks/series.svg build/benchmarks/series.txt tests/benchmarks/
	cp build/benchmarks/simulation.svg build/benchmarks/simulation.txt tests/benchmarks/
	cp build/benchmarks/sweep.txt build/benchmarks/sensitivities.txt tests/benchmarks/

pictures: setup ## Draw the README's pictures and run the notebooks again
	$(BIN)/holonom errata --force --svg examples/paper/errata.svg > /dev/null
	$(BIN)/holonom stability --force --plot examples/hard/stability.svg > /dev/null
	$(BIN)/holonom -q simulate examples/overhead_crane.mac --samples 61 --force --film examples/gallery/overhead_crane.svg
	$(BIN)/holonom -q simulate examples/arm.mac --scene circle_scene --samples 61 --force --film examples/gallery/arm.svg
	$(BIN)/holonom -q simulate examples/linkage.mac --until 3 --samples 121 --force --film examples/gallery/linkage.svg
	$(BIN)/holonom -q simulate examples/stewart_platform.mac --samples 61 --force --film examples/gallery/stewart_platform.svg
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

# The first Python that is new enough; python3 is the last resort because it may be anything.
PYTHON = $(shell for python in python3.11 python3.12 python3.13 python3; do \
  $$python -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null && echo $$python && break; done)

# Debian's packages of what is missing are installed as root; where that is not to be had, all of them are told at once,
# and what can be made without them is.
define install-missing
	[ -n "$$missing" ] || exit 0; \
	as_root=; \
	if [ "$$(id -u)" = 0 ]; then as_root=env; \
	elif sudo -n true 2>/dev/null; then as_root="sudo -n"; \
	elif [ -t 0 ] && command -v sudo >/dev/null; then as_root=sudo; fi; \
	if [ -n "$$as_root" ] && command -v apt-get >/dev/null && $$as_root apt-get update -qq && \
	  $$as_root env DEBIAN_FRONTEND=noninteractive apt-get install -qq $$missing; then exit 0; fi; \
	{ echo "Missing here, and not to be installed without root rights or apt-get:$$missing."; \
	  echo "The line for an administrator: apt-get update && apt-get install$$missing"; \
	  echo "make goes on with what is there."; } >&2
endef

# Maxima, a C compiler, bubblewrap, which keeps scene files from your own, and Python's venv.
have-programs:
	@missing=; python="$(PYTHON)"; \
	command -v maxima >/dev/null || missing="$$missing maxima"; \
	command -v cc >/dev/null || missing="$$missing gcc libc6-dev"; \
	command -v bwrap >/dev/null || missing="$$missing bubblewrap"; \
	if [ -z "$$python" ]; then missing="$$missing python3-venv"; \
	elif ! $$python -c 'import ensurepip' 2>/dev/null; then missing="$$missing $${python##*/}-venv"; fi; \
	$(install-missing)

# A font that the printed book in Chinese carries.
have-chinese-letters:
	@missing=; \
	fc-list :lang=zh 2>/dev/null | grep -q . || missing="$$missing fonts-noto-cjk"; \
	$(install-missing)

$(STAMP): pyproject.toml constraints.txt | have-programs
	@test -n "$(PYTHON)" || { echo "Holonom needs Python 3.11 or later: please install it." >&2; exit 2; }
	@$(PYTHON) -c 'import ensurepip' || { echo "$(PYTHON) has no ensurepip, which makes .venv: please install its package for venv." >&2; exit 2; }
	$(PYTHON) -m venv --clear .venv
	$(BIN)/pip install --quiet --disable-pip-version-check --constraint constraints.txt --editable '.[dev,motion,sweep,companion]'
	@touch $@
