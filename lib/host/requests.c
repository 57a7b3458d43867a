#include "requests.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <lauxlib.h>

#include "actions.h"
#include "conditions.h"
#include "events.h"
#include "journal.h"
#include "queue.h"
#include "status.h"
#include "telling.h"

/* ---------------------------------------------------------------------------------------------- at once */

/* A command that is held in a phase belongs to the robot. */
static bool may_give_up(const wh_controller_t *controller) {
    const bool is_robot = controller->mechanism.kind == WH_MECHANISM_ROBOT;
    const bool is_cell = controller->mechanism.kind == WH_MECHANISM_CELL && !controller->leader->is_tester;
    return wh_host_plays_jobs(controller->host) ? is_robot || is_cell : !controller->host->running;
}

static void stop_acting(const wh_controller_t *controller) {
    wh_controller_t *acting = wh_controller_acting(controller);
    wh_controller_stop_queue(controller->leader);
    if (acting && acting->action.is_running) {
        wh_controller_stop_running(acting);
    } else if (acting) {
        acting->action.is_stopped = true;
    }
}

static void answer_stop(wh_controller_t *controller, const wh_request_t *request) {
    wh_host_t *host = controller->host;
    const bool is_any = wh_controller_acting(controller);
    if (is_any && controller->leader->is_held) {
        wh_controller_release_to_stop(controller);
    }
    stop_acting(controller);
    if (!is_any && may_give_up(controller)) {
        wh_mcs_give_up(&host->session->mcs, controller->mechanism.index);
    }
    wh_controller_tell_result(controller, WH_ENCODE_ANSWER, request, WH_OK, "OK", 0);
}

static void answer_hold(wh_controller_t *controller, const wh_request_t *request, bool is_held) {
    wh_host_t *host = controller->host;
    const wh_controller_t *acting = wh_controller_acting(controller);
    if (!acting || !acting->action.is_running || controller->leader->is_held == is_held) {
        wh_controller_refuse(controller, request, WH_STATUS_NOT_IN_PHASE,
                             is_held ? "no command of this controller runs" : "no HOLD stands");
        return;
    }
    controller->leader->is_held = is_held;
    wh_mcs_hold_job(&host->session->mcs, wh_controller_job(controller), is_held);
    wh_controller_tell_result(controller, WH_ENCODE_ANSWER, request, WH_OK, "OK", 0);
    wh_controller_tell_others(controller, WH_HOST_HOLD, is_held ? 1 : 0);
}

static void execute_query(wh_controller_t *controller, const wh_request_t *request, const char *line) {
    char *answer = controller->host->texts->asked;
    wh_session_t *session = controller->host->session;
    const bool is_robot = controller->mechanism.kind == WH_MECHANISM_ROBOT;
    const wh_mcs_asker_t asker = {
        .controller = wh_host_plays_jobs(controller->host) ? wh_controller_job(controller) : 0,
        .robot = is_robot ? controller->mechanism.index + 1 : 0,
        .station = is_robot ? NULL : controller->mechanism.name};
    const wh_status_t status = wh_session_execute_for(session, &asker, line, answer, WH_SESSION_ANSWER_BYTES);
    wh_controller_tell_result(controller, WH_ENCODE_ANSWER, request, status, answer, 0);
}

