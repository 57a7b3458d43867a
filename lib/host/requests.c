/* What becomes of a request: what passes while something runs, what is begun, and what is refused. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <lauxlib.h>

#include "../record/record.h"
#include "../text/utf8.h"
#include "host.h"

/* ------------------------------------------------------------------------------------------------ telling */

/* Tells the host of this error, or of none. It was shown if a frame went out and all came through whole. */
static void tell(wh_controller_t *controller, wh_encoder_t encoder, const wh_told_t *told, bool is_reply,
                 wh_status_t number) {
    const uint64_t before = controller->told;
    const uint64_t broken = controller->broken;
    wh_controller_tell(controller, encoder, told, is_reply);
    const bool is_shown = controller->told > before && controller->broken == broken;
    if (is_shown && number != WH_OK && (size_t)number < WH_HOST_NUMBERS) {
        ++controller->host->shown[number];
    }
}

static void refuse_as(wh_controller_t *controller, const wh_request_t *request, const wh_failure_t *failure) {
    const wh_told_t told = {.request = request, .failure = failure};
    controller->counters.busy += failure->number == WH_STATUS_BUSY ? 1 : 0;
    tell(controller, WH_ENCODE_REFUSE, &told, true, failure->number);
}

static void refuse(wh_controller_t *controller, const wh_request_t *request, wh_status_t number,
                   const char *detail) {
    wh_failure_t failure = {.number = number};
    (void)snprintf(failure.detail, sizeof failure.detail, "%s", detail);
    refuse_as(controller, request, &failure);
}

static void tell_result(wh_controller_t *controller, wh_encoder_t encoder, const wh_request_t *request,
                        wh_status_t number, const char *answer, double seconds) {
    static char status[WH_MCS_DESCRIPTION_BYTES];
    const wh_mcs_t *mcs = &controller->host->session->mcs;
    wh_controller_describe(controller, status);
    const wh_result_t result = {.number = number,
                                .answer = answer,
                                .status = status,
                                .seconds = seconds,
                                .is_held = controller->host->is_held,
                                .layout = mcs->layout,
                                .mechanism = &controller->mechanism,
                                .sensors = mcs->state.sensors};
    const wh_told_t told = {.request = request, .result = &result};
    tell(controller, encoder, &told, encoder == WH_ENCODE_ANSWER, number);
}

/* A mistake is a line that names the dialect's file and line. */
static void tell_mistake(wh_controller_t *controller, const wh_request_t *request) {
    char message[WH_SANDBOX_MESSAGE_BYTES];
    wh_utf8_visible(message, sizeof message, controller->dialect.message);
    ++controller->counters.mistakes;
    (void)fprintf(stderr, "serve: %s: %s\n", controller->name, message);
    refuse(controller, request, WH_STATUS_BAD_ARGUMENT, message);
}

void wh_controller_event(wh_controller_t *controller, const wh_event_t *event, double seconds) {
    const wh_layout_t *layout = controller->host->session->mcs.layout;
    const bool has_wafer = event->wafer >= 0 && (size_t)event->wafer < layout->wafer_count;
    const bool has_gripper = event->gripper >= 0 && (size_t)event->gripper < layout->machine.gripper_count;
    const wh_host_event_t told_event = {.kind = wh_event_name(event->kind),
                                        .is_complaint = wh_record_is_complaint(event->kind),
                                        .wafer = has_wafer ? layout->wafers[event->wafer].name : "",
                                        .gripper = has_gripper ? layout->grippers[event->gripper].name : "",
                                        .seconds = seconds};
    const wh_told_t told = {.event = &told_event};
    const bool is_its_own = !has_gripper || (controller->mechanism.grippers >> event->gripper & 1U) != 0;
    if (controller->dialect.encodes[WH_ENCODE_EVENT] && is_its_own) {
        wh_controller_tell(controller, WH_ENCODE_EVENT, &told, false);
    }
}

/* ---------------------------------------------------------------------------------------------- at once */

