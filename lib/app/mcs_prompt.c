#include "mcs_prompt.h"

#include <stdlib.h>

#include "../text/json.h"
#include "../text/utf8.h"
#include "prompt/input.h"
#include "prompt/prompt.h"

/* --------------------------------------------------------------------------------------- told to the page */

/* The longest text of a list; what asked has the whole answer. */
#define SHOWN_BYTES 2000

/* Shows a line that was said, as at a port. */
static void show_line(const wh_mcs_prompt_t *prompt, int kind, const char *who, const char *text) {
    char shown[SHOWN_BYTES];
    wh_utf8_clip(shown, sizeof shown, text);
    wh_news_t *news = wh_news_make(WH_NEWS_FRAME, wh_session_time_us(&prompt->session), shown, who);
    news->line = kind;
    wh_live_tell(prompt->live, news);
}

/* Tells the page that has asked; it takes the object over. */
static void answer_page(const wh_mcs_prompt_t *prompt, json_t *told) {
    char *text = json_dumps(told, JSON_COMPACT);
    json_decref(told);
    if (text) {
        wh_live_tell(prompt->live, wh_news_make(WH_NEWS_ANSWER, 0, text, NULL));
    }
    free(text);
}

static const char *asker(const wh_mcs_prompt_t *prompt, int64_t request) {
    return wh_live_has_asked(prompt->live, request) ? "page" : "request";
}

static void hear_request(void *user, int64_t request, const char *line) {
    const wh_mcs_prompt_t *prompt = user;
    show_line(prompt, '>', asker(prompt, request), line);
}

static void hear_answer(void *user, const waferhand_mcs *message) {
    const wh_mcs_prompt_t *prompt = user;
    show_line(prompt, '<', asker(prompt, message->request), message->text);
    if (wh_live_has_asked(prompt->live, message->request)) {
        answer_page(prompt,
                    wh_json_set(json_object(), "id %lld ok %i line %s text %s", (long long)message->request,
                                message->error == 0, message->command, message->text));
    }
}

/* A line of standard input; requests are heard above. */
static void hear_typed(void *user, const char *line, wh_status_t status, const char *answer) {
    const wh_mcs_prompt_t *prompt = user;
    (void)status;
    if (prompt->link->control.requests.executing.seq == 0) {
        show_line(prompt, answer ? '<' : '>', "prompt", answer ? answer : line);
    }
}

static json_t *candidate(const void *subject, size_t i) {
    const wh_candidates_t *candidates = subject;
    return wh_json_text(candidates->texts[i]);
}

/* While a command is executed there are none. */
static void complete(wh_mcs_prompt_t *prompt, const wh_live_line_t *line) {
    static wh_candidates_t candidates;
    wh_session_complete(&prompt->session, line->text, &candidates);
    json_t *told =
        wh_json_set(json_object(), "id %lld ok %i line %s", (long long)line->number, true, line->text);
    wh_json_put(told, "kept", json_stringn(line->text, candidates.start));
    wh_json_put(told, "candidates", wh_json_list(candidate, &candidates, candidates.count));
    answer_page(prompt, told);
}

/* ---------------------------------------------------------------------------------------------- attending */

/* Hands the page's lines on. Between commands and within them: none is executed here. */
static void hand_on(wh_mcs_prompt_t *prompt) {
    wh_live_line_t line;
    while (wh_live_take_line(prompt->live, &line)) {
        if (line.completes) {
            complete(prompt, &line);
        } else {
            wh_mcs_process_ask(&prompt->link->control, line.number, line.text);
        }
    }
}

/* A signal ends a pause, so that it can end the command. */
static void attend_slices(void *user) {
    wh_mcs_prompt_t *prompt = user;
    wh_mcs_process_idle(&prompt->link->control);
    hand_on(prompt);
    if (wh_interrupt_is_due()) {
        wh_live_go_on(prompt->live);
    }
}

static void wait_for_simulator(void *user) {
    wh_mcs_prompt_t *prompt = user;
    wh_live_rest(prompt->live);
    hand_on(prompt);
}

static void attend(void *user) {
    static char answer[WH_SESSION_ANSWER_BYTES];
    wh_mcs_prompt_t *prompt = user;
    wh_mcs_process_t *control = &prompt->link->control;
    char line[WH_LINK_LINE];
    wh_mcs_process_idle(control);
    hand_on(prompt);
    while (!wh_interrupt_is_due() && wh_mcs_process_next_request(control, line)) {
        const wh_status_t status = wh_session_execute(&prompt->session, line, answer, sizeof answer);
        wh_mcs_process_answer(control, status, answer);
    }
}

static void stop_waiting(void *user) {
    const wh_mcs_prompt_t *prompt = user;
    wh_mcs_process_stop_waiting(&prompt->link->control);
}

static void say(void *user, const char *line) {
    wh_prompt_say(user, line);
}

/* ------------------------------------------------------------------------------------ opening and running */

bool wh_mcs_prompt_open(wh_mcs_prompt_t *prompt, wh_session_options_t *wanted) {
    wh_mcs_process_t *control = &prompt->link->control;
    if (prompt->live) {
        control->owner = (wh_mcs_process_owner_t){
            .waits = wait_for_simulator, .asked = hear_request, .answered = hear_answer, .user = prompt};
        wh_live_set_attendant(prompt->live, attend_slices, prompt);
        wanted->report = hear_typed;
        wanted->report_user = prompt;
    }
    wanted->partners = wh_mcs_process_partners(control);
    wanted->listener = wh_live_listener(prompt->live, &wanted->listener);
    return wh_session_open(&prompt->session, wanted);
}

int wh_mcs_prompt_run(wh_mcs_prompt_t *prompt) {
    wh_mcs_link_t *link = prompt->link;
    const wh_prompt_watch_t watch = {wh_node_descriptor(&link->node), wh_live_descriptor(prompt->live),
                                     attend, stop_waiting, prompt};
    wh_prompt_t *lines = wh_prompt_open(&prompt->session, &watch);
    link->control.last_beat_us = wh_node_clock_us(); /* piped input is executed before the first beat */
    link->node.listener = say;
    link->node.listener_user = lines;
    const int status = wh_prompt_run(lines);
    link->node.listener = NULL;
    wh_prompt_close(lines);
    return status;
}
