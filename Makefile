# The face of the project: `make help` lists what there is. GNU make 3.81 and a POSIX shell are enough.

PRESET ?=
ASPECT ?=
FRAME ?= 0
FRAMES ?=
NAME ?=
FILE ?=
FORMAT ?=
OVER ?=
TIME ?=
AS ?=
KIND ?=
VIEW ?=
SHOW ?=
SOUND ?=
STORY ?=
LOOP ?=
SPECTRA ?=
BED ?=
SCALE ?=
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
PLAN ?=
MECHANISMS ?=
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
override FORMAT := $(value FORMAT)
override OVER := $(value OVER)
override TIME := $(value TIME)
override FILE := $(value FILE)
override AS := $(value AS)
override KIND := $(value KIND)
override VIEW := $(value VIEW)
override SHOW := $(value SHOW)
override SOUND := $(value SOUND)
override STORY := $(value STORY)
override LOOP := $(value LOOP)
override SPECTRA := $(value SPECTRA)
override BED := $(value BED)
override SCALE := $(value SCALE)
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
override MECHANISMS := $(value MECHANISMS)
override PLAN := $(value PLAN)
override CLUSTER := $(value CLUSTER)
override CLUSTER_TLS := $(value CLUSTER_TLS)
override MECHANISM = $(subst -,_,$*)
export FORMAT OVER TIME FILE AS PRESET ASPECT FRAME FRAMES NAME KIND VIEW SHOW SOUND STORY LOOP SPECTRA BED SCALE KERNELS GAP MECHANISM N HOST FOLDER ONLY WITHIN WATTS SEED
export CLUSTER CLUSTER_TLS ANYWAY STRICT PLAN MECHANISMS

PRESETS := draft preview production final
ifneq ($(PRESET),)
ifneq ($(words $(PRESET)) $(filter $(PRESETS),$(PRESET)),1 $(PRESET))
$(error PRESET=$(PRESET) is not a preset; choose one of: $(PRESETS))
endif
endif

ASPECTS := 16:9 1:1 4:5 9:16
ifneq ($(ASPECT),)
ifneq ($(words $(ASPECT)) $(filter $(ASPECTS),$(ASPECT)),1 $(ASPECT))
$(error ASPECT=$(ASPECT) is not an aspect; choose one of: $(ASPECTS))
endif
endif

PYTHON := .venv/bin/python
# The program `mbsd`, of which this file is a face: it reads PRESET, ONLY and the like from the environment.
MBSD = $(PYTHON) -m studio.command
export MBSD_FACE := make
export MBSD_PYTHON := $(PYTHON)
# install compiles the kernels in the background; these want all of them, and nothing else running.
ALL_KERNELS = @$(PYTHON) -m tools.compiling wait
PROGRAMS_OF_TESTS = @$(PYTHON) -m shared.system --for-tests || case "$${STRICT:-$$CI}" in ""|0) ;; *) false ;; esac

# pyright comes whole in its wheel; without this it asks the network whether it is the newest.
export PYRIGHT_PYTHON_IGNORE_WARNINGS := 1

# The outermost make: a stage ends with it, also when make was killed and could not tell (shared/stage/signals.py).
ifndef MBSD_MAKE
export MBSD_MAKE := $(shell echo $$PPID)
endif

.DEFAULT_GOAL := help
.PHONY: help install libraries check list run-all all overnight status stop view-all view-engines gallery showreel fetch new import test-fast test test-slow test-all lint format bench bench-start bench-live bench-film hunt hunt-parts hunt-imports torture check-numbers keep-numbers record-numbers check-events record-events schema docs docs-site site study-engines study-run-up readme-loop integrators wheel release lock clean clean-all always

