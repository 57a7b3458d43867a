/* Any text as a dialect's file, and the bytes that a host sends to it.
 *
 * The text ends at the first byte 1E; frames follow, each ended by such a byte. A text that is no
 * dialect is refused in one line that names the file. In a valid dialect each call keeps its
 * budget. A mistake in any of its functions gives one line that names the file, and its substitute
 * is reported. Nothing that the dialect does to its sandbox ends the process. */
#include <lauxlib.h>
#include <string.h>
#include <sys/mman.h>

#include "fuzz.h"
#include "host/dialect.h"
#include "layout/layout.h"
#include "reading/layout_read.h"

#define FRAME_END 0x1E
/* The largest number in an input. */
#define FRAMES 16

static const char status[] = "phase=idle seq=1965 time=1.965 theta=0 r=300 z=900 yaw=-1.5 "
                             "EE.holds=\"Wafer 1\" PA.holds=none error=42";

static const wh_layout_t *layout;
static wh_port_mechanism_t cell;
static char path[40]; /* the path of a file in memory */
static int file;
static wh_dialect_t dialect;

int LLVMFuzzerInitialize(int *argc, char ***argv) {
    (void)argc;
    (void)argv;
    wh_sandbox_result_t result;
    const wh_sandbox_limits_t limits = {.print_to = stderr};
    wh_sandbox_t *const sandbox = wh_sandbox_new(&limits);
    layout = sandbox ? wh_layout_load(sandbox, "lua/layouts/paper.lua", &result) : NULL;
    REQUIRE(layout != NULL);
    cell = wh_mechanism_all(WH_MECHANISM_CELL, layout);
    file = memfd_create("dialect", 0);
    REQUIRE(file >= 0);
    (void)snprintf(path, sizeof path, "/proc/self/fd/%d", file);
    fuzz_silence();
    return 0;
}

static void put_text(const uint8_t *data, size_t size) {
    REQUIRE(ftruncate(file, 0) == 0);
    REQUIRE(pwrite(file, data, size, 0) == (ssize_t)size);
}

/* ------------------------------------------------------------------------------------------------ mistakes */

static void check_message(void) {
    if (strstr(dialect.message, path) == NULL || !fuzz_is_one_line(dialect.message)) {
        dprintf(STDERR_FILENO, "%s\n", dialect.message);
    }
    REQUIRE(strstr(dialect.message, path) != NULL && fuzz_is_one_line(dialect.message));
}

/* A reply that is no frame is a mistake as well; it is detected before anything is sent. */
static const wh_client_t client = {"motion", 1};
static const wh_pose_t poses[WH_GRIPPERS];

static void check_text(void) {
    uint8_t frame[WH_FRAMING_LINE];
    for (size_t at = 0; dialect.text && at <= dialect.text_size;) {
        const char *body = dialect.text + at;
        const char *end = memchr(body, 0, dialect.text_size - at);
        const size_t size = end ? (size_t)(end - body) : dialect.text_size - at;
        const size_t framed =
            wh_framing_encode(&dialect.replies, dialect.text_start, (const uint8_t *)body, size, frame);
        REQUIRE(framed <= dialect.replies.longest);
        at += size + 1;
    }
}

static void tell(wh_encoder_t encoder, const wh_told_t *told) {
    wh_failure_t failure;
    if (wh_dialect_encode(&dialect, encoder, told)) {
        check_text();
    } else if (!wh_dialect_refused(&dialect, &failure)) {
        check_message();
    }
}

/* ------------------------------------------------------------------------------------------------- frames */