/* STATUS and VERSION are answered while a command runs, too. */
static void answer_request(wh_controller_t *controller, const wh_request_t *request,
                           const wh_lines_t *lines) {
    char *text = controller->host->texts->told;
    const wh_word_kind_t kind = request->command->kind;
    const bool is_own_status =
        wh_host_plays_jobs(controller->host) && wh_session_says(lines->lines[0], "STATUS");
    if (kind == WH_WORD_LOCAL) {
        wh_controller_tell_result(controller, WH_ENCODE_ANSWER, request, WH_OK, lines->lines[0], 0);
    } else if (!controller->host->running && !is_own_status) {
        execute_query(controller, request, lines->lines[0]);
    } else if (kind == WH_WORD_QUERY) {
        wh_controller_refuse(controller, request, WH_STATUS_BUSY, "");
    } else {
        (void)snprintf(text, sizeof controller->host->texts->told, "OK version=" WH_VERSION);
        if (wh_session_says(lines->lines[0], "STATUS")) {
            (void)snprintf(text, sizeof controller->host->texts->told, "OK ");
            wh_controller_describe(controller, text + 3);
        }
        wh_controller_tell_result(controller, WH_ENCODE_ANSWER, request, WH_OK, text, 0);
    }
}

/* ------------------------------------------------------------------------------------------------ actions */

/* Why an action cannot be taken on now; null: it can. */
static const char *find_busy(const wh_controller_t *controller) {
    if (wh_controller_acting(controller) || controller->leader->pending) {
        return "this controller's command has not ended";
    }
    if (controller->owed.due_us != INT64_MAX) {
        return "the host owes an ACKN";
    }
    return NULL;
}

/* True if a report shows one run and this line would begin another one. */
static bool begins_another_run(const wh_host_t *host, const char *line) {
    return host->shows_one_run && (wh_session_says(line, "RESET") || wh_session_says(line, "UNDO") ||
                                   wh_word_of(line) == wh_word_of("RESTORE"));
}

/* An action is acknowledged at once, unless its only answer comes when it begins. True: its host waits for
 * nothing more. */
static bool acknowledge_action(wh_controller_t *controller, const wh_request_t *request) {
    const wh_told_t told = {.request = request};
    if (request->command->when == WH_WHEN_AT_ONCE) {
        return false;
    }
    wh_controller_tell(controller, WH_ENCODE_ACKNOWLEDGE, &told, true);
    return controller->dialect->encodes[WH_ENCODE_ACKNOWLEDGE];
}

/* From here on the request belongs to the controller. */
static void take_on_action(wh_controller_t *controller, wh_request_t *request, const wh_lines_t *lines,
                           bool is_answered) {
    controller->action.is_answered = is_answered;
    controller->action.is_there = true;
    controller->action.is_running = controller->action.has_begun = false;
    controller->action.is_stopped = false;
    controller->action.is_left = false;
    controller->action.order = ++controller->host->so_far.orders;
    controller->action.since_us = wh_host_now(controller->host);
    controller->action.request = *request;
    controller->action.lines = *lines;
    ++controller->counters.actions;
    *request = (wh_request_t){.reference = LUA_NOREF};
    wh_mcs_call(&controller->host->session->mcs);
}

/* An error on purpose in a port's answer, not in a command. */
static bool is_on_purpose(const wh_controller_t *controller, const char *line, wh_status_t error) {
    static const char *const passing[] = {"FAULT", "ALARM", "CLEAR", "WAIT"};
    for (size_t i = 0; i < sizeof passing / sizeof passing[0]; ++i) {
        if (wh_word_of(line) == wh_word_of(passing[i])) {
            return false;
        }
    }
    return wh_mcs_take_alarm(&controller->host->session->mcs, error, wh_controller_job(controller));
}

/* True if the action may wait behind what runs. */
static bool may_queue(const wh_controller_t *controller, const wh_dialect_command_t *command) {
    const bool is_behind = wh_controller_acting(controller) || controller->leader->pending;
    return is_behind && controller->owed.due_us == INT64_MAX && wh_queue_actions(controller) < command->queue;
}

