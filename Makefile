# Every command sets up what it needs; `make setup` alone prepares .venv.
.PHONY: setup run test check soak lock vocabulary vendor picture screenshots evaluation choices relations bench
VENV := .venv
PYTHON := $(VENV)/bin/python
STAMP := $(VENV)/.complete

setup: $(STAMP)

$(STAMP): requirements.lock pyproject.toml client/pyproject.toml
	python3 -m venv $(VENV)
	$(VENV)/bin/pip install --quiet --disable-pip-version-check --requirement requirements.lock
	$(VENV)/bin/pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation --editable . --editable client
	touch $@

run: setup
	$(VENV)/bin/faience serve --samples

test: setup
	$(PYTHON) -m pytest -n 2 --dist loadfile --no-loadscope-reorder

check: setup
	$(VENV)/bin/ruff check .
	$(VENV)/bin/ruff format --check .
	$(VENV)/bin/mypy
	$(VENV)/bin/lint-imports
	$(PYTHON) -m soak.audit requirements.lock

# Breaks the service on purpose for about a quarter of an hour: kills, mutants, cut and stalled uploads, full disks; fills docs/promises.md
soak: setup
	$(PYTHON) -m soak

# Writes the exact versions now in .venv; run after changing pyproject.toml and installing.
lock:
	$(VENV)/bin/pip list --format=freeze --exclude faience --exclude faience-client --exclude pip > requirements.lock

# Learns the vocabulary that ships with the project again, from shapes made by its own code.
vocabulary: setup
	$(PYTHON) -m benchmarks.default_vocabulary

# Bundles the npm packages that the page uses again, after a version was changed in the script; needs node and npm.
vendor:
	service/static/vendor/refresh.sh

# Draws the picture of the README.
picture: setup
	$(PYTHON) -m benchmarks.picture

# Draws the pictures of the page in the README, in the system's Chromium.
screenshots: setup
	$(PYTHON) -m benchmarks.screenshots

# Measures every method on a folder of shapes and poses, and fills the tables of docs/evaluation.md: make evaluation DATA=folder
evaluation: setup
	$(VENV)/bin/faience evaluate $(DATA) --hard --ablation
	$(PYTHON) -m benchmarks.evaluation_page faience-evaluation/results.json

# Measures what the choices cost that the paper leaves open, and fills the tables of docs/choices.md: make choices DATA=folder
choices: setup
	$(PYTHON) -m benchmarks.choices $(DATA)

# Measures how well relations are told, and fills the tables of docs/relations.md: make relations DATA=folder
relations: setup
	$(PYTHON) -m benchmarks.relations $(DATA)

# Measures what describing and searching cost, and fills the tables of docs/speed.md (half an hour): make bench DATA=folder
bench: setup
	$(PYTHON) -m benchmarks.bench $(DATA)