/* Ends what runs of this port. */
static void stop_running(wh_controller_t *controller) {
    wh_host_t *host = controller->host;
    controller->is_stopped = true;
    if (wh_host_plays_jobs(host)) {
        wh_controller_end_job(controller, WH_STATUS_STOPPED, "by a request");
    } else {
        host->is_told_to_stop = true;
        wh_mcs_stop(&host->session->mcs);
    }
}

static void release(wh_host_t *host) {
    host->is_held = false;
    host->holder = NULL;
}

/* What is held in a phase is the robot's. */
static bool may_give_up(const wh_controller_t *controller) {
    const bool is_robot = controller->mechanism.kind == WH_MECHANISM_ROBOT;
    return wh_host_plays_jobs(controller->host) ? is_robot : !controller->host->running;
}

static void stop(wh_controller_t *controller, const wh_request_t *request) {
    wh_host_t *host = controller->host;
    if (controller->is_running) {
        if (host->holder == controller) {
            release(host);
        }
        stop_running(controller);
    } else if (controller->has_action) {
        controller->is_stopped = true;
    } else if (may_give_up(controller)) {
        wh_mcs_give_up(&host->session->mcs, controller->mechanism.index);
    }
    tell_result(controller, WH_ENCODE_ANSWER, request, WH_OK, "OK", 0);
}

void wh_host_stop(wh_host_t *host) {
    wh_host_note(host, host->running ? host->running : host->controllers[0], WH_TRANSCRIPT_HALTED, NULL, 0);
    release(host);
    for (size_t i = 0; i < host->count; ++i) {
        wh_controller_t *controller = host->controllers[i];
        controller->is_stopped = controller->has_action;
        if (controller->is_running) {
            stop_running(controller);
        }
    }
    if (!host->running) {
        wh_mcs_give_up(&host->session->mcs, WH_NONE);
    }
}

static void hold(wh_controller_t *controller, const wh_request_t *request, bool is_held) {
    wh_host_t *host = controller->host;
    const bool is_its_turn = host->is_held ? host->holder == controller : is_held;
    if (!controller->is_running || !is_its_turn) {
        refuse(controller, request, WH_STATUS_NOT_IN_PHASE,
               is_held ? "no command of this controller runs" : "no HOLD stands");
        return;
    }
    host->is_held = is_held;
    host->holder = is_held ? controller : NULL;
    tell_result(controller, WH_ENCODE_ANSWER, request, WH_OK, "OK", 0);
}

static void execute_query(wh_controller_t *controller, const wh_request_t *request, const char *line) {
    static char answer[WH_SESSION_ANSWER_BYTES];
    wh_session_t *session = controller->host->session;
    const bool is_robot = controller->mechanism.kind == WH_MECHANISM_ROBOT;
    session->mcs.asking = wh_host_plays_jobs(controller->host) ? (int32_t)controller->number + 1 : 0;
    session->mcs.asking_robot = is_robot ? controller->mechanism.index + 1 : 0;
    const wh_status_t status = wh_session_execute(session, line, answer, sizeof answer);
    session->mcs.asking = session->mcs.asking_robot = 0;
    tell_result(controller, WH_ENCODE_ANSWER, request, status, answer, 0);
}

/* STATUS and VERSION are answered while a command runs, too. */
static void answer(wh_controller_t *controller, const wh_request_t *request, const wh_lines_t *lines) {
    static char text[WH_MCS_DESCRIPTION_BYTES + 4];
    const wh_word_kind_t kind = request->command->kind;
    const bool is_own_status =
        wh_host_plays_jobs(controller->host) && wh_session_says(lines->lines[0], "STATUS");
    if (kind == WH_WORD_LOCAL) {
        tell_result(controller, WH_ENCODE_ANSWER, request, WH_OK, lines->lines[0], 0);
    } else if (!controller->host->running && !is_own_status) {
        execute_query(controller, request, lines->lines[0]);
    } else if (kind == WH_WORD_QUERY) {
        refuse(controller, request, WH_STATUS_BUSY, "");
    } else {
        (void)snprintf(text, sizeof text, "OK version=" WH_VERSION);
        if (wh_session_says(lines->lines[0], "STATUS")) {
            (void)snprintf(text, sizeof text, "OK ");
            wh_controller_describe(controller, text + 3);
        }
        tell_result(controller, WH_ENCODE_ANSWER, request, WH_OK, text, 0);
    }
}

