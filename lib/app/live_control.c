#include "live_control.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <sys/random.h>

#include "../mcs/session.h"
#include "../text/array.h"
#include "../text/clock.h"
#include "../text/json.h"

/* Looks again this often while a run is paused, us. */
#define PAUSED_US 2000

#define LEAST_RATE 0.001
#define MOST_RATE 1000.0
#define MOST_SLICES 1000000

/* Numbers of requests are drawn, because other testers count theirs from 1 on, and other operators draw
 * theirs; a page's number is a double. */
#define TESTERS_BASE 1000000000LL
#define OPERATORS_BASE (1LL << 52)

#define EXPECTED "expected token and one of pause, slices, command, rate, line, complete, hold, continue"

enum { OK = 200, ACCEPTED = 202, BAD = 400, FORBIDDEN = 403, UNAVAILABLE = 503 };

/* ------------------------------------------------------------------------------------ the stepping thread */

/* Waits while it is paused and no slice may pass. */
static void hold(wh_live_control_t *control, void (*idle)(void *user), void *user) {
    const struct timespec a_while = {0, PAUSED_US * 1000L};
    bool may_pass = false;
    idle(user);
    __atomic_store_n(&control->stands, true, __ATOMIC_RELEASE);
    while (!may_pass && __atomic_load_n(&control->is_paused, __ATOMIC_ACQUIRE)) {
        may_pass = __atomic_load_n(&control->slices, __ATOMIC_ACQUIRE) > 0;
        if (may_pass) {
            (void)__atomic_sub_fetch(&control->slices, 1, __ATOMIC_ACQ_REL);
        } else {
            (void)clock_nanosleep(CLOCK_MONOTONIC, 0, &a_while, NULL);
            idle(user);
        }
    }
    __atomic_store_n(&control->stands, false, __ATOMIC_RELEASE);
}

void wh_live_control_slice(wh_live_control_t *control, wh_live_pace_t *pace, int64_t run_us,
                           void (*idle)(void *user), void *user) {
    if (__atomic_load_n(&control->is_paused, __ATOMIC_RELAXED)) {
        hold(control, idle, user);
        wh_live_pace_begin(pace);
        return;
    }
    wh_live_pace_wait(pace, (double)__atomic_load_n(&control->rate_ppm, __ATOMIC_RELAXED) / 1e6, run_us);
}

void wh_live_control_command(wh_live_control_t *control, void (*idle)(void *user), void *user) {
    if (__atomic_exchange_n(&control->ends_at_command, false, __ATOMIC_ACQ_REL)) {
        __atomic_store_n(&control->is_paused, true, __ATOMIC_RELEASE);
        hold(control, idle, user);
    }
}

void wh_live_control_go_on(wh_live_control_t *control) {
    __atomic_store_n(&control->ends_at_command, false, __ATOMIC_RELEASE);
    __atomic_store_n(&control->slices, 0, __ATOMIC_RELEASE);
    __atomic_store_n(&control->is_paused, false, __ATOMIC_RELEASE);
}

/* --------------------------------------------------------------------------------------- lines for others */

/* The answer comes later, with this number. */
static unsigned accept(const wh_live_control_t *control, char **answer) {
    char told[64];
    (void)snprintf(told, sizeof told, "{\"ok\":true,\"id\":%lld}", (long long)control->requests);
    *answer = wh_text_copy(told);
    return ACCEPTED;
}

/* Hands { id, line } or { id, rate } on; the answer comes as a frame with this id. */
static unsigned ask_tester(wh_live_control_t *control, const char *key, json_t *value, char **answer) {
    json_t *request = json_object();
    char line[WH_LIVE_LINE_BYTES * 6 + 200];
    wh_json_put(request, "id", json_integer(++control->requests));
    wh_json_put(request, key, json_incref(value));
    char *text = json_dumps(request, JSON_COMPACT);
    json_decref(request);
    const int length = snprintf(line, sizeof line, "%s\n", text ? text : "");
    free(text);
    if (length < 2 || (size_t)length >= sizeof line || !wh_live_tester_send(&control->tester, line)) {
        *answer = wh_text_copy("{\"ok\":false,\"text\":\"the tester's port does not answer\"}");
        return UNAVAILABLE;
    }
    return accept(control, answer);
}

/* ----------------------------------------------------------------------------------------------- requests */

