# Which tests there are: a new file is found by its name. Programs are built from and named after their
# source; everything in tests/end_to_end that begins with #! is run as it is.

include lib/build/rooms.mk

TEST_SOURCES := $(wildcard tests/unit/*/*_test.c tests/property/*_random.c tests/property/*_random.cpp tests/firmware/*_test.c)
CXX_TESTS := $(basename $(filter %.cpp,$(TEST_SOURCES)))

# A test of the program's parts is linked with them; all others see the library alone, as a firmware does,
# and are built in float too.
PROGRAM_TESTS := $(basename $(shell grep -lE '^.include ("($(subst $() ,|,$(strip $(HOST_ROOMS))))/|<waferhand_)' $(TEST_SOURCES) /dev/null))
TESTS := $(basename $(TEST_SOURCES))
# Those of collision are linked with it, and there is no float build of it.
COLLISION_TESTS := $(basename $(shell grep -lE '^.include "(collision/|waferhand_collision)' $(TEST_SOURCES) /dev/null))

# Programs that end-to-end tests use: built with the tests, not run by themselves. Two are built by the tests themselves.
TOOLS := $(filter-out %/play_segments %/pty_dialogue,$(basename $(wildcard tests/end_to_end/tools/*.c)))

# Programs that measure, to be run by hand: built with the tests too. Those of `make bench` are in tests/bench/bench.mk.
BENCHES := tests/bench/gap tests/bench/counts
LIBRARY_TESTS := $(filter-out $(PROGRAM_TESTS) $(COLLISION_TESTS),$(filter tests/unit/% tests/firmware/% tests/property/horizon_random,$(TESTS)))

# The longest first, so that no processor waits for them at the end.
LONGEST := tests/end_to_end/report_page tests/end_to_end/same_bits
END_TO_END := $(LONGEST) $(filter-out $(LONGEST),$(shell awk 'FNR == 1 && /^.!/ { print FILENAME }' $(filter-out $(patsubst %/.,%,$(wildcard tests/end_to_end/*/.)),$(wildcard tests/end_to_end/*)) /dev/null))
