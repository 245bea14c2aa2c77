# Everything the project does has one command here; the work is in tools/. `make help` lists them.
# Each target brings what it stands on up to date first, and is quick where nothing changed.

# Blender 4.2 to 5.0 speak Python 3.11, and so does the project where it is there.
PYTHON ?= $(shell for p in python3.11 python3; do $$p -c '' 2>/dev/null && echo $$p && break; done)
ready  := $(PYTHON) tools/setup.py
python := .venv/bin/python

# `make test` runs one recipe after the other; the tools use all cores themselves.
.NOTPARALLEL:
.PHONY: help setup envs demo test test-quick test-cpp test-python test-docs test-tools test-blender test-blenders soak stress fuzz scenes bench bench-docs lint format sanitize docs stubs operators gallery tutorials package release-linux clean
.DEFAULT_GOAL := help

help:  ## Show this list
	@sed -n 's/^\([a-z -]*\):.*## /\1\t/p' $(MAKEFILE_LIST) | expand -t 24

setup:  ## Install what is needed, make .venv, build riffler into it
	@$(ready)

envs:  ## Make an environment for every Blender that the tests use: .envs
	@$(ready) test

demo:  ## Carve the demo figure, mill a bust of it, write STL and NC code, render both: out/demo
	@$(ready) demo
	$(python) demo/run.py --out out/demo --blender-python .envs/bpy-4.5/bin/python

test:  ## Run every test: C++, Python, tools, documents, Blender (SUITES="… lint sanitize" for others)
	@$(ready) test
	@$(python) tools/test.py $(SUITES)

test-quick:  ## After a change: the C++ and Python tests without those that cost most at the last complete run
	@$(ready) cpp-tests
	@$(python) tools/test.py quick

test-cpp:  ## Run the C++ tests only
	@$(ready) cpp-tests
	@$(python) tools/test.py cpp

test-python test-docs test-tools:  ## Run the Python tests, the documents' examples or the tests of tools/ only
	@$(ready)
	@$(python) tools/test.py $(@:test-%=%)

test-blender:  ## Run the Blender tests only
	@$(ready) test
	@$(python) tools/test.py blender

test-blenders:  ## Build wheels for newer Blenders in chroots of Debian, test one zip of all in their windows (SUITES="trixie" for some)
	@$(ready)
	@$(python) tools/blenders.py $(SUITES)

soak:  ## Plan by feel for ten minutes; make STROKES strokes and UNDOS steps of undo, EXAMPLES runs of operators, from SEED, in Blender
	@$(ready) test
	@$(ready) cpp-tests
	$(python) tools/preset.py release riffler_tests
	RIFFLER_LONG=1 build/release/native/tests/riffler_tests --gtest_filter='Orienting.*'
	$(python) blender_tests/run.py --soak --seed $(or $(SEED),1) $(if $(STROKES),--strokes $(STROKES)) \
	  $(if $(UNDOS),--undos $(UNDOS)) $(if $(EXAMPLES),--examples $(EXAMPLES))

stress:  ## Carve MOVES random moves per cutter, edit histories EDITS times, mesh VOLUMES random volumes, follow STROKES strokes, hold tools at POSES, machine PARTS random parts, make DABS of brushes, from SEED, and check each
	@$(ready) cpp-tests
	$(python) tools/preset.py release riffler_stress riffler_history_stress riffler_mesh_stress riffler_contact_stress riffler_tests
	build/release/native/stress/riffler_stress --table --moves $(or $(MOVES),20000) --seed $(or $(SEED),1)
	build/release/native/stress/riffler_history_stress --edits $(or $(EDITS),1000) --seed $(or $(SEED),1)
	build/release/native/stress/riffler_mesh_stress --volumes $(or $(VOLUMES),100000) --seed $(or $(SEED),1)
	build/release/native/stress/riffler_mesh_stress --tolerant --volumes $(or $(VOLUMES),100000) --seed $(or $(SEED),1)
	build/release/native/stress/riffler_mesh_stress --strokes $(or $(STROKES),10000) --seed $(or $(SEED),1)
	build/release/native/stress/riffler_contact_stress --poses $(or $(POSES),1000000) --seed $(or $(SEED),1)
	RIFFLER_LONG=1 build/release/native/tests/riffler_tests --gtest_filter='Sculpting.*:LedAlongWalls.*'
	RIFFLER_LONG=1 $(python) -m pytest -q native/tests/python/test_tasks.py -k many_tasks
	RIFFLER_LONG=1 $(python) -m pytest -q native/tests/python/test_finish_patterns.py
	$(python) native/tests/python/machining_stress.py --parts $(or $(PARTS),200) --seed $(or $(SEED),1)
	$(python) native/tests/python/brush_stress.py --dabs $(or $(DABS),100000) --seed $(or $(SEED),1)

