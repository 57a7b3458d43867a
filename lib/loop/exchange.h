/* Which frame is of which slice: commands of a board come in, and the answer of the next slice comes out. No
 * input or output, no clock; nothing is allocated.
 *
 * State number n is of slice n; 0 is the cell before its first slice. The answer to state n drives slice n +
 * lag; the answer to state 0 drives slices 1 to lag. A slice whose answer is not there in time has none of
 * its own: it is held. Its answer may come later, and counts as late; if none comes, it is lost.
 */
#ifndef WH_LOOP_EXCHANGE_H
#define WH_LOOP_EXCHANGE_H

#include <stdbool.h>

#include "../math/config.h"
#include "board.h"

/* The longest lag, slices; slices that are remembered. */
#define WH_EXCHANGE_LAG 100
#define WH_EXCHANGE_SLICES 256

/* The kinds of frames. */
typedef enum {
    WH_EXCHANGE_TAKEN,
    WH_EXCHANGE_HELLO,
    WH_EXCHANGE_DOUBLED,    /* the answer of its slice was there before */
    WH_EXCHANGE_LATE,       /* its slice is over */
    WH_EXCHANGE_UNKNOWN,    /* it answers a state that was not sent: one of another run */
    WH_EXCHANGE_OTHER_AXES, /* it has another number of axes than the cell's machine */
    WH_EXCHANGE_NEWS
} wh_exchange_news_t;

/* The board's answers are counted from its reset on: fewer than before are a reset, and a gap is answers that
 * it sent and that never came. */
typedef struct {
    uint64_t frames[WH_EXCHANGE_NEWS]; /* by what they were */
    uint64_t held, resets, lost_answers;
    int64_t answers, slowest_us, sum_us; /* from state to answer, of those that were taken */
} wh_exchange_counters_t;

typedef enum { WH_EXCHANGE_AWAITED, WH_EXCHANGE_THERE, WH_EXCHANGE_USED, WH_EXCHANGE_HELD } wh_answer_state_t;

typedef struct {
    uint32_t slice; /* that the entry is of */
    wh_answer_state_t state;
    uint32_t valves;
    double axes[WH_BOARD_AXES];
    int64_t sent_us; /* when the state of this number was sent first; 0: not yet */
} wh_exchange_slot_t;

typedef struct {
    size_t axes;
    uint32_t lag;
    uint32_t next; /* the slice that is next, from 1 */
    bool is_heard; /* an answer to a state has come since the board's reset */
    bool is_reset; /* the last frame told of a reset; the reader clears it */
    uint32_t last_sent, last_number;
    wh_exchange_counters_t counters;
    wh_exchange_slot_t slots[WH_EXCHANGE_SLICES];
} wh_exchange_t;

/* `axes`: at most WH_BOARD_AXES; `lag`: 1 to WH_EXCHANGE_LAG. */
void wh_exchange_init(wh_exchange_t *exchange, size_t axes, uint32_t lag);

/* Takes a command frame whose sum is right. */
wh_exchange_news_t wh_exchange_hear(wh_exchange_t *exchange, const uint8_t frame[], int64_t now_us);

/* Notes when the state of slice next - 1 goes out. */
void wh_exchange_note_sent(wh_exchange_t *exchange, int64_t now_us);

/* True if the answer of the next slice is there. */
bool wh_exchange_is_ready(const wh_exchange_t *exchange);

/* Goes on to the slice after the next. Returns the answer of the one that was next; null: it is held. */
const wh_exchange_slot_t *wh_exchange_take(wh_exchange_t *exchange);

/* Held slices whose answers have not come until now. */
uint64_t wh_exchange_lost(const wh_exchange_t *exchange);

/* Writes a state frame of WH_BOARD_STATE_BYTES. */
void wh_exchange_write(const wh_exchange_t *exchange, const wh_board_state_t *state, uint8_t frame[]);

#endif
