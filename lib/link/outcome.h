/* The end of a run, as motion control tells it: the text of the phase OVER on WAFERHAND_MCS.
 *
 *     passed; commands 12, expectations 4, met 4, cycles 3
 *     failed; commands 2, expectations 0, met 0, cycles 0; the error that ended the script, or another reason
 *     ended; ...                              a prompt's session, which expects nothing
 *
 * The counts are of the messages before, so that a listener knows how many it has missed.
 */
#ifndef WH_LINK_OUTCOME_H
#define WH_LINK_OUTCOME_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum {
    WH_OUTCOME_UNTOLD, /* nobody has told the end */
    WH_OUTCOME_PASSED, /* no error, every expectation met, no complaint of the cell */
    WH_OUTCOME_FAILED,
    WH_OUTCOME_ENDED /* without a verdict */
} wh_outcome_verdict_t;

typedef struct {
    wh_outcome_verdict_t verdict;
    int64_t commands, expectations, met, cycles;
} wh_run_told_t;

/* Room for a text without a reason. */
#define WH_OUTCOME_BYTES 160

/* "passed" and so on; "untold". Never null. */
const char *wh_outcome_word(wh_outcome_verdict_t verdict);

/* Writes the text, with `reason` after it unless that is null or empty. */
void wh_outcome_write(const wh_run_told_t *outcome, const char *reason, char *text, size_t size);

/* Reads the text. Returns the reason within `text`, "" if there is none. Returns null and writes nothing if
 * it is no such text: verdict and counts may contradict each other, or an older program wrote it. */
const char *wh_outcome_read(const char *text, wh_run_told_t *outcome);

#endif
