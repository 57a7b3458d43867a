/* The look of text on a stream: colour, characters beyond ASCII, width; and making text printable.
 *
 * The program calls setlocale(LC_CTYPE, "") once at its start and leaves LC_NUMERIC unchanged. Without the
 * call everything is ASCII; with another LC_NUMERIC the decimal point might be a comma.
 */
#ifndef WH_TEXT_STYLE_H
#define WH_TEXT_STYLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

typedef struct {
    bool colour;
    bool utf8;
    size_t width; /* columns of the terminal; 0: no terminal, so any width is possible */
} wh_style_t;

typedef enum { WH_INK_PLAIN, WH_INK_GOOD, WH_INK_BAD, WH_INK_WARN, WH_INK_DIM, WH_INK_BOLD } wh_ink_t;

/* The style for a stream: colour by wh_style_wants_colour with NO_COLOR and TERM, UTF-8 by the locale,
 * width from the terminal. A stream without a descriptor counts as no terminal. Under mpirun each stream
 * does, because it cannot be known there, unless the environment has CLICOLOR_FORCE, not empty and not
 * 0. */
wh_style_t wh_style_of(FILE *out);

/* True on a terminal, unless NO_COLOR is set and not empty or TERM is unset, empty or "dumb". Either string
 * may be null. */
bool wh_style_wants_colour(bool terminal, const char *no_color, const char *term);

/* The escape sequence that switches an ink on, or null for plain or without colour. */
const char *wh_style_ink(const wh_style_t *style, wh_ink_t ink);

/* Prints formatted text in an ink. The text is printed unchanged: see wh_style_printable. */
__attribute__((format(printf, 4, 5))) void wh_style_print(const wh_style_t *style, FILE *out, wh_ink_t ink,
                                                          const char *format, ...);

/* Characters of the style: in UTF-8, or their replacements in ASCII. */
typedef enum { WH_GLYPH_TICK, WH_GLYPH_CROSS, WH_GLYPH_ARROW, WH_GLYPH_DEGREE } wh_glyph_t;
const char *wh_style_glyph(const wh_style_t *style, wh_glyph_t glyph);

/* A copy in which every byte that the locale cannot print, including line ends and escapes, appears as
 * \xNN. So a name or a message can neither break a table nor control a terminal. The caller frees it. It
 * ends the program if out of memory. */
char *wh_style_printable(const char *text);

/* Prints a text in this form. */
void wh_style_put(FILE *out, const char *text);

/* The number of columns that a text from wh_style_printable takes on a terminal. */
size_t wh_style_columns(const char *printable);

#endif
