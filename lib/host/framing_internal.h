/* Shared by a description of frames and their reader. */
#ifndef WH_HOST_FRAMING_INTERNAL_H
#define WH_HOST_FRAMING_INTERNAL_H

#include "framing.h"

bool wh_framing_begins_with(const wh_framing_mark_t *mark, const wh_framing_mark_t *with);

/* The one byte that `longer` has behind `end`, or -1: it does not begin so, or has another length. */
int wh_framing_byte_behind(const wh_framing_mark_t *longer, const wh_framing_mark_t *end);

/* How many digits or bytes the sum has. */
size_t wh_framing_sum_size(const wh_framing_t *framing);

/* Like wh_framing_sum, over the bytes of the length as they came. */
uint16_t wh_framing_sum_over(const wh_framing_t *framing, size_t start, const uint8_t *length,
                             const uint8_t *body, size_t size);

/* The bytes of the whole frame whose length these bytes are, behind a start of `start_size` bytes; 0: they
 * are no length, or less than a frame has. */
size_t wh_framing_whole(const wh_framing_t *framing, size_t start_size, const uint8_t *length);

/* The value of a hex digit; 16: it is not a hex digit. */
unsigned wh_framing_digit(uint8_t byte);

#endif
