/* Any frames to each of lua/dialects, in its sandbox, in the way a controller receives them.
 *
 * The first byte chooses the dialect. Frames follow, each ended by the byte 1E. A frame that begins
 * with the byte 1D goes to the framer unchanged; the rest become bodies of good frames. Nothing
 * that a host sends is a mistake in the dialect. Its functions keep their budgets, each request
 * becomes lines that an operator could type, and every result is reported in frames that a host can
 * read. */
#include <stdlib.h>
#include <string.h>

#include <lauxlib.h>

#include "fuzz.h"
#include "host/dialect.h"
#include "script/sandbox_internal.h"
#include "snapshot.h"

#define FRAME_END 0x1E
#define AS_IT_IS 0x1D

static const char *const paths[] = {"lua/dialects/prompt.lua",       "lua/dialects/words.lua",
                                    "lua/dialects/dollar.lua",       "lua/dialects/verbs.lua",
                                    "lua/dialects/control.lua",      "lua/dialects/numbered.lua",
                                    "lua/dialects/numbered_port.lua"};
static const wh_client_t client = {"", 1};
static const char status[] =
    "phase=idle seq=1965 time=1.965 theta=0 r=300 z=900 yaw=-1.5 EE.holds=\"Wafer 1\" PA.holds=none "
    "error=42";

#define DIALECTS (sizeof paths / sizeof paths[0])

static wh_dialect_t dialects[DIALECTS];
static wh_dialect_t *dialect; /* one of them */
static wh_framer_t framer;

int LLVMFuzzerInitialize(int *argc, char ***argv) {
    (void)argc;
    (void)argv;
    for (size_t i = 0; i < DIALECTS; ++i) {
        REQUIRE(wh_dialect_open(&dialects[i], paths[i], NULL));
        fuzz_snapshot_add(dialects[i].sandbox, sizeof *dialects[i].sandbox);
    }
    fuzz_snapshot_take();
    return 0;
}

/* ------------------------------------------------------------------------------------------------ answers */

/* Each body is a frame, so the dialect makes no mistake. */
static void check_text(wh_encoder_t encoder, bool made) {
    uint8_t frame[WH_FRAMING_LINE];
    if (!made) {
        dprintf(STDERR_FILENO, "%s: %s\n", wh_encoder_names[encoder], dialect->message);
    }
    REQUIRE(made);
    for (size_t at = 0; dialect->text && at <= dialect->text_size;) {
        const char *body = dialect->text + at;
        const char *end = memchr(body, 0, dialect->text_size - at);
        const size_t size = end ? (size_t)(end - body) : dialect->text_size - at;
        const size_t framed =
            wh_framing_encode(&dialect->replies, dialect->text_start, (const uint8_t *)body, size, frame);
        if (framed == 0) {
            dprintf(STDERR_FILENO, "%s: no body: %.*s\n", wh_encoder_names[encoder], (int)size, body);
        }
        REQUIRE(framed > 0);
        at += size + 1;
    }
}

static void tell(wh_encoder_t encoder, const wh_told_t *told) {
    wh_failure_t failure;
    bool made = wh_dialect_encode(dialect, encoder, told);
    if (!made && encoder == WH_ENCODE_ANSWER && wh_dialect_refused(dialect, &failure)) {
        const wh_told_t refusal = {.request = told->request, .failure = &failure};
        encoder = WH_ENCODE_REFUSE;
        made = wh_dialect_encode(dialect, encoder, &refusal);
    }
    check_text(encoder, made);
}

static void refuse(const wh_request_t *request, const wh_failure_t *failure) {
    const wh_told_t told = {.request = request, .failure = failure};
    tell(WH_ENCODE_REFUSE, &told);
}

/* The outcomes: success, and an error that the input's bytes choose. */
static void answer(const wh_request_t *request, wh_encoder_t encoder, const wh_lines_t *lines, size_t size) {
    const wh_status_t number = (wh_status_t)(1 + size % 127);
    char error[200];
    (void)snprintf(error, sizeof error, "ERROR %d %s: refused", (int)number, wh_status_name(number));
    const char *well = request->command->kind == WH_WORD_LOCAL
                           ? lines->lines[0]
                           : "OK version=0.1.0 codes=1024 wafer=\"Wafer 1\" "
                             "seconds=1.965";
    wh_result_t result = {.answer = well, .status = status, .seconds = 1.965, .sensors = 1};
    const wh_told_t told = {.request = request, .result = &result};
    tell(encoder, &told);
    result = (wh_result_t){.number = number, .answer = error, .status = status, .is_held = true};
    tell(encoder, &told);
}

