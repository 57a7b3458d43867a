/* Snapshots: copied back, copied elsewhere or read from bytes, a run continues bit for bit; and
 * only bytes that were written are accepted. */
#include "sim/snapshot.h"

#include "math/hash.h"
#include "math/trig.h"
#include "support/pose.h"

enum { WAFERS = 6, GRIPPERS = 3, STATIONS = 2, BUCKETS = 8 + 4 * GRIPPERS + 5 * WAFERS, LENGTH = 400 };

/* One simulator with all that belongs to it. */
typedef struct {
    wh_simulator_t simulator;
    wh_wafer_t wafers[WAFERS];
    wh_gripper_t grippers[GRIPPERS];
    uint32_t buckets[BUCKETS];
} run_t;

static wh_station_t stations[STATIONS];
static run_t run, twin;
static wh_command_t commands[LENGTH];
static uint64_t hashes[LENGTH];
static wh_grasp_counters_t happened; /* counts over all whole runs */
static wh_wafer_t room_wafers[WAFERS];
static wh_gripper_t room_grippers[GRIPPERS];
static wh_snapshot_room_t room = {.wafers = room_wafers, .grippers = room_grippers};
static uint8_t bytes[WH_SNAPSHOT_SIZE(WAFERS, GRIPPERS)];

static wh_grasp_storage_t storage_of(run_t *of, bool indexed) {
    const wh_grasp_storage_t storage = {
        of->wafers, WAFERS, of->grippers, GRIPPERS, indexed ? of->buckets : NULL, indexed ? BUCKETS : 0};
    return storage;
}

static wh_physics_t lively_physics(wh_check_t check) {
    wh_physics_t physics = wh_physics_default();
    physics.vacuum = wh_vacuum_delayed();
    physics.vacuum.debounce = check == WH_CHECK_SWEPT ? 4 : 0;
    physics.pads = (wh_pads_t){WH_REAL(0.5), 10, WH_REAL(0.128), WH_REAL(9.81)};
    physics.faults[0] = wh_fault_make(WH_FAULT_LEAK, 1, WH_REAL(0.8), 20, 300);
    physics.faults[1] = wh_fault_make(WH_FAULT_WAFER_SHIFTED, 2, 0, 50, 350);
    physics.faults[1].offset.r.x = 1;
    physics.fault_count = 2;
    return physics;
}

/* Two stacks with wafers, 20 mm apart; releases settle; swept or sampled. */
static void begin(run_t *of, wh_check_t check, bool indexed) {
    const wh_grasp_storage_t storage = storage_of(of, indexed);
    const wh_cell_t cell = {stations, STATIONS, wh_tolerance_paper(), WH_REAL(0.2), WH_REAL(0.01), true,
                            0,        0};
    wh_grasp_config_t config = wh_grasp_config_default();
    config.check = check;
    memset(of, 0x5a, sizeof *of);
    for (int s = 0; s < STATIONS; ++s) {
        stations[s] = (wh_station_t){wh_test_at(30 * s, 0, 0), 3, 10, WH_NONE};
    }
    for (int w = 0; w < WAFERS; ++w) {
        of->wafers[w].base_from_wafer = wh_test_at(30 * (w / 3), 0, 10 * (w % 3));
    }
    const wh_physics_t physics = lively_physics(check);
    assert_int_equal(wh_simulator_init(&of->simulator, &config, &storage, &cell), WH_OK);
    assert_int_equal(wh_simulator_set_physics(&of->simulator, &physics), WH_OK);
}

