# Waferhand: the commands that people type. lib/build/build.mk and tests/tests.mk have the rules, tests/check/check.mk has the
# checks, and *.packages of lib/build and tests list the packages.
#
# Settings, as in `make CC=clang WERROR=1`:
#   CC CXX CPPFLAGS CFLAGS CXXFLAGS LDFLAGS  as usual, taken as they are; EXTRA is appended to every compiler call
#   FLOAT=1    the library's number is float instead of double
#   WITHOUT="sweep index"   the library has no swept checking, no index over the wafers, or neither
#   SHARED=1   the shared libraries are installed, too
#   COLLISION=1  install-library installs collision, too; it needs libccd
#   FOR="run test"  whose packages `make deps` installs: run, page, test, check, bench, verify, manual, spy, browser, playground
#   CCACHE=    does not use ccache, which is otherwise used if it is there
#   WERROR=1   warnings are errors (always so if CI is set)
#   V=1        shows the commands; 0 switches off what 1 switches on, and is the default
#   B=build    the folder to build in, as in `make library B=build/m7 CC=arm-none-eabi-gcc CFLAGS=...`
#   PREFIX=/usr/local LIBDIR=PREFIX/lib DESTDIR=   where `make install` puts things; PREFIX and LIBDIR without blanks
#
# Only `make deps`, `make run` and `make test` install packages, with apt-get. Every other command prints the one line that would
# install what is missing, and stops.

# Commands run one after the other; the builds that they start are parallel. Otherwise `make -j run test` would have two makes
# at work in build/.
.NOTPARALLEL:

NEED = @CC='$(CC)' lib/build/need
DEPS = $(NEED) --install
JOBS = $(if $(filter -j%,$(MAKEFLAGS)),,-j$(shell nproc))
# Another compiler than Debian's own, such as a target's, brings its own headers.
COMPILER = $(if $(filter cc gcc,$(CC)),$(NEED) library $(if $(COLLISION),collision))
BUILD = @+$(MAKE) --no-print-directory $(JOBS) -f lib/build/build.mk

# Invariants (WH_ASSERT, WH_ASSERT_CONSISTENT) are on as well. These builds are the slow ones, hence -O1 and no debug
# information but line numbers.
SANITIZE = CFLAGS='-O1 -g1 -DWH_DEBUG -DWH_DEBUG_TABLE' CXXFLAGS='-O1 -g1 -DWH_DEBUG -DWH_DEBUG_TABLE' \
           EXTRA='$(EXTRA) -fsanitize=address,undefined,float-cast-overflow -fno-sanitize-recover=all'

include lib/build/switches.mk tests/tests.mk

# These checks need tools of their own; tests/README.md says which claim each of them checks.
CORE_PARTS := symbols footprint instructions bits on_target eva fuzz configurations
PART := $(CORE_PARTS) board played same_bits builds playground analysers wp random long hour long_counts coverage mutation host_mutation

.PHONY: all deps library shared manual manual-tables install-library run spy playground test quick bench check verify-core verify install uninstall clean help

all: ## the library, the program, the Lua module and the manual page, in build/
	$(NEED) run
	$(BUILD) all

library: ## build/libwaferhand.a alone: needs nothing but a C compiler, of any target
	$(COMPILER)
	$(BUILD) library

deps: ## installs the packages that `make` needs, or those of FOR="run test"
	$(DEPS) $(or $(FOR),run)

run: ## plays the two examples of the paper; installs what is missing for it
	$(DEPS) run
	$(BUILD) program
	@for script in 01_transfer 02_prealigner; do \
	    build/waferhand run "lua/examples/$$script.lua" || exit; \
	done

spy: ## opens lcm-spy, with our messages decoded and a view of the proximity check
	$(NEED) spy
	$(BUILD) spy
	@lib/spy/start build/spy/types.jar

