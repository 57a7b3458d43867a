# Fuzz targets for clang's libFuzzer; tests/verify/fuzz builds them, with its flags. Each is linked with an archive of all
# parts, so that it can bring one of its own: what it defines itself is not taken from there.

FUZZERS := $(basename $(wildcard tests/fuzz/*_fuzz.c))
FUZZ_SUPPORT := $(patsubst %.c,$(B)/obj/%.o,$(filter-out %_fuzz.c,$(wildcard tests/fuzz/*.c)))

.PHONY: fuzzers
fuzzers: $(FUZZERS:%=$(B)/%)

$(FUZZERS:%=$(B)/obj/%.o) $(FUZZ_SUPPORT): $(B)/lcm/waferhand_messages.h
$(B)/fuzz_parts.a: $(filter-out $(B)/obj/lib/app/main.o,$(PROGRAM_OBJECTS)) $(B)/sources
	$(archive)

# Lua's memory from snapshots; LCM without a network; argp without exits, and nothing behind it.
$(B)/tests/fuzz/script_fuzz $(B)/tests/fuzz/line_fuzz: $(B)/obj/tests/fuzz/snapshot.o
$(B)/tests/fuzz/message_fuzz: $(B)/obj/tests/fuzz/fake_node.o $(B)/obj/tests/fuzz/message_frames.o
$(B)/tests/fuzz/argv_fuzz: LINK += $(foreach name,argp_parse argp_error fopen wh_run_and_print wh_mcs_link_open wh_open_node wh_study_open \
    wh_layout_load wh_sandbox_new wh_sandbox_free wh_sandbox_set_parameter,-Wl,--wrap=$(name))

$(FUZZERS:%=$(B)/%): $(B)/tests/fuzz/%: $(B)/obj/tests/fuzz/%.o $(B)/fuzz_parts.a $(B)/libwaferhand_collision.a \
    $(B)/libwaferhand.a $(B)/libwaferhand_lcm.a
	@mkdir -p $(@D)
	@echo "  LD   $@"
	$(LINK) -fsanitize=fuzzer -o $@ $(filter %.o,$^) $(B)/fuzz_parts.a $(COLLISION_LIBS) $(B)/libwaferhand.a $(PROGRAM_LIBS)
