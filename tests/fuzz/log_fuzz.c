/* Any bytes as a recording, read and stepped again as `waferhand replay` does it. The reader's
 * places add up, and so do the counts of each run. The exit status reports the findings, and --json
 * prints JSON. A block of slices that can be decoded can be encoded, to the same slices.
 *
 * Mutation changes single events, so that lengths and sync words of a log are right more often than
 * by chance. */
#include <fcntl.h>
#include <jansson.h>
#include <string.h>
#include <sys/mman.h>

#include "app/app.h"
#include "fuzz.h"
#include "log/log_run.h"
#include "print/record_print.h"
#include "report/document.h"
#include "wire/slices.h"

#define HEADER 28

static int file = -1;
static char path[64];

int LLVMFuzzerInitialize(int *argc, char ***argv) {
    (void)argc;
    (void)argv;
    file = memfd_create("log", 0);
    snprintf(path, sizeof path, "/proc/self/fd/%d", file);
    REQUIRE(file >= 0);
    fuzz_silence();
    return 0;
}

static void put_file(const uint8_t *data, size_t size) {
    REQUIRE(ftruncate(file, 0) == 0);
    REQUIRE(pwrite(file, data, size, 0) == (ssize_t)size);
}

/* ------------------------------------------------------------------------------------------------- replaying */

static void check_runs(const wh_replay_t *replay) {
    REQUIRE(replay->run_count <= WH_REPLAY_RUNS && replay->cell_count <= WH_REPLAY_CELLS);
    for (size_t i = 0; i < replay->run_count; ++i) {
        const wh_replay_run_t *const run = &replay->runs[i];
        REQUIRE(run->slices.compared >= 0 && run->slices.unanswered >= 0 && run->slices.outside_valves >= 0 &&
                run->slices.taken_up >= 0);
        REQUIRE(run->slices.differing >= 0 && run->slices.differing <= run->slices.compared);
        REQUIRE(memchr(run->difference.what, '\0', sizeof run->difference.what) != NULL);
        REQUIRE(run->first_slice <= run->last_slice);
        for (size_t other = 0; other < i; ++other) {
            REQUIRE(replay->runs[other].run != run->run);
        }
    }
}

/* Hashes a block's data; another block with the same data gives the same value. */
static void give(const wh_slices_t *slices, wh_slices_t *to) {
    waferhand_command command;
    int32_t told[WH_GRIPPERS];
    uint64_t hash;
    to->count = 0;
    for (size_t i = 0; i < slices->count; ++i) {
        wh_slices_get(slices, i, &command, told, &hash);
        REQUIRE(wh_slices_add(to, &command, told, hash));
    }
}

static void check_slices(const uint8_t *data, size_t size) {
    static wh_slices_t slices;
    static wh_slices_t again;
    static uint8_t bytes[WH_SLICES_BYTES];
    if (!wh_slices_decode(data, size, &slices)) {
        return;
    }
    give(&slices, &again);
    REQUIRE(again.count == slices.count);
    for (size_t from = 0, at = 0; from < again.count; at = from) {
        const size_t length = wh_slices_encode(&again, &from, bytes);
        REQUIRE(wh_slices_decode(bytes, length, &slices) && slices.count == from - at);
        REQUIRE(memcmp(slices.hash, again.hash + at, slices.count * sizeof *slices.hash) == 0);
        REQUIRE(memcmp(slices.valves, again.valves + at, slices.count) == 0);
        for (size_t c = 0; c < again.axes + 12 * again.grippers; ++c) {
            REQUIRE(memcmp(slices.column[c], again.column[c] + at, slices.count * sizeof(uint64_t)) == 0);
        }
    }
}

static void check_event(const wh_log_t *log, wh_log_result_t result, uint64_t *count) {
    *count += result == WH_LOG_EVENT ? 1 : 0;
    if (result == WH_LOG_EVENT && strcmp(log->channel, WH_CHANNEL_SLICES) == 0) {
        check_slices(log->data, log->size);
    }
    REQUIRE(log->count == *count && log->size <= WH_LOG_EVENT_BYTES);
    REQUIRE(strlen(log->channel) < sizeof log->channel);
}

/* Places add up: no part of the file is left out, and none is read twice. */
static void check_places(FILE *in, wh_log_t *log, size_t size) {
    uint64_t count = 0;
    uint64_t end = 0;
    wh_log_open(log, in);
    if (log->source.zstd) {
        return;
    }
    wh_log_result_t result = wh_log_next(log);
    for (; result == WH_LOG_EVENT || result == WH_LOG_DAMAGED; result = wh_log_next(log)) {
        check_event(log, result, &count);
        REQUIRE(log->offset == end && log->offset < log->next && log->next <= size);
        end = log->next;
    }
    REQUIRE(log->offset == end && (result == WH_LOG_CUT || end == size));
}

