# Two commands do all the set-up: `make demo` and `make test`.
PYTHON ?= python3
VENV ?= .venv
BIN := $(VENV)/bin
ifeq ($(OS),Windows_NT)
BIN := $(VENV)/Scripts
endif
PACKAGE_STAMP := $(VENV)/.installed-package
STAMP := $(VENV)/.installed
RELEASE_STAMP := $(VENV)/.installed-release
DOCS_STAMP := $(VENV)/.installed-docs
# The same versions today and next year, those of build tools too; pip itself first, as older ones hold less.
INSTALL := -m pip install --quiet --constraint constraints.txt --build-constraint constraints.txt
PYTEST := -m pytest -n auto --dist worksteal
# The tiers that `make test` leaves out; CONTRIBUTING.md says what is in each.
LATER := rest or docs or types or kernels

.PHONY: setup constraints demo selfcheck test test-all test-rest test-newest test-oldest test-kernels test-versions test-elsewhere damage soak crash bounds fuzz fields \
	properties budget lint type contracts check bench kernels same-kernels validation free-blocks scoreboard trust trust-check pages pictures \
	docs docs-check words release clean

setup: $(STAMP)  ## Create the environment and install the package with its development tools

$(PACKAGE_STAMP): pyproject.toml constraints.txt
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --constraint constraints.txt --upgrade pip
	$(BIN)/python $(INSTALL) --editable .
	$(BIN)/python -m compileall -q rocking_cli mechanisms
	$(BIN)/python -c "import pathlib; pathlib.Path('$(PACKAGE_STAMP)').touch()"

$(STAMP): $(PACKAGE_STAMP)
	$(BIN)/python $(INSTALL) --editable ".[dev]"
	$(BIN)/python -c "import pathlib; pathlib.Path('$(STAMP)').touch()"

constraints: setup  ## Write constraints.txt: the newest versions that pyproject.toml allows, for all Pythons and systems
	$(BIN)/python -m uv pip compile --quiet --universal --all-extras --python-version 3.11 --upgrade --no-annotate \
		--custom-compile-command "make constraints" --output-file constraints.txt pyproject.toml

demo: $(PACKAGE_STAMP)  ## The main job on the shipped example: equiv, respond with a plot, pulse; and a quick selfcheck
	$(BIN)/python -c "import pathlib; pathlib.Path('out').mkdir(exist_ok=True)"
	$(BIN)/rocking equiv examples/frame.yaml
	$(BIN)/rocking respond examples/frame.yaml --record examples/accel.csv --plot out/response.png --out out/history.csv
	$(BIN)/rocking pulse --a 2 --omega 3
	$(BIN)/rocking selfcheck --quick

selfcheck: $(PACKAGE_STAMP)  ## Whether this installation computes correctly
	$(BIN)/rocking selfcheck

test: setup  ## What to run before a commit, and the twenty slowest
	$(BIN)/python $(PYTEST) -m "not ($(LATER))" --durations=20

test-all: test  ## All tests: those of `test`, then those of all other tiers
	$(BIN)/python $(PYTEST) -m "$(LATER)"

test-rest: setup  ## Those that `test` leaves out and no other target runs
	$(BIN)/python $(PYTEST) -m rest --durations=20

test-newest test-oldest: test-%: setup  ## One case of each test that rests on libraries, with their newest versions, and with the oldest that pyproject.toml allows
	$(BIN)/python -m uv venv --quiet --clear --python $(BIN)/python out/$*
	$(BIN)/python -m uv pip install --quiet --python out/$* --resolution $(RESOLUTION-$*) --editable ".[dev]"
	$(BIN)/python -m tests.elsewhere files | xargs out/$*/$(notdir $(BIN))/python $(PYTEST) -m "not ($(LATER) or again)"

RESOLUTION-newest := highest
RESOLUTION-oldest := lowest-direct

test-kernels: setup  ## The tests of fits, studies, linkages and spectra, with the last bits as other processors round them
	$(BIN)/python -m tests.elsewhere kernels

test-versions: setup  ## One case of each, and of what rests on Python, with its first and its last version if they are installed here
	$(BIN)/python -m tests.elsewhere versions

test-elsewhere: setup  ## Both, side by side
	$(BIN)/python -m tests.elsewhere kernels versions

damage: setup  ## What is said of real records that lost a character; DAMAGE=2000 is how often, ROCKING_RECORDS where they are
	$(BIN)/python -m tests.damage

budget: setup  ## Lines of code of each folder; lowers the numbers in tests/house/budget.toml
	$(BIN)/python -m tests.house.budget

lint: setup
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

type: setup
	$(BIN)/mypy
	$(BIN)/python $(PYTEST) -m types

contracts: setup  ## Who may import whom
	$(BIN)/lint-imports

check: lint type contracts test

bench: setup  ## Ratios within one run; see docs/performance.md. RECORD=FILE for a record of your own
	-$(BIN)/python $(INSTALL) ".[bench]"
	$(BIN)/python benchmarks/starting.py
	$(BIN)/python benchmarks/histories.py $(RECORD)
	$(BIN)/python benchmarks/yardstick.py $(RECORD)
	$(BIN)/python benchmarks/maps.py
	-$(BIN)/python benchmarks/pages.py
	$(BIN)/python benchmarks/fragility.py
	$(BIN)/python benchmarks/fits.py
	$(BIN)/python benchmarks/linkages.py
	$(BIN)/python benchmarks/joints.py
	$(BIN)/python benchmarks/walls.py
	$(BIN)/python benchmarks/importing.py

