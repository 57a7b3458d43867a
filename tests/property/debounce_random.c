/* The debounce of vacuum sensors against a plain loop that keeps the whole history of each switch. Leaks come
 * and go, valves switch, wafers are taken and let go. A copy that is read from a snapshot at any slice goes on
 * alike. */
#include <string.h>

#include "sim/snapshot.h"
#include "support/pose.h"

enum { GRIPPERS = 2, WAFERS = 2, SLICES = 300, OPEN = WH_VALVE_OPEN, CLOSED = WH_VALVE_CLOSED };

typedef struct {
    wh_simulator_t simulator;
    wh_wafer_t wafers[WAFERS];
    wh_gripper_t grippers[GRIPPERS];
    wh_state_t state;
} cell_t;

/* The plain loop: each slice's switch of a gripper, and its sensor. */
typedef struct {
    bool switched[SLICES + 1];
    bool told;
} plain_t;

static cell_t cell, copy;
static plain_t plain[GRIPPERS];
static wh_physics_t physics;
static struct { int turns, unsaid, lost, copies; } found;

static void draw_physics(void) {
    static const int32_t debounces[] = {0, 1, 2, 7, 40};
    wh_vacuum_config_t *vacuum = &physics.vacuum;
    physics = wh_physics_default();
    vacuum->build = WH_REAL(wh_test_uniform(0, 0.01));
    vacuum->vent = WH_REAL(wh_test_uniform(0, 0.01));
    vacuum->on = WH_REAL(wh_test_uniform(0.5, 0.9));
    vacuum->off = WH_REAL(wh_test_uniform(0.3, 0.5));
    vacuum->idle = WH_REAL(wh_test_below(2) == 0 ? 0 : wh_test_uniform(0, 0.29));
    vacuum->debounce = debounces[wh_test_below(5)];
}

static void begin(cell_t *of) {
    const wh_grasp_config_t config = wh_grasp_config_default();
    const wh_cell_t none = {.tolerance = wh_tolerance_paper()};
    const wh_grasp_storage_t storage = {of->wafers, WAFERS, of->grippers, GRIPPERS, NULL, 0};
    memset(of, 0, sizeof *of);
    for (int w = 0; w < WAFERS; ++w) {
        of->wafers[w].base_from_wafer = wh_test_at(400 * w, 0, 0);
    }
    assert_int_equal(wh_simulator_init(&of->simulator, &config, &storage, &none), WH_OK);
    assert_int_equal(wh_simulator_set_physics(&of->simulator, &physics), WH_OK);
}

/* Each gripper stands at its wafer; now and then its valve turns, or a leak of some slices begins. */
static wh_command_t draw_command(const wh_command_t *before, int64_t seq) {
    wh_command_t command = {.utime = 1000 * seq, .seq = seq, .gripper_count = GRIPPERS};
    for (int g = 0; g < GRIPPERS; ++g) {
        const bool turns = seq == 1 || wh_test_below(40) == 0;
        command.grippers[g].base_from_gripper = wh_test_at(400 * g, 0, 0);
        command.grippers[g].valve = turns ? (int32_t)wh_test_below(2) : before->grippers[g].valve;
    }
    const int32_t slot = (int32_t)wh_test_below(4);
    const wh_fault_phase_t phase = cell.simulator.physics.faults.slots[slot].phase;
    if (wh_test_below(8) == 0 && (phase == WH_FAULT_FREE || phase == WH_FAULT_OVER)) {
        const int64_t lasting = 1 + wh_test_below(30);
        command.fault_count = 1;
        command.faults[0].index = slot;
        command.faults[0].fault =
            wh_fault_make(WH_FAULT_LEAK, slot % GRIPPERS, WH_REAL(wh_test_uniform(0, 1)), seq, seq + lasting);
    }
    return command;
}