/* ------------------------------------------------------------------------------------------------ actions */

/* Why an action cannot be taken on now; null: it can. */
static const char *find_busy(const wh_controller_t *controller) {
    if (controller->has_action) {
        return "this controller's command has not ended";
    }
    if (controller->ackn_due_us != INT64_MAX) {
        return "the host owes an ACKN";
    }
    return NULL;
}

/* True if a report shows one run and this line would begin another one. */
static bool begins_another_run(const wh_host_t *host, const char *line) {
    return host->shows_one_run && (wh_session_says(line, "RESET") || wh_session_says(line, "UNDO") ||
                                   wh_word_of(line) == wh_word_of("RESTORE"));
}

/* The request is the controller's from here on. */
static void take_on(wh_controller_t *controller, wh_request_t *request, const wh_lines_t *lines) {
    const wh_told_t told = {.request = request};
    wh_controller_tell(controller, WH_ENCODE_ACKNOWLEDGE, &told, true);
    controller->has_action = true;
    controller->is_running = false;
    controller->is_stopped = false;
    controller->is_left = false;
    controller->order = ++controller->host->orders;
    controller->since_us = wh_host_now(controller->host);
    controller->request = *request;
    controller->lines = *lines;
    ++controller->counters.actions;
    *request = (wh_request_t){.reference = LUA_NOREF};
    wh_mcs_call(&controller->host->session->mcs);
}

/* An error on purpose that a port answers, and no command. */
static bool is_on_purpose(const wh_controller_t *controller, const char *line, wh_status_t error) {
    static const char *const passing[] = {"FAULT", "ALARM", "CLEAR", "WAIT"};
    for (size_t i = 0; i < sizeof passing / sizeof passing[0]; ++i) {
        if (wh_word_of(line) == wh_word_of(passing[i])) {
            return false;
        }
    }
    return wh_mcs_take_alarm(&controller->host->session->mcs, error, (int32_t)controller->number + 1);
}

static void begin(wh_controller_t *controller, wh_request_t *request, const wh_lines_t *lines) {
    const char *busy = find_busy(controller);
    if (!busy && is_on_purpose(controller, lines->lines[0], WH_STATUS_BUSY)) {
        busy = "another controller's command runs";
    }
    for (size_t i = 0; i < lines->count; ++i) {
        if (begins_another_run(controller->host, lines->lines[i])) {
            refuse(
                controller, request, WH_STATUS_BAD_ARGUMENT,
                "a report shows one run (expected no RESET, RESTORE or UNDO beside --report, --data, --gltf "
                "and --svg)");
            return;
        }
    }
    if (busy) {
        refuse(controller, request, WH_STATUS_BUSY, busy);
        return;
    }
    take_on(controller, request, lines);
}

void wh_controller_end(wh_controller_t *controller, wh_status_t number, const char *text, double seconds) {
    wh_host_t *host = controller->host;
    const bool is_told = !controller->is_left || controller->dialect.completes_to_next;
    const uint64_t before = controller->told;
    controller->counters.busy += number == WH_STATUS_BUSY ? 1 : 0;
    controller->has_action = controller->is_running = false; /* it asks for its state as it tells this */
    if (is_told) {
        tell_result(controller, WH_ENCODE_COMPLETE, &controller->request, number, text, seconds);
    }
    if (controller->told == before) { /* what the host says next comes behind this end all the same */
        wh_host_note(host, controller, WH_TRANSCRIPT_ENDED, NULL, 0);
    }
    if (is_told && controller->dialect.ackn_s > 0 && controller->dialect.text) {
        controller->ackn_due_us = wh_host_now(host) + (int64_t)(controller->dialect.ackn_s * 1e6);
    }
    wh_dialect_forget(&controller->dialect, &controller->request);
}

