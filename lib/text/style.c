#include "style.h"

#include <langinfo.h>
#include <limits.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>
#include <wchar.h>
#include <wctype.h>

#include "array.h"

bool wh_style_wants_colour(bool terminal, const char *no_color, const char *term) {
    const bool refused = no_color && no_color[0] != '\0';
    const bool able = term && term[0] != '\0' && strcmp(term, "dumb") != 0;
    return terminal && able && !refused;
}

/* Open MPI's mpirun gives the first rank a pseudo-terminal, even if its own output goes into a file. */
static bool is_asked_for_under_mpirun(void) {
    const char *forced = getenv("CLICOLOR_FORCE");
    return !getenv("OMPI_COMM_WORLD_SIZE") || (forced && forced[0] != '\0' && strcmp(forced, "0") != 0);
}

wh_style_t wh_style_of(FILE *out) {
    const int descriptor = fileno(out);
    const bool terminal = descriptor >= 0 && isatty(descriptor) == 1 && is_asked_for_under_mpirun();
    struct winsize size;
    wh_style_t style;
    style.colour = wh_style_wants_colour(terminal, getenv("NO_COLOR"), getenv("TERM"));
    style.utf8 = strcmp(nl_langinfo(CODESET), "UTF-8") == 0;
    style.width = terminal && ioctl(descriptor, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
    return style;
}

const char *wh_style_ink(const wh_style_t *style, wh_ink_t ink) {
    static const char *const sequences[] = {
        [WH_INK_PLAIN] = NULL,      [WH_INK_GOOD] = "\033[32m", [WH_INK_BAD] = "\033[31m",
        [WH_INK_WARN] = "\033[33m", [WH_INK_DIM] = "\033[2m",   [WH_INK_BOLD] = "\033[1m",
    };
    return style->colour ? sequences[ink] : NULL;
}

void wh_style_print(const wh_style_t *style, FILE *out, wh_ink_t ink, const char *format, ...) {
    const char *on = wh_style_ink(style, ink);
    va_list arguments;
    fputs(on ? on : "", out);
    va_start(arguments, format);
    vfprintf(out, format, arguments);
    va_end(arguments);
    fputs(on ? "\033[0m" : "", out);
}

const char *wh_style_glyph(const wh_style_t *style, wh_glyph_t glyph) {
    static const char *const glyphs[][2] = {[WH_GLYPH_TICK] = {"ok", "✓"},
                                            [WH_GLYPH_CROSS] = {"x", "✗"},
                                            [WH_GLYPH_ARROW] = {"->", "→"},
                                            [WH_GLYPH_DEGREE] = {" deg", "°"}};
    return glyphs[glyph][style->utf8 ? 1 : 0];
}

/* The number of bytes of the printable character at `text`; 0 if there is none. */
static size_t printable_bytes(const char *text) {
    wchar_t character;
    mbstate_t state;
    memset(&state, 0, sizeof state);
    const size_t bytes = mbrtowc(&character, text, strnlen(text, MB_LEN_MAX), &state);
    const bool decoded = bytes != (size_t)-1 && bytes != (size_t)-2 && bytes != 0;
    return decoded && iswprint((wint_t)character) ? bytes : 0;
}

char *wh_style_printable(const char *text) {
    char *copy = wh_memory_need(malloc(4 * strlen(text) + 1));
    char *to = copy;
    while (*text != '\0') {
        const size_t bytes = printable_bytes(text);
        if (bytes == 0) {
            to += sprintf(to, "\\x%02x", (unsigned)(unsigned char)*text++);
        } else {
            memcpy(to, text, bytes);
            to += bytes;
            text += bytes;
        }
    }
    *to = '\0';
    return copy;
}

void wh_style_put(FILE *out, const char *text) {
    char *printable = wh_style_printable(text);
    fputs(printable, out);
    free(printable);
}

size_t wh_style_columns(const char *printable) {
    size_t columns = 0;
    mbstate_t state;
    memset(&state, 0, sizeof state);
    while (*printable != '\0') {
        wchar_t character;
        const size_t bytes = mbrtowc(&character, printable, strnlen(printable, MB_LEN_MAX), &state);
        if (bytes == 0 || bytes == (size_t)-1 || bytes == (size_t)-2) {
            return columns + strlen(printable);
        }
        const int width = wcwidth(character);
        columns += width > 0 ? (size_t)width : 0;
        printable += bytes;
    }
    return columns;
}
