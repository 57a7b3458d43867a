/* Bytes as text that can stand in a page: base 64, and long texts deflated before.
 *
 * Texts that are returned are the caller's to free. Ends the program if out of memory.
 */
#ifndef WH_TEXT_PACKED_H
#define WH_TEXT_PACKED_H

#include <stddef.h>
#include <stdint.h>

/* `head`, then the bytes as RFC 4648 has them, with padding. */
char *wh_packed_bytes(const char *head, const uint8_t *bytes, size_t size);

/* A text by zlib (RFC 1950), then in base 64: what a browser's DecompressionStream("deflate") undoes. */
char *wh_packed_text(const char *text, size_t size);

#endif