void wh_controller_end_unbegun(wh_controller_t *controller, wh_status_t number, const char *reason) {
    char text[WH_SANDBOX_MESSAGE_BYTES];
    char whole[WH_SANDBOX_MESSAGE_BYTES];
    (void)snprintf(whole, sizeof whole, "%s; %s", wh_record_error_text(number), reason);
    wh_session_write_error(text, sizeof text, number, whole);
    wh_controller_end(controller, number, text, 0);
}

/* A fault ends with the next slice, and no slice comes while nothing moves: one is waited for. */
static void end_faults(const wh_controller_t *controller) {
    static char text[WH_SESSION_ANSWER_BYTES];
    char line[40];
    wh_session_t *session = controller->host->session;
    if (wh_word_of(controller->lines.lines[controller->lines.count - 1]) == wh_word_of("CLEAR")) {
        (void)snprintf(line, sizeof line, "WAIT %.6f", (double)session->mcs.track.slice_us / 1e6);
        session->mcs.is_part = true; /* UNDO takes it back with the CLEAR */
        (void)wh_session_execute(session, line, text, sizeof text);
        session->mcs.is_part = false;
    }
}

void wh_host_begin_clock(wh_host_t *host, wh_controller_t *controller) {
    const wh_track_t *track = &host->session->mcs.track;
    host->running = controller;
    host->last_served_us = 0; /* what came behind this action is heard in its first slice */
    host->is_told_to_stop = false;
    host->base_wall_us = wh_host_now(host);
    host->base_run_us = track->slice * track->slice_us;
    host->clock_slice = track->slice;
}

void wh_controller_play(wh_controller_t *controller) {
    static char text[WH_SESSION_ANSWER_BYTES];
    wh_host_t *host = controller->host;
    if (wh_host_plays_jobs(host)) {
        wh_host_play_jobs(host);
        return;
    }
    const wh_track_t *track = &host->session->mcs.track;
    int64_t slices = 0; /* a RESET, RESTORE or UNDO may set the clock back */
    wh_status_t status = WH_OK;
    if (controller->is_stopped) {
        wh_controller_end_unbegun(controller, WH_STATUS_STOPPED, "it waited and was not begun");
        return;
    }
    wh_host_begin_clock(host, controller);
    controller->is_running = true;
    for (size_t i = 0; i < controller->lines.count && status == WH_OK; ++i) {
        const int64_t begin = track->slice;
        status = wh_session_execute(host->session, controller->lines.lines[i], text, sizeof text);
        wh_host_heed_clock(host);
        slices += track->slice > begin ? track->slice - begin : 0;
    }
    if (status == WH_OK) {
        end_faults(controller);
    }
    wh_host_heed_stop(host, status);
    host->running = NULL;
    host->is_held = false;
    wh_controller_end(controller, status, text, (double)(slices * track->slice_us) / 1e6);
}

/* ------------------------------------------------------------------------------------------------- frames */

/* What the dialect has no part in. */
static bool take_own(wh_controller_t *controller, wh_request_t *request) {
    const wh_word_kind_t kind = request->command->kind;
    if (kind == WH_WORD_ACKN) {
        controller->ackn_due_us = INT64_MAX;
    } else if (kind == WH_WORD_STOP) {
        stop(controller, request);
    } else if (kind == WH_WORD_HOLD || kind == WH_WORD_RESUME) {
        hold(controller, request, kind == WH_WORD_HOLD);
    } else {
        return false;
    }
    return true;
}

/* A dialect of a whole cell has words that one of its controllers has not. */
static bool does(const wh_controller_t *controller, const wh_dialect_command_t *command) {
    for (size_t i = 0; i < command->does_count; ++i) {
        if (!wh_mechanism_does(controller->mechanism.kind, command->does[i])) {
            return false;
        }
    }
    return true;
}

