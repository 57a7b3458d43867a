# Waferhand: the commands that people type. What is made from what stands in lib/build/build.mk and
# tests/tests.mk, the checks in tests/check/check.mk, the packages in *.packages of lib/build and tests.
#
# Settings, as in `make CC=clang WERROR=1`:
#   CC CXX CFLAGS CXXFLAGS LDFLAGS  as usual; EXTRA is appended to every compiler call
#   FLOAT=1    the library's number is float instead of double
#   WITHOUT="sweep index"   the library has no swept checking, no index over the wafers, or neither
#   SHARED=1   libwaferhand.so is installed, too; COLLISION=1 for install-library: so is collision, over libccd
#   WERROR=1   warnings are errors (so they are where CI is set)
#   V=1        shows the commands; 0 switches off what 1 switches on, and is the default
#   B=build    the folder to build in, as in `make library B=build/m7 CC=arm-none-eabi-gcc CFLAGS=...`
#   PREFIX=/usr/local LIBDIR=PREFIX/lib DESTDIR=   where `make install` puts things; the first two without blanks

# Commands run one after the other, the builds that they start in parallel: `make -j run test` would else
# have two makes at work in build/.
.NOTPARALLEL:

NEED = @CC='$(CC)' lib/build/need
JOBS = $(if $(filter -j%,$(MAKEFLAGS)),,-j$(shell nproc))
BUILD = @+$(MAKE) --no-print-directory $(JOBS) -f lib/build/build.mk

# Invariants (WH_ASSERT, WH_ASSERT_CONSISTENT) are on as well; -O1, for these builds are the slow ones.
SANITIZE = CFLAGS='-O1 -g -DWH_DEBUG -DWH_DEBUG_TABLE' CXXFLAGS='-O1 -g -DWH_DEBUG -DWH_DEBUG_TABLE' \
           EXTRA='$(EXTRA) -fsanitize=address,undefined,float-cast-overflow -fno-sanitize-recover=all'

include lib/build/switches.mk tests/tests.mk

# Checks that need tools of their own; tests/README.md says which claim is checked by which of them.
CORE_PARTS := symbols footprint instructions bits on_target eva fuzz
PART := $(CORE_PARTS) wp coverage mutation host_mutation

.PHONY: all library shared install-library run spy view test quick bench check verify-core verify install uninstall clean help

all: ## the library, the program, the Lua module and the manual page, in build/
	$(NEED) run
	$(BUILD) all

library: ## build/libwaferhand.a alone: needs nothing but a C compiler, of any target
	$(BUILD) library

run: all ## plays the two examples of the paper
	@for script in 01_transfer 02_prealigner; do \
	    build/waferhand run "lua/examples/$$script.lua" || exit; \
	done

spy: ## opens lcm-spy, with our messages decoded and a view of the proximity check
	$(NEED) spy
	$(BUILD) spy
	@lib/link/spy/start build/spy/types.jar

view: all ## shows a cell live in a web browser: fetches Drake's viewer, says what to start beside it
	$(NEED) run view
	@lib/view/fetch
	@lib/view/start

test: ## every test: plain, under sanitizers, in float, and end to end
	$(NEED) run test $(if $(CI),browser)
	$(BUILD) all tests
	$(BUILD) B=build/sanitize $(SANITIZE) tests program
	$(BUILD) B=build/float FLOAT=1 library-tests
	@tests/run $(TESTS:%=build/%) $(TESTS:%=build/sanitize/%) $(LIBRARY_TESTS:%=build/float/%) $(END_TO_END)

quick: ## the plain unit and property tests alone, for while you work
	$(NEED) run test
	$(BUILD) tests
	@tests/run $(TESTS:%=build/%)

bench: ## how fast, against peers in the same process: minutes. BENCH=step for one subject or row, JSON=1
	$(NEED) run test bench
	@tests/bench/wheels
	$(BUILD) all bench
	@tests/bench/run $(if $(JSON),--json)

check: ## format, warnings as errors, static analysis
	$(NEED) run test check $(if $(CI),browser)
	$(BUILD) B=build/check/float CC=gcc WERROR=1 FLOAT=1 library
	$(BUILD) B=build/check/clang CC=clang CXX=clang++ WERROR=1 tests
	$(BUILD) B=build/check CC=gcc CXX=g++ WERROR=1 all tests check

verify-core: ## what must never rot: bits on targets, no allocation, stack, sizes, proofs of no error, 60 s of fuzzing each
	-$(NEED) run test verify
	@FUZZ_SECONDS=$(or $(FUZZ_SECONDS),60) tests/verify/run $(CORE_PARTS)

verify: ## all of it, hours; goes on where it was stopped. PART="wp mutation" for some
	-$(NEED) run test verify
	@RESUME=1 FUZZ_SECONDS=$(or $(FUZZ_SECONDS),600) FUZZ_SEED=$(or $(FUZZ_SEED),0) tests/verify/run $(PART)

shared: ## build/libwaferhand.so alone
	$(BUILD) shared

install: ## all of it into PREFIX, below DESTDIR
	$(if $(FLOAT),$(error the program is of doubles: make install-library FLOAT=1))
	@$(MAKE) --no-print-directory all
	$(BUILD) install

install-library: ## the library alone: needs nothing but a C compiler. SHARED=1 COLLISION=1 add theirs
	$(BUILD) install-library $(if $(COLLISION),install-collision)

uninstall: ## takes away what install put there
	$(BUILD) uninstall

clean: ## removes build/
	rm -rf build

help: ## this list, and the settings
	@sed -n 's/^\([a-z-]*\):.*## /make \1\t/p' Makefile | expand -t 18
	@echo
	@sed -n 's/^# \(Settings,.*\)/\1/p; s/^#   /  /p' Makefile
