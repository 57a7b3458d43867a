/* Any bytes as an operator's lines, one after the other in one cell. Each is answered in one line,
 * OK or an error's number. A line that is not understood moves nothing, and the word under the
 * cursor completes to words that can be typed. */
#include <string.h>

#include "fuzz.h"
#include "mcs/session.h"
#include "script/sandbox_internal.h"
#include "snapshot.h"
#include "sound_cell.h"
#include "text/array.h"

#define MEMORY ((size_t)4 << 20)
#define BUDGET 20000
#define LINES 6

static wh_session_t session;

int LLVMFuzzerInitialize(int *argc, char ***argv) {
    const wh_session_options_t options = {.layout = "tests/fuzz/cell.lua",
                                          .limits = {.memory_bytes = MEMORY, .print_to = stderr}};
    (void)argc;
    (void)argv;
    REQUIRE(wh_session_open(&session, &options));
    session.sandbox->budget = BUDGET;
    wh_record_free(&session.record);
    wh_rehearsal_free(&session.mcs.rehearsal);
    fuzz_snapshot_add(session.sandbox, sizeof *session.sandbox);
    fuzz_snapshot_add(&session, sizeof session);
    fuzz_snapshot_take();
    return 0;
}

static void check_answer(wh_status_t status, const char *answer, size_t size) {
    REQUIRE(strlen(answer) < size && fuzz_is_one_line(answer));
    if (status == WH_OK) {
        REQUIRE(strncmp(answer, "OK", 2) == 0);
        return;
    }
    char head[80];
    snprintf(head, sizeof head, "ERROR %d %s", (int)status, wh_status_name(status));
    REQUIRE(strncmp(answer, head, strlen(head)) == 0);
}

static void check_completion(const char *line) {
    wh_candidates_t candidates;
    wh_session_complete(&session, line, &candidates);
    REQUIRE(candidates.start <= strlen(line) && candidates.count <= WH_SESSION_CANDIDATES);
    for (size_t i = 0; i < candidates.count; ++i) {
        REQUIRE(candidates.texts[i] != NULL && candidates.texts[i][0] != '\0');
        REQUIRE(fuzz_is_one_line(candidates.texts[i]));
    }
}

static void execute(const char *line) {
    static char answer[WH_SESSION_ANSWER_BYTES];
    const uint64_t before = wh_grasp_hash(&session.mcs.local.simulator.table);
    /* Now and then the buffer is short, to test the answer's end. */
    const size_t room = strlen(line) % 16 == 15 ? 40 : sizeof answer;
    const wh_status_t status = wh_session_execute(&session, line, answer, room);
    if (room == sizeof answer) {
        check_answer(status, answer, room);
    }
    REQUIRE(strlen(answer) < room);
    if (status == WH_STATUS_NO_SUCH_COMMAND || status == WH_STATUS_BAD_ARGUMENT) {
        REQUIRE(wh_grasp_hash(&session.mcs.local.simulator.table) == before);
    }
    fuzz_check_cell(&session.mcs);
    REQUIRE(session.mcs.recorder.running == WH_NONE && !session.mcs.rehearsal.is_on);
    check_completion(line);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    fuzz_snapshot_restore();
    session.record.script = wh_text_copy("prompt");
    char *const text = malloc(size + 1);
    REQUIRE(text != NULL);
    if (size > 0) {
        memcpy(text, data, size);
    }
    text[size] = '\0';
    char *line = text;
    for (int i = 0; i < LINES && line; ++i) {
        char *const next = strchr(line, '\n');
        if (next) {
            *next = '\0';
        }
        /* RESET makes a new sandbox, which the snapshot does not know:
         * tests/unit/mcs/session_test.c tests it. */
        if (!wh_session_says(line, "RESET")) {
            execute(line);
        }
        line = next ? next + 1 : NULL;
    }
    wh_mcs_close(&session.mcs);
    wh_record_free(&session.record);
    free(text);
    return 0;
}
