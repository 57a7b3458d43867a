/* Bytes as text for use in a page: base 64, and long texts deflated first.
 *
 * The caller frees the returned texts. They end the program if out of memory.
 */
#ifndef WH_TEXT_PACKED_H
#define WH_TEXT_PACKED_H

#include <stddef.h>
#include <stdint.h>

/* `head`, then the bytes in base 64 (RFC 4648), with padding. */
char *wh_packed_bytes(const char *head, const uint8_t *bytes, size_t size);

/* A text compressed by zlib (RFC 1950), then in base 64; a browser's DecompressionStream("deflate")
 * reverses it. */
char *wh_packed_text(const char *text, size_t size);

#endif
