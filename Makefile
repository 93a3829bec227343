# The face of the project: `make help` lists what there is. GNU make 3.81 and a POSIX shell are enough.

# Twelve frames on one sheet are small: drafts, unless PRESET says otherwise.
SHEET_PRESET := $(if $(filter undefined,$(origin PRESET)),draft,$(value PRESET))
PRESET ?= preview
ASPECT ?=
FRAME ?= 0
FRAMES ?=
NAME ?=
KIND ?=
VIEW ?=
SHOW ?=
SPECTRA ?=
BED ?=
KERNELS ?=
GAP ?=
N ?=
HOST ?=
FOLDER ?=
ONLY ?=
WATTS ?=
STRICT ?=
ANYWAY ?=
SEED ?= 1
CLUSTER ?=
CLUSTER_TLS ?=
PYTEST ?= -n 2 --dist loadscope --no-loadscope-reorder

# Words of the user are taken as they are: make expands nothing in them, and commands get them through the environment,
# where no shell reads them. Python refuses what is no name (shared/stage/paths.py).
override PRESET := $(value PRESET)
override ASPECT := $(value ASPECT)
override FRAME := $(value FRAME)
override FRAMES := $(value FRAMES)
override NAME := $(value NAME)
override KIND := $(value KIND)
override VIEW := $(value VIEW)
override SHOW := $(value SHOW)
override SPECTRA := $(value SPECTRA)
override BED := $(value BED)
override KERNELS := $(value KERNELS)
override GAP := $(value GAP)
override N := $(value N)
override HOST := $(value HOST)
override FOLDER := $(value FOLDER)
override ONLY := $(value ONLY)
override SEED := $(value SEED)
override STRICT := $(filter-out 0,$(value STRICT))
override WATTS := $(value WATTS)
override ANYWAY := $(value ANYWAY)
override CLUSTER := $(value CLUSTER)
override CLUSTER_TLS := $(value CLUSTER_TLS)
override MECHANISM = $(subst -,_,$*)
export PRESET SHEET_PRESET ASPECT FRAME FRAMES NAME KIND VIEW SHOW SPECTRA BED KERNELS GAP MECHANISM N HOST FOLDER ONLY WITHIN WATTS SEED
export CLUSTER CLUSTER_TLS ANYWAY STRICT

PRESETS := draft preview production final
ifneq ($(words $(PRESET)) $(filter $(PRESETS),$(PRESET)),1 $(PRESET))
$(error PRESET=$(PRESET) is not a preset; choose one of: $(PRESETS))
endif

ASPECTS := 16:9 1:1 4:5 9:16
ifneq ($(ASPECT),)
ifneq ($(words $(ASPECT)) $(filter $(ASPECTS),$(ASPECT)),1 $(ASPECT))
$(error ASPECT=$(ASPECT) is not an aspect; choose one of: $(ASPECTS))
endif
endif

PYTHON := .venv/bin/python
STAGE = $(PYTHON) -m mechanisms
PICTURE = $(PYTHON) -m render
NIGHT = $(PYTHON) -m studio.night
OF_NIGHT = --preset "$$PRESET" $${ASPECT:+--aspect="$$ASPECT"} --only="$$ONLY" --show="$$SHOW" --spectra="$$SPECTRA" --watts="$$WATTS" --anyway="$$ANYWAY" --python="$(PYTHON)"
# install compiles the kernels in the background; these want all of them, and nothing else running.
ALL_KERNELS = @$(PYTHON) -m tools.compiling wait
PROGRAMS_OF_TESTS = @$(PYTHON) -m shared.system --for-tests || case "$${STRICT:-$$CI}" in ""|0) ;; *) false ;; esac

# pyright comes whole in its wheel; without this it asks the network whether it is the newest.
export PYRIGHT_PYTHON_IGNORE_WARNINGS := 1

# The outermost make: a stage ends with it, also when make was killed and could not tell (shared/stage/lineage.py).
ifndef MBSD_MAKE
export MBSD_MAKE := $(shell echo $$PPID)
endif

