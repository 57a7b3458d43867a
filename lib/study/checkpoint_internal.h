/* Within the state of a study: JSON there and back. */
#ifndef WH_STUDY_CHECKPOINT_INTERNAL_H
#define WH_STUDY_CHECKPOINT_INTERNAL_H

#include <jansson.h>

#include "checkpoint.h"

/* Which study it is; null when memory is out. */
json_t *wh_checkpoint_identity(const wh_study_t *study);

/* Null when memory is out. */
json_t *wh_checkpoint_put_tally(const wh_tally_t *tally);

/* Takes a tally of so many wafers from JSON; false when it is none. `tally` is initialised. */
bool wh_checkpoint_take_tally(const json_t *root, wh_tally_t *tally);

#endif