help: ## this list
	@echo "make <target>, with PRESET=draft|preview|production|final on every picture target (preview by default)."
	@echo "ASPECT=16:9|1:1|4:5|9:16 on these targets: the shape of the picture, composed for it (16:9 by default)."
	@echo "SHOW=reactions,forces,velocities,accelerations,title on these targets: arrows and words in the picture."
	@echo "SOUND=off on run- and film-<name>, run-all and overnight: films without their sound."
	@echo "SPECTRA=\"shaking force,motor\" on run-, plot- and compare-<name>, run-all and all: spectra of these."
	@echo "MECHANISMS=~/machines on these targets: a folder of your own; results are put into its out/."
	@echo "A mechanism's name takes hyphens or underscores: run-four-bar, run-four_bar."
	@echo
	@sed -n 's/^\([a-z][a-z-]*\)-%:[^#]*## /\1-<name>|/p; s/^\([a-z][a-z-]*\):[^#]*## /\1|/p' Makefile \
	| awk -F'|' '{ printf "  %-18s %s\n", $$1, $$2 }'

run-%: libraries always ## everything of one mechanism: parts, motion, clearance, report, plots, GLB, poster, film
	@$(MBSD) run -- "$$MECHANISM"

run-all: libraries ## the same of every mechanism; goes on after a failure or ONLY=four_bar,slider_crank
	@$(MBSD) all

all: run-all ## the same

overnight: libraries ## all of it in the background, also after the logout; WATTS=85 tells the energy it takes
	@$(MBSD) overnight

status:  ## progress of every film: frames, seconds a frame, time left, last error
	@$(MBSD) status

stop:  ## stop `overnight` after the current frame; run `overnight` again to resume
	@$(MBSD) stop

check-%: install always ## look for likely mistakes in a model before anything is built
	@$(MBSD) check -- "$$MECHANISM"

parts-%: libraries always ## the solids: out/<name>/parts/ (STL, STEP, parts.json); SCALE=1:20 of a model
	@$(MBSD) parts -- "$$MECHANISM"

print-%: libraries always ## plates to print (3MF, STL), outlines to cut (DXF), lists; BED=220x220 GAP=5 in mm, SCALE=1:20
	@$(MBSD) print -- "$$MECHANISM"

solve-%: install always ## the motion: out/<name>/data.json
	@$(MBSD) solve -- "$$MECHANISM"

animate-%: install always ## the moving skeleton with its arrows: animation.mp4, .gif; VIEW=forces,reactions,...
	@$(MBSD) animate -- "$$MECHANISM"

clearance-%: libraries always ## proof that no two parts touch over the whole motion: clearance.json
	@$(MBSD) clearance -- "$$MECHANISM"

plot-%: install always ## the plots: out/<name>/plots/; SPECTRA="shaking force,motor" adds theirs
	@$(MBSD) plot -- "$$MECHANISM"

report-%: install always ## what was found, in sentences and tables: out/<name>/report.md
	@$(MBSD) report -- "$$MECHANISM"

compare-%: install always ## the motions of all its variants on the same pages: out/<name>/compare/
	@$(MBSD) compare -- "$$MECHANISM"

glb-%: libraries always ## the parts with their motion in one file for any glTF viewer: out/<name>/<name>.glb
	@$(MBSD) glb -- "$$MECHANISM"

view-%: install always ## one HTML page with the machine, its forces and its plots: out/<name>/view.html
	@$(MBSD) view -- "$$MECHANISM"

article-%: install always ## one HTML page that explains the machine, with numbers to drag: out/<name>/article.html
	@$(MBSD) article -- "$$MECHANISM"

live-%: install always ## a page that follows the editor: sliders, dragging, fits to a path; prints its address
	@$(MBSD) live -- "$$MECHANISM"

poster-%: libraries always ## one picture at its best: out/<name>/poster.png
	@$(MBSD) poster -- "$$MECHANISM"

exploded-%: libraries always ## the parts taken apart, with names and masses: out/<name>/exploded.png, .glb
	@$(MBSD) exploded -- "$$MECHANISM"

contact-%: libraries always ## contact sheet of twelve frames, draft quality by default: out/<name>/contact.png
	@$(MBSD) contact -- "$$MECHANISM"

still-%: libraries always ## one frame of the film: out/<name>/stills/; FRAME=15 (from 0)
	@$(MBSD) still -- "$$MECHANISM"

frames-%: libraries always ## the frames of the film: out/<name>/frames/<preset>/
	@$(MBSD) frames -- "$$MECHANISM"