static void take_request(wh_controller_t *controller, wh_request_t *request) {
    static wh_lines_t lines;
    wh_failure_t failure;
    const wh_word_kind_t kind = request->command->kind;
    if (!does(controller, request->command)) {
        refuse(controller, request, WH_STATUS_NO_SUCH_COMMAND, request->command->name);
        return;
    }
    if (take_own(controller, request)) {
        return;
    }
    const wh_decoded_t outcome = wh_dialect_run(&controller->dialect, request, &lines, &failure);
    if (outcome == WH_DECODED_MISTAKE) {
        tell_mistake(controller, request);
    } else if (outcome == WH_DECODED_REFUSED) {
        refuse_as(controller, request, &failure);
    } else if (kind != WH_WORD_LOCAL && kind != WH_WORD_ALWAYS &&
               is_on_purpose(controller, lines.lines[0], WH_STATUS_NO_SUCH_COMMAND)) {
        refuse(controller, request, WH_STATUS_NO_SUCH_COMMAND, request->command->name);
    } else if (kind == WH_WORD_ACTION) {
        begin(controller, request, &lines);
    } else {
        answer(controller, request, &lines);
    }
}

/* The last frame again, with its number: the answer may have been lost. */
static bool is_repeated(wh_controller_t *controller, const wh_request_t *request, const wh_frame_t *frame) {
    const bool is_known = request->sequence[0] != '\0' && controller->reply.text &&
                          frame->body_size == controller->last_size &&
                          memcmp(frame->body, controller->last, frame->body_size) == 0;
    if (is_known) {
        ++controller->counters.repeated;
        wh_controller_tell_again(controller, &controller->reply);
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
        free(controller->reply.text);
        controller->reply.text = NULL;
        memcpy(controller->last, frame->body, frame->body_size);
        controller->last_size = frame->body_size;
        controller->remembers = request->sequence[0] != '\0';
    }
    if (is_request) {
        take_request(controller, request);
    } else if (decoded == WH_DECODED_REFUSED) {
        refuse_as(controller, request, failure);
    } else if (decoded == WH_DECODED_MISTAKE) {
        tell_mistake(controller, request);
    }
    controller->remembers = false;
}

void wh_controller_take(wh_controller_t *controller, const wh_frame_t *frame) {
    wh_request_t request;
    wh_failure_t failure;
    const int64_t begin_us = wh_host_now(controller->host);
    if (frame->kind != WH_FRAME_GOOD) {
        const wh_told_t told = {.reason = wh_frame_kind_name(frame->kind)};
        ++controller->counters.bad;
        wh_controller_tell(controller, WH_ENCODE_BAD, &told, true);
        return;
    }
    ++controller->counters.frames;
    const wh_decoded_t decoded = wh_dialect_decode(&controller->dialect, (const char *)frame->body,
                                                   frame->body_size, &request, &failure);
    take_decoded(controller, frame, decoded, &request, &failure);
    wh_dialect_forget(&controller->dialect, &request);
    controller->host->lua_us += wh_host_now(controller->host) - begin_us;
}

void wh_controller_give_up_waiting(wh_controller_t *controller) {
    wh_host_note(controller->host, controller, WH_TRANSCRIPT_ELAPSED, NULL, 0);
    if (controller->ackn_due_us != INT64_MAX) {
        const wh_told_t told = {.reason = NULL};
        controller->ackn_due_us = INT64_MAX;
        ++controller->counters.unacknowledged;
        wh_controller_tell(controller, WH_ENCODE_UNACKNOWLEDGED, &told, false);
    } else if (wh_controller_waits(controller)) {
        wh_controller_end_job(controller, WH_STATUS_BUSY,
                              "another controller's command has run for too long");
    }
}

void wh_controller_tick(wh_controller_t *controller) {
    const int64_t now = wh_host_now(controller->host);
    const bool is_over_time = now - controller->since_us > (int64_t)(controller->dialect.busy_s * 1e6);
    if (controller->ackn_due_us <= now || (is_over_time && wh_controller_waits(controller))) {
        wh_controller_give_up_waiting(controller);
    }
}
