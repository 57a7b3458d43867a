# Fuzz targets for clang's libFuzzer; tests/verify/fuzz builds them, with its flags. Each is linked with an archive of all
# parts. A target can bring a part of its own: functions that it defines are not taken from the archive. The sanitizer checks
# types of C++, too.

FUZZERS := $(basename $(wildcard tests/fuzz/*_fuzz.c))
FUZZ_SUPPORT := $(patsubst %.c,$(B)/obj/%.o,$(filter-out %_fuzz.c,$(wildcard tests/fuzz/*.c)))

.PHONY: fuzzers
fuzzers: $(FUZZERS:%=$(B)/%)

$(FUZZERS:%=$(B)/obj/%.o) $(FUZZ_SUPPORT): $(B)/lcm/waferhand_messages.h
# No target calls the estimates: Eigen under sanitizers took a third of the build.
ifneq ($(findstring fuzzer-no-link,$(EXTRA)),)
$(filter $(B)/obj/lib/estimate/%,$(PROGRAM_CXX_OBJECTS)): override EXTRA := -w
endif
$(B)/fuzz_parts.a: $(filter-out $(B)/obj/lib/app/main.o,$(PROGRAM_OBJECTS)) $(B)/sources
	$(archive)

# Lua's memory comes from snapshots, LCM has no network, and argp neither exits nor starts the work.
$(B)/tests/fuzz/script_fuzz $(B)/tests/fuzz/line_fuzz $(B)/tests/fuzz/dialect_fuzz: $(B)/obj/tests/fuzz/snapshot.o
$(B)/tests/fuzz/message_fuzz: $(B)/obj/tests/fuzz/fake_node.o
WRAPPED := $(shell grep -oE '__wrap_[a-z_]+' tests/fuzz/argv_fuzz.c | sed 's/__wrap_//' | sort -u)
$(B)/tests/fuzz/argv_fuzz: LINK += $(WRAPPED:%=-Wl,--wrap=%)

# A target's replacement must replace an existing part: otherwise, after a change of names, the part itself would stay in place.
fuzzers: check-fuzz-parts
.PHONY: check-fuzz-parts check-fuzz-names
check-fuzz-parts: $(B)/fuzz_parts.a $(FUZZERS:%=$(B)/obj/%.o) $(FUZZ_SUPPORT)
	@tests/fuzz/names parts $^
check: check-fuzz-names
check-fuzz-names:
	@tests/fuzz/names words

$(FUZZERS:%=$(B)/%): $(B)/tests/fuzz/%: $(B)/obj/tests/fuzz/%.o $(B)/fuzz_parts.a $(B)/libwaferhand_collision.a \
    $(B)/libwaferhand.a $(B)/libwaferhand_lcm.a
	@mkdir -p $(@D)
	@echo "  LD   $@"
	$(LINK) -fsanitize=fuzzer -fsanitize-link-c++-runtime -o $@ $(filter %.o,$^) $(B)/fuzz_parts.a $(COLLISION_LIBS) $(B)/libwaferhand.a $(PROGRAM_LIBS)