/* Takes as long for any token. */
static bool is_token(const wh_live_control_t *control, const json_t *given) {
    char text[WH_LIVE_TOKEN + 1] = "";
    unsigned differs = 0;
    if (json_is_string(given)) {
        (void)snprintf(text, sizeof text, "%s", json_string_value(given));
        differs |= json_string_length(given) != WH_LIVE_TOKEN ? 1U : 0U;
    }
    for (size_t i = 0; i < WH_LIVE_TOKEN; ++i) {
        differs |= (unsigned char)text[i] ^ (unsigned char)control->token[i];
    }
    return differs == 0;
}

static unsigned refuse(unsigned status, const char *text, char **answer) {
    char *made = wh_array_new(strlen(text) + 40, 1);
    (void)snprintf(made, strlen(text) + 40, "{\"ok\":false,\"text\":\"%s\"}", text);
    *answer = made;
    return status;
}

static unsigned done(char **answer) {
    *answer = wh_text_copy("{\"ok\":true}");
    return OK;
}

static unsigned set_rate(wh_live_control_t *control, json_t *given, char **answer) {
    const double rate = json_number_value(given);
    if (!json_is_number(given) || !(rate <= MOST_RATE) || !(rate >= LEAST_RATE || rate == 0)) {
        return refuse(BAD, "rate: expected a number from 0.001 to 1000, or 0", answer);
    }
    if (control->controlled == WH_LIVE_TESTER) {
        return ask_tester(control, "rate", given, answer);
    }
    if (!control->paces) {
        return refuse(BAD, "rate: motion control runs free (expected mcs without --rate)", answer);
    }
    __atomic_store_n(&control->rate_ppm, (int64_t)(rate * 1e6), __ATOMIC_RELAXED);
    return done(answer);
}

/* A STOP ends a pause, so that what stands still can end. */
static unsigned ask_operator(wh_live_control_t *control, const char *line, bool completes, char **answer) {
    if (!wh_live_lines_put(&control->lines, control->requests + 1, completes, line)) {
        return refuse(UNAVAILABLE, "too many lines wait (expected fewer than 16)", answer);
    }
    ++control->requests;
    if (!completes && wh_session_says(line, "STOP")) {
        wh_live_control_go_on(control);
    }
    return accept(control, answer);
}

static unsigned take_line(wh_live_control_t *control, json_t *given, bool completes, char **answer) {
    const char *line = json_string_value(given);
    if (control->controlled == WH_LIVE_RUN) {
        return refuse(BAD, "line: a script commands this run (expected serve, or mcs --layout)", answer);
    }
    if (!line || json_string_length(given) > WH_LIVE_LINE_BYTES || line[strcspn(line, "\r\n")] != '\0') {
        return refuse(BAD, "line: expected one line of at most 1000 bytes", answer);
    }
    if (control->controlled == WH_LIVE_PROMPT) {
        return ask_operator(control, line, completes, answer);
    }
    return completes
               ? refuse(BAD, "complete: a tester's lines are not completed (expected mcs --layout)", answer)
               : ask_tester(control, "line", given, answer);
}

static unsigned refuse_pause(const wh_live_control_t *control, char **answer) {
    return control->controlled == WH_LIVE_TESTER
               ? refuse(BAD, "pause: hosts wait for their answers (expected run --page-control)", answer)
               : refuse(BAD, "pause: motion control runs free (expected mcs without --rate)", answer);
}

/* Pauses, and the ways on from there. */
static unsigned take_pause(wh_live_control_t *control, const json_t *request, char **answer) {
    const json_t *pause = json_object_get(request, "pause");
    const json_t *slices = json_object_get(request, "slices");
    if (!control->paces) {
        return refuse_pause(control, answer);
    }
    if (slices) {
        const json_int_t count = json_integer_value(slices);
        if (!json_is_integer(slices) || count < 1 || count > MOST_SLICES) {
            return refuse(BAD, "slices: expected a whole number from 1 to 1000000", answer);
        }
        (void)__atomic_add_fetch(&control->slices, count, __ATOMIC_ACQ_REL);
        return done(answer);
    }
    if (pause && !json_is_boolean(pause)) {
        return refuse(BAD, "pause: expected true or false", answer);
    }
    const bool is_command = json_is_true(json_object_get(request, "command"));
    __atomic_store_n(&control->ends_at_command, is_command, __ATOMIC_RELEASE);
    __atomic_store_n(&control->slices, 0, __ATOMIC_RELEASE);
    __atomic_store_n(&control->is_paused, !is_command && json_is_true(pause), __ATOMIC_RELEASE);
    return done(answer);
}