.DEFAULT_GOAL := help
.PHONY: help install libraries check list run-all all overnight status stop view-all view-engines gallery showreel fetch new test-fast test test-slow lint format bench bench-start bench-live bench-film hunt hunt-parts torture check-numbers keep-numbers record-numbers schema docs study-engines study-run-up readme-loop integrators wheel lock clean clean-all always

# A stage with nothing to do ends at once, so each target simply runs the stages it stands on.
define upto_motion
@$(STAGE) parts "$$MECHANISM"
@$(STAGE) solve "$$MECHANISM"
endef
# Motion and plots go on where there are no automatic parts.
define upto_bare_motion
@$(STAGE) parts "$$MECHANISM" --or-none
@$(STAGE) solve "$$MECHANISM"
endef
define upto_shot
$(upto_motion)
@$(STAGE) shot "$$MECHANISM"
endef
SPECTRA_IF_ANY = $${SPECTRA:+--spectra="$$SPECTRA"}

help: ## this list
	@echo "make <target>, with PRESET=draft|preview|production|final on every picture target (preview by default)."
	@echo "ASPECT=16:9|1:1|4:5|9:16 on these targets: the shape of the picture, composed for it (16:9 by default)."
	@echo "SHOW=reactions,forces,velocities,accelerations,title on these targets: arrows and words in the picture."
	@echo "SPECTRA=\"shaking force,motor\" on run-, plot- and compare-<name>, run-all and all: spectra of these."
	@echo "A mechanism's name takes hyphens or underscores: run-four-bar, run-four_bar."
	@echo
	@sed -n 's/^\([a-z][a-z-]*\)-%:[^#]*## /\1-<name>|/p; s/^\([a-z][a-z-]*\):[^#]*## /\1|/p' Makefile \
	| awk -F'|' '{ printf "  %-18s %s\n", $$1, $$2 }'

run-%: libraries always ## everything of one mechanism: parts, motion, clearance, report, plots, GLB, poster, film
	$(upto_motion)
	@$(STAGE) clearance "$$MECHANISM"
	@$(STAGE) shot "$$MECHANISM"
	@$(PICTURE) report "$$MECHANISM"
	@$(PICTURE) plots "$$MECHANISM" $(SPECTRA_IF_ANY)
	@$(PICTURE) glb "$$MECHANISM"
	@$(PICTURE) poster "$$MECHANISM" --preset "$$PRESET" $${ASPECT:+--aspect="$$ASPECT"} $${SHOW:+--show="$$SHOW"}
	@$(PICTURE) film "$$MECHANISM" --preset "$$PRESET" $${ASPECT:+--aspect="$$ASPECT"} $${SHOW:+--show="$$SHOW"}

run-all: libraries ## run-<name> for every mechanism or ONLY=four_bar,slider_crank; goes on after a failure
	@$(NIGHT) run $(OF_NIGHT)

all: run-all ## the same

overnight: libraries ## the same in the background, also after the logout; WATTS=85 tells the energy it takes
	@$(NIGHT) start $(OF_NIGHT)

status: ## what every film is at: frames, seconds a frame, time left, last error
	@$(NIGHT) status

stop: ## end make overnight or make all after the frame in flight; the same command goes on from there
	@$(NIGHT) stop

parts-%: libraries always ## the solids: out/<name>/parts/ (STL, STEP, parts.json)
	@$(STAGE) parts "$$MECHANISM"

print-%: libraries always ## plates to print (3MF, STL), outlines to cut (DXF), lists; BED=220x220 GAP=5 in mm
	@$(STAGE) parts "$$MECHANISM"
	@$(STAGE) print "$$MECHANISM" --bed="$$BED" --gap="$$GAP"

solve-%: install always ## the motion: out/<name>/data.json
	$(upto_bare_motion)

animate-%: install always ## the moving skeleton, VIEW=forces,reactions,velocities,...: animation.mp4, .gif
	@$(STAGE) animate "$$MECHANISM" --view="$$VIEW"

clearance-%: libraries always ## proof that no two parts touch over the whole motion: clearance.json
	$(upto_motion)
	@$(STAGE) clearance "$$MECHANISM"