fuzz: setup  ## Hostile records, structures and command lines; INPUTS=100000 is how many
	$(BIN)/python -c "import os, sys, pytest; os.environ['ROCKING_FUZZ'] = '$(or $(INPUTS),10000)'; sys.exit(pytest.main(['-q', 'tests/cli/test_fuzz.py']))"

fields: setup  ## Every field of every example and starter, spoilt in every way; PAIRS=1000 is how many pairs as well
	$(BIN)/python -c "import os, sys, pytest; os.environ['ROCKING_FIELDS'] = '$(or $(PAIRS),1000)'; sys.exit(pytest.main(['-q', 'tests/cli/test_fields.py']))"

properties: setup  ## New examples for every property test, random ones; EXAMPLES=1000 is how many for each
	$(BIN)/python -c "import os, sys, pytest; os.environ['ROCKING_PROPERTIES'] = '$(or $(EXAMPLES),500)'; sys.exit(pytest.main(['-q', '-n', 'auto', '-m', 'hypothesis', '--ignore=tests/cli/test_fuzz.py', 'tests']))"

bounds: setup  ## Random structures with every bound of the code as it is and doubled, ten minutes; CASES, FREE: how many, by free blocks
	$(BIN)/python -m tests.bounds

soak: setup  ## What takes too long for the tests, an hour: damaged stores, races, kills, spoilt records; READERS=20 is how often
	$(BIN)/python -m tests.soak

crash: setup  ## A quarter of an hour: every command that writes, ended and made to fail at each call on its folder; NAMES: which of them
	$(BIN)/python -m tests.crash $(NAMES)

validation: setup  ## Renew the tables of docs/validation.md
	$(BIN)/python -m docs.make_validation

free-blocks: setup  ## Renew the evidence of docs/free_blocks.md, ten minutes
	$(BIN)/python -m docs.make_free_blocks

EXPERIMENTS := $(or $(ROCKING_EXPERIMENTS),../shared/experiments)
scoreboard: setup  ## Write the lines of this version into docs/scoreboard.md; ROCKING_EXPERIMENTS is the folder of the tests
	$(BIN)/python -m validation.scoreboard "$(EXPERIMENTS)"

# As most processors round, not those with AVX-512: late impacts, and so the share of one of 600 tests, hang on last bits.
ROUNDING := OPENBLAS_CORETYPE=Haswell NPY_DISABLE_CPU_FEATURES="X86_V4 AVX512_ICL AVX512_SPR"
trust: setup  ## Renew docs/how_far_to_trust_it.md and its data, an hour
	$(BIN)/python -m validation.traces
	$(BIN)/python -m validation.middle "$(EXPERIMENTS)"
	$(ROUNDING) $(BIN)/python -m validation.trust "$(EXPERIMENTS)"

trust-check: setup  ## Whether that page is stale, two minutes; without the tests nothing is checked
	$(ROUNDING) $(BIN)/python -m validation.trust "$(EXPERIMENTS)" --check

KERNELS := out/kernels
kernels: $(PACKAGE_STAMP)  ## Compile the kernels that are shipped, rocking_cli/dynamics/ready; READY=FOLDER for another place
	$(PYTHON) -m venv $(KERNELS)
	$(KERNELS)/$(notdir $(BIN))/python -m pip install --quiet platformdirs $$($(BIN)/python -c "from rocking_cli.dynamics.shipped import MADE_BY; print(*map('=='.join, MADE_BY.items()))")
	$(KERNELS)/$(notdir $(BIN))/python scripts/make_kernels.py $(READY)

same-kernels: setup  ## Make the shipped kernels anew, by Python 3.11 as they were, and compare them and what they compute
	$(MAKE) kernels PYTHON=$(PYTHON) READY=out/ready
	diff -r out/ready rocking_cli/dynamics/ready
	$(BIN)/python $(PYTEST) -m kernels

pictures: setup  ## Write the pictures that the tests compare with anew; look at them before committing
	$(BIN)/python -m tests.render

$(DOCS_STAMP): $(STAMP)
	$(BIN)/python $(INSTALL) --editable ".[docs]"
	$(BIN)/python -c "import pathlib; pathlib.Path('$(DOCS_STAMP)').touch()"

pages: $(DOCS_STAMP)  ## Every made page, list and picture: the types of the package, outputs and options in the pages, examples in Python
	$(BIN)/python docs/make_stub.py
	$(BIN)/python docs/make_pages.py
	$(BIN)/python -m docs.make_validation
	$(BIN)/python docs/make_python.py

docs: pages  ## The documentation as a site, out/site/index.html; every warning is an error
	$(BIN)/python -m sphinx -W --keep-going -E -q -b html -d out/doctrees docs out/site

docs-check: docs words  ## Both, and an error if `make pages` had to renew anything
	git diff --exit-code --stat -- docs README.md rocking_cli/__init__.pyi
	ROCKING_SITE=out/site $(BIN)/python -m pytest -q -m docs tests/house/test_site.py tests/house/test_docs.py -k "test_site or every_command"

words:  ## The words of the pages by topic, and an error if a topic has more than its number
	$(PYTHON) docs/count_words.py

$(RELEASE_STAMP): $(PACKAGE_STAMP)
	$(BIN)/python $(INSTALL) --editable ".[release]"
	$(BIN)/python -c "import pathlib; pathlib.Path('$(RELEASE_STAMP)').touch()"

release: $(RELEASE_STAMP)  ## dist/: source distribution and a wheel for each system, checked, installed elsewhere and tried there
	$(BIN)/python scripts/release.py

clean:
	$(PYTHON) -c "import shutil; [shutil.rmtree(p, ignore_errors=True) for p in ('$(VENV)', 'out', 'dist', 'docs/_generated', '.mypy_cache', '.ruff_cache', '.pytest_cache')]"
