/* Chaos of a line: frames that are lost, come twice or late, and bytes that come wrong.
 *
 * Philox (math/philox.h) draws each fate from (seed, port, direction, frame, byte), never in sequence. So
 * frame 7 meets the same fate whatever became of frames 0 to 6, on every machine. Frames count from 0 for
 * each port and direction, as they were sent, before any chaos. A framer of its own (framing.h) cuts the
 * frames to the controller. After chaos their bytes go to the framer that the controller reads. */
#ifndef WH_HOST_CHAOS_H
#define WH_HOST_CHAOS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "framing.h"

/* The longest delay. */
#define WH_CHAOS_DELAY_US 3600000000
/* Room for the bytes that chaos makes of a frame. */
#define WH_CHAOS_BYTES (2 * WH_FRAMING_LINE)

/* Zero: none. Probabilities from 0 to 1. */
typedef struct {
    uint64_t seed;
    double drop;  /* that a frame is lost */
    double twice; /* that it comes twice (`double` in a dialect) */
    double
        garble; /* that a byte comes wrong: in one half of the cases another byte comes, in a quarter no byte,
                 * in a quarter the byte twice */
    int64_t delay_us;    /* the most that a frame comes later, evenly spread */
    int64_t late_ack_us; /* the most that an acknowledgement comes later in addition */
} wh_chaos_t;

/* Names the bytes of a frame: the port's number, from 0 in the order of the command line, the direction, and
 * the frame's number. */
typedef struct {
    uint32_t port; /* below 2^24 */
    bool is_to_host;
    uint64_t frame;
} wh_chaos_place_t;

/* The fate of a frame: 0, 1 or 2 copies, and the delay of each. */
typedef struct {
    size_t copies;
    int64_t later_us[2];
} wh_chaos_fate_t;

/* True if all members are in their ranges. If not, `problem` tells field, value and what was expected. */
bool wh_chaos_validate(const wh_chaos_t *chaos, char problem[WH_FRAMING_PROBLEM_BYTES]);

/* True if something may happen: a seed alone is no chaos. */
bool wh_chaos_is_on(const wh_chaos_t *chaos);

/* The fate of a frame. */
wh_chaos_fate_t wh_chaos_fate(const wh_chaos_t *chaos, wh_chaos_place_t place, bool is_acknowledgement);

/* The bytes of copy 0 or 1 as they come. `size` is at most WH_FRAMING_LINE. Returns how many there are. Cost:
 * 15 ns a byte, and none if nothing is garbled. */
size_t wh_chaos_garble(const wh_chaos_t *chaos, wh_chaos_place_t place, size_t copy, const uint8_t *bytes,
                       size_t size, uint8_t garbled[WH_CHAOS_BYTES]);

#endif