/* Grippers that wander between the wafers, valves that switch, a fault now and then. */
static void draw_commands(void) {
    memset(commands, 0, sizeof commands);
    for (int i = 0; i < LENGTH; ++i) {
        wh_command_t *c = &commands[i];
        c->seq = i + 1;
        c->utime = 1000 * (i + 1);
        c->gripper_count = GRIPPERS;
        for (int g = 0; g < GRIPPERS; ++g) {
            wh_gripper_input_t *input = &c->grippers[g];
            const bool jumps = i == 0 || wh_test_below(12) == 0;
            *input = i > 0 ? commands[i - 1].grippers[g] : *input;
            if (jumps) {
                const double x = 30 * wh_test_below(2) + wh_test_uniform(-3, 3);
                input->base_from_gripper =
                    wh_test_at(x, wh_test_uniform(-3, 3), 10 * (int)wh_test_below(3) - 0.9);
            }
            input->base_from_gripper.r.z += WH_REAL(wh_test_uniform(-0.1, 0.3));
            input->valve = i == 0 || wh_test_below(25) == 0 ? (int32_t)wh_test_below(2) : input->valve;
        }
        if (i % 97 == 40) {
            c->faults[0].index = 2 + i / 97;
            c->faults[0].fault = wh_fault_make(WH_FAULT_VALVE_STUCK, i / 97 % GRIPPERS, 0, i + 5, i + 40);
            c->fault_count = 1;
        }
    }
}

/* Events are compared, too. */
static uint64_t step(run_t *of, int slice) {
    wh_state_t state;
    assert_int_equal(wh_simulator_step(&of->simulator, &commands[slice], &state), WH_OK);
    uint64_t hash = wh_hash_word(wh_simulator_hash(&of->simulator), state.sensors);
    for (size_t i = 0; i < state.event_count; ++i) {
        const wh_event_t *event = &state.events[i];
        hash = wh_hash_int(wh_hash_int(hash, (int32_t)event->kind), event->wafer);
        hash = wh_hash_word(wh_hash_real(hash, event->measured.margin_projz), event->measured_slice);
    }
    return hash;
}

static void play_on(run_t *of, int from, int to) {
    for (int slice = from; slice < to; ++slice) {
        assert_true(step(of, slice) == hashes[slice]);
    }
}

/* A whole run, with its hashes stored; then the same again up to `until`. */
static void play_to(wh_check_t check, bool indexed, int until) {
    draw_commands();
    begin(&run, check, indexed);
    for (int slice = 0; slice < LENGTH; ++slice) {
        hashes[slice] = step(&run, slice);
    }
    const wh_grasp_counters_t *c = &run.simulator.table.counters;
    happened.picked += c->picked;
    happened.released += c->released;
    happened.near_misses += c->near_misses;
    begin(&run, check, indexed);
    play_on(&run, 0, until);
}

static size_t save(const run_t *of) {
    size_t size = 0;
    assert_int_equal(wh_simulator_save(&of->simulator, bytes, sizeof bytes, &size), WH_OK);
    assert_int_equal(size, wh_simulator_saved_size(&of->simulator));
    assert_true(size <= sizeof bytes);
    return size;
}

/* Any slice of sampled and swept runs, with an index and without. */
static void each_way(void (*at)(int slice, bool indexed)) {
    memset(&happened, 0, sizeof happened);
    for (int i = 0; i < 24; ++i) {
        const int slice = (int)wh_test_below(LENGTH - 1);
        play_to(i % 2 == 0 ? WH_CHECK_SAMPLED : WH_CHECK_SWEPT, i % 4 < 2, slice);
        at(slice, i % 4 < 2);
    }
    assert_true(happened.picked > 100 && happened.released > 100 && happened.near_misses > 25);
}

static void copy_back(int slice, bool indexed) {
    static run_t saved;
    const wh_grasp_storage_t storage = storage_of(&run, indexed);
    saved.simulator = run.simulator;
    memcpy(saved.wafers, run.wafers, sizeof run.wafers);
    memcpy(saved.grippers, run.grippers, sizeof run.grippers);
    play_on(&run, slice, LENGTH);
    run.simulator = saved.simulator;
    memcpy(run.wafers, saved.wafers, sizeof run.wafers);
    memcpy(run.grippers, saved.grippers, sizeof run.grippers);
    assert_int_equal(wh_simulator_relink(&run.simulator, &storage), WH_OK);
    play_on(&run, slice, LENGTH);
}

