/* UTF-8 in text of any bytes: which of them are characters, and where a text may be cut. */
#ifndef WH_TEXT_UTF8_H
#define WH_TEXT_UTF8_H

#include <stdbool.h>
#include <stddef.h>

/* The replacement character, U+FFFD. */
#define WH_UTF8_REPLACEMENT "\xef\xbf\xbd"

/* How many bytes the character at `text` has, 1 to 4; 0 at the end of the text and where no valid character
 * begins (RFC 3629: nothing longer than needed, no surrogates, nothing above U+10FFFF). */
size_t wh_utf8_bytes(const char *text);

/* True if the byte goes on with a character that begins before it. */
static inline bool wh_utf8_goes_on(char byte) {
    return ((unsigned char)byte & 0xC0U) == 0x80U;
}

/* How many characters the text has. */
size_t wh_utf8_count(const char *text);

/* The greatest length up to `length` at which the text can be cut without cutting a character. */
size_t wh_utf8_cut(const char *text, size_t length);

/* Copies a text into `size` bytes, at least 4. One that is too long is cut between characters and ends in
 * "...". */
void wh_utf8_clip(char *to, size_t size, const char *from);

/* How many bytes of `text` are a control character, 0 if it begins with none: U+0000 to U+001F, U+007F to
 * U+009F, and a lone byte that some terminals take for one of these. */
size_t wh_utf8_control_bytes(const char *text);

/* wh_utf8_clip of a text in which each byte of a control character stands as \xNN: it stays on its line and
 * steers no terminal. */
void wh_utf8_visible(char *to, size_t size, const char *from);

/* wh_utf8_visible of a text of `length` bytes, which may be 0 too, and a final zero. */
void wh_utf8_visible_bytes(char *to, size_t size, const char *from, size_t length);

/* The beginning of a text of any bytes with its control characters as \xNN, but for line ends and tabs.
 * Returns how many of the bytes were taken, at least one of them; `piece` has them then, without a final
 * zero. */
#define WH_UTF8_PIECE 512
size_t wh_utf8_piece(const char *text, size_t size, char piece[WH_UTF8_PIECE], size_t *length);

/* A copy with U+FFFD for each byte that is no UTF-8. The caller frees it. Ends the program if out of
 * memory. */
char *wh_utf8_repaired(const char *text);

#endif
