# Fuzz targets for clang's libFuzzer; tests/verify/fuzz builds them, with its flags. Each is linked with an archive of all
# parts, so that it can bring one of its own: what it defines itself is not taken from there. The sanitizer checks types of C++, too.

FUZZERS := $(basename $(wildcard tests/fuzz/*_fuzz.c))
FUZZ_SUPPORT := $(patsubst %.c,$(B)/obj/%.o,$(filter-out %_fuzz.c,$(wildcard tests/fuzz/*.c)))

.PHONY: fuzzers
fuzzers: $(FUZZERS:%=$(B)/%)

$(FUZZERS:%=$(B)/obj/%.o) $(FUZZ_SUPPORT): $(B)/lcm/waferhand_messages.h
$(B)/fuzz_parts.a: $(filter-out $(B)/obj/lib/app/main.o,$(PROGRAM_OBJECTS)) $(B)/sources
	$(archive)

# Lua's memory from snapshots; LCM without a network; argp without exits, and nothing behind it.
$(B)/tests/fuzz/script_fuzz $(B)/tests/fuzz/line_fuzz $(B)/tests/fuzz/dialect_fuzz: $(B)/obj/tests/fuzz/snapshot.o
$(B)/tests/fuzz/message_fuzz: $(B)/obj/tests/fuzz/fake_node.o
WRAPPED := $(shell grep -oE '__wrap_[a-z_]+' tests/fuzz/argv_fuzz.c | sed 's/__wrap_//' | sort -u)
$(B)/tests/fuzz/argv_fuzz: LINK += $(WRAPPED:%=-Wl,--wrap=%)

# What a target puts in the place of a part must be one: a name that has changed would leave the part itself in place.
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