film-%: libraries always ## the film: out/films/<name>-<preset>.mp4; STORY=explain|compare of shots, LOOP=12 seconds
	@$(MBSD) film -- "$$MECHANISM"

scene-ui-%: libraries always ## open the scene in an installed Blender
	@$(MBSD) scene-ui -- "$$MECHANISM"

scene-%: libraries always ## save the scene: out/<name>/<name>.blend
	@$(MBSD) scene -- "$$MECHANISM"

verify-%: libraries always ## solids, motion, some frames and the film made again in scratch and compared; FRAMES=0,30
	@$(MBSD) verify -- "$$MECHANISM"

view-all: install ## all pages and a picture of each by Chromium: view.html, view.png; ONLY=four_bar,pendulum
	@$(MBSD) view-all

site: install ## a wall of all machines in motion and a page for each, for any web host: out/site/
	@$(MBSD) site

view-engines: install ## pages used in Firefox and Safari's engine: a small four-bar, or ONLY=four_bar,pendulum
	@$(PYTHON) -m tools.browsers --name="$$ONLY"

gallery: libraries ## posters of all mechanisms and the page that shows them: docs/gallery/
	@$(MBSD) gallery

showreel: install ## the finished films, each under its title, as one; stories where made or STORY=loop; ONLY=four_bar
	@$(MBSD) showreel

fetch: install ## copy new films from another computer: HOST=user@machine FOLDER=mbsd
	@$(MBSD) fetch -- "$$HOST"

scheduler: install ## scheduler of a cluster; it prints its address; HOST=address for other machines
	@$(MBSD) scheduler

worker: install ## makes frames and parts for whoever asks the same scheduler: CLUSTER=tcp://scheduler:8786
	@$(MBSD) worker -- "$$CLUSTER"

certificates: install ## certificates, so that a cluster lets nobody else in: CLUSTER_TLS=folder
	@$(MBSD) certificates -- "$$CLUSTER_TLS"

new: install ## a new mechanism that already runs: make new NAME=my_linkage KIND=driven|simulated
	@$(MBSD) new -- "$$NAME"

export-%: install always ## tables, drawings, STEP, USD, MuJoCo, URDF, FMI, Modelica: FORMAT=mjcf TIME=0.5
	@$(MBSD) export -- "$$MECHANISM"

study-%: install always ## a grid of its Params solved, as a table (study.csv): OVER="crank=0.03:0.05:5; speed=6,12"
	@$(MBSD) study -- "$$MECHANISM"

tolerances-%: install always ## how far results stray as its parts do, by its tolerances.py; what to tighten
	@$(MBSD) tolerances -- "$$MECHANISM"

import: install ## a mechanism of Linkage, PMKS, pylinkage or Ondsel, or a DXF sketch: FILE=walker.linkage2 AS=walker
	@$(MBSD) import -- "$$FILE"

list: install ## the mechanisms and what is made of them
	@$(MBSD) list

check: install ## versions, system libraries, render device, disk space
	@$(PYTHON) -m tools.check
	@$(PYTHON) -m tools.device_check

install: ## uv, Python 3.13, every package at its locked version; kernels compile in the background
	@sh tools/install.sh

libraries: install ## whether the system has what parts and pictures load; their targets ask before they begin
	@test ! -d .venv || test -f .venv/libraries-found || { echo "error: parts and pictures need these libraries; nothing was built" >&2; exit 1; }

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

test-all: install ## every test once, as CI runs them: quick ones first, then the longest
	$(PROGRAMS_OF_TESTS)
	$(ALL_KERNELS)
	@$(PYTHON) -m pytest $(PYTEST)

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
	@$(PYTHON) -m benchmarks film --name "$${NAME:-four_bar}" --preset "$${PRESET:-preview}" --frames "$${N:-60}"

check-numbers: install ## raw bytes of 300 runs against those recorded, or WITHIN=1e-9 of those kept; ONLY="gallery four_bar"
	$(ALL_KERNELS)
	@$(PYTHON) -m tools.numbers $${WITHIN:+within} $${WITHIN:-check} "$$ONLY"

keep-numbers: install ## keep the numbers of these runs, before a change that may move last digits
	$(ALL_KERNELS)
	@$(PYTHON) -m tools.numbers keep "$$ONLY"