/* ------------------------------------------------------------------------------------------------- frames */

static void check_outcome(wh_decoded_t outcome) {
    if (outcome == WH_DECODED_MISTAKE) {
        dprintf(STDERR_FILENO, "%s\n", dialect->message);
    }
    REQUIRE(outcome != WH_DECODED_MISTAKE);
}

static void check_lines(const wh_lines_t *lines, wh_word_kind_t kind) {
    for (size_t i = 0; i < lines->count; ++i) {
        REQUIRE(strlen(lines->lines[i]) < sizeof lines->lines[i]);
        REQUIRE(kind == WH_WORD_LOCAL || wh_word_of(lines->lines[i]));
    }
}

static void take_request(const wh_request_t *request, size_t size) {
    static wh_lines_t lines;
    wh_failure_t failure;
    const wh_word_kind_t kind = request->command->kind;
    const wh_told_t told = {.request = request};
    if (kind == WH_WORD_ACKN) {
        return;
    }
    const bool has_lines = kind != WH_WORD_STOP && kind != WH_WORD_HOLD && kind != WH_WORD_RESUME;
    const wh_decoded_t outcome =
        has_lines ? wh_dialect_run(dialect, request, NULL, NULL, &lines, &failure) : WH_DECODED_REQUEST;
    check_outcome(outcome);
    if (outcome == WH_DECODED_REFUSED) {
        refuse(request, &failure);
        return;
    }
    if (has_lines) {
        check_lines(&lines, kind);
    }
    if (kind == WH_WORD_ACTION) {
        tell(WH_ENCODE_ACKNOWLEDGE, &told);
    }
    answer(request, kind == WH_WORD_ACTION ? WH_ENCODE_COMPLETE : WH_ENCODE_ANSWER, &lines, size);
}

static void take(const wh_frame_t *frame) {
    wh_request_t request;
    wh_failure_t failure;
    if (frame->kind != WH_FRAME_GOOD) {
        const wh_told_t told = {.reason = wh_frame_kind_name(frame->kind)};
        tell(WH_ENCODE_BAD, &told);
        return;
    }
    const wh_decoded_t outcome = wh_dialect_decode(dialect, &client, frame, &request, &failure);
    check_outcome(outcome);
    if (outcome == WH_DECODED_REFUSED) {
        refuse(&request, &failure);
    } else if (outcome == WH_DECODED_REQUEST) {
        REQUIRE(request.command && strlen(request.sequence) < sizeof request.sequence);
        take_request(&request, frame->body_size);
    }
    wh_dialect_forget(dialect, &request);
}

static void feed(const uint8_t *bytes, size_t size) {
    wh_frame_t frame;
    size_t at = 0;
    do {
        at += wh_framer_feed(&framer, bytes + at, size - at, 0, &frame);
        if (frame.kind != WH_FRAME_NONE) {
            take(&frame);
        }
    } while (frame.kind != WH_FRAME_NONE || at < size);
}

static void take_piece(const uint8_t *data, size_t size) {
    uint8_t bytes[WH_FRAMING_LINE];
    if (size > 0 && data[0] == AS_IT_IS) {
        feed(data + 1, size - 1);
        return;
    }
    feed(bytes, wh_framing_encode(&dialect->framing, 0, data, size, bytes));
}

static void tell_of_events(void) {
    const wh_host_event_t event = {.kind = "slot_occupied",
                                   .is_complaint = true,
                                   .wafer = "Wafer 1",
                                   .gripper = "EE",
                                   .seconds = 1.158,
                                   .value = -1,
                                   .client = client};
    const wh_told_t told = {.event = &event};
    const wh_told_t nothing = {.reason = NULL};
    tell(WH_ENCODE_EVENT, &told);
    tell(WH_ENCODE_UNACKNOWLEDGED, &nothing);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size == 0) {
        return 0;
    }
    dialect = &dialects[data[0] % DIALECTS];
    REQUIRE(wh_framer_init(&framer, &dialect->framing));
    for (size_t at = 1; at < size;) {
        const uint8_t *end = memchr(data + at, FRAME_END, size - at);
        const size_t length = end ? (size_t)(end - data) - at : size - at;
        take_piece(data + at, length);
        at += length + 1;
    }
    tell_of_events();
    free(dialect->text);
    dialect->text = NULL;
    fuzz_snapshot_restore();
    return 0;
}