plot-%: install always ## the plots, SPECTRA="shaking force,motor" with spectra of these: out/<name>/plots/
	$(upto_bare_motion)
	@$(PICTURE) plots "$$MECHANISM" $(SPECTRA_IF_ANY)

report-%: install always ## what was found, in sentences and tables: out/<name>/report.md
	$(upto_bare_motion)
	@$(PICTURE) report "$$MECHANISM"

compare-%: install always ## the motions of all its variants on the same pages: out/<name>/compare/
	@names=$$($(STAGE) variants "$$MECHANISM") || exit; for one in $$names; do \
	$(STAGE) parts "$$one" --or-none && $(STAGE) solve "$$one" || exit; done
	@$(PICTURE) compare "$$MECHANISM" $(SPECTRA_IF_ANY)

glb-%: libraries always ## the parts with their motion in one file for any glTF viewer: out/<name>/<name>.glb
	$(upto_shot)
	@$(PICTURE) glb "$$MECHANISM"

view-%: install always ## one HTML page with the machine, its forces and its plots: out/<name>/view.html
	$(upto_bare_motion)
	@$(STAGE) shot "$$MECHANISM"
	@$(PICTURE) view "$$MECHANISM"

live-%: install always ## a page that follows the editor: sliders, dragging, fits to a path; prints its address
	@$(PYTHON) -m studio.live "$$MECHANISM"

poster-%: libraries always ## one picture at its best: out/<name>/poster.png
	$(upto_shot)
	@$(PICTURE) poster "$$MECHANISM" --preset "$$PRESET" $${ASPECT:+--aspect="$$ASPECT"} $${SHOW:+--show="$$SHOW"}

contact-%: libraries always ## a sheet of twelve frames, drafts if no PRESET is given: out/<name>/contact.png
	$(upto_shot)
	@$(PICTURE) contact "$$MECHANISM" --preset "$$SHEET_PRESET" $${ASPECT:+--aspect="$$ASPECT"} $${SHOW:+--show="$$SHOW"}

still-%: libraries always ## one frame of the film, FRAME=15 (from 0): out/<name>/stills/
	$(upto_shot)
	@$(PICTURE) still "$$MECHANISM" --frame="$$FRAME" --preset "$$PRESET" $${ASPECT:+--aspect="$$ASPECT"} $${SHOW:+--show="$$SHOW"}

frames-%: libraries always ## the frames of the film: out/<name>/frames/<preset>/
	$(upto_shot)
	@$(PICTURE) frames "$$MECHANISM" --preset "$$PRESET" $${ASPECT:+--aspect="$$ASPECT"} $${SHOW:+--show="$$SHOW"}

film-%: libraries always ## the film: out/films/<name>-<preset>.mp4
	$(upto_shot)
	@$(PICTURE) film "$$MECHANISM" --preset "$$PRESET" $${ASPECT:+--aspect="$$ASPECT"} $${SHOW:+--show="$$SHOW"}

scene-ui-%: libraries always ## open the scene in an installed Blender
	$(upto_shot)
	@$(PICTURE) scene-ui "$$MECHANISM" --preset "$$PRESET" $${ASPECT:+--aspect="$$ASPECT"} $${SHOW:+--show="$$SHOW"}

scene-%: libraries always ## save the scene: out/<name>/<name>.blend
	$(upto_shot)
	@$(PICTURE) scene "$$MECHANISM" --preset "$$PRESET" $${ASPECT:+--aspect="$$ASPECT"} $${SHOW:+--show="$$SHOW"}

verify-%: libraries always ## solids, motion, some frames (FRAMES=0,30) and the film made again in scratch and compared
	@$(PYTHON) -m studio.verify "$$MECHANISM" --preset "$$PRESET" $${ASPECT:+--aspect="$$ASPECT"} --frames="$$FRAMES" $${SHOW:+--show="$$SHOW"}

view-all: install ## all pages (ONLY=four_bar,pendulum) and a picture of each by Chromium: view.html, view.png
	@$(PYTHON) -m studio.pages --only="$$ONLY"

