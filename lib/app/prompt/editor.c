#include "editor.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <wchar.h>

#include <histedit.h>
#include <limits.h>

#include "../../text/array.h"
#include "../../text/guard.h"
#include "../../text/output.h"
#include "../../text/style.h"
#include "../../text/utf8.h"
#include "history.h"

#define PROMPT "mcs> "

struct wh_editor {
    const wh_input_t *input;
    EditLine *edit;
    History *history;
    char history_path[PATH_MAX];
    char *line;            /* the last one */
    bool typing;           /* the prompt is shown */
    wh_line_event_t event; /* why there is no further character */
    mbstate_t decoding;
};

static wh_editor_t *editor_of(EditLine *edit) {
    void *editor = NULL;
    el_get(edit, EL_CLIENTDATA, &editor);
    return editor;
}

static char *prompt_text(EditLine *edit) {
    static char text[] = PROMPT;
    (void)edit;
    return text;
}

/* --------------------------------------------------------------------------------------------- characters */

/* Stops the process. Until it goes on, the terminal is in the state that the shell expects. */
static void suspend(EditLine *edit) {
    el_set(edit, EL_PREP_TERM, 0);
    raise(SIGSTOP);
    el_set(edit, EL_PREP_TERM, 1);
    el_set(edit, EL_REFRESH);
}

/* True if reading goes on after the signals that have arrived. */
static bool handle_signals(wh_editor_t *editor) {
    for (int number = wh_interrupt_take(); number != 0; number = wh_interrupt_take()) {
        if (number == SIGWINCH) {
            el_resize(editor->edit);
        } else if (number == SIGTSTP) {
            suspend(editor->edit);
        } else {
            editor->event = number == SIGINT ? WH_LINE_NONE : WH_LINE_LEAVING;
            return false;
        }
    }
    return true;
}

/* Waits until a byte can be read; false when the line has come to an end instead. */
static bool wait_for_byte(wh_editor_t *editor) {
    for (;;) {
        const wh_input_event_t event = wh_input_wait(editor->input);
        if (event == WH_INPUT_READY) {
            return true;
        }
        if (event != WH_INPUT_SIGNAL) {
            editor->event = WH_LINE_END;
            return false;
        }
        if (!handle_signals(editor)) {
            return false;
        }
    }
}

/* Reads a character for libedit. Returns 1, 0 at the end of the input, or -1. Bytes that are no characters of
 * the locale are dropped. */
static int read_character(EditLine *edit, wchar_t *character) {
    wh_editor_t *editor = editor_of(edit);
    while (wait_for_byte(editor)) {
        char byte = 0;
        const ssize_t bytes = read(STDIN_FILENO, &byte, 1);
        if (bytes == 0) {
            return 0;
        }
        if (bytes < 0) {
            if (errno != EINTR && errno != EAGAIN) {
                return -1;
            }
            continue;
        }
        const size_t used = mbrtowc(character, &byte, 1, &editor->decoding);
        if (used <= 1) {
            return 1;
        }
        if (used == (size_t)-1) {
            memset(&editor->decoding, 0, sizeof editor->decoding);
        }
    }
    return -1;
}

/* ------------------------------------------------------------------------------------------------ history */

static void enter_line(void *user, const char *text) {
    HistEvent event;
    history(user, &event, H_ENTER, text);
}

static void open_history(wh_editor_t *editor) {
    HistEvent event;
    editor->history = history_init();
    if (!editor->history) {
        return;
    }
    history(editor->history, &event, H_SETSIZE, WH_HISTORY_LINES);
    history(editor->history, &event, H_SETUNIQUE, 1);
    wh_output_state_path("history", editor->history_path, sizeof editor->history_path);
    wh_history_load(editor->history_path, enter_line, editor->history);
    el_set(editor->edit, EL_HIST, history, editor->history);
}

/* Adds a line to the history, without the blanks that completion leaves at its end. */
static void remember(wh_editor_t *editor, char *line) {
    size_t length = strlen(line);
    while (length > 0 && line[length - 1] == ' ') {
        line[--length] = '\0';
    }
    if (length > 0 && editor->history) {
        enter_line(editor->history, line);
        wh_history_append(editor->history_path, line);
    }
}