fuzz:  ## Fuzz every reader of files for SECONDS each, from SEED, under the sanitizers (TARGETS="rs274 ply" for some): build/fuzz
	@$(ready) cpp-tests
	@$(python) tools/fuzz.py --seconds $(or $(SECONDS),600) --seed $(or $(SEED),1) $(TARGETS)

scenes:  ## Write the hashes of the replayed journals anew: native/tests/scenes/hashes.txt
	@$(ready) cpp-tests
	$(python) tools/preset.py release riffler_scene_hashes
	build/release/native/tests/riffler_scene_hashes native/tests/scenes > build/hashes.txt
	mv build/hashes.txt native/tests/scenes/hashes.txt

bench:  ## Measure run time and error, of rivals too: out/bench (JOBS="b5x force" for some)
	@$(ready) bench
	$(python) tools/preset.py bench
	mkdir -p out/bench
	RIFFLER_THREADS=1 build/bench/native/bench/riffler_bench --benchmark_filter='whole|follow' \
	  --benchmark_out=out/bench/native.json
	.venv/bin/riffler bench $(JOBS) --out out/bench $(if $(RIFFLER_MODELS),--models $(RIFFLER_MODELS)) \
	  --programs build/bench/native/bench --rivals .envs/rivals/bin/python \
	  $(foreach v,4.5 4.2 5.0,--blender .envs/bpy-$(v)/bin/python) --blender blender

bench-docs:  ## Put figures and plots of the last `make bench` into the documents
	@$(ready)
	$(python) tools/bench_docs.py out/bench

lint:  ## Check style, layers, types, and that every header stands alone
	@$(ready) cpp-tests
	@$(python) tools/test.py lint

format:  ## Bring all sources into style
	@$(ready)
	find native device examples -name '*.[ch]pp' -o -name '*.[ch]' | xargs .venv/bin/clang-format -i
	$(python) -m ruff check --fix-only --quiet .
	$(python) -m ruff format .

sanitize:  ## Run the C++ tests under the address and undefined-behaviour sanitizers
	@$(ready) cpp-tests
	@$(python) tools/test.py sanitize

docs:  ## Check links and examples, make the site of the documents and the API reference: out/site
	@$(ready)
	$(python) tools/check_docs.py
	$(python) tools/docs.py

stubs:  ## Write native/python/riffler/_core.pyi anew from the built module: after a change of the bindings
	@$(ready)
	$(python) tools/stubs.py

operators:  ## Write docs/operators.md anew from the add-on in Blender: after a change of an operator or of its settings
	@$(ready) demo
	$(python) tools/operators.py

gallery:  ## Plan, measure and draw the pictures of planning, stability and the pen: docs/images
	@$(ready) demo
	@$(ready) cpp-tests
	$(python) tools/preset.py release riffler_stability
	for script in film mouse mouse_fixtures by_feel sole figure relief linocut characters concepts verify_map stability pen_states pen_frames; do $(python) docs/gallery/$$script.py || exit 1; done

tutorials:  ## Do the tutorials in Blender's window and take their pictures: docs/images/tutorials (NAMES="relief" for some)
	@$(ready) test
	$(python) tools/tutorials.py $(NAMES)

package:  ## Make the wheel and the Blender extension: dist
	@$(ready)
	$(python) tools/package.py

release-linux:  ## Build the wheel for every Linux with glibc 2.28 or later, by Zig's compiler, and compare its results with .venv's: dist/linux
	@$(ready)
	@$(python) tools/release_linux.py

clean:  ## Remove what was built (not .venv and .envs)
	rm -rf build out dist
