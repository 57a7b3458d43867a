/* A centring in words, for readers of its plot. */
#ifndef WH_RECORD_CENTRING_WORDS_H
#define WH_RECORD_CENTRING_WORDS_H

#include "record.h"

#define WH_CENTRING_LINES 6
#define WH_CENTRING_LINE_BYTES 240

typedef struct {
    bool is_sure;        /* sure, and within the layout's limits as far as the command's end tells */
    wh_status_t verdict; /* the reason if not, otherwise WH_OK */
    /* The verdict, "sure" or the reason; centre; radius; crossings; notch; the command and its end. */
    char lines[WH_CENTRING_LINES][WH_CENTRING_LINE_BYTES];
} wh_centring_words_t;

/* Describes one of the record's centrings. Values that a log does not contain are described as not told. It
 * is not sure where a log's states contradict the command's end. */
void wh_centring_words(const wh_record_t *record, const wh_centring_record_t *centring,
                       wh_centring_words_t *words);

#endif