view-engines: install ## pages used in Firefox and Safari's engine: a small four-bar, or ONLY=four_bar,pendulum
	@$(PYTHON) -m tools.engines --name="$$ONLY"

gallery: libraries ## posters of all mechanisms (PRESET) and the page that shows them: docs/gallery/
	@for file in mechanisms/*/mechanism.py; do one=$${file%/mechanism.py}; one=$${one#mechanisms/}; \
	"$(MAKE)" --no-print-directory "clearance-$$one" || echo "gallery: no clearance of $$one" >&2; \
	"$(MAKE)" --no-print-directory "poster-$$one" PRESET="$$PRESET" ASPECT=16:9 || echo "gallery: no poster of $$one" >&2; done
	@$(PICTURE) gallery

showreel: install ## the finished films of PRESET, each under its title, as one; ONLY=four_bar,geneva_drive
	@$(PICTURE) showreel --preset "$$PRESET" $${ASPECT:+--aspect="$$ASPECT"} --only="$$ONLY" $${SHOW:+--show="$$SHOW"}

fetch: install ## bring the films of another machine home, what changed alone: HOST=user@machine FOLDER=mbsd
	@$(PYTHON) -m studio.fetch --folder="$$FOLDER" -- "$$HOST"

scheduler: install ## of a cluster: CLUSTER=tcp://127.0.0.1:8786 is its address; HOST=address for other machines
	@$(PYTHON) -m shared.cluster scheduler --host="$$HOST"

worker: install ## frames and parts for whoever gives the same CLUSTER=tcp://scheduler:8786; HOST=its own address
	@$(PYTHON) -m shared.cluster worker --host="$$HOST" -- "$$CLUSTER"

certificates: install ## CLUSTER_TLS=folder: so that a cluster on several machines lets nobody else in
	@$(PYTHON) -m shared.cluster certificates -- "$$CLUSTER_TLS"

new: install ## a new mechanism that already runs: make new NAME=my_linkage KIND=driven|simulated
	@$(STAGE) new --kind="$${KIND:-driven}" -- "$$NAME"

list: install ## the mechanisms and what is made of them
	@$(STAGE) list

check: install ## versions, system libraries, render device, disk space
	@$(PYTHON) -m tools.check
	@$(PYTHON) -m tools.device_check

install: ## uv, Python 3.13, every package at its locked version; kernels compile in the background
	@sh tools/install.sh

libraries: install ## whether the system has what parts and pictures load; their targets ask before they begin
	@test ! -d .venv || test -f .venv/libraries-found || { echo "error: parts and pictures need these libraries; nothing was made" >&2; exit 1; }

test: install ## all tests but the slow ones; PYTEST="-k name" picks some; STRICT=1 skips none
	$(PROGRAMS_OF_TESTS)
	$(ALL_KERNELS)
	@$(PYTHON) -m pytest -m "not slow" $(PYTEST)

test-fast: install ## the quick ones among them: no Blender, no browser, no mechanism of the gallery
	$(PROGRAMS_OF_TESTS)
	$(ALL_KERNELS)
	@$(PYTHON) -m pytest -m fast $(PYTEST)

test-slow: install ## the slow ones: all stages of the rest of the gallery, large machines, random ones
	$(PROGRAMS_OF_TESTS)
	$(ALL_KERNELS)
	@$(PYTHON) -m pytest -m slow $(PYTEST)

lint: install ## formatting, ruff, pyright, import rules
	@.venv/bin/ruff format --check .
	@.venv/bin/ruff check .
	@.venv/bin/pyright
	@.venv/bin/lint-imports --no-cache

format: install ## format the sources and cure what ruff can
	@.venv/bin/ruff check --fix --exit-zero --quiet .
	@.venv/bin/ruff format .

bench: install ## the solver beside its peers: a table, and out/bench.json
	$(ALL_KERNELS)
	@sh tools/install.sh bench
	@$(PYTHON) -m benchmarks

bench-start: install ## how long one waits for a first result and for calls as users make them
	$(ALL_KERNELS)
	@$(PYTHON) -m benchmarks start

bench-live: install ## from a slider of the live page to the picture, in Chromium; NAME=four_bar N=40 steps
	@$(PYTHON) -m benchmarks live --name "$${NAME:-four_bar}" --count "$${N:-40}"

bench-film: install ## what a film costs beside Cycles alone, a plain script, one core; NAME=four_bar N=60 frames
	@$(PYTHON) -m benchmarks film --name "$${NAME:-four_bar}" --preset "$$PRESET" --frames "$${N:-60}"

check-numbers: install ## raw bytes of 300 runs against those recorded, or WITHIN=1e-9 of those kept; ONLY="gallery four_bar"
	$(ALL_KERNELS)
	@$(PYTHON) -m tools.numbers $${WITHIN:+within} $${WITHIN:-check} "$$ONLY"

keep-numbers: install ## keep the numbers of these runs, before a change that may move last digits
	$(ALL_KERNELS)
	@$(PYTHON) -m tools.numbers keep "$$ONLY"

record-numbers: install ## record them anew, where a change of numbers is meant
	$(ALL_KERNELS)
	@$(PYTHON) -m tools.numbers record

hunt: install ## N random mechanisms (1000), each solved again in other words; SEED=1 says which: out/hunt.json
	$(ALL_KERNELS)
	@$(PYTHON) -m tools.hunt --n "$${N:-1000}" --seed "$$SEED"

hunt-parts: install ## parts of N random mechanisms (1000), goes on where it stopped; SEED=1: out/hunt_parts.json
	$(ALL_KERNELS)
	@$(PYTHON) -m tools.hunt_parts --n "$${N:-1000}" --seed "$$SEED"

torture: install ## N nights of postage stamps (20), killed and damaged meanwhile; SEED=1: out/torture.json
	$(ALL_KERNELS)
	@$(PYTHON) -m tools.torture --n "$${N:-20}" --seed "$$SEED" --only="$$ONLY"

schema: install ## write docs/schema/ from shared/contract/ and the solver's joints and laws
	@$(PYTHON) -m tools.schema
	@$(PYTHON) -m mbsd.saving.schema docs/schema/model.schema.json

docs: install ## write docs/theory.md and the map of rooms from docstrings, and draw the pictures of docs/
	@$(PYTHON) tools/theory.py
	@$(PYTHON) tools/rooms.py
	@$(PYTHON) -m tools.figures

study-engines: install ## which bank angle suits which V engine: out/engines/ and the tables of docs/engines.md
	$(ALL_KERNELS)
	@$(PYTHON) -m tools.engine_layouts

study-run-up: install ## engines on mounts run through resonance, 120 simulations on all cores: out/engines/run_up.csv, .svg
	$(ALL_KERNELS)
	@$(PYTHON) -m tools.engine_run_up

readme-loop: libraries ## the loop at the top of README.md, filmed by the page in Chromium: docs/readme_loop.webp
	@$(STAGE) parts four_bar
	@$(STAGE) solve four_bar
	@$(STAGE) shot four_bar
	@$(PYTHON) -m tools.readme_loop

integrators: install ## measure the integrators again, for docs/integrators.md: order, cost, 10 000 periods (5 minutes)
	$(ALL_KERNELS)
	@$(PYTHON) -m tools.integrators
	@$(PYTHON) -m tools.figures integrators

wheel: install ## the solver alone as sdist and wheel: dist/; KERNELS=1: a wheel with compiled kernels, too
	@$(PYTHON) -m tools.wheel $${KERNELS:+--kernels}

lock: ## choose versions anew within pyproject.toml: requirements.lock, requirements-bench.lock
	@sh tools/lock.sh

clean: ## remove all results
	@sh tools/clean.sh

clean-all: clean ## remove results, environment and caches
	@rm -rf .venv .venv-uv .cache .pytest_cache .ruff_cache .hypothesis .import_linter_cache mbsd.egg-info
	@find . -name __pycache__ -type d -prune -exec rm -rf {} +

always:
