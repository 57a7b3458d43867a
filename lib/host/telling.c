#include "telling.h"

#include <stdio.h>
#include <string.h>

#include <lauxlib.h>

#include "../record/record.h"
#include "../text/array.h"
#include "../text/utf8.h"
#include "conditions.h"
#include "journal.h"
#include "line.h"
#include "status.h"

/* ------------------------------------------------------------------------------------------------- bodies */

static void say_mistake(wh_controller_t *controller, const char *message) {
    ++controller->counters.mistakes;
    (void)fprintf(stderr, "serve: %s: %s\n", controller->name, message);
}

void wh_controller_say_mistake(wh_controller_t *controller) {
    say_mistake(controller, controller->dialect->message);
}

/* Makes a frame of the text's next body, which begins at `*at`, and passes that body. Returns the frame's
 * bytes; 0: it is not a frame. */
static size_t take_body(const wh_controller_t *controller, const wh_reply_t *reply, size_t *at,
                        uint8_t frame[WH_FRAMING_LINE]) {
    const char *begin = reply->text + *at;
    const char *end = memchr(begin, 0, reply->size - *at);
    const size_t length = end ? (size_t)(end - begin) : reply->size - *at;
    *at += length + 1;
    return wh_framing_encode(&controller->dialect->replies, reply->start, (const uint8_t *)begin, length,
                             frame);
}

/* Sends all of the text's bodies as frames. False, and none is sent, if one of them makes no frame. */
static bool send_body(wh_controller_t *controller, const wh_reply_t *reply, bool is_reply) {
    uint8_t frame[WH_FRAMING_LINE];
    const int64_t due_us =
        wh_host_now(controller->host) + (is_reply ? (int64_t)(controller->dialect->timing.ack_s * 1e6) : 0);
    for (size_t at = 0; at <= reply->size;) {
        if (take_body(controller, reply, &at, frame) == 0) {
            return false;
        }
    }
    for (size_t at = 0; at <= reply->size;) {
        const size_t bytes = take_body(controller, reply, &at, frame);
        wh_controller_enqueue(controller, true, frame, bytes, due_us, is_reply);
    }
    wh_controller_send_due(controller, wh_host_now(controller->host));
    return true;
}

/* Keeps the reply for the case that the host repeats the request. */
static void remember_reply(wh_controller_t *controller) {
    const wh_dialect_t *dialect = controller->dialect;
    if (controller->repeat.remembers) {
        controller->repeat.remembers = false;
        controller->repeat.reply.text = wh_array_new(dialect->text_size + 1, 1);
        controller->repeat.reply.size = dialect->text_size;
        controller->repeat.reply.start = dialect->text_start;
        memcpy(controller->repeat.reply.text, dialect->text, dialect->text_size);
    }
}

/* Encodes and sends. False: the dialect's mistake was reported, and its host was not told anything yet. */
static bool encode_and_send(wh_controller_t *controller, wh_encoder_t encoder, const wh_told_t *told,
                            bool is_reply) {
    wh_dialect_t *dialect = controller->dialect;
    const int64_t begin = wh_host_now(controller->host);
    wh_failure_t failure;
    bool made = wh_dialect_encode(dialect, encoder, told);
    if (!made && encoder == WH_ENCODE_ANSWER && wh_dialect_refused(dialect, &failure)) {
        const wh_told_t refusal = {.request = told->request, .failure = &failure};
        made = wh_dialect_encode(dialect, WH_ENCODE_REFUSE, &refusal);
        controller->refused_as = failure.number;
    }
    controller->host->clock.lua_us += wh_host_now(controller->host) - begin;
    if (!made) {
        say_mistake(controller, dialect->message);
        return false;
    }
    const wh_reply_t reply = {dialect->text, dialect->text_size, dialect->text_start};
    if (reply.text && !send_body(controller, &reply, is_reply)) {
        (void)snprintf(
            dialect->message, sizeof dialect->message,
            "%.300s: encode.%s: its text of %zu bytes is no body of a frame (expected none of the marks of "
            "a start or an end, and no more than framing.longest, %zu, with all that a frame has)",
            dialect->path, wh_encoder_names[encoder], reply.size, dialect->framing.longest);
        say_mistake(controller, dialect->message);
        return false;
    }
    if (reply.text) {
        remember_reply(controller);
    }
    return true;
}

/* A mistake in an encoder is refused with error 48. A mistake in `refuse` is refused likewise, with the code
 * alone. */
void wh_controller_tell(wh_controller_t *controller, wh_encoder_t encoder, const wh_told_t *told,
                        bool is_reply) {
    wh_failure_t failure = {.number = WH_STATUS_BAD_ARGUMENT};
    const wh_request_t none = {.reference = LUA_NOREF};
    const wh_told_t refusal = {.request = told->request ? told->request : &none, .failure = &failure};
    char code[WH_DIALECT_NAME_BYTES];
    if (encode_and_send(controller, encoder, told, is_reply) || encoder == WH_ENCODE_EVENT ||
        encoder == WH_ENCODE_UNACKNOWLEDGED) {
        return;
    }
    wh_utf8_visible(failure.detail, sizeof failure.detail, controller->dialect->message);
    (void)snprintf(code, sizeof code, "%s", wh_dialect_code(controller->dialect, failure.number));
    const wh_reply_t bare = {code, strlen(code), 0};
    ++controller->host->shown[WH_STATUS_BAD_ARGUMENT];
    if (encoder == WH_ENCODE_REFUSE || !encode_and_send(controller, WH_ENCODE_REFUSE, &refusal, is_reply)) {
        (void)send_body(controller, &bare, is_reply);
    }
}

