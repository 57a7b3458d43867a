/* What the files of a transcript share: as a text, as JSON lines, and played. */
#ifndef WH_HOST_TRANSCRIPT_INTERNAL_H
#define WH_HOST_TRANSCRIPT_INTERNAL_H

#include "transcript.h"

/* As in JSON; null: there is no such kind. */
const char *wh_transcript_kind_name(wh_transcript_kind_t kind);
bool wh_transcript_has_bytes(wh_transcript_kind_t kind);

/* True if it could be read once it is written. */
bool wh_transcript_is_entry(const wh_transcript_entry_t *entry);

/* Writes into `message` what is wrong, and returns false. */
bool wh_transcript_refuse(wh_transcript_t *transcript, size_t line, const char *field, const char *value,
                          const char *expected);

/* Append what was read. False: refused; of an entry kind and bytes are right already. `size`: the text's, in
 * which a zero is no end. */
bool wh_transcript_add_head(wh_transcript_t *transcript, const wh_transcript_head_t *head, size_t size);
bool wh_transcript_add_entry(wh_transcript_t *transcript, const wh_transcript_entry_t *entry);

/* Once all entries are there: what comes next is the first of either side. */
void wh_transcript_rewind(wh_transcript_t *transcript);

/* Takes a line of JSON apart; its place in memory is the head's or the entry's from then on. */
bool wh_transcript_take_json(wh_transcript_t *transcript, size_t line, char *text);

#endif
