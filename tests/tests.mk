# Finds the tests: a new file is found by its name. Programs are named after their source; everything in tests/end_to_end that
# begins with #! runs as it is.

include lib/build/rooms.mk

TEST_SOURCES := $(wildcard tests/unit/*/*_test.c tests/property/*_random.c tests/property/*_random.cpp tests/firmware/*_test.c)
CXX_TESTS := $(basename $(filter %.cpp,$(TEST_SOURCES)))

# A test of the program's parts is linked with them. All other tests see only the library, as a firmware does, and are built in
# float too.
PROGRAM_TESTS := $(basename $(shell grep -lE '^.include ("($(subst $() ,|,$(strip $(HOST_ROOMS))))/|<waferhand_)' $(TEST_SOURCES) /dev/null))
TESTS := $(basename $(TEST_SOURCES))
# Tests of collision are linked with it, and have no float build.
COLLISION_TESTS := $(basename $(shell grep -lE '^.include "(collision/|waferhand_collision)' $(TEST_SOURCES) /dev/null))

# Programs that end-to-end tests use: they are built with the tests, but do not run by themselves. The tests themselves build
# two of them.
TOOLS := $(filter-out %/play_segments %/pty_dialogue %/board,$(basename $(wildcard tests/end_to_end/tools/*.c)))

# Programs that measure, to be run by hand; they are built with the tests too. The ones of `make bench` are in
# tests/bench/bench.mk.
BENCHES := tests/bench/gap tests/bench/counts
# Tests linked into two programs, one with the program's parts and one with the library alone: see tests/support/together.h.
# Tests that count allocations, that stand beside a firmware, or that are C++ stay programs of their own. APART=1 keeps all of
# them apart.
ALONE := $(CXX_TESTS) $(filter tests/firmware/%,$(TESTS)) $(basename $(shell grep -l 'support/heap.h' $(TEST_SOURCES) /dev/null))
LIBRARY_TESTS := $(filter-out $(PROGRAM_TESTS) $(COLLISION_TESTS),$(filter tests/unit/% tests/firmware/% tests/property/horizon_random,$(TESTS)))

PROGRAM_TOGETHER := $(if $(APART)$(FLOAT),,$(filter-out $(ALONE),$(PROGRAM_TESTS)))
LIBRARY_TOGETHER := $(if $(APART),,$(filter-out $(ALONE),$(if $(FLOAT),$(LIBRARY_TESTS),$(filter-out $(PROGRAM_TESTS),$(TESTS)))))

# Tests that do not run again under sanitizers; their heads give the reason.
SANITIZED_TESTS := $(filter-out $(basename $(shell grep -l 'Plain alone: ' $(TEST_SOURCES) /dev/null)),$(TESTS))

# The longest tests start first, so that no processor waits for them at the end.
LONGEST := tests/end_to_end/report_page tests/end_to_end/same_bits
END_TO_END := $(LONGEST) $(filter-out $(LONGEST),$(shell awk 'FNR == 1 && /^.!/ { print FILENAME }' $(filter-out $(patsubst %/.,%,$(wildcard tests/end_to_end/*/.)),$(wildcard tests/end_to_end/*)) /dev/null))
