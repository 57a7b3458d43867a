/* Within motion control: stretches of slices that counted time may leave out, played all the same and held
 * against what leaving them out gives. See `run --counted --verify`.
 *
 * The first N stretches are verified, and each later one by its number alone: stretch i with the chance
 * N / i. So at least N are, up to the run's end, and the same ones in each run. */
#ifndef WH_MCS_VERIFY_H
#define WH_MCS_VERIFY_H

#include "../sim/slice.h"

#define WH_VERIFY_BYTES 300

/* Zero it to begin with, but for `wanted`. */
typedef struct {
    uint64_t wanted;              /* N; 0: nothing is verified */
    uint64_t stretches, verified; /* so far */
    int64_t first, last;          /* slices of the stretch that is played now; last is 0 for none */
    uint32_t sensors;             /* that stay meanwhile */
    size_t axis_count;
    wh_real_t axes[WH_AXES];          /* behind the last slice */
    uint64_t hash;                    /* likewise, of the simulator */
    char difference[WH_VERIFY_BYTES]; /* the first one; empty: none */
} wh_verify_t;

/* Counts a stretch. True if it is to be verified. */
bool wh_verify_takes(wh_verify_t *verify);

/* The expectation for the stretch up to the slice of `command`: its axes, this hash, and no other sensors
 * than now. */
void wh_verify_expect(wh_verify_t *verify, int64_t first, const wh_command_t *command, uint64_t hash,
                      uint32_t sensors);

/* Looks at a slice that was played; of slices beyond the stretch it takes no notice. `hash` is the
 * simulator's behind it. Returns how it differs from what was expected, a constant text; null: it does
 * not. */
const char *wh_verify_slice(wh_verify_t *verify, const wh_command_t *command, const wh_state_t *state,
                            uint64_t hash);

#endif
