/* Status codes: every call that can fail returns one; zero is success. */
#ifndef WH_MATH_STATUS_H
#define WH_MATH_STATUS_H

#include "config.h"

WH_HEADER_BEGIN

/* WH_STATUS_NULL_ARGUMENT, ...: number, name and text of each stand in math/status.def. */
typedef enum WH_FOUR_BYTES {
#define WH_STATUS(number, name, text) WH_STATUS_##name = (number),
#include "status.def"
#undef WH_STATUS
} wh_status_t;

#define WH_OK WH_STATUS_OK

/* The catalogue's text for a status that a function of the library returns: a constant string in English
 * without a full stop, never null. For any other number it is "unknown status": a firmware links no texts
 * of a whole controller's answers, 40 to 69 and from 80 on. Cost: linear in the catalogue. */
const char *wh_status_text(wh_status_t status) WH_SYMBOL(wh_status_text);

/* The catalogue's name for any status, such as "NOT_FINITE"; "UNKNOWN" if it is not in it. Cost: linear in
 * the catalogue. */
const char *wh_status_name(wh_status_t status) WH_SYMBOL(wh_status_name);

WH_HEADER_END

#endif
