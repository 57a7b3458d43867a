/* Any text as a layout. It is refused in one line that names the file, or it is a cell that can be
 * set up unchanged, sent in a message, and read back from it. In a second sandbox the same text is
 * refused or read alike. */
#include <lauxlib.h>
#include <string.h>

#include "fuzz.h"
#include "layout/layout.h"
#include "motion/track.h"
#include "reading/layout_read.h"
#include "script/sandbox.h"
#include "sim/simulator.h"
#include "wire/messages.h"

#define NAME "layout.lua"
#define MEMORY ((size_t)2 << 20)
#define BUDGET 20000

typedef struct {
    const char *text;
    size_t size;
    const wh_layout_t *layout;
} job_t;

/* Loads as wh_layout_load does, but from memory. It runs protected. */
static int load(lua_State *L) {
    job_t *const job = lua_touserdata(L, 1);
    wh_sandbox_result_t result;
    if (!wh_sandbox_evaluate_text(L, NAME, job->text, job->size, &result)) {
        lua_pushstring(L, result.message);
        return lua_error(L);
    }
    job->layout = wh_layout_read(L, NAME);
    return 0;
}

static const wh_layout_t *read_layout(wh_sandbox_t *sandbox, const uint8_t *data, size_t size,
                                      wh_sandbox_result_t *result) {
    job_t job = {(const char *)data, size, NULL};
    lua_State *const L = wh_sandbox_state(sandbox);
    lua_pushcfunction(L, load);
    lua_pushlightuserdata(L, &job);
    return wh_sandbox_call(L, 1, 0, result) ? job.layout : NULL;
}

static void check_names(const wh_layout_t *layout) {
    for (size_t s = 0; s < layout->station_count; ++s) {
        REQUIRE(wh_layout_find_station(layout, layout->stations[s].name) == (int32_t)s);
    }
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        REQUIRE(wh_layout_find_gripper(layout, layout->grippers[g].name) == (int32_t)g);
    }
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        const wh_layout_wafer_t *const wafer = &layout->wafers[w];
        REQUIRE(wh_layout_find_wafer(layout, wafer->name) == (int32_t)w);
        REQUIRE(wafer->station >= 0 && (size_t)wafer->station < layout->station_count);
        REQUIRE(wafer->slot >= 1 && wafer->slot <= layout->places[wafer->station].slots);
        REQUIRE(wafer->name[0] != '\0' && fuzz_is_one_line(wafer->name));
    }
}

static void check_set_up(const wh_layout_t *layout) {
    const wh_cell_t cell = layout->cell;
    wh_gripper_t grippers[WH_GRIPPERS];
    wh_simulator_t simulator;
    wh_track_t track;
    wh_wafer_t *const wafers = calloc(layout->wafer_count + 1, sizeof *wafers);
    REQUIRE(wafers != NULL);
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        wafers[w] = layout->start[w];
    }
    const wh_grasp_storage_t storage = {.wafers = wafers,
                                        .wafer_count = layout->wafer_count,
                                        .grippers = grippers,
                                        .gripper_count = layout->machine.gripper_count};
    REQUIRE(wh_simulator_init(&simulator, &layout->grasp, &storage, &cell) == WH_OK);
    REQUIRE(wh_simulator_set_physics(&simulator, &layout->physics) == WH_OK);
    REQUIRE(wh_track_init(&track, &layout->machine, layout->slice_us) == WH_OK);
    free(wafers);
}

/* `replay` builds its cell from the message in which `sim` describes its own. */
static void check_message(const wh_layout_t *layout) {
    static uint8_t bytes[WH_LINK_DATAGRAM];
    static wh_link_cell_t room;
    const wh_link_identity_t identity = {1, wh_layout_hash(layout)};
    waferhand_cell cell;
    if (layout->wafer_count > WH_LINK_WAFERS) {
        return;
    }
    REQUIRE(wh_link_cell_from_layout(layout, &identity, &room));
    const int size = waferhand_cell_encode(bytes, 0, (int)sizeof bytes, &room.message);
    if (size < 0) {
        return; /* no datagram can hold it */
    }
    REQUIRE(wh_link_decode_cell(bytes, (size_t)size, &cell));
    wh_layout_t *const again = wh_link_layout_from_cell(&cell);
    REQUIRE(again != NULL);
    REQUIRE(again->station_count == layout->station_count && again->wafer_count == layout->wafer_count);
    wh_link_layout_free(again);
    REQUIRE(waferhand_cell_decode_cleanup(&cell) == 0);
}

static void check_refusal(const wh_sandbox_result_t *result) {
    REQUIRE(strncmp(result->message, NAME ":", sizeof NAME) == 0 || result->status == WH_SANDBOX_BUDGET ||
            result->status == WH_SANDBOX_MEMORY);
    REQUIRE(fuzz_is_one_line(result->message));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    const wh_sandbox_limits_t limits = {.memory_bytes = MEMORY, .instructions = BUDGET, .print_to = stderr};
    wh_sandbox_result_t result;
    wh_sandbox_t *const sandbox = wh_sandbox_new(&limits);
    REQUIRE(sandbox != NULL);
    const wh_layout_t *const layout = read_layout(sandbox, data, size, &result);
    if (!layout) {
        check_refusal(&result);
    } else {
        wh_sandbox_result_t again_result;
        wh_sandbox_t *const again = wh_sandbox_new(&limits);
        const wh_layout_t *const same = read_layout(again, data, size, &again_result);
        REQUIRE(same && wh_layout_hash(same) == wh_layout_hash(layout));
        wh_sandbox_free(again);
        check_names(layout);
        check_set_up(layout);
        check_message(layout);
    }
    wh_sandbox_free(sandbox);
    return 0;
}
