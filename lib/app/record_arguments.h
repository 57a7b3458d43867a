/* The options of `run`, `sim` and `mcs` about a recording. */
#ifndef WH_APP_RECORD_ARGUMENTS_H
#define WH_APP_RECORD_ARGUMENTS_H

#include "../link/recording.h"
#include "../text/options.h"

typedef struct {
    const char *slices, *all; /* files */
    double part_mb;
} wh_record_arguments_t;

extern const wh_option_t wh_record_options[];

/* Refuses by argp_error what does not go together. */
void wh_record_arguments_check(const wh_record_arguments_t *arguments, struct argp_state *state);

/* Sets the options of a recording, by `program`, which must outlive it; it replaces an old file or does
 * not. */
void wh_record_arguments_apply(const wh_record_arguments_t *arguments, const char *program, bool replaces,
                               wh_recording_t *recording);

#endif