static void a_run_that_is_copied_back_goes_on_as_it_did(void **state) {
    (void)state;
    each_way(copy_back);
}

/* The copy has an index though the original has none, and neither disturbs the other. */
static void copy_away(int slice, bool indexed) {
    twin.simulator = run.simulator;
    memcpy(twin.wafers, run.wafers, sizeof run.wafers);
    memcpy(twin.grippers, run.grippers, sizeof run.grippers);
    const wh_grasp_storage_t storage = storage_of(&twin, !indexed);
    assert_int_equal(wh_simulator_relink(&twin.simulator, &storage), WH_OK);
    const uint64_t before = wh_simulator_hash(&run.simulator);
    play_on(&twin, slice, LENGTH);
    assert_true(wh_simulator_hash(&run.simulator) == before);
    play_on(&run, slice, LENGTH);
}

static void a_copy_with_arrays_of_its_own_is_a_second_simulator(void **state) {
    (void)state;
    each_way(copy_away);
}

static void read_again(int slice, bool indexed) {
    const size_t size = save(&run);
    static uint8_t again[sizeof bytes];
    size_t again_size = 0;
    begin(&twin, run.simulator.table.config.check, !indexed);
    memset(&room.physics, 0xa5, sizeof room.physics);
    assert_int_equal(wh_simulator_load(&twin.simulator, bytes, size, &room), WH_OK);
    assert_memory_equal(&twin.simulator.table.counters, &run.simulator.table.counters,
                        sizeof(wh_grasp_counters_t));
    assert_int_equal(wh_simulator_save(&twin.simulator, again, sizeof again, &again_size), WH_OK);
    assert_int_equal(again_size, size);
    assert_memory_equal(again, bytes, size);
    play_on(&twin, slice, LENGTH);
}

static void a_run_read_from_bytes_goes_on_as_it_did(void **state) {
    (void)state;
    each_way(read_again);
}

/* ---------------------------------------------------------------------------------------------------- refusals */

static void refuse(size_t size, wh_status_t status) {
    const wh_simulator_t before = twin.simulator;
    const uint64_t hash = wh_simulator_hash(&twin.simulator);
    assert_int_equal(wh_simulator_load(&twin.simulator, bytes, size, &room), status);
    assert_memory_equal(&twin.simulator, &before, sizeof before);
    assert_true(wh_simulator_hash(&twin.simulator) == hash);
}

static void bytes_that_have_changed_are_refused(void **state) {
    (void)state;
    play_to(WH_CHECK_SAMPLED, true, 200);
    const size_t size = save(&run);
    begin(&twin, WH_CHECK_SAMPLED, true);
    for (size_t at = 0; at < size; at += WH_TEST_SHARE) {
        const uint8_t was = bytes[at];
        bytes[at] = (uint8_t)(was ^ (1U << wh_test_below(8)));
        refuse(size, at == 6 || at == 7 ? WH_STATUS_OTHER_SNAPSHOT : WH_STATUS_DAMAGED);
        bytes[at] = was;
    }
    for (size_t shorter = 0; shorter < size; shorter += WH_TEST_SHARE) {
        refuse(shorter, WH_STATUS_DAMAGED);
    }
    assert_int_equal(wh_simulator_load(&twin.simulator, bytes, size, &room), WH_OK);
}

static void seal(size_t size) {
    uint64_t sum = WH_HASH_START;
    for (size_t i = 0; i < size - 8; ++i) {
        sum = wh_hash_word(sum, bytes[i]);
    }
    for (size_t i = 0; i < 8; ++i) {
        bytes[size - 8 + i] = (uint8_t)(sum >> (8 * i));
    }
}