static bool is_lost(const wh_state_t *state, int g) {
    bool lost = false;
    for (size_t e = 0; e < state->event_count; ++e) {
        lost = lost || (state->events[e].kind == WH_EVENT_VACUUM_LOST && state->events[e].gripper == g);
    }
    return lost;
}

/* True if the switch stood otherwise than told in this slice and in those before it that the debounce asks for. */
static bool has_stood(const bool switched[], bool was_told, int seq) {
    bool stands = true;
    for (int i = seq; i >= seq - physics.vacuum.debounce; --i) {
        stands = stands && i > 0 && switched[i] != was_told;
    }
    return stands;
}

/* The sensor turns in a slice if its switch has stood otherwise than told in this and all of the slices before
 * it that the debounce asks for. */
static void judge(int g, int seq) {
    const wh_vacuum_config_t *vacuum = &physics.vacuum;
    const wh_vacuum_t *now = &cell.simulator.physics.vacuum[g];
    bool *switched = plain[g].switched;
    const bool was_told = plain[g].told;
    switched[seq] = switched[seq - 1] ? now->level >= vacuum->off : now->level >= vacuum->on;
    plain[g].told = was_told != has_stood(switched, was_told, seq);
    assert_true(((cell.state.sensors >> g & 1U) != 0) == plain[g].told);
    const bool is_held = cell.state.grippers[g].wafer != WH_NONE;
    const bool lost = was_told && !plain[g].told && is_held && now->command == OPEN;
    assert_true(is_lost(&cell.state, g) == lost);
    found.turns += (int)(was_told != plain[g].told);
    found.unsaid += (int)(switched[seq] != switched[seq - 1] && switched[seq] == was_told);
    found.lost += (int)lost;
}

/* Reads the copy anew from the bytes of the cell. */
static void copy_cell(void) {
    static wh_wafer_t wafers[WAFERS];
    static wh_gripper_t grippers[GRIPPERS];
    static wh_snapshot_room_t room = {.wafers = wafers, .grippers = grippers};
    static uint8_t bytes[WH_SNAPSHOT_SIZE(WAFERS, GRIPPERS)];
    size_t size = 0;
    begin(&copy);
    assert_int_equal(wh_simulator_save(&cell.simulator, bytes, sizeof bytes, &size), WH_OK);
    assert_int_equal(wh_simulator_load(&copy.simulator, bytes, size, &room), WH_OK);
    found.copies += physics.vacuum.debounce > 0 && cell.simulator.physics.vacuum[0].waits > 0 ? 1 : 0;
}

static void a_turn_is_told_once_it_has_stood(void **state) {
    (void)state;
    wh_rounds_t rounds = WH_ROUNDS(60, 20000, 1);
    while (wh_round(&rounds)) {
        wh_command_t command = {0};
        draw_physics();
        memset(plain, 0, sizeof plain);
        begin(&cell);
        copy_cell();
        for (int seq = 1; seq <= SLICES; ++seq) {
            command = draw_command(&command, seq);
            assert_int_equal(wh_simulator_step(&cell.simulator, &command, &cell.state), WH_OK);
            assert_int_equal(wh_simulator_step(&copy.simulator, &command, &copy.state), WH_OK);
            assert_true(wh_simulator_hash(&cell.simulator) == wh_simulator_hash(&copy.simulator));
            assert_int_equal(cell.state.sensors, copy.state.sensors);
            for (int g = 0; g < GRIPPERS; ++g) {
                judge(g, seq);
            }
            if (wh_test_below(30) == 0) {
                copy_cell();
            }
        }
    }
    print_message("%d turns, %d not told, %d losses, %d copies in %d rounds\n", found.turns, found.unsaid,
                  found.lost, found.copies, rounds.made);
    assert_true(found.turns > rounds.made && found.unsaid > rounds.made / 4);
    assert_true(found.lost > rounds.made / 4 && found.copies > rounds.made / 8);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_turn_is_told_once_it_has_stood)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