static void accept_action(wh_controller_t *controller, wh_request_t *request, const wh_lines_t *lines) {
    const char *busy = find_busy(controller);
    if (!busy && is_on_purpose(controller, lines->lines[0], WH_STATUS_BUSY)) {
        busy = "another controller's command runs";
    }
    for (size_t i = 0; i < lines->count; ++i) {
        if (begins_another_run(controller->host, lines->lines[i])) {
            wh_controller_refuse(
                controller, request, WH_STATUS_BAD_ARGUMENT,
                "a report shows one run (expected no RESET, RESTORE or UNDO beside --report, --data, --gltf "
                "and --svg)");
            return;
        }
    }
    if (busy && may_queue(controller, request->command)) {
        const bool is_answered = acknowledge_action(controller, request);
        wh_queue_append(controller, request, lines)->is_answered = is_answered;
        return;
    }
    if (busy) {
        wh_controller_refuse(controller, request, WH_STATUS_BUSY, busy);
        return;
    }
    const bool is_answered = acknowledge_action(controller, request);
    take_on_action(controller, request, lines, is_answered);
}

/* ------------------------------------------------------------------------------------------------- frames */

/* Refuses an ACKN whose number is not that of the completion. An ACKN that is not awaited is ignored. */
static void take_ackn(wh_controller_t *controller, const wh_request_t *request) {
    const char *owed = controller->owed.sequence;
    char detail[2 * WH_DIALECT_NAME_BYTES + 40];
    if (controller->owed.due_us != INT64_MAX && owed[0] != '\0' && request->sequence[0] != '\0' &&
        strcmp(owed, request->sequence) != 0) {
        (void)snprintf(detail, sizeof detail, "ACKN %s (expected %s, which is owed)", request->sequence,
                       owed);
        wh_controller_refuse(controller, request, WH_STATUS_BAD_ARGUMENT, detail);
        return;
    }
    controller->owed.due_us = INT64_MAX;
}

/* Takes requests in which the dialect has no part. */
static bool take_own(wh_controller_t *controller, wh_request_t *request) {
    const wh_word_kind_t kind = request->command->kind;
    if (kind == WH_WORD_ACKN) {
        take_ackn(controller, request);
    } else if (kind == WH_WORD_STOP) {
        answer_stop(controller, request);
    } else if (kind == WH_WORD_HOLD || kind == WH_WORD_RESUME) {
        answer_hold(controller, request, kind == WH_WORD_HOLD);
    } else {
        return false;
    }
    return true;
}

/* A dialect of a whole cell has words that one of its controllers does not have. A command does if one of its
 * words does: an INIT may go home at a robot, and turn at an aligner. */
static bool does_command(const wh_controller_t *controller, const wh_dialect_command_t *command) {
    bool does = command->does_count == 0;
    for (size_t i = 0; i < command->does_count; ++i) {
        does = does || wh_mechanism_does(controller->mechanism.kind, command->does[i]);
    }
    return does;
}

/* Refuses lines of which one has a word of another mechanism, and an error on purpose. */
static bool refuse_lines(wh_controller_t *controller, const wh_request_t *request, const wh_lines_t *lines) {
    const wh_word_kind_t kind = request->command->kind;
    for (size_t i = 0; kind != WH_WORD_LOCAL && i < lines->count; ++i) {
        const wh_word_t *word = wh_word_of(lines->lines[i]);
        if (word && !wh_mechanism_does(controller->mechanism.kind, word)) {
            wh_controller_refuse(controller, request, WH_STATUS_NO_SUCH_COMMAND, word->name);
            return true;
        }
    }
    if (kind == WH_WORD_LOCAL || kind == WH_WORD_ALWAYS ||
        !is_on_purpose(controller, lines->lines[0], WH_STATUS_NO_SUCH_COMMAND)) {
        return false;
    }
    wh_controller_refuse(controller, request, WH_STATUS_NO_SUCH_COMMAND, request->command->name);
    return true;
}

/* "RATE 10": simulated time passes ten times as fast as the wall clock, from now on; 0: as fast as it can. A
 * transcript that is played knows no wall clock. */