static void another_version_or_number_type_is_named(void **state) {
    (void)state;
    play_to(WH_CHECK_SAMPLED, true, 10);
    const size_t size = save(&run);
    begin(&twin, WH_CHECK_SAMPLED, true);
    bytes[6] = WH_SNAPSHOT_MANY + 1;
    seal(size);
    refuse(size, WH_STATUS_OTHER_SNAPSHOT);
    bytes[6] = WH_SNAPSHOT_BACKS - 1;
    seal(size);
    refuse(size, WH_STATUS_OTHER_SNAPSHOT);
    bytes[6] = WH_SNAPSHOT_BACKS;
    seal(size);
    assert_int_equal(wh_simulator_load(&twin.simulator, bytes, size, &room), WH_OK);
    assert_true(wh_simulator_hash(&twin.simulator) == wh_simulator_hash(&run.simulator));
    begin(&twin, WH_CHECK_SAMPLED, true);
    bytes[6] = WH_SNAPSHOT_VERSION;
    bytes[7] = (uint8_t)(12 - sizeof(wh_real_t));
    seal(size);
    refuse(size, WH_STATUS_OTHER_SNAPSHOT);
}

static void a_snapshot_of_another_cell_is_refused(void **state) {
    (void)state;
    play_to(WH_CHECK_SAMPLED, true, 10);
    const size_t size = save(&run);
    begin(&twin, WH_CHECK_SWEPT, true);
    refuse(size, WH_STATUS_OTHER_SNAPSHOT);
    begin(&twin, WH_CHECK_SAMPLED, true);
    twin.simulator.vacuum.build += WH_REAL(0.01);
    refuse(size, WH_STATUS_OTHER_SNAPSHOT);
    begin(&twin, WH_CHECK_SAMPLED, true);
    twin.simulator.pads.mass += WH_REAL(0.01);
    refuse(size, WH_STATUS_OTHER_SNAPSHOT);
    begin(&twin, WH_CHECK_SAMPLED, true);
    twin.simulator.cell.settle = false;
    refuse(size, WH_STATUS_OTHER_SNAPSHOT);
    begin(&twin, WH_CHECK_SAMPLED, true);
    stations[1].pitch += 1;
    refuse(size, WH_STATUS_OTHER_SNAPSHOT);
    begin(&twin, WH_CHECK_SAMPLED, true);
    twin.simulator.cell.thickness += WH_REAL(0.5);
    refuse(size, WH_STATUS_OTHER_SNAPSHOT);
}

static void what_is_missing_is_refused(void **state) {
    (void)state;
    play_to(WH_CHECK_SAMPLED, true, 100);
    size_t size = save(&run);
    wh_snapshot_room_t none = {NULL, room_grippers, room.physics};
    assert_int_equal(wh_simulator_save(&run.simulator, bytes, size - 1, &size), WH_STATUS_BAD_CAPACITY);
    assert_int_equal(wh_simulator_save(NULL, bytes, size, &size), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_simulator_save(&run.simulator, NULL, size, &size), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_simulator_save(&run.simulator, bytes, size, NULL), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_simulator_load(NULL, bytes, size, &room), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_simulator_load(&run.simulator, NULL, size, &room), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_simulator_load(&run.simulator, bytes, size, NULL), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_simulator_load(&run.simulator, bytes, size, &none), WH_STATUS_NULL_ARGUMENT);
}

static void the_simulators_own_arrays_are_no_room(void **state) {
    (void)state;
    play_to(WH_CHECK_SAMPLED, true, 100);
    const size_t size = save(&run);
    static wh_snapshot_room_t own;
    own.wafers = run.wafers;
    own.grippers = room_grippers;
    assert_int_equal(wh_simulator_load(&run.simulator, bytes, size, &own), WH_STATUS_OVERLAP);
    own.wafers = room_wafers;
    own.grippers = run.grippers;
    assert_int_equal(wh_simulator_load(&run.simulator, bytes, size, &own), WH_STATUS_OVERLAP);
    assert_int_equal(wh_simulator_load(&run.simulator, bytes, size, &room), WH_OK);
}

static void expect_not_initialised(run_t *of) {
    const wh_grasp_storage_t storage = storage_of(of, false);
    size_t size = 1;
    assert_int_equal(wh_simulator_saved_size(&of->simulator), 0);
    assert_int_equal(wh_simulator_relink(&of->simulator, &storage), WH_STATUS_NOT_INITIALISED);
    assert_int_equal(wh_simulator_save(&of->simulator, bytes, sizeof bytes, &size),
                     WH_STATUS_NOT_INITIALISED);
    assert_int_equal(size, 1);
    assert_int_equal(wh_simulator_load(&of->simulator, bytes, sizeof bytes, &room),
                     WH_STATUS_NOT_INITIALISED);
}

/* Nothing, garbage, a simulator that wh_simulator_init refused, and one with one of its marks overwritten. */
static void what_was_never_initialised_is_refused(void **state) {
    (void)state;
    static run_t none;
    const wh_grasp_config_t config = wh_grasp_config_default();
    const wh_grasp_storage_t storage = storage_of(&none, false);
    memset(&none, 0xa5, sizeof none);
    expect_not_initialised(&none);
    memset(&none, 0, sizeof none);
    expect_not_initialised(&none);
    assert_int_not_equal(wh_simulator_init(&none.simulator, &config, &storage, NULL), WH_OK);
    expect_not_initialised(&none);
    begin(&none, WH_CHECK_SAMPLED, true);
    none.simulator.table.mark = 0;
    expect_not_initialised(&none);
    none.simulator.table.mark = WH_GRASP_MARK;
    none.simulator.mark = 0;
    expect_not_initialised(&none);
}

static void look(void *user, const wh_command_t *command, const wh_gripper_input_t inputs[],
                 const wh_grasp_t *table, wh_event_list_t *list) {
    (void)command;
    (void)inputs;
    (void)table;
    (void)list;
    ++*(int *)user;
}

/* A copy does not call the original's observer, and arrays that do not fit leave everything unchanged. */
static void relinking_looks_at_what_it_is_given(void **state) {
    (void)state;
    int looks = 0;
    play_to(WH_CHECK_SAMPLED, true, 100);
    run.simulator.observer = (wh_observer_t){look, NULL, &looks};
    twin = run;
    const wh_grasp_storage_t good = storage_of(&twin, true);
    const wh_simulator_t before = twin.simulator;
    wh_grasp_storage_t bad = good;
    assert_int_equal(wh_simulator_relink(NULL, &good), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_simulator_relink(&twin.simulator, NULL), WH_STATUS_NULL_ARGUMENT);
    bad.wafers = NULL;
    assert_int_equal(wh_simulator_relink(&twin.simulator, &bad), WH_STATUS_NULL_ARGUMENT);
    bad = good;
    bad.wafer_count = WAFERS - 1;
    assert_int_equal(wh_simulator_relink(&twin.simulator, &bad), WH_STATUS_BAD_CAPACITY);
    bad = good;
    bad.bucket_count = BUCKETS - 1;
    assert_int_equal(wh_simulator_relink(&twin.simulator, &bad), WH_STATUS_BAD_CAPACITY);
    twin.wafers[0].holder = GRIPPERS;
    assert_int_equal(wh_simulator_relink(&twin.simulator, &good), WH_STATUS_OUT_OF_RANGE);
    assert_memory_equal(&twin.simulator, &before, sizeof before);
    twin.wafers[0].holder = run.wafers[0].holder;
    assert_int_equal(wh_simulator_relink(&twin.simulator, &good), WH_OK);
    (void)step(&twin, 100);
    assert_int_equal(looks, 0);
    const wh_grasp_storage_t own = storage_of(&run, true);
    assert_int_equal(wh_simulator_relink(&run.simulator, &own), WH_OK);
    (void)step(&run, 100);
    assert_int_equal(looks, 1);
}

/* Bytes that were changed and sealed again: refused, or a sound state that can be stepped and is
 * written as it was read. */