/* --------------------------------------------------------------------------------------------- completion */

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

/* Prints the candidates in columns below the line. */
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
        printf("%-*s%s", last ? 0 : (int)widest, text, last ? "\n" : "");
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

/* Completes the word before the cursor as far as all candidates agree, the only one with a blank behind it;
 * where they agree no further, lists them below the line. Returns what an editor function returns to
 * libedit. */
static unsigned char complete(EditLine *edit, int key) {
    wh_candidates_t candidates;
    const LineInfo *line = el_line(edit);
    char *before = wh_memory_need(strndup(line->buffer, (size_t)(line->cursor - line->buffer)));
    unsigned char result = CC_ERROR;
    (void)key;
    wh_session_complete(editor_of(edit)->input->session, before, &candidates);
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

/* ------------------------------------------------------------------------------------------------- editor */

/* Reads ~/.editrc last, so that the user's settings win. */
static void set_up(wh_editor_t *editor) {
    el_set(editor->edit, EL_CLIENTDATA, editor);
    el_set(editor->edit, EL_SIGNAL, 0);
    el_set(editor->edit, EL_PROMPT, prompt_text);
    el_set(editor->edit, EL_EDITOR, "emacs");
    /* This is the wide function: libedit copies narrow names and never frees the copies. */
    el_wset(editor->edit, EL_ADDFN, L"wh-complete", L"completes a command or a name", complete);
    el_set(editor->edit, EL_BIND, "^I", "wh-complete", NULL);
    el_set(editor->edit, EL_BIND, "^R", "em-inc-search-prev", NULL);
    open_history(editor);
    el_source(editor->edit, NULL);
    el_set(editor->edit, EL_GETCFN, read_character);
}

wh_editor_t *wh_editor_open(const wh_input_t *input) {
    wh_editor_t *editor = wh_array_new(1, sizeof *editor);
    editor->input = input;
    editor->edit = el_init("waferhand", stdin, stdout, wh_guard_terminal());
    if (!editor->edit) {
        free(editor);
        return NULL;
    }
    set_up(editor);
    return editor;
}

wh_line_event_t wh_editor_read(wh_editor_t *editor, const char **line) {
    int length = 0;
    editor->event = WH_LINE_END;
    memset(&editor->decoding, 0, sizeof editor->decoding);
    /* libedit itself prepares the terminal after it has shown the prompt: a Ctrl-D in between would be
     * lost. */
    el_set(editor->edit, EL_PREP_TERM, 1);
    editor->typing = true;
    const char *typed = el_gets(editor->edit, &length);
    editor->typing = false;
    free(editor->line);
    editor->line = typed && length > 0 ? strndup(typed, strcspn(typed, "\n")) : NULL;
    if (!editor->line) {
        fputs(editor->event == WH_LINE_NONE ? "^C\n" : "\n", stdout);
        fflush(stdout);
        return editor->event;
    }
    remember(editor, editor->line);
    *line = editor->line;
    return WH_LINE_READ;
}

void wh_editor_say(wh_editor_t *editor, const char *line) {
    char *printable = wh_style_printable(line);
    const size_t columns = wh_style_of(stdout).width;
    if (!editor->typing || !isatty(STDERR_FILENO)) {
        fprintf(stderr, "%s\n", printable);
    } else {
        const LineInfo *typed = el_line(editor->edit);
        const size_t shown = strlen(PROMPT) + (size_t)(typed->lastchar - typed->buffer);
        const size_t length = wh_style_columns(printable);
        /* Writes blanks over the old line; a line that is longer than the terminal now stays where it is. */
        const bool fits = columns == 0 || shown < columns;
        fflush(stdout);
        fprintf(wh_guard_terminal(), "%s%s%*s\n", fits ? "\r" : "\n", printable,
                fits && shown > length ? (int)(shown - length) : 0, "");
        el_set(editor->edit, EL_REFRESH);
    }
    free(printable);
}

void wh_editor_close(wh_editor_t *editor) {
    if (!editor) {
        return;
    }
    el_end(editor->edit);
    if (editor->history) {
        history_end(editor->history);
    }
    free(editor->line);
    free(editor);
}
