#include "record_arguments.h"

const wh_option_t wh_record_options[] = {
    {"record", 0, "FILE",
     "Record slices into an LCM event log: what `replay` and `report` need; compressed if the name ends in "
     ".zst",
     WH_OPTION_TEXT, .variable = offsetof(wh_record_arguments_t, slices)},
    {"record-all", 0, "FILE", "Record every message instead, as lcm-spy and viewers want it", WH_OPTION_TEXT,
     .variable = offsetof(wh_record_arguments_t, all)},
    {"record-size", 0, "MB", "Go on in a new file (run.part2.log) when one is so large", WH_OPTION_REAL,
     .variable = offsetof(wh_record_arguments_t, part_mb), 0.01, 1e6, "a number from 0.01 to 1e+06"},
    {0}};

void wh_record_arguments_check(const wh_record_arguments_t *arguments, struct argp_state *state) {
    if (arguments->slices && arguments->all) {
        argp_error(state, "--record-all: %s (--record is given, too: one recording at a time)",
                   arguments->all);
    }
    if (arguments->part_mb > 0 && !arguments->slices && !arguments->all) {
        argp_error(state, "--record-size goes with --record or --record-all");
    }
}

void wh_record_arguments_apply(const wh_record_arguments_t *arguments, const char *program, bool replaces,
                               wh_recording_t *recording) {
    recording->options = (wh_recording_options_t){.path = arguments->all ? arguments->all : arguments->slices,
                                                  .program = program,
                                                  .all = arguments->all != NULL,
                                                  .replaces = replaces,
                                                  .part_mb = arguments->part_mb};
}