record-numbers: install ## record them anew, where a change of numbers is meant
	$(ALL_KERNELS)
	@$(PYTHON) -m tools.numbers record

check-events: install ## 580 runs with contacts, stops and events against those recorded, within their bounds; ONLY="rope"
	$(ALL_KERNELS)
	@$(PYTHON) -m tools.numbers events check "$$ONLY"

record-events: install ## record them anew, where a change of numbers is meant, with bounds measured anew; ONLY="rope"
	$(ALL_KERNELS)
	@$(PYTHON) -m tools.numbers events record "$$ONLY"

hunt: install ## N random mechanisms (1000), each solved again in other words; SEED=1 says which: out/hunt.json
	$(ALL_KERNELS)
	@$(PYTHON) -m tools.hunt --n "$${N:-1000}" --seed "$$SEED"
	@$(PYTHON) -m tools.hunt_space --n 200 --seed "$$SEED"

hunt-parts: install ## parts of N random mechanisms (1000), goes on where it stopped; SEED=1: out/hunt_parts.json
	$(ALL_KERNELS)
	@$(PYTHON) -m tools.hunt_parts --n "$${N:-1000}" --seed "$$SEED"

hunt-imports: install ## N damaged files of other programs (1000), each imported or refused; SEED=1: out/hunt_imports.json
	@$(PYTHON) -m tools.hunt_imports --n "$${N:-1000}" --seed "$$SEED"

torture: install ## N nights of postage stamps (20), killed and damaged meanwhile; SEED=1: out/torture.json
	$(ALL_KERNELS)
	@$(PYTHON) -m tests.studio.night.torture --n "$${N:-20}" --seed "$$SEED" --only="$$ONLY"

schema: install ## write docs/schema/ from shared/contract/ and the solver's joints and laws
	@$(PYTHON) -m tools.schema
	@$(PYTHON) -m mbsd.saving.schema docs/schema/model.schema.json

docs: install ## the pictures of docs/, the lecture's outputs, the site
	@$(PYTHON) -m tools.documents figures
	@$(PYTHON) -m tools.documents lecture
	@$(PYTHON) -m tools.site

docs-site: install ## the documents and all names of mbsd as pages, with a search, to read without a network: out/docs/
	@$(PYTHON) -m tools.site

study-engines: install ## which bank angle suits which V engine: out/engines/ and the tables of docs/engines.md
	$(ALL_KERNELS)
	@$(PYTHON) -m tools.documents bank-angles

study-run-up: install ## engines on mounts run through resonance, 120 simulations on all cores: out/engines/run_up.csv, .svg
	$(ALL_KERNELS)
	@$(PYTHON) -m tools.documents run-up

readme-loop: libraries ## the loop at the top of README.md, filmed by the page in Chromium: docs/readme_loop.webp
	@$(MBSD) view four_bar
	@$(PYTHON) -m tools.documents readme-loop

integrators: install ## measure the integrators again, for docs/integrators.md: order, cost, 10 000 periods (5 minutes)
	$(ALL_KERNELS)
	@$(PYTHON) -m tools.documents integrators
	@$(PYTHON) -m tools.documents figures integrators

wheel: install ## sdist and wheels with compiled kernels: dist/; KERNELS="3.11 3.12 3.13 3.14", KERNELS=none
	@case "$$KERNELS" in none) $(PYTHON) -m tools.wheel ;; *) $(PYTHON) -m tools.wheel --kernels $$KERNELS ;; esac

release: install ## what must hold before a tag, looked at in a clean clone: archives, hashes, NOTES.md in dist/
	@$(PYTHON) -m tools.release

lock: ## choose versions anew within pyproject.toml: requirements.lock, requirements-bench.lock
	@sh tools/lock.sh

clean: ## remove all results
	@sh tools/clean.sh

clean-all: clean ## remove results, environment and caches
	@rm -rf .venv .venv-uv .cache .pytest_cache .ruff_cache .hypothesis .import_linter_cache mbsd.egg-info
	@find . -name __pycache__ -type d -prune -exec rm -rf {} +

always:
