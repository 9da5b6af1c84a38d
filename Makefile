# A thin front: installs the Debian packages, then calls CMake and CTest. `make help` lists what there is.

PRESET ?= release
BUILD = build/$(PRESET)
DEMO_SCENE ?= scenes/caustic-glass.pbrt

# One compiler a processor, but no more than memory allows at about 1.5 GB each.
JOBS ?= $(shell memory=$$(awk '/MemAvailable/ { print int($$2 / 1500000) }' /proc/meminfo 2>/dev/null); \
                processors=$$(nproc); \
                [ -n "$$memory" ] && [ "$$memory" -lt "$$processors" ] && processors=$$memory; \
                [ "$$processors" -ge 1 ] && echo $$processors || echo 1)

.PHONY: help packages build demo test portable sanitized-readers sanitize fuzz bench gallery format clean

help:
	@echo 'make demo    install what is missing, build, render a caustic to build/demo.png'
	@echo 'make test    install what is missing, build, run all tests'
	@echo 'make build   install what is missing, build; the program is build/release/dapple'
	@echo 'make portable  build the program alone of the preset portable, and check it'
	@echo 'make sanitize  build and run the tests that watch memory and threads, with sanitizers (bounded: for CI)'
	@echo 'make fuzz  build and run the fuzz targets of the readers, SECONDS each (clang)'
	@echo 'make bench   build, run the benchmarks'
	@echo 'make gallery build, compare all algorithms on all scenes: build/gallery/index.html'
	@echo 'make format  clang-format all sources'
	@echo 'make clean   remove build/'
	@echo 'Variables: PRESET=release|portable|debug|asan|tsan, JOBS=N, SECONDS=N'

packages:
	@scripts/install_packages.sh

build: packages
	@cmake --preset $(PRESET)
	@cmake --build $(BUILD) --parallel $(JOBS)

demo: packages
	@cmake --preset $(PRESET)
	@cmake --build $(BUILD) --parallel $(JOBS) --target dapple
	@$(BUILD)/dapple render $(DEMO_SCENE) -o build/demo.png
	@echo "The picture is $(CURDIR)/build/demo.png"

# Tests labelled slow compare with the reference images in the folder that DAPPLE_REFERENCES names; without it they are skipped.
test: build
	@ctest --test-dir $(BUILD) --output-on-failure --parallel $(JOBS)

# The program alone: what tests find of it they find in the release build.
portable: packages
	@cmake --preset portable
	@cmake --build build/portable --parallel $(JOBS) --target dapple
	@scripts/check_portable build/portable/dapple

# The readers and all that they need, by clang under the address and undefined-behaviour sanitizers.
sanitized-readers: packages
	@scripts/install_packages.sh clang libclang-rt-14-dev
	@cmake --preset fuzz
	@cmake --build build/fuzz --parallel $(JOBS)

# A part of what `ctest --preset asan` and `ctest --preset tsan` run, for integration: the tests of all that reads files, and of
# what all that runs in parallel goes through.
sanitize: sanitized-readers
	@build/fuzz/tests/fuzz/image_tests --gtest_brief=1 --gtest_filter='-Flip.*'
	@build/fuzz/tests/fuzz/io_tests --gtest_brief=1
	@cmake --preset tsan
	@cmake --build build/tsan --parallel $(JOBS) --target base_tests
	@TSAN_OPTIONS=suppressions=tests/tsan_suppressions.txt build/tsan/tests/base_tests --gtest_brief=1

SECONDS ?= 10
fuzz: sanitized-readers
	@scripts/fuzz -seconds $(SECONDS)

bench: build
	@for program in $(BUILD)/bench/*_bench; do echo "== $$program"; $$program || exit 1; done

gallery: build
	@bench/gallery

format:
	@git ls-files --cached --others --exclude-standard '*.h' '*.cpp' | xargs clang-format -i

clean:
	rm -rf build
