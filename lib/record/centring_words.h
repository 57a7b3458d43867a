/* A centring in words, for whoever looks at a plot of it. */
#ifndef WH_RECORD_CENTRING_WORDS_H
#define WH_RECORD_CENTRING_WORDS_H

#include "record.h"

#define WH_CENTRING_LINES 6
#define WH_CENTRING_LINE_BYTES 240

typedef struct {
    bool is_sure;        /* and within what the layout allows, as far as the command's end tells */
    wh_status_t verdict; /* why not, else WH_OK */
    /* The verdict, "sure" or the reason; centre; radius; crossings; notch; the command and how it ended. */
    char lines[WH_CENTRING_LINES][WH_CENTRING_LINE_BYTES];
} wh_centring_words_t;

/* Of one of the record's centrings. What a log does not tell is said to be not told. Where a log's states say
 * anything else than the command's end, it is not sure. */
void wh_centring_words(const wh_record_t *record, const wh_centring_record_t *centring,
                       wh_centring_words_t *words);

#endif