playground: ## build/playground.html: Waferhand in one page, without a server; about 5 minutes of emscripten the first time
	$(NEED) run playground
	$(BUILD) playground
	@echo 'build/playground.html'

test: ## every test: plain, under sanitizers, in float, and end to end; installs what is missing for it
	$(DEPS) run test $(if $(CI),browser)
	$(BUILD) all tests
	$(BUILD) B=build/sanitize $(SANITIZE) sanitized-tests program
	$(BUILD) B=build/float FLOAT=1 library-tests
	@tests/run $(TESTS:%=build/%) $(SANITIZED_TESTS:%=build/sanitize/%) $(LIBRARY_TESTS:%=build/float/%) $(END_TO_END)

# Half the seconds of random numbers that `make test` has; a seed of one's own still plays all rounds.
quick: ## the plain unit and property tests alone, for while you work
	$(NEED) run test
	$(BUILD) unit-tests
	@$(if $(WH_SEED)$(WH_TEST_SECONDS),,WH_TEST_SECONDS=1.5) tests/run $(TESTS:%=build/%)

bench: ## how fast, against peers in the same process: minutes. BENCH=step for one subject or row, JSON=1
	$(NEED) run test bench
	@tests/bench/wheels
	$(BUILD) all bench
	@tests/bench/run $(if $(JSON),--json)

# In CI, warnings are errors in the trees that `make test` builds, so these trees are not built twice. Clang's warnings come
# from its own logs.
check: ## format, warnings as errors, static analysis
	$(NEED) run test check $(if $(CI),browser manual)
	$(BUILD) $(if $(CI),B=build/float,B=build/check/float CC=gcc WERROR=1) FLOAT=1 library
	$(BUILD) $(if $(CI),,B=build/check CC=gcc CXX=g++ WERROR=1) all tests check

verify-core: ## what must never rot: bits on targets, no allocation, stack, sizes, proofs of no error, 60 s of fuzzing each
	-$(NEED) run test verify
	@FUZZ_SECONDS=$(or $(FUZZ_SECONDS),60) tests/verify/run $(CORE_PARTS)

verify: ## all of it, hours; goes on where it was stopped. PART="wp mutation" for some
	-$(NEED) run test verify
	@RESUME=1 EVA=all BITS=all FUZZ_SECONDS=$(or $(FUZZ_SECONDS),600) FUZZ_SEED=$(or $(FUZZ_SEED),0) tests/verify/run $(PART)

manual: ## all manuals as one site with a search, in build/manual, read from disk; make install takes it along
	$(NEED) manual
	@lib/build/site build/manual && echo 'build/manual/index.html'

manual-tables: ## writes the tables of fields, errors and words in lua/manual anew, from what the program goes by
	$(NEED) run test
	$(BUILD) all build/tests/end_to_end/tools/manual_tables
	@build/tests/end_to_end/tools/manual_tables tests/end_to_end/tools/manual_tables.lua lua/manual/*.md

shared: ## build/libwaferhand.so alone
	$(COMPILER)
	$(BUILD) shared

install: ## all of it into PREFIX, below DESTDIR
	$(if $(FLOAT),$(error the program is of doubles: make install-library FLOAT=1))
	@$(MAKE) --no-print-directory all
	$(BUILD) install

install-library: ## the library alone: needs nothing but a C compiler. SHARED=1 COLLISION=1 add theirs
	$(COMPILER)
	$(BUILD) install-library $(if $(COLLISION),install-collision)

uninstall: ## takes away what install put there
	$(BUILD) uninstall

clean: ## removes build/
	rm -rf build

help: ## this list, and the settings
	@sed -n 's/^\([a-z-]*\):.*## /make \1\t/p' Makefile | expand -t 22
	@echo
	@sed -n 's/^# \(Settings,.*\)/\1/p; s/^#   /  /p; /^# Only/,/^$$/ { s/^# Only/\n&/; s/^\(\n*\)# /\1/p }' Makefile