static void set_rate(wh_controller_t *controller, const wh_request_t *request, const char *line) {
    wh_host_t *host = controller->host;
    char *end = NULL;
    const double rate = strtod(line + strcspn(line, " "), &end);
    if (*end != '\0' || !(rate == 0 || (rate >= 1e-3 && rate <= 1e3))) {
        wh_controller_refuse(controller, request, WH_STATUS_BAD_ARGUMENT,
                             "rate (expected 0 or 0.001 to 1000)");
        return;
    }
    if (!host->played) {
        host->rate = rate;
        ++host->so_far.rates;
        host->clock.base_wall_us = wh_host_now(host);
        host->clock.base_run_us = wh_session_time_us(host->session);
    }
    wh_controller_tell_result(controller, WH_ENCODE_ANSWER, request, WH_OK, "OK", 0);
}

/* The robot's own controller changes by what a tester has told. */
static wh_decoded_t change_by_tester(wh_controller_t *controller, const wh_lines_t *lines,
                                     wh_failure_t *failure) {
    char reason[WH_MCS_CHANGE_BYTES];
    const wh_status_t status = wh_controller_change(controller, lines, reason);
    wh_host_tell_modes(controller->host);
    if (status == WH_OK) {
        return WH_DECODED_REQUEST;
    }
    failure->number = status;
    (void)snprintf(failure->detail, sizeof failure->detail, "%s", reason);
    return WH_DECODED_REFUSED;
}

/* Tells a dialect, once for all of its ports. A running action stops if the dialect says so. */
static wh_decoded_t tell_leader(wh_controller_t *controller, const char *text, wh_failure_t *failure) {
    wh_lines_t *conditions = &controller->host->texts->conditions;
    bool stops = false;
    if (controller->leader != controller) {
        return WH_DECODED_NOTHING;
    }
    const wh_decoded_t outcome = wh_dialect_tell(controller->dialect, text, &stops, conditions, failure);
    if (outcome == WH_DECODED_REQUEST && stops) {
        stop_acting(controller);
    }
    return outcome == WH_DECODED_REQUEST ? change_by_tester(controller, conditions, failure) : outcome;
}

/* "TELL estop on": each controller whose dialect hears testers is told the rest. */
static void tell_controllers(wh_controller_t *controller, const wh_request_t *request, const char *line) {
    const wh_host_t *host = controller->host;
    const char *text = line + strcspn(line, " ");
    size_t heard = 0;
    for (size_t i = 0; i < host->count; ++i) {
        wh_controller_t *other = host->controllers[i];
        wh_failure_t failure;
        const wh_decoded_t outcome = tell_leader(other, text + strspn(text, " "), &failure);
        if (outcome == WH_DECODED_REFUSED || outcome == WH_DECODED_MISTAKE) {
            wh_controller_refuse(controller, request, WH_STATUS_BAD_ARGUMENT,
                                 outcome == WH_DECODED_REFUSED ? failure.detail : other->dialect->message);
            return;
        }
        heard += outcome == WH_DECODED_REQUEST ? 1 : 0;
    }
    if (heard == 0) {
        wh_controller_refuse(controller, request, WH_STATUS_BAD_ARGUMENT,
                             "no dialect hears testers (expected one with a function `tester`)");
        return;
    }
    wh_controller_tell_result(controller, WH_ENCODE_ANSWER, request, WH_OK, "OK", 0);
}

/* "CONTROLLER power=off", which passes at any time. */
static void answer_controller(wh_controller_t *controller, const wh_request_t *request,
                              const wh_lines_t *lines) {
    char reason[WH_MCS_CHANGE_BYTES];
    char answer[WH_MCS_CHANGE_BYTES + 3] = "OK ";
    const wh_status_t status = wh_controller_change(controller, lines, reason);
    if (status != WH_OK) {
        wh_controller_refuse(controller, request, status, reason);
        return;
    }
    wh_controller_tell_conditions(controller, answer + strlen(answer), sizeof answer - strlen(answer));
    wh_controller_tell_result(controller, WH_ENCODE_ANSWER, request, WH_OK, answer, 0);
    wh_host_tell_modes(controller->host);
}

