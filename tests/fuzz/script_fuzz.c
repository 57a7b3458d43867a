/* Any text as a motion script. It ends within its budget and memory, its error is one line that
 * begins with its name, the cell is sound, and its report is JSON. Now and then the same text runs
 * twice, to the same bits. */
#include <jansson.h>
#include <string.h>

#include "fuzz.h"
#include "mcs/mcs.h"
#include "print/record_print.h"
#include "script/sandbox_internal.h"
#include "snapshot.h"
#include "sound_cell.h"
#include "text/array.h"

#define NAME "tests/fuzz/script.lua"
#define MEMORY ((size_t)4 << 20)
#define BUDGET 20000
/* The amount by which one charge may exceed the budget. No charge is for more than all memory, read
 * at one step for each byte. */
#define OVERDRAFT MEMORY

static wh_sandbox_t *sandbox;
static wh_mcs_t mcs;
static wh_record_t record;
static FILE *nowhere;

static int name_cell(lua_State *L) {
    lua_getglobal(L, "cell");
    lua_pushliteral(L, "cell.lua");
    lua_call(L, 1, 0);
    return 0;
}

int LLVMFuzzerInitialize(int *argc, char ***argv) {
    (void)argc;
    (void)argv;
    nowhere = fopen("/dev/null", "w");
    const wh_sandbox_limits_t limits = {.memory_bytes = MEMORY, .print_to = nowhere};
    wh_sandbox_result_t result;
    sandbox = wh_sandbox_new(&limits);
    REQUIRE(nowhere && sandbox && wh_mcs_open(&mcs, sandbox, NAME, &record, &result));
    mcs.wanted.keeps_segments = true;
    lua_pushcfunction(sandbox->main, name_cell);
    REQUIRE(wh_sandbox_call(sandbox->main, 0, 0, &result));
    sandbox->budget = BUDGET;
    wh_sandbox_renew(sandbox);
    wh_record_free(&record);
    wh_rehearsal_free(&mcs.rehearsal);
    fuzz_snapshot_add(sandbox, sizeof *sandbox);
    fuzz_snapshot_add(&mcs, sizeof mcs);
    fuzz_snapshot_add(&record, sizeof record);
    fuzz_snapshot_take();
    return 0;
}

static void begin(void) {
    fuzz_snapshot_restore();
    record.script = wh_text_copy(NAME);
}

static void end(void) {
    wh_mcs_close(&mcs);
    wh_record_free(&record);
}

static void check_result(bool ok, const wh_sandbox_result_t *result) {
    REQUIRE(ok == (result->status == WH_SANDBOX_OK));
    REQUIRE(ok == (result->message[0] == '\0'));
    REQUIRE(ok || strncmp(result->message, NAME ":", sizeof NAME) == 0);
    REQUIRE(fuzz_is_one_line(result->message));
    REQUIRE(wh_sandbox_memory_high_water(sandbox) <= MEMORY);
    REQUIRE(wh_sandbox_spent(sandbox) <= BUDGET + OVERDRAFT);
    REQUIRE(result->status == WH_SANDBOX_BUDGET || wh_sandbox_spent(sandbox) <= BUDGET);
}

static void check_report(void) {
    static const wh_style_t style = {.utf8 = true, .width = 80};
    char *text = NULL;
    size_t size = 0;
    FILE *const out = open_memstream(&text, &size);
    REQUIRE(out && wh_record_print_json(&record, out) == 0);
    fclose(out);
    json_t *const json = json_loadb(text, size, 0, NULL);
    REQUIRE(json != NULL);
    REQUIRE(json_array_size(json_object_get(json, "commands")) == record.command_count);
    REQUIRE(json_array_size(json_object_get(json, "wafers")) == mcs.layout->wafer_count);
    json_decref(json);
    free(text);
    const wh_record_sections_t all = {.gantt = true, .cycle = true, .margins = true};
    REQUIRE(wh_record_print_table(&record, nowhere, &style, &all) == 0);
}

/* After an input a sandbox still does its work once it has a new budget. */
static void check_usable(void) {
    static const char text[] = "return 6 * 7";
    lua_State *const L = wh_sandbox_state(sandbox);
    wh_sandbox_renew(sandbox);
    REQUIRE(wh_sandbox_evaluate_text(L, "after", text, sizeof text - 1, NULL) && lua_tointeger(L, -1) == 42);
    lua_pop(L, 1);
}

/* Runs the script; returns a hash of all its results. */
static uint64_t run(const uint8_t *data, size_t size) {
    wh_sandbox_result_t result;
    lua_State *const L = wh_sandbox_state(sandbox);
    const int top = lua_gettop(L);
    const bool ok = wh_sandbox_evaluate_text(L, NAME, (const char *)data, size, &result);
    REQUIRE(lua_gettop(L) == top + (ok ? 1 : 0));
    lua_settop(L, top);
    check_result(ok, &result);
    fuzz_check_cell(&mcs);
    wh_mcs_finish(&mcs);
    return record.hash ^ wh_sandbox_spent(sandbox) ^ (uint64_t)result.status << 32;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    begin();
    const uint64_t bits = run(data, size);
    if (record.command_count > 0 || record.expectation_count > 0) {
        check_report();
    }
    check_usable();
    end();
    if (bits % 8 == 0) {
        begin();
        REQUIRE(run(data, size) == bits);
        end();
    }
    return 0;
}
