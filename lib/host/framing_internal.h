/* Shared by a description of frames and their reader. */
#ifndef WH_HOST_FRAMING_INTERNAL_H
#define WH_HOST_FRAMING_INTERNAL_H

#include "framing.h"

bool wh_framing_begins_with(const wh_framing_mark_t *mark, const wh_framing_mark_t *with);

/* The one byte that `longer` has behind `end`, or -1: it does not begin so, or has another length. */
int wh_framing_byte_behind(const wh_framing_mark_t *longer, const wh_framing_mark_t *end);

/* How many digits the sum has. */
size_t wh_framing_digits(const wh_framing_t *framing);

/* The value of a hex digit; 16: it is not a hex digit. */
unsigned wh_framing_digit(uint8_t byte);

#endif