/* Makes the request's lines, and answers or accepts it. */
static void carry_out(wh_controller_t *controller, wh_request_t *request) {
    wh_lines_t *lines = &controller->host->texts->lines;
    wh_failure_t failure;
    const wh_word_kind_t kind = request->command->kind;
    const wh_decoded_t outcome =
        wh_dialect_run(controller->dialect, request, wh_controller_tell_now, controller, lines, &failure);
    if (outcome == WH_DECODED_MISTAKE) {
        wh_controller_tell_mistake(controller, request);
    } else if (outcome == WH_DECODED_REFUSED) {
        wh_controller_refuse_as(controller, request, &failure);
    } else if (refuse_lines(controller, request, lines)) {
        return;
    } else if (kind == WH_WORD_RATE) {
        set_rate(controller, request, lines->lines[0]);
    } else if (kind == WH_WORD_CONTROLLER) {
        answer_controller(controller, request, lines);
    } else if (kind == WH_WORD_TELL) {
        tell_controllers(controller, request, lines->lines[0]);
    } else if (kind == WH_WORD_ACTION) {
        accept_action(controller, request, lines);
    } else {
        answer_request(controller, request, lines);
    }
}

static void take_request(wh_controller_t *controller, wh_request_t *request) {
    const wh_dialect_command_t *command = request->command;
    const bool is_idle = !wh_controller_acting(controller) && !controller->leader->pending;
    controller->carrier->line.closes = controller->carrier->line.closes || command->closes;
    if (!does_command(controller, command)) {
        wh_controller_refuse(controller, request, WH_STATUS_NO_SUCH_COMMAND, command->name);
    } else if (command->when == WH_WHEN_IDLE && !is_idle) {
        (void)wh_queue_append(controller, request, NULL);
    } else if (!take_own(controller, request)) {
        carry_out(controller, request);
    }
}

/* Requests that wait at this dialect's ports go on, as far as they can. True if something did. */
static bool go_on(wh_controller_t *leader) {
    bool is_any = false;
    while (!leader->host->is_ended && !wh_controller_acting(leader)) {
        wh_pending_t *pending = wh_queue_take(leader);
        if (!pending) {
            break;
        }
        is_any = true;
        if (pending->request.command->kind == WH_WORD_ACTION) {
            take_on_action(pending->from, &pending->request, &pending->lines, pending->is_answered);
        } else if (!take_own(pending->from, &pending->request)) {
            carry_out(pending->from, &pending->request);
        }
        wh_queue_free(pending);
    }
    return is_any;
}

bool wh_host_go_on(wh_host_t *host) {
    bool is_any = false;
    for (size_t i = 0; i < host->count; ++i) {
        is_any |= host->controllers[i]->leader == host->controllers[i] && go_on(host->controllers[i]);
    }
    return is_any;
}

/* The last frame again, with its number: the answer may have been lost. */
static bool is_repeated(wh_controller_t *controller, const wh_request_t *request, const wh_frame_t *frame) {
    const bool is_known =
        request->sequence[0] != '\0' && (controller->repeat.reply.text || wh_controller_owes(controller)) &&
        frame->body_size == controller->repeat.last_size && frame->end == controller->repeat.last_end &&
        memcmp(frame->body, controller->repeat.last, frame->body_size) == 0;
    if (is_known) {
        ++controller->counters.repeated;
        wh_controller_tell_again(controller, &controller->repeat.reply); /* nothing if it is still to come */
    }
    return is_known;
}

