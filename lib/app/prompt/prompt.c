#include "prompt.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../../text/array.h"
#include "../../text/style.h"
#include "../app.h"
#include "answer.h"
#include "editor.h"

/* Lines from a pipe or a file: bytes, whatever they are. */
typedef struct {
    char buffer[4096];
    size_t begin, end;
    char line[WH_SESSION_LINE_BYTES + 2]; /* one more than a session takes, so that it refuses longer lines */
} plain_t;

struct wh_prompt {
    wh_input_t input;
    wh_editor_t *editor; /* null: plain */
    plain_t plain;
    wh_style_t style;
    bool failed;  /* a command did */
    bool leaving; /* a signal ended a command, and the prompt with it */
    char answer[WH_SESSION_ANSWER_BYTES];
};

void wh_prompt_say(wh_prompt_t *prompt, const char *line) {
    if (prompt->editor) {
        wh_editor_say(prompt->editor, line);
    } else {
        fprintf(stderr, "%s\n", line);
    }
}

/* Faults and errors on purpose that nobody met in a run. */
static void say_untried(void *user, const char *list) {
    const size_t size = strlen(list) + 100;
    char *text = wh_array_new(size, 1);
    (void)snprintf(text, size, "mcs: never came, and so were not tried: %s", list);
    wh_prompt_say(user, text);
    free(text);
}

wh_prompt_t *wh_prompt_open(wh_session_t *session, const wh_prompt_watch_t *watch) {
    wh_prompt_t *prompt = wh_array_new(1, sizeof *prompt);
    const bool terminal = isatty(STDIN_FILENO) && isatty(STDOUT_FILENO);
    prompt->input.session = session;
    prompt->input.watch = *watch;
    prompt->style = wh_style_of(stdout);
    wh_interrupt_hold(terminal);
    prompt->editor = terminal ? wh_editor_open(&prompt->input) : NULL;
    wh_session_tell_untried(session, say_untried, prompt);
    return prompt;
}

void wh_prompt_close(wh_prompt_t *prompt) {
    if (prompt) {
        wh_editor_close(prompt->editor);
        wh_interrupt_release();
        wh_session_tell_untried(prompt->input.session, NULL, NULL);
        free(prompt);
    }
}

/* -------------------------------------------------------------------------------------------- plain lines */

/* WH_LINE_NONE if there was nothing to read. */
static wh_line_event_t read_bytes(plain_t *plain) {
    const ssize_t bytes = read(STDIN_FILENO, plain->buffer, sizeof plain->buffer);
    plain->begin = 0;
    plain->end = bytes > 0 ? (size_t)bytes : 0;
    if (bytes > 0) {
        return WH_LINE_READ;
    }
    return bytes < 0 && (errno == EINTR || errno == EAGAIN) ? WH_LINE_NONE : WH_LINE_END;
}

/* Fills the empty buffer. */
static wh_line_event_t fill(plain_t *plain, const wh_input_t *input) {
    wh_line_event_t line = WH_LINE_NONE;
    while (line == WH_LINE_NONE) {
        const wh_input_event_t event = wh_input_wait(input);
        if (event == WH_INPUT_SIGNAL && wh_interrupt_take() != 0) {
            line = WH_LINE_LEAVING;
        } else if (event == WH_INPUT_BROKEN) {
            line = WH_LINE_END;
        } else if (event == WH_INPUT_READY) {
            line = read_bytes(plain);
        }
    }
    return line;
}

static wh_line_event_t finish(plain_t *plain, size_t length) {
    if (length > 0 && length <= WH_SESSION_LINE_BYTES && plain->line[length - 1] == '\r') {
        --length;
    }
    plain->line[length] = '\0';
    return WH_LINE_READ;
}

/* The next line, in plain->line: without its end, cut if it is too long, a byte 0 replaced by 1, which is
 * refused too. */
static wh_line_event_t read_plain(plain_t *plain, const wh_input_t *input) {
    size_t length = 0;
    for (bool any = false;; any = true) {
        if (plain->begin == plain->end) {
            const wh_line_event_t event = fill(plain, input);
            if (event != WH_LINE_READ) {
                return event == WH_LINE_END && any ? finish(plain, length) : event;
            }
        }
        const char byte = plain->buffer[plain->begin++];
        if (byte == '\n') {
            return finish(plain, length);
        }
        if (length <= WH_SESSION_LINE_BYTES) {
            plain->line[length++] = byte != '\0' ? byte : '\1';
        }
    }
}

/* ----------------------------------------------------------------------------------------------- the loop */

static wh_line_event_t read_line(wh_prompt_t *prompt, const char **line) {
    if (prompt->editor) {
        return wh_editor_read(prompt->editor, line);
    }
    *line = prompt->plain.line;
    return read_plain(&prompt->plain, &prompt->input);
}

