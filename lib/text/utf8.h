/* UTF-8 in text of any bytes: finds the characters, and the places where a text may be cut. */
#ifndef WH_TEXT_UTF8_H
#define WH_TEXT_UTF8_H

#include <stdbool.h>
#include <stddef.h>

/* The replacement character, U+FFFD. */
#define WH_UTF8_REPLACEMENT "\xef\xbf\xbd"

/* The number of bytes of the character at `text`, 1 to 4. It is 0 at the end of the text and where no valid
 * character begins (RFC 3629: not longer than needed, no surrogates, nothing above U+10FFFF). */
size_t wh_utf8_bytes(const char *text);

/* True if the byte continues a character that begins before it. */
static inline bool wh_utf8_goes_on(char byte) {
    return ((unsigned char)byte & 0xC0U) == 0x80U;
}

/* The number of characters in the text. */
size_t wh_utf8_count(const char *text);

/* The greatest length up to `length` at which the text can be cut without cutting a character. */
size_t wh_utf8_cut(const char *text, size_t length);

/* Copies a text into `size` bytes, at least 4. A text that is too long is cut between characters and ends
 * in "...". */
void wh_utf8_clip(char *to, size_t size, const char *from);

/* The number of bytes of `text` that are a control character, 0 if it begins with none. Control characters
 * are U+0000 to U+001F, U+007F to U+009F, and a lone byte that some terminals take for one of these. */
size_t wh_utf8_control_bytes(const char *text);

/* wh_utf8_clip of a text in which each byte of a control character appears as \xNN: it stays on its line
 * and cannot control a terminal. */
void wh_utf8_visible(char *to, size_t size, const char *from);

/* wh_utf8_visible of a text of `length` bytes, which may contain 0, and a final zero. */
void wh_utf8_visible_bytes(char *to, size_t size, const char *from, size_t length);

/* The beginning of a text of any bytes with its control characters as \xNN, except line ends and tabs.
 * Returns the number of bytes taken, at least one of them; `piece` then has them, without a final zero. */
#define WH_UTF8_PIECE 512
size_t wh_utf8_piece(const char *text, size_t size, char piece[WH_UTF8_PIECE], size_t *length);

/* A copy with U+FFFD for each byte that is not UTF-8. The caller frees it. It ends the program if out of
 * memory. */
char *wh_utf8_repaired(const char *text);

#endif
