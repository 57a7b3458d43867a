/* Snapshots that were changed, with a correct sum at the end. They are refused, and the simulator
 * is unchanged, bit for bit; or they are a sound state, which is written as it was read and can be
 * stepped.
 *
 * The first byte chooses one of the states of a lively run, the second the number of bytes cut off
 * its end. Then each three bytes are a change: the place, and the byte that stands there now. */
#include "sim/snapshot.h"

#include <string.h>

#include "fuzz.h"
#include "math/hash.h"

enum { WAFERS = 3, GRIPPERS = 2, STATES = 16, SLICES = 12, ROOM = 16384 };

typedef struct {
    wh_simulator_t simulator;
    wh_wafer_t wafers[WAFERS];
    wh_gripper_t grippers[GRIPPERS];
} run_t;

static const wh_station_t station = {{{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {0, 0, 0}}, 3, 10, WH_NONE};
static run_t run, before;
static uint8_t states[STATES][ROOM];
static size_t sizes[STATES];
static wh_wafer_t wafers[WAFERS];
static wh_gripper_t grippers[GRIPPERS];
static wh_snapshot_room_t room = {.wafers = wafers, .grippers = grippers};

static void begin(void) {
    const wh_grasp_config_t config = wh_grasp_config_default();
    const wh_grasp_storage_t storage = {run.wafers, WAFERS, run.grippers, GRIPPERS, NULL, 0};
    const wh_cell_t cell = {&station, 1, wh_tolerance_paper(), 1, 1, true, 0, 0};
    wh_physics_t physics = wh_physics_default();
    physics.vacuum = wh_vacuum_delayed();
    physics.pads = (wh_pads_t){0.5, 10, 0.128, 9.81};
    physics.faults[0] = wh_fault_make(WH_FAULT_WAFER_SHIFTED, 2, 0, 5, 150);
    physics.faults[1] = wh_fault_make(WH_FAULT_LEAK, 0, 0.7, 100, WH_FAULT_FOREVER);
    physics.fault_count = 2;
    memset(&run, 0, sizeof run);
    for (int w = 0; w < WAFERS; ++w) {
        run.wafers[w].base_from_wafer = wh_pose_identity();
        run.wafers[w].base_from_wafer.r.z = 10 * w;
    }
    REQUIRE(wh_simulator_init(&run.simulator, &config, &storage, &cell) == WH_OK);
    REQUIRE(wh_simulator_set_physics(&run.simulator, &physics) == WH_OK);
}

/* Both grippers move up through the wafers and down again; their valves take turns. */
static wh_status_t step(int64_t seq) {
    wh_command_t command;
    wh_state_t state;
    memset(&command, 0, sizeof command);
    command.seq = seq;
    command.gripper_count = GRIPPERS;
    for (int g = 0; g < GRIPPERS; ++g) {
        const int64_t at = (seq + 40 * g) % 80;
        command.grippers[g].base_from_gripper = wh_pose_identity();
        command.grippers[g].base_from_gripper.r.z = 0.5 * (double)(at < 40 ? at : 80 - at) - 1;
        command.grippers[g].valve = (seq / 50 + g) % 2 == 0 ? WH_VALVE_OPEN : WH_VALVE_CLOSED;
    }
    return wh_simulator_step(&run.simulator, &command, &state);
}

int LLVMFuzzerInitialize(int *argc, char ***argv) {
    (void)argc;
    (void)argv;
    begin();
    int64_t seq = 0;
    for (int i = 0; i < STATES; ++i) {
        REQUIRE(wh_simulator_save(&run.simulator, states[i], ROOM, &sizes[i]) == WH_OK);
        for (int slice = 0; slice < SLICES; ++slice) {
            REQUIRE(step(++seq) == WH_OK);
        }
    }
    REQUIRE(run.simulator.table.counters.picked > 1);
    begin();
    return 0;
}

static void seal(uint8_t bytes[], size_t size) {
    uint64_t sum = WH_HASH_START;
    for (size_t i = 0; i + 8 < size; ++i) {
        sum = wh_hash_word(sum, bytes[i]);
    }
    for (size_t i = 0; size >= 8 && i < 8; ++i) {
        bytes[size - 8 + i] = (uint8_t)(sum >> (8 * i) & 0xff);
    }
}

/* The changed bytes, in memory of their own so that a sanitizer sees a read beyond them. */
static uint8_t *change(const uint8_t *data, size_t left, size_t *size) {
    const size_t state = data[0] % STATES;
    const size_t cut = data[1];
    *size = cut < sizes[state] ? sizes[state] - cut : 0;
    uint8_t *bytes = malloc(*size + 1);
    REQUIRE(bytes != NULL);
    memcpy(bytes, states[state], *size);
    for (size_t i = 2; i + 2 < left && *size > 0; i += 3) {
        bytes[(data[i] | (size_t)data[i + 1] << 8) % *size] = data[i + 2];
    }
    seal(bytes, *size);
    return bytes;
}

static void check_taken(size_t size) {
    static uint8_t again[ROOM];
    size_t again_size = 0;
    const wh_simulator_t *s = &run.simulator;
    const uint64_t hash = wh_simulator_hash(s);
    REQUIRE(wh_grasp_is_consistent(&s->table));
    REQUIRE(wh_physics_state_validate(&s->physics, GRIPPERS, WAFERS) == WH_OK);
    REQUIRE(wh_simulator_save(s, again, ROOM, &again_size) == WH_OK && again_size == size);
    REQUIRE(wh_simulator_load(&run.simulator, again, size, &room) == WH_OK);
    REQUIRE(wh_simulator_hash(s) == hash);
    for (int64_t seq = 1; seq <= 3; ++seq) {
        REQUIRE(step(seq) == WH_OK);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size < 2) {
        return 0;
    }
    size_t changed_size = 0;
    uint8_t *bytes = change(data, size, &changed_size);
    memcpy(&before, &run, sizeof run);
    if (wh_simulator_load(&run.simulator, bytes, changed_size, &room) == WH_OK) {
        check_taken(changed_size);
        begin();
    } else {
        REQUIRE(memcmp(&before, &run, sizeof run) == 0);
    }
    free(bytes);
    return 0;
}
