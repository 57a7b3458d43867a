/* A study's progress as text: in a file, to go on from, and on its way to another rank.
 *
 * JSON. `study` says to which study it belongs (identity.h). It does not hold the number of trials, because a
 * study can be extended. `done` has the first and the last trial of each stretch that is done, `tally` the
 * rest. `check`, the last member, is a hash of all bytes before it: a state that was changed is refused.
 */
#ifndef WH_STUDY_CHECKPOINT_H
#define WH_STUDY_CHECKPOINT_H

#include "pool.h"

/* The progress as text, to be freed. */
char *wh_checkpoint_text(const wh_study_t *study, const wh_progress_t *progress);

/* Adds the text's contents to `progress`, which is unchanged on failure: then `message` says what is wrong,
 * "of another study: its seed is 2 (expected 1)", "of a longer study", "of another version" or
 * "damaged". */
bool wh_checkpoint_read(const wh_study_t *study, const char *text, size_t size, wh_progress_t *progress,
                        char *message, size_t message_size);

/* Replaces the file at once: a reader sees the old text or the new one, also after a crash. False, with
 * errno, when that is not possible. */
bool wh_checkpoint_save(const char *path, const char *text);

typedef enum { WH_CHECKPOINT_NONE, WH_CHECKPOINT_READ, WH_CHECKPOINT_REFUSED } wh_checkpoint_found_t;

/* Reads a file, if there is one; one that is refused is named on stderr. */
wh_checkpoint_found_t wh_checkpoint_load(const char *path, const wh_study_t *study, wh_progress_t *progress);

/* Where a study's progress is kept unless the user names a file: "study-HASH" of wh_output_state_path. Makes
 * the folder. To be freed; null if there is no such place. */
char *wh_checkpoint_default_path(const wh_study_t *study);

#endif