void wh_controller_greet(wh_controller_t *controller) {
    wh_dialect_t *dialect = controller->dialect;
    const wh_client_t client = {controller->role, controller->line.client};
    if (!dialect->clients.greets) {
        return;
    }
    if (!wh_dialect_welcome(dialect, &client)) {
        say_mistake(controller, dialect->message);
        return;
    }
    const wh_reply_t reply = {dialect->text, dialect->text_size, dialect->text_start};
    if (reply.text && !send_body(controller, &reply, false)) {
        wh_dialect_note(dialect, "connected: its text is no body of a frame");
        say_mistake(controller, dialect->message);
    }
}

void wh_controller_part(wh_controller_t *controller) {
    const wh_client_t client = {controller->role, controller->line.client};
    wh_lines_t *lines = &controller->host->texts->conditions;
    char reason[WH_MCS_CHANGE_BYTES];
    if (controller->dialect->clients.heeds_going && !wh_dialect_part(controller->dialect, &client, lines)) {
        say_mistake(controller, controller->dialect->message);
    } else if (controller->dialect->clients.heeds_going &&
               wh_controller_change(controller, lines, reason) != WH_OK) {
        wh_dialect_note(controller->dialect, reason);
        say_mistake(controller, controller->dialect->message);
    }
}

void wh_controller_tell_again(wh_controller_t *controller, const wh_reply_t *reply) {
    if (reply->text) {
        (void)send_body(controller, reply, true);
    }
}

/* ------------------------------------------------------------------------------------------------ replies */

/* Tells the host of this error, or of none. The error counts as shown if a frame went out and all frames came
 * through whole. */
static void tell_and_count(wh_controller_t *controller, wh_encoder_t encoder, const wh_told_t *told,
                           bool is_reply, wh_status_t number) {
    const uint64_t before = controller->line.told;
    const uint64_t broken = controller->line.broken;
    controller->refused_as = WH_OK;
    wh_controller_tell(controller, encoder, told, is_reply);
    number = controller->refused_as != WH_OK ? controller->refused_as : number;
    const bool is_shown = controller->line.told > before && controller->line.broken == broken;
    if (is_shown && number != WH_OK && (size_t)number < WH_HOST_NUMBERS) {
        ++controller->host->shown[number];
    }
}

void wh_controller_refuse_as(wh_controller_t *controller, const wh_request_t *request,
                             const wh_failure_t *failure) {
    const wh_told_t told = {.request = request, .failure = failure};
    controller->counters.busy += failure->number == WH_STATUS_BUSY ? 1 : 0;
    tell_and_count(controller, WH_ENCODE_REFUSE, &told, true, failure->number);
}

void wh_controller_refuse(wh_controller_t *controller, const wh_request_t *request, wh_status_t number,
                          const char *detail) {
    wh_failure_t failure = {.number = number};
    (void)snprintf(failure.detail, sizeof failure.detail, "%s", detail);
    wh_controller_refuse_as(controller, request, &failure);
}

void wh_controller_tell_now(void *user, wh_result_t *now) {
    const wh_controller_t *controller = user;
    wh_host_texts_t *texts = controller->host->texts;
    char *status = controller->host->texts->status;
    const wh_session_t *session = controller->host->session;
    wh_controller_describe(controller, status);
    *now = (wh_result_t){.answer = "",
                         .status = status,
                         .is_held = wh_controller_is_held(controller),
                         .layout = wh_session_layout(session),
                         .mechanism = &controller->mechanism,
                         .sensors = wh_session_sensors(session),
                         .poses = texts->poses,
                         .controller = texts->controller};
    wh_controller_tell_conditions(controller, texts->controller, sizeof texts->controller);
    wh_session_poses(session, controller->host->texts->poses);
}

void wh_controller_tell_result(wh_controller_t *controller, wh_encoder_t encoder, const wh_request_t *request,
                               wh_status_t number, const char *answer, double seconds) {
    wh_result_t result;
    wh_controller_tell_now(controller, &result);
    result.number = number;
    result.answer = answer;
    result.seconds = seconds;
    const wh_told_t told = {.request = request, .result = &result};
    tell_and_count(controller, encoder, &told, encoder == WH_ENCODE_ANSWER, number);
}

void wh_controller_tell_mistake(wh_controller_t *controller, const wh_request_t *request) {
    char message[WH_SANDBOX_MESSAGE_BYTES];
    wh_utf8_visible(message, sizeof message, controller->dialect->message);
    say_mistake(controller, message);
    wh_controller_refuse(controller, request, WH_STATUS_BAD_ARGUMENT, message);
}