/* Reads the whole log; returns its findings. */
static wh_reading_verdict_t read_log(size_t size) {
    static wh_replay_t replay;
    static wh_log_t log;
    wh_reading_t reading;
    FILE *const in = fopen(path, "rb");
    REQUIRE(in != NULL);
    check_places(in, &log, size);
    memset(&replay, 0, sizeof replay);
    const wh_log_files_t files = {.files = {in}, .count = 1};
    wh_reading_replay(&files, &log, &replay, &reading);
    check_runs(&replay);
    const wh_reading_verdict_t verdict = wh_reading_judge(&replay, &reading, false, NULL);
    const wh_reading_verdict_t lenient = wh_reading_judge(&replay, &reading, true, NULL);
    /* Leniency excuses missing data, and nothing else. */
    REQUIRE(verdict == lenient || verdict == WH_READING_INCOMPLETE);
    REQUIRE(verdict != WH_READING_SAME || (reading.damage_count == 0 && !reading.is_cut));
    wh_replay_close(&replay);
    wh_log_close(&log);
    fclose(in);
    return verdict;
}

/* ------------------------------------------------------------------------------------------------- reporting */

/* All data that can be read can be shown, as JSON that can be read back. */
static void report(void) {
    static wh_log_run_t run;
    const wh_log_run_options_t options = {.path = path};
    char *text = NULL;
    size_t size = 0;
    if (wh_log_run_read(&run, &options)) {
        FILE *const out = open_memstream(&text, &size);
        json_t *const record = wh_record_to_json(&run.record);
        const wh_document_t document = {.title = "log",
                                        .reproduce = "",
                                        .source = "log",
                                        .notes = run.notes.texts,
                                        .note_count = run.notes.count,
                                        .run = record,
                                        .record = &run.record,
                                        .signals = &run.signals};
        REQUIRE(out != NULL && record != NULL && wh_document_write(&document, out) == 0 && fclose(out) == 0);
        json_t *const read = json_loadb(text, size, 0, NULL);
        REQUIRE(read != NULL && !memchr(text, '<', size));
        json_decref(read);
        json_decref(record);
        free(text);
    } else {
        REQUIRE(fuzz_is_one_line(run.message));
    }
    wh_log_run_close(&run);
}

/* ---------------------------------------------------------------------------------------------- the program */

/* Runs a subcommand with standard output in memory; the caller frees it. */
static char *print(int *status, int argc, char **argv) {
    char *text = NULL;
    size_t size = 0;
    FILE *const real = stdout;
    FILE *const out = open_memstream(&text, &size);
    REQUIRE(out != NULL);
    stdout = out;
    *status = wh_app_replay(argc, argv);
    stdout = real;
    fclose(out);
    return text;
}

static void check_program(wh_reading_verdict_t verdict) {
    static char name[] = "replay";
    static char option[] = "--json";
    char *with_json[] = {name, option, path, NULL};
    char *without[] = {name, path, NULL};
    int status = 0;
    int again = 0;
    char *const text = print(&status, 3, with_json);
    free(print(&again, 2, without));
    REQUIRE(status == again && status == (int)verdict);
    json_t *const json = json_loads(text, 0, NULL);
    REQUIRE(json != NULL || text[0] == '\0');
    json_decref(json);
    free(text);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    put_file(data, size);
    check_program(read_log(size));
    /* It costs ten times as much. */
    if (size % 8 == 0) {
        report();
    }
    return 0;
}

/* ------------------------------------------------------------------------------------------------- mutation */

static uint32_t number_at(const uint8_t *data, size_t at) {
    return (uint32_t)data[at] << 24 | (uint32_t)data[at + 1] << 16 | (uint32_t)data[at + 2] << 8 |
           data[at + 3];
}

static void put_number(uint8_t *data, size_t at, uint32_t value) {
    for (size_t i = 0; i < 4; ++i) {
        data[at + i] = (uint8_t)(value >> (24 - 8 * i) & 0xffU);
    }
}

/* The length of the event at the beginning of this many bytes, 0 if there is none. */
static size_t event_length(const uint8_t *data, size_t left) {
    if (left < HEADER) {
        return 0;
    }
    const uint64_t length = (uint64_t)HEADER + number_at(data, 20) + number_at(data, 24);
    return length <= left ? (size_t)length : 0;
}

/* Changes one event's data, and corrects its length and check. Returns the log's new size. */
static size_t mutate_event(uint8_t *data, size_t at, size_t size, size_t max_size, bool seal) {
    static uint8_t rest[1 << 16];
    const size_t begin = at + HEADER + number_at(data, at + 20);
    const size_t old_size = number_at(data, at + 24);
    const size_t behind = size - begin - old_size;
    if (behind > sizeof rest || begin + behind >= max_size) {
        return LLVMFuzzerMutate(data, size, max_size);
    }
    memcpy(rest, data + begin + old_size, behind);
    const size_t new_size = LLVMFuzzerMutate(data + begin, old_size, max_size - begin - behind);
    put_number(data, at + 24, (uint32_t)new_size);
    if (seal) {
        wh_link_seal(data + begin, new_size);
    }
    memcpy(data + begin + new_size, rest, behind);
    return begin + new_size + behind;
}

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max_size, unsigned int seed) {
    size_t starts[64];
    size_t count = 0;
    size_t at = 0;
    for (size_t length = event_length(data, size); length > 0 && count < sizeof starts / sizeof starts[0];
         length = event_length(data + at, size - at)) {
        starts[count++] = at;
        at += length;
    }
    if (count == 0 || seed % 8 == 0) {
        return LLVMFuzzerMutate(data, size, max_size);
    }
    return mutate_event(data, starts[seed / 16 % count], size, max_size, (seed & 8) != 0);
}