static void print_answer(wh_prompt_t *prompt, wh_status_t status) {
    if (!prompt->editor) {
        puts(prompt->answer);
        return;
    }
    if (wh_answer_print_wafers(prompt->answer, &prompt->style, stdout)) {
        return;
    }
    char *printable = wh_style_printable(prompt->answer);
    /* The terminal has printed ^C: the answer begins on a new line. */
    if (status == WH_STATUS_STOPPED) {
        putchar('\n');
    }
    wh_style_print(&prompt->style, stdout, status == WH_OK ? WH_INK_PLAIN : WH_INK_BAD, "%s", printable);
    putchar('\n');
    free(printable);
}

/* True if a signal that came during the command ends the prompt. At a terminal Ctrl-C ends only the
 * command. */
static bool is_interrupted(const wh_prompt_t *prompt) {
    bool interrupted = false;
    for (int number = wh_interrupt_take(); number != 0; number = wh_interrupt_take()) {
        interrupted =
            interrupted || number == SIGTERM || number == SIGHUP || (number == SIGINT && !prompt->editor);
    }
    return interrupted;
}

/* A signal that came before the command stops it, too: it is not begun. */
static wh_status_t perform(wh_prompt_t *prompt, const char *line) {
    if (!wh_interrupt_is_due()) {
        return wh_session_execute(prompt->input.session, line, prompt->answer, sizeof prompt->answer);
    }
    wh_session_write_error(prompt->answer, sizeof prompt->answer, WH_STATUS_STOPPED,
                           wh_record_error_text(WH_STATUS_STOPPED));
    return WH_STATUS_STOPPED;
}

static void execute(wh_prompt_t *prompt, const char *line) {
    wh_interrupt_stop_session(prompt->input.session);
    const wh_status_t status = perform(prompt, line);
    wh_interrupt_stop_session(NULL);
    wh_input_tell_stop(&prompt->input);
    prompt->failed = prompt->failed || status != WH_OK;
    print_answer(prompt, status);
    prompt->leaving = is_interrupted(prompt);
}

/* True for blank lines and comments. A line of blanks that was cut does not count: its end is unknown. */
static bool says_nothing(const char *line) {
    const size_t blanks = strspn(line, " ");
    return line[blanks] == '#' || (blanks <= WH_SESSION_LINE_BYTES && line[blanks] == '\0');
}

/* True if the prompt goes on after this line. */
static bool take_line(wh_prompt_t *prompt, const char *line) {
    if (wh_session_says(line, "QUIT")) {
        if (!prompt->editor) {
            puts("OK");
        }
        return false;
    }
    if (!says_nothing(line)) {
        execute(prompt, line);
    }
    return fflush(stdout) == 0 && !prompt->leaving;
}

/* Reads and executes lines. Returns WH_LINE_END or WH_LINE_LEAVING. */
static wh_line_event_t take_lines(wh_prompt_t *prompt) {
    const char *line = NULL;
    wh_line_event_t event = WH_LINE_NONE;
    while (event != WH_LINE_END && event != WH_LINE_LEAVING) {
        event = read_line(prompt, &line);
        if (event == WH_LINE_READ && !take_line(prompt, line)) {
            event = WH_LINE_END;
        }
    }
    return event;
}

/* The arm is still in a station, after a command that was not ended. */
static void judge_held(wh_prompt_t *prompt) {
    const wh_mcs_held_t *held = wh_mcs_find_held(&prompt->input.session->mcs, WH_NONE);
    if (held) {
        char text[WH_MCS_HELD_BYTES + 100];
        (void)snprintf(text, sizeof text, "mcs: %s is left held, %s: no CONTINUE or STOP came", held->command,
                       held->phase);
        wh_prompt_say(prompt, text);
        prompt->failed = true;
    }
}

static void tell_never_came(wh_prompt_t *prompt) {
    char *list = wh_mcs_tell_never_came(&prompt->input.session->mcs);
    if (list) {
        say_untried(prompt, list);
        free(list);
    }
}

int wh_prompt_run(wh_prompt_t *prompt) {
    const wh_line_event_t event = take_lines(prompt);
    judge_held(prompt);
    tell_never_came(prompt);
    if (!wh_app_is_printed(0)) {
        return WH_EXIT_USAGE;
    }
    const wh_session_t *session = prompt->input.session;
    const bool failed = !prompt->editor && (prompt->failed || session->complaints + session->unmet > 0);
    return event == WH_LINE_LEAVING || prompt->leaving || failed ? WH_EXIT_FAILED : WH_EXIT_MET;
}