/* The outcomes: success, and an error that the input's bytes choose. */
static void answer(const wh_request_t *request, size_t size) {
    const wh_status_t number = (wh_status_t)(1 + size % 127);
    wh_result_t result = {.answer = "OK wafer=\"Wafer 1\" codes=1024 seconds=1.965",
                          .status = status,
                          .seconds = 1.965,
                          .layout = layout,
                          .mechanism = &cell,
                          .sensors = 1,
                          .poses = poses};
    const wh_told_t told = {.request = request, .result = &result};
    const wh_failure_t failure = {.number = number, .detail = "so it is"};
    const wh_told_t refusal = {.request = request, .failure = &failure};
    tell(WH_ENCODE_ACKNOWLEDGE, &(wh_told_t){.request = request});
    tell(WH_ENCODE_ANSWER, &told);
    tell(WH_ENCODE_COMPLETE, &told);
    result.number = number;
    result.answer = "ERROR 42 WAFER_MISSING: refused";
    result.is_held = true;
    tell(WH_ENCODE_COMPLETE, &told);
    tell(WH_ENCODE_REFUSE, &refusal);
}

static void see_now(void *user, wh_result_t *now) {
    (void)user;
    *now = (wh_result_t){
        .answer = "", .status = status, .layout = layout, .mechanism = &cell, .sensors = 1, .poses = poses};
}

static void run(const wh_request_t *request, size_t size) {
    static wh_lines_t lines;
    wh_failure_t failure;
    const wh_decoded_t outcome = wh_dialect_run(&dialect, request, see_now, NULL, &lines, &failure);
    REQUIRE(lines.count <= WH_DIALECT_LINES);
    if (outcome == WH_DECODED_MISTAKE) {
        check_message();
    } else if (outcome == WH_DECODED_REQUEST) {
        REQUIRE(lines.count >= 1);
        answer(request, size);
    }
}

static void take(const uint8_t *body, size_t size) {
    wh_request_t request;
    wh_failure_t failure;
    const wh_frame_t frame = {.kind = WH_FRAME_GOOD, .body = body, .body_size = size};
    const wh_decoded_t outcome = wh_dialect_decode(&dialect, &client, &frame, &request, &failure);
    if (outcome == WH_DECODED_MISTAKE) {
        check_message();
    } else if (outcome == WH_DECODED_REQUEST) {
        REQUIRE(request.command != NULL);
        run(&request, size);
    }
    wh_dialect_forget(&dialect, &request);
}

static void take_frames(const uint8_t *data, size_t size) {
    for (size_t at = 0, count = 0; at < size && count < FRAMES; ++count) {
        const uint8_t *end = memchr(data + at, FRAME_END, size - at);
        const size_t length = end ? (size_t)(end - data) - at : size - at;
        take(data + at, length);
        at += length + 1;
    }
}

static void tell_of_events(void) {
    const wh_host_event_t event = {.kind = "slot_occupied",
                                   .is_complaint = true,
                                   .wafer = "Wafer 1",
                                   .gripper = "EE",
                                   .seconds = 1.158,
                                   .value = 1,
                                   .client = client};
    tell(WH_ENCODE_EVENT, &(wh_told_t){.event = &event});
    tell(WH_ENCODE_BAD, &(wh_told_t){.reason = "bad sum"});
    tell(WH_ENCODE_UNACKNOWLEDGED, &(wh_told_t){.reason = NULL});
}

/* A client comes and goes, and a tester says something. */
static void call_hooks(void) {
    static wh_lines_t lines;
    wh_failure_t failure;
    bool stops = false;
    if (wh_dialect_welcome(&dialect, &client)) {
        check_text();
    } else {
        check_message();
    }
    if (wh_dialect_tell(&dialect, "estop on", &stops, &lines, &failure) == WH_DECODED_MISTAKE) {
        check_message();
    }
    if (!wh_dialect_part(&dialect, &client, &lines)) {
        check_message();
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    const uint8_t *const end = size > 0 ? memchr(data, FRAME_END, size) : NULL;
    const size_t length = end ? (size_t)(end - data) : size;
    put_text(data, length);
    if (!wh_dialect_open(&dialect, path, NULL)) {
        check_message();
    } else if (!wh_dialect_fits(&dialect, layout)) {
        check_message();
    } else {
        take_frames(data + length + 1, end ? size - length - 1 : 0);
        tell_of_events();
        call_hooks();
    }
    wh_dialect_close(&dialect);
    return 0;
}