static void take_decoded(wh_controller_t *controller, const wh_frame_t *frame, wh_decoded_t decoded,
                         wh_request_t *request, const wh_failure_t *failure) {
    const bool is_request = decoded == WH_DECODED_REQUEST && request->command;
    if (is_request && request->command->kind != WH_WORD_ACKN) {
        if (is_repeated(controller, request, frame)) {
            return;
        }
        free(controller->repeat.reply.text);
        controller->repeat.reply.text = NULL;
        memcpy(controller->repeat.last, frame->body, frame->body_size);
        controller->repeat.last_size = frame->body_size;
        controller->repeat.last_end = frame->end;
        controller->repeat.remembers = request->sequence[0] != '\0';
    }
    if (is_request) {
        take_request(controller, request);
    } else if (decoded == WH_DECODED_REFUSED) {
        wh_controller_refuse_as(controller, request, failure);
    } else if (decoded == WH_DECODED_MISTAKE) {
        wh_controller_tell_mistake(controller, request);
    }
    controller->repeat.remembers = false;
}

/* Takes a good frame. */
static void take_good(wh_controller_t *controller, const wh_frame_t *frame) {
    wh_request_t request;
    wh_failure_t failure;
    const int64_t begin_us = wh_host_now(controller->host);
    ++controller->counters.frames;
    const wh_client_t client = {controller->role, controller->line.client};
    const wh_decoded_t decoded = wh_dialect_decode(controller->dialect, &client, frame, &request, &failure);
    take_decoded(controller, frame, decoded, &request, &failure);
    wh_dialect_forget(controller->dialect, &request);
    controller->host->clock.lua_us += wh_host_now(controller->host) - begin_us;
}

/* The unit of this line that the frame is for; null: it has none of that address. */
static wh_controller_t *find_unit(wh_controller_t *carrier, const wh_frame_t *frame) {
    const wh_host_t *host = carrier->host;
    char unit[WH_DIALECT_NAME_BYTES];
    if (!wh_dialect_unit_of(carrier->dialect, (const char *)frame->body, frame->body_size, unit)) {
        wh_controller_say_mistake(carrier);
    }
    for (size_t i = 0; i < host->count; ++i) {
        if (host->controllers[i]->carrier == carrier && strcmp(host->controllers[i]->unit, unit) == 0) {
            return host->controllers[i];
        }
    }
    if (carrier->counters.nobodys++ == 0) {
        memcpy(carrier->counters.nobody, unit, sizeof unit);
    }
    return NULL;
}

void wh_controller_take(wh_controller_t *controller, const wh_frame_t *frame) {
    const wh_told_t told = {.reason = wh_frame_kind_name(frame->kind)};
    const bool is_good = frame->kind == WH_FRAME_GOOD;
    wh_controller_t *unit = is_good && controller->unit ? find_unit(controller, frame) : controller;
    controller->counters.bad += is_good ? 0 : 1;
    if (is_good && unit) {
        take_good(unit, frame);
    } else if (!is_good && !controller->unit) { /* nobody knows for which unit it was */
        wh_controller_tell(controller, WH_ENCODE_BAD, &told, true);
    }
}

void wh_controller_give_up_waiting(wh_controller_t *controller) {
    wh_host_note(controller->host, controller, WH_TRANSCRIPT_ELAPSED, NULL, 0);
    if (controller->owed.due_us != INT64_MAX) {
        const wh_told_t told = {.reason = NULL};
        controller->owed.due_us = INT64_MAX;
        ++controller->counters.unacknowledged;
        wh_controller_tell(controller, WH_ENCODE_UNACKNOWLEDGED, &told, false);
    } else if (wh_controller_waits(controller)) {
        wh_controller_end_job(controller, WH_STATUS_BUSY,
                              "another controller's command has run for too long");
    }
}

void wh_controller_tick(wh_controller_t *controller) {
    const int64_t now = wh_host_now(controller->host);
    const bool is_over_time =
        now - controller->action.since_us > (int64_t)(controller->dialect->timing.busy_s * 1e6);
    if (controller->owed.due_us <= now || (is_over_time && wh_controller_waits(controller))) {
        wh_controller_give_up_waiting(controller);
    }
}