/* The reason may have names in it. */
static unsigned refuse_hold(wh_status_t status, const char *reason, char **answer) {
    char text[WH_MCS_HOLD_BYTES + 100];
    (void)snprintf(text, sizeof text, "error %d %s: %s", (int)status, wh_status_name(status), reason);
    json_t *told = wh_json_set(json_object(), "ok %i text %s", false, text);
    *answer = wh_memory_need(json_dumps(told, JSON_COMPACT));
    json_decref(told);
    return BAD;
}

static unsigned hold_robot(wh_live_control_t *control, const json_t *given, bool is_held, char **answer) {
    char reason[WH_MCS_HOLD_BYTES];
    const char *name = json_is_string(given) ? json_string_value(given) : "";
    const bool is_name = json_is_string(given) && name[0] && strlen(name) < WH_NAME_SIZE;
    if (control->controlled != WH_LIVE_RUN) {
        return refuse(BAD, "hold, continue: hosts have a HOLD of their own (expected run --page-control)",
                      answer);
    }
    if (!is_name && !json_is_true(given)) {
        return refuse(BAD, "hold, continue: expected a robot's name, or true for all of them", answer);
    }
    if (__atomic_load_n(&control->is_paused, __ATOMIC_ACQUIRE)) {
        return refuse(BAD, "hold, continue: the run is paused (expected it to go on)", answer);
    }
    const wh_status_t status = wh_live_hold_ask(&control->hold, name, is_held, reason);
    return status == WH_OK ? done(answer) : refuse_hold(status, reason, answer);
}

/* True if the request has one of these. */
static bool has_any(const json_t *request, const char *const keys[], size_t count) {
    bool has = false;
    for (size_t i = 0; i < count; ++i) {
        has = has || json_object_get(request, keys[i]);
    }
    return has;
}

static unsigned take_rest(wh_live_control_t *control, const json_t *request, char **answer) {
    static const char *const holds[] = {"hold", "continue"}, *const pauses[] = {"pause", "slices", "command"};
    const json_t *hold = json_object_get(request, "hold");
    if (has_any(request, holds, 2)) {
        return hold_robot(control, hold ? hold : json_object_get(request, "continue"), hold != NULL, answer);
    }
    return has_any(request, pauses, 3) ? take_pause(control, request, answer) : refuse(BAD, EXPECTED, answer);
}

static unsigned take(wh_live_control_t *control, const json_t *request, char **answer) {
    json_t *rate = json_object_get(request, "rate");
    json_t *line = json_object_get(request, "line");
    json_t *complete = json_object_get(request, "complete");
    if (!is_token(control, json_object_get(request, "token"))) {
        return refuse(FORBIDDEN, "the token is wrong (expected the one that the program has printed)",
                      answer);
    }
    if (json_object_size(request) != 2) {
        return refuse(BAD, EXPECTED, answer);
    }
    if (line || complete) {
        return take_line(control, line ? line : complete, complete, answer);
    }
    if (rate) {
        return set_rate(control, rate, answer);
    }
    return take_rest(control, request, answer);
}

unsigned wh_live_control_take(wh_live_control_t *control, const char *body, size_t size, char **answer) {
    json_error_t error;
    json_t *request = json_loadb(body, size, JSON_REJECT_DUPLICATES, &error);
    const unsigned status = json_is_object(request) ? take(control, request, answer)
                                                    : refuse(BAD, "expected a JSON object", answer);
    json_decref(request);
    return status;
}

/* ------------------------------------------------------------------------------------------------ opening */

/* The token has bytes of its own: numbers of requests are no secret. */
typedef struct {
    unsigned char token[WH_LIVE_TOKEN / 2];
    uint32_t base;
} drawn_t;

bool wh_live_control_begin(wh_live_control_t *control, wh_live_controlled_t controlled, bool paces,
                           double rate) {
    drawn_t drawn;
    control->controlled = controlled;
    control->paces = paces && controlled != WH_LIVE_TESTER;
    control->rate_ppm = (int64_t)(rate * 1e6);
    if (!wh_live_lines_open(&control->lines) || getrandom(&drawn, sizeof drawn, 0) != (ssize_t)sizeof drawn) {
        return false;
    }
    for (size_t i = 0; i < sizeof drawn.token; ++i) {
        (void)snprintf(control->token + 2 * i, 3, "%02x", drawn.token[i]);
    }
    control->base = controlled == WH_LIVE_TESTER ? TESTERS_BASE + 1000LL * (drawn.base & 0xffffU)
                                                 : OPERATORS_BASE + 65536LL * drawn.base;
    control->requests = control->base;
    return true;
}

void wh_live_control_end(wh_live_control_t *control) {
    wh_live_tester_leave(&control->tester);
    wh_live_lines_close(&control->lines);
}