static void sealed_bytes_give_a_sound_state_or_none(void **state) {
    (void)state;
    static uint8_t good[sizeof bytes];
    static uint8_t again[sizeof bytes];
    int taken = 0;
    play_to(WH_CHECK_SAMPLED, true, 150);
    const size_t size = save(&run);
    memcpy(good, bytes, size);
    begin(&twin, WH_CHECK_SAMPLED, true);
    for (int i = 0; i < 20000 / WH_TEST_SHARE; ++i) {
        memcpy(bytes, good, size);
        for (uint32_t changes = 1 + wh_test_below(3); changes > 0; --changes) {
            bytes[16 + wh_test_below((uint32_t)size - 24)] =
                (uint8_t)(wh_test_below(3) == 0 ? 0xff : wh_test_random());
        }
        seal(size);
        const uint64_t hash = wh_simulator_hash(&twin.simulator);
        if (wh_simulator_load(&twin.simulator, bytes, size, &room) != WH_OK) {
            assert_true(wh_simulator_hash(&twin.simulator) == hash);
            continue;
        }
        size_t again_size = 0;
        wh_state_t answer;
        ++taken;
        assert_true(wh_grasp_is_consistent(&twin.simulator.table));
        assert_int_equal(wh_simulator_save(&twin.simulator, again, sizeof again, &again_size), WH_OK);
        assert_int_equal(again_size, size);
        (void)wh_simulator_step(&twin.simulator, &commands[150], &answer);
    }
    assert_true(taken > 100);
}

/* The sizes are the ones that snapshot.h gives. */
static void the_most_bytes_are_those_of_the_manual(void **state) {
    (void)state;
    const size_t more = (WH_DOORS - WH_SNAPSHOT_FEW_DOORS) * sizeof(wh_real_t);
    assert_int_equal(WH_SNAPSHOT_SIZE(25, 2), (sizeof(wh_real_t) == 8 ? 10062 : 6006) + more);
    assert_true(WH_AXES != 32 || WH_SNAPSHOT_SIZE(25, 2) == (sizeof(wh_real_t) == 8 ? 10222 : 6086));
    assert_int_equal((37 * sizeof(wh_real_t) + 32) * WH_FAULTS, sizeof(wh_real_t) == 8 ? 5248 : 2880);
}

/* The format is public in a header: the same bytes on every machine. The sum was noted on x86-64. */
static void bytes_are_the_same_everywhere(void **state) {
    (void)state;
    begin(&run, WH_CHECK_SAMPLED, false);
    const size_t size = save(&run);
    static const uint8_t head[8] = {'W', 'H', 'S', 'N', 'A', 'P', WH_SNAPSHOT_VERSION, sizeof(wh_real_t)};
    assert_memory_equal(bytes, head, sizeof head);
    uint64_t sum = 0;
    for (size_t i = 0; i < 8; ++i) {
        sum |= (uint64_t)bytes[size - 8 + i] << (8 * i);
    }
    print_message("sum %016llx\n", (unsigned long long)sum);
    assert_true(sum ==
                (sizeof(wh_real_t) == 8 ? UINT64_C(0x0a166856133dbcda) : UINT64_C(0xb5eceb6ad438420d)));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_run_that_is_copied_back_goes_on_as_it_did),
        cmocka_unit_test(a_copy_with_arrays_of_its_own_is_a_second_simulator),
        cmocka_unit_test(a_run_read_from_bytes_goes_on_as_it_did),
        cmocka_unit_test(bytes_that_have_changed_are_refused),
        cmocka_unit_test(another_version_or_number_type_is_named),
        cmocka_unit_test(a_snapshot_of_another_cell_is_refused),
        cmocka_unit_test(what_is_missing_is_refused),
        cmocka_unit_test(the_simulators_own_arrays_are_no_room),
        cmocka_unit_test(what_was_never_initialised_is_refused),
        cmocka_unit_test(relinking_looks_at_what_it_is_given),
        cmocka_unit_test(sealed_bytes_give_a_sound_state_or_none),
        cmocka_unit_test(the_most_bytes_are_those_of_the_manual),
        cmocka_unit_test(bytes_are_the_same_everywhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
