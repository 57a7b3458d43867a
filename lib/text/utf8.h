/* Text of any bytes as JSON. */
#ifndef WH_TEXT_UTF8_H
#define WH_TEXT_UTF8_H

#include <jansson.h>

/* How long the valid UTF-8 character at `text` is: 0 when there is none. */
size_t wh_utf8_bytes(const char *text);

/* A text, repaired where it is no UTF-8: U+FFFD for each wrong byte; null for null. */
json_t *wh_json_text(const char *text);

#endif
