/* Shared by the files of a transcript: as text, as JSON lines, and played. */
#ifndef WH_HOST_TRANSCRIPT_INTERNAL_H
#define WH_HOST_TRANSCRIPT_INTERNAL_H

#include "transcript.h"

/* The kind's name in JSON; null: there is no such kind. */
const char *wh_transcript_kind_name(wh_transcript_kind_t kind);
bool wh_transcript_has_bytes(wh_transcript_kind_t kind);

/* True if the entry can be read back once it is written. */
bool wh_transcript_is_entry(const wh_transcript_entry_t *entry);

/* Writes into `message` what is wrong, and returns false. */
bool wh_transcript_refuse(wh_transcript_t *transcript, size_t line, const char *field, const char *value,
                          const char *expected);

/* Append a head or an entry that was read. False: it is refused; kind and bytes of an entry are right
 * already. `size` is the text's size: a zero in the text does not end it. */
bool wh_transcript_add_head(wh_transcript_t *transcript, const wh_transcript_head_t *head, size_t size);
bool wh_transcript_add_entry(wh_transcript_t *transcript, const wh_transcript_entry_t *entry);

/* Call it once all entries are there: the next entry of each side is then its first one. */
void wh_transcript_rewind(wh_transcript_t *transcript);

/* Takes a line of JSON apart. From then on its memory belongs to the head or the entry. */
bool wh_transcript_take_json(wh_transcript_t *transcript, size_t line, char *text);

#endif
