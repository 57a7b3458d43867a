#include "dialect_say.h"

#include <stdio.h>
#include <string.h>

#include "../host/transcript.h"

/* Prints the bytes of a frame as a transcript has them. */
static void print_bytes(const char *sign, const uint8_t *bytes, size_t size) {
    char shown[4 * WH_FRAMING_LINE + 1];
    (void)wh_transcript_escape(shown, sizeof shown, bytes, size);
    printf("%s \"%s\"\n", sign, shown);
}

/* Prints the bodies that an encoder made as frames; none if it made none. */
static bool print_reply(const wh_dialect_t *dialect) {
    uint8_t frame[WH_FRAMING_LINE];
    bool good = true;
    for (size_t at = 0; dialect->text && at <= dialect->text_size && good;) {
        const char *body = dialect->text + at;
        const char *end = memchr(body, 0, dialect->text_size - at);
        const size_t length = end ? (size_t)(end - body) : dialect->text_size - at;
        const size_t size =
            wh_framing_encode(&dialect->replies, dialect->text_start, (const uint8_t *)body, length, frame);
        good = size > 0;
        if (good) {
            print_bytes("<", frame, size);
        }
        at += length + 1;
    }
    if (!good) {
        fprintf(stderr, "%s: its answer is no body of a frame\n", dialect->path);
    }
    return good;
}

static bool print_encoded(wh_dialect_t *dialect, wh_encoder_t encoder, const wh_told_t *told) {
    wh_failure_t failure;
    bool made = wh_dialect_encode(dialect, encoder, told);
    if (!made && wh_dialect_refused(dialect, &failure)) {
        const wh_told_t refusal = {.request = told->request, .failure = &failure};
        made = wh_dialect_encode(dialect, WH_ENCODE_REFUSE, &refusal);
    }
    if (!made) {
        fprintf(stderr, "%s\n", dialect->message);
    }
    return made && print_reply(dialect);
}

/* Nothing runs and nothing is known here: only what the dialect says by itself is an answer. */
static bool say_request(wh_dialect_t *dialect, const wh_request_t *request) {
    static wh_lines_t lines;
    wh_failure_t failure;
    const wh_dialect_command_t *command = request->command;
    const wh_decoded_t outcome = wh_dialect_run(dialect, request, NULL, NULL, &lines, &failure);
    if (outcome == WH_DECODED_REFUSED) {
        return print_encoded(dialect, WH_ENCODE_REFUSE,
                             &(wh_told_t){.request = request, .failure = &failure});
    }
    if (outcome == WH_DECODED_MISTAKE) {
        fprintf(stderr, "%s\n", dialect->message);
        return false;
    }
    if (command->kind == WH_WORD_LOCAL) {
        const wh_result_t result = {.answer = lines.lines[0], .status = ""};
        return print_encoded(dialect, WH_ENCODE_ANSWER, &(wh_told_t){.request = request, .result = &result});
    }
    for (size_t i = 0; i < lines.count; ++i) {
        printf("  %s\n", lines.lines[i]);
    }
    return command->kind != WH_WORD_ACTION || command->when == WH_WHEN_AT_ONCE ||
           print_encoded(dialect, WH_ENCODE_ACKNOWLEDGE, &(wh_told_t){.request = request});
}

/* The port of PORT:FRAME, where a dialect has several; the frame begins behind it. Null: none is named. */
static const char *take_port(const wh_dialect_clients_t *clients, const char **body) {
    for (size_t i = 0; i < clients->port_count; ++i) {
        const size_t length = strlen(clients->ports[i]);
        if (strncmp(*body, clients->ports[i], length) == 0 && (*body)[length] == ':') {
            *body += length + 1;
            return clients->ports[i];
        }
    }
    return clients->port_count > 1 ? NULL : clients->ports[0];
}

static bool refuse_port(const wh_dialect_clients_t *clients, const char *body) {
    fprintf(stderr, "--say %s: no port (expected PORT:FRAME, with a port of ", body);
    for (size_t i = 0; i < clients->port_count; ++i) {
        fprintf(stderr, "%s%s", i > 0 ? ", " : "", clients->ports[i]);
    }
    fputs(")\n", stderr);
    return false;
}

/* Where a line may carry several units: for which one the frame is. */
static bool print_unit(wh_dialect_t *dialect, const char *body) {
    char unit[WH_DIALECT_NAME_BYTES];
    if (!dialect->clients.knows_units) {
        return true;
    }
    if (!wh_dialect_unit_of(dialect, body, strlen(body), unit)) {
        fprintf(stderr, "%s\n", dialect->message);
        return false;
    }
    printf("  for unit %s\n", unit[0] != '\0' ? unit : "none");
    return true;
}

static bool say_frame(wh_dialect_t *dialect, const char *body) {
    wh_client_t client = {"", 1};
    uint8_t frame[WH_FRAMING_LINE];
    wh_request_t request;
    wh_failure_t failure;
    client.port = take_port(&dialect->clients, &body);
    if (!client.port) {
        return refuse_port(&dialect->clients, body);
    }
    const size_t size = wh_framing_encode(&dialect->framing, 0, (const uint8_t *)body, strlen(body), frame);
    if (size == 0) {
        fprintf(stderr, "--say %s: no body of a frame (expected none of the marks of a start or an end)\n",
                body);
        return false;
    }
    print_bytes(">", frame, size);
    if (!print_unit(dialect, body)) {
        return false;
    }
    const wh_frame_t said = {.kind = WH_FRAME_GOOD, .body = (const uint8_t *)body, .body_size = strlen(body)};
    const wh_decoded_t outcome = wh_dialect_decode(dialect, &client, &said, &request, &failure);
    bool good = outcome != WH_DECODED_MISTAKE;
    if (outcome == WH_DECODED_REQUEST) {
        good = say_request(dialect, &request);
    } else if (outcome == WH_DECODED_REFUSED) {
        good =
            print_encoded(dialect, WH_ENCODE_REFUSE, &(wh_told_t){.request = &request, .failure = &failure});
    } else if (!good) {
        fprintf(stderr, "%s\n", dialect->message);
    }
    wh_dialect_forget(dialect, &request);
    return good;
}

bool wh_dialect_say(wh_dialect_t *dialect, const wh_option_list_t *bodies) {
    bool good = true;
    for (size_t i = 0; i < bodies->count && good; ++i) {
        good = say_frame(dialect, bodies->items[i]);
    }
    return good;
}
