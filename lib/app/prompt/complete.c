/* Completes the word before the cursor. */
#include "complete.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../text/style.h"
#include "../../text/utf8.h"

static size_t common_length(const wh_candidates_t *candidates) {
    size_t length = strlen(candidates->texts[0]);
    for (size_t i = 1; i < candidates->count; ++i) {
        size_t same = 0;
        while (same < length && candidates->texts[0][same] == candidates->texts[i][same]) {
            ++same;
        }
        length = same;
    }
    return wh_utf8_cut(candidates->texts[0], length);
}

static size_t characters_in(const char *text) {
    const size_t count = mbstowcs(NULL, text, 0);
    return count == (size_t)-1 ? strlen(text) : count;
}

/* Candidates in columns below the line. */
static void list_candidates(const wh_candidates_t *candidates) {
    const wh_style_t style = wh_style_of(stdout);
    size_t column = 0;
    size_t widest = 0;
    for (size_t i = 0; i < candidates->count; ++i) {
        const size_t width = strlen(candidates->texts[i]) + 2;
        widest = width > widest ? width : widest;
    }
    putchar('\n');
    for (size_t i = 0; i < candidates->count; ++i) {
        char *text = wh_style_printable(candidates->texts[i]);
        column += widest;
        const bool last = column + widest > style.width || i + 1 == candidates->count;
        printf("%-*s%s", last ? 0 : (int)widest, text ? text : "", last ? "\n" : "");
        column = last ? 0 : column;
        free(text);
    }
    fflush(stdout);
}

/* The word's text becomes `length` bytes of the first candidate, and a blank when it is the only one. */
static void replace_word(EditLine *edit, const char *word, const wh_candidates_t *candidates, size_t length) {
    char text[WH_NAME_SIZE * 2 + 100];
    const char *first = candidates->texts[0];
    const bool finished = candidates->count == 1 && length > 0 && first[length - 1] != '=';
    snprintf(text, sizeof text, "%.*s%s", (int)length, first, finished ? " " : "");
    el_deletestr(edit, (int)characters_in(word));
    el_insertstr(edit, text);
}

unsigned char wh_prompt_complete(EditLine *edit, wh_session_t *session) {
    wh_candidates_t candidates;
    const LineInfo *line = el_line(edit);
    char *before = strndup(line->buffer, (size_t)(line->cursor - line->buffer));
    unsigned char result = CC_ERROR;
    if (!before) {
        return CC_ERROR;
    }
    wh_session_complete(session, before, &candidates);
    if (candidates.count > 0) {
        const char *word = before + candidates.start;
        const size_t length = common_length(&candidates);
        if (candidates.count == 1 || length > strlen(word)) {
            replace_word(edit, word, &candidates, length);
            result = CC_REFRESH;
        } else {
            list_candidates(&candidates);
            result = CC_REDISPLAY;
        }
    }
    free(before);
    return result;
}
