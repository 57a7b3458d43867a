/* The two formats of STL: words, or 50 bytes a facet after 84 of head. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "stl_internal.h"

enum { HEAD = 80, COUNT = 4, FACET = 50, NORMAL = 12, WORD = 64 };

/* Takes over one corner, whose place in the file `where` tells for the message. */
static bool take_corner(wh_stl_t *stl, const double xyz[3], size_t corner, const char *where) {
    double scaled[3];
    for (size_t i = 0; i < 3; ++i) {
        scaled[i] = xyz[i] * stl->mm_per_unit;
        if (!(scaled[i] >= -WH_CONVEX_LARGEST && scaled[i] <= WH_CONVEX_LARGEST)) {
            return wh_stl_refuse(stl, "%s: a coordinate of %g times %g mm (expected -%g to %g mm)", where,
                                 xyz[i], stl->mm_per_unit, WH_CONVEX_LARGEST, WH_CONVEX_LARGEST);
        }
    }
    stl->corners[3 * stl->facets + corner] = wh_vec3(scaled[0], scaled[1], scaled[2]);
    return true;
}

static bool too_many(wh_stl_t *stl) {
    return wh_stl_refuse(stl, ": more than %d facets", WH_STL_FACETS);
}

/* ---------------------------------------------------------------------------------------------------- binary */

static uint32_t little_endian(const char *bytes) {
    uint32_t value = 0;
    for (size_t i = 4; i-- > 0;) {
        value = value << 8 | (unsigned char)bytes[i];
    }
    return value;
}

static double single(const char *bytes) {
    const uint32_t bits = little_endian(bytes);
    float value;
    memcpy(&value, &bits, sizeof value);
    return (double)value;
}

static bool read_binary(wh_stl_t *stl) {
    const uint32_t count = little_endian(stl->begin + HEAD);
    for (stl->at = stl->begin + HEAD + COUNT; stl->facets < count; ++stl->facets, stl->at += FACET) {
        for (size_t corner = 0; corner < 3; ++corner) {
            const char *bytes = stl->at + NORMAL + 12 * corner;
            const double xyz[3] = {single(bytes), single(bytes + 4), single(bytes + 8)};
            char where[WORD];
            (void)snprintf(where, sizeof where, ": byte %zu", (size_t)(bytes - stl->begin));
            if (!take_corner(stl, xyz, corner, where)) {
                return false;
            }
        }
    }
    return true;
}

/* ----------------------------------------------------------------------------------------------------- ASCII */

static bool is_space(char c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}

/* The next word, cut when it is long, made printable; empty at the end. Its line is stl->line. */
static void next_word(wh_stl_t *stl, char word[WORD]) {
    for (; stl->at < stl->end && is_space(*stl->at); ++stl->at) {
        stl->line += *stl->at == '\n';
    }
    size_t length = 0;
    for (; stl->at < stl->end && !is_space(*stl->at); ++stl->at) {
        if (length < WORD - 1) {
            word[length++] = *stl->at;
            if (*stl->at < ' ' || *stl->at > '~') {
                word[length - 1] = '?';
            }
        }
    }
    word[length] = '\0';
}

static void skip_line(wh_stl_t *stl) {
    while (stl->at < stl->end && *stl->at != '\n') {
        ++stl->at;
    }
}

static bool refuse_word(wh_stl_t *stl, const char *word, const char *expected) {
    if (word[0] == '\0') {
        return wh_stl_refuse(stl, ":%u: the file ends (expected %s)", stl->line, expected);
    }
    return wh_stl_refuse(stl, ":%u: \"%s\" (expected %s)", stl->line, word, expected);
}

static bool expect(wh_stl_t *stl, const char *keyword) {
    char word[WORD];
    next_word(stl, word);
    return strcasecmp(word, keyword) == 0 || refuse_word(stl, word, keyword);
}

static bool read_number(wh_stl_t *stl, double *number) {
    char word[WORD];
    next_word(stl, word);
    char *behind = word;
    *number = strtod(word, &behind);
    return (behind != word && *behind == '\0' && *number - *number == 0) ||
           refuse_word(stl, word, "a number");
}

static bool read_vertex(wh_stl_t *stl, size_t corner) {
    double xyz[3];
    if (!expect(stl, "vertex")) {
        return false;
    }
    for (size_t i = 0; i < 3; ++i) {
        if (!read_number(stl, &xyz[i])) {
            return false;
        }
    }
    char where[WORD];
    (void)snprintf(where, sizeof where, ":%u", stl->line);
    return take_corner(stl, xyz, corner, where);
}

/* What follows the word `facet`. The normal may be anything: some programs write none. */
static bool read_facet(wh_stl_t *stl) {
    char ignored[WORD];
    if (!expect(stl, "normal")) {
        return false;
    }
    for (size_t i = 0; i < 3; ++i) {
        next_word(stl, ignored);
    }
    if (!expect(stl, "outer") || !expect(stl, "loop")) {
        return false;
    }
    for (size_t corner = 0; corner < 3; ++corner) {
        if (!read_vertex(stl, corner)) {
            return false;
        }
    }
    return expect(stl, "endloop") && expect(stl, "endfacet");
}

static bool read_text(wh_stl_t *stl) {
    char word[WORD];
    stl->line = 1;
    next_word(stl, word);
    skip_line(stl);
    for (next_word(stl, word); strcasecmp(word, "facet") == 0; next_word(stl, word)) {
        if (stl->facets == WH_STL_FACETS) {
            return too_many(stl);
        }
        if (!read_facet(stl)) {
            return false;
        }
        ++stl->facets;
    }
    if (strcasecmp(word, "endsolid") != 0) {
        return refuse_word(stl, word, "facet or endsolid");
    }
    skip_line(stl);
    next_word(stl, word);
    return word[0] == '\0' || refuse_word(stl, word, "the end of the file: one solid");
}

/* Binary files may begin with `solid` as well, but only they have the length that their count asks for. */
bool wh_stl_read_facets(wh_stl_t *stl) {
    const size_t length = (size_t)(stl->end - stl->begin);
    if (length >= HEAD + COUNT) {
        const uint32_t count = little_endian(stl->begin + HEAD);
        if (length == HEAD + COUNT + FACET * (size_t)count) {
            return count <= WH_STL_FACETS ? read_binary(stl) : too_many(stl);
        }
    }
    char word[WORD];
    next_word(stl, word);
    stl->at = stl->begin;
    if (strcasecmp(word, "solid") == 0) {
        return read_text(stl);
    }
    return wh_stl_refuse(
        stl,
        ": %zu bytes (expected the word solid, or 80 bytes, a count of facets, and 50 bytes for "
        "each)",
        length);
}
