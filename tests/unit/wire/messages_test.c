/* A run over messages ends with the bits of a run by calls: client and simulation are in one
 * process, on memq. Events arrive with their verdicts. Blocks of slices give back every bit, and
 * none of their bytes is trusted. */
#include "support/support.h"

#include "link/protocol_client.h"
#include "link/sim_process.h"
#include "mcs/script_run.h"
#include "wire/slices.h"

static wh_node_t node;
static wh_protocol_client_t client;
static wh_sim_process_t simulation;

static wh_link_t *connect(void *user, wh_mcs_t *mcs) {
    const wh_protocol_client_options_t options = {.rate = 0};
    (void)user;
    assert_int_equal(wh_sim_process_open(&simulation, &node, mcs->layout, true), WH_OK);
    assert_true(wh_protocol_client_open(&client, &node, mcs->layout, &options));
    return &client.link;
}

/* The observer of the messages of a run; null: nobody. */
static void *watched;
static wh_node_handler_t on_passing_command, on_passing_state;

static uint64_t play(const char *script, bool over_messages) {
    wh_script_run_options_t options = {.script = script, .limits = {.print_to = stderr}};
    wh_script_run_t run;
    if (over_messages) {
        assert_true(wh_node_open(&node, "memq://", NULL));
        options.partners.connect = connect;
    }
    if (watched) {
        assert_true(wh_node_subscribe(&node, WH_CHANNEL_COMMAND, on_passing_command, watched) &&
                    wh_node_subscribe(&node, WH_CHANNEL_STATE, on_passing_state, watched));
    }
    const wh_script_run_outcome_t outcome = wh_script_run(&run, &options);
    assert_true(outcome == WH_RUN_MET || (watched && outcome == WH_RUN_FAILED));
    const uint64_t hash = run.record.hash;
    if (over_messages) {
        assert_true(simulation.server.counters.stepped == (uint64_t)run.record.slices);
        assert_true(simulation.counters.garbage == 0);
        assert_true(client.counters.malformed == 0);
        wh_sim_process_close(&simulation);
        wh_node_close(&node);
    }
    wh_script_run_close(&run);
    return hash;
}

static void examples_have_the_same_hash(void **state) {
    static const char *const scripts[] = {"lua/examples/01_transfer.lua", "lua/examples/02_prealigner.lua",
                                          "lua/examples/03_missed_pick.lua"};
    (void)state;
    for (size_t i = 0; i < sizeof scripts / sizeof scripts[0]; ++i) {
        assert_true(play(scripts[i], true) == play(scripts[i], false));
    }
}

/* A near miss at this height, judged by this limit, over a message. */
static wh_event_t send_near_miss(double height, double limit) {
    static wh_link_state_t room;
    static wh_link_arrays_t arrays;
    static wh_wafer_t wafer;
    static wh_gripper_t gripper;
    static wh_physics_state_t physics;
    const wh_link_identity_t identity = {0};
    const wh_tolerance_t paper = wh_tolerance_paper();
    wh_tolerance_t applied = paper;
    wh_event_t event = {.kind = WH_EVENT_NEAR_MISS, .other = WH_NONE, .parts = {WH_NONE, WH_NONE}};
    wh_state_t state = {.wafers = &wafer,
                        .wafer_count = 1,
                        .grippers = &gripper,
                        .gripper_count = 1,
                        .events = &event,
                        .event_count = 1,
                        .physics = &physics};
    wh_state_t got;
    applied.projz = limit;
    gripper.wafer = gripper.approach.wafer = gripper.contest.wafer = WH_NONE;
    event.measured.dr_proj_z = -height;
    event.measured.n1_proj_n2 = 1;
    wh_proximity_judge(&applied, &event.measured);
    wh_link_state_to_message(&state, &identity, 0, 0, &room);
    assert_int_equal(wh_link_state_from_message(&room.message, &paper, &arrays, &got), WH_OK);
    assert_int_equal(got.event_count, 1);
    assert_int_equal(got.events[0].measured.failed, event.measured.failed);
    assert_true(got.events[0].measured.margin_projz == event.measured.margin_projz);
    assert_true(got.events[0].limit == 0);
    return got.events[0];
}

/* For a swept one 0.998 of the limit counts, also after the transfer of the message. */
static void a_near_miss_keeps_its_verdict(void **state) {
    (void)state;
    const double swept = wh_tolerance_paper().projz * WH_SWEEP_INSIDE;
    assert_false(send_near_miss(0.4998, swept).measured.ready);
    assert_true(send_near_miss(0.4998, 0.5).measured.ready);
    assert_false(send_near_miss(7.3, swept).measured.ready);
    assert_false(send_near_miss(7.3, 0.5).measured.ready);
}

/* ------------------------------------------------------------------------------------------------- slices */

static wh_slices_t collected, decoded;
static uint8_t block[WH_SLICES_BYTES];

/* The data that were put into a block. */
typedef struct {
    waferhand_command command;
    int32_t told[WH_GRIPPERS];
    uint64_t hash;
} slice_t;

static slice_t given[WH_SLICES_MOST];

static double real_of(uint64_t bits) {
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Any bits: now and then NaN, an infinity, a zero of either sign, or a tiny number. */
static double odd_real(void) {
    static const uint64_t odd[] = {0,
                                   UINT64_C(0x8000000000000000),
                                   UINT64_C(0x7ff0000000000000),
                                   UINT64_C(0xfff0000000000000),
                                   UINT64_C(0x7ff0000000000001),
                                   UINT64_C(0xfff8dead0000beef),
                                   1,
                                   UINT64_C(0x7fefffffffffffff)};
    const uint64_t bits = wh_test_random();
    return bits % 4 == 0 ? real_of(odd[bits >> 8 & 7]) : real_of(wh_test_random());
}

/* A zero with changing signs, or any number; now and then an odd value, otherwise smooth. */
static double rough_number(uint64_t kind, size_t i) {
    if (kind == 4) {
        return i % 50 == 0 ? odd_real() : 1.0 / (1.0 + (double)i * 1e-3);
    }
    if (kind == 5) {
        return i % 2 == 0 ? 0.0 : -0.0;
    }
    return odd_real();
}

/* A number of slice i, of one of the kinds that a column may have. */
static double number(uint64_t kind, size_t i) {
    const double t = (double)i * 1e-3;
    switch (kind % 8) {
    case 0:
        return 12.5;
    case 1:
        return 3.0 + t * (0.5 + t * (-2.0 + t * 9.0));
    case 2:
        return 700 * cos(3 * t);
    case 3:
        return -700 * cos(3 * t);
    default:
        return rough_number(kind % 8, i);
    }
}

static waferhand_command make_command(const uint64_t kinds[WH_SLICES_COLUMNS], size_t i) {
    waferhand_command command = {.utime = 5000 + (int64_t)i * 1000,
                                 .seq = 5 + (int64_t)i,
                                 .run = 77,
                                 .layout_hash = -3,
                                 .lockstep = 1,
                                 .gripper_count = 1 + (int32_t)(kinds[0] >> 8 & 15),
                                 .axis_count = (int32_t)(kinds[1] >> 8) & 31};
    size_t column = 0;
    for (int32_t a = 0; a < command.axis_count; ++a) {
        command.axis_position[a] = number(kinds[column++], i);
    }
    for (int32_t g = 0; g < command.gripper_count; ++g) {
        for (size_t k = 0; k < 3; ++k) {
            command.gripper_position[g][k] = number(kinds[column++], i);
        }
        for (size_t k = 0; k < 9; ++k) {
            command.gripper_rotation[g][k] = number(kinds[column++], i);
        }
        command.valve[g] = (int32_t)((i / (100 + (size_t)g)) & 1);
    }
    return command;
}

/* Fills `given` and `collected` with this number of slices whose columns are of random kinds, below
 * `most`. */
static void collect(size_t count, uint64_t most) {
    uint64_t kinds[WH_SLICES_COLUMNS];
    for (size_t c = 0; c < WH_SLICES_COLUMNS; ++c) {
        const uint64_t bits = wh_test_random();
        kinds[c] = (bits & 0xff00) | (bits >> 16) % most;
    }
    collected.count = 0;
    for (size_t i = 0; i < count; ++i) {
        given[i] = (slice_t){make_command(kinds, i), {0}, wh_test_random()};
        for (int32_t g = 0; g < given[i].command.gripper_count; ++g) {
            given[i].told[g] = (int32_t)(i / 333) & 1;
        }
        assert_true(wh_slices_add(&collected, &given[i].command, given[i].told, given[i].hash));
    }
}

static void assert_given(const slice_t *slice, size_t i) {
    uint8_t wanted[4000];
    uint8_t got[4000];
    waferhand_command command;
    int32_t told[WH_GRIPPERS];
    uint64_t hash;
    wh_slices_get(&decoded, i, &command, told, &hash);
    const int size = waferhand_command_encode(wanted, 0, sizeof wanted, &slice->command);
    assert_int_equal(waferhand_command_encode(got, 0, sizeof got, &command), size);
    assert_memory_equal(got, wanted, (size_t)size);
    assert_memory_equal(told, slice->told, sizeof told);
    assert_true(hash == slice->hash);
}

/* Encodes and decodes all collected slices; returns how many messages that took. */
static size_t assert_all_come_back(void) {
    size_t messages = 0;
    for (size_t from = 0, at = 0; from < collected.count; at = from, ++messages) {
        const size_t size = wh_slices_encode(&collected, &from, block);
        assert_true(from > at && size <= sizeof block);
        assert_true(wh_slices_decode(block, size, &decoded));
        assert_int_equal(decoded.count, from - at);
        for (size_t i = at; i < from; ++i) {
            assert_given(&given[i], i - at);
        }
    }
    return messages;
}

static void a_block_gives_back_every_bit(void **state) {
    (void)state;
    wh_test_seed();
    size_t split = 0;
    for (int round = 0; round < 200 / WH_TEST_SHARE; ++round) {
        const uint64_t bits = wh_test_random();
        collect(1 + (size_t)(bits % WH_SLICES_MOST), round % 2 == 0 ? 8 : 6);
        split += assert_all_come_back() > 1 ? 1 : 0;
    }
    /* Some of them had too many bits for one message. */
    assert_true(split > 0);
}

static void assert_left_out(waferhand_command command, int32_t told) {
    const int32_t valves[WH_GRIPPERS] = {told};
    const size_t before = collected.count;
    assert_false(wh_slices_add(&collected, &command, valves, 1));
    assert_int_equal(collected.count, before);
}

static void a_block_takes_no_slice_that_it_could_not_give_back(void **state) {
    static const uint64_t kinds[WH_SLICES_COLUMNS] = {0};
    const waferhand_command sound = make_command(kinds, 2);
    (void)state;
    collect(0, 1);
    const int32_t told[WH_GRIPPERS] = {0};
    for (size_t i = 0; i < 2; ++i) {
        const waferhand_command before = make_command(kinds, i);
        assert_true(wh_slices_add(&collected, &before, told, 1));
    }
    const int32_t count = sound.gripper_count;
#define LEFT_OUT(change)                                                                                     \
    do {                                                                                                     \
        waferhand_command changed = sound;                                                                   \
        changed.change;                                                                                      \
        assert_left_out(changed, 0);                                                                         \
    } while (0)
    LEFT_OUT(seq = 8);
    LEFT_OUT(seq = 6);
    LEFT_OUT(utime += 1);
    LEFT_OUT(run = 78);
    LEFT_OUT(layout_hash = 0);
    LEFT_OUT(lockstep = 0);
    LEFT_OUT(lockstep = 2);
    LEFT_OUT(gripper_count = count + 1);
    LEFT_OUT(gripper_count = 0);
    LEFT_OUT(axis_count = 1);
    LEFT_OUT(axis_count = -1);
    LEFT_OUT(valve[0] = 2);
    LEFT_OUT(valve[count] = 1);
    LEFT_OUT(gripper_position[count][0] = 1);
    LEFT_OUT(gripper_rotation[15][8] = -0.0);
    LEFT_OUT(axis_position[31] = 1);
    LEFT_OUT(fault_count = 1);
    LEFT_OUT(fault_index[3] = 1);
    LEFT_OUT(faults[3].until_seq = 1);
    LEFT_OUT(faults[0].value = -0.0);
#undef LEFT_OUT
    assert_left_out(sound, -1);
    assert_true(wh_slices_add(&collected, &sound, told, 1));
    for (size_t i = 3; i < WH_SLICES_MOST; ++i) {
        const waferhand_command next = make_command(kinds, i);
        assert_true(wh_slices_add(&collected, &next, told, 1));
    }
    assert_left_out(make_command(kinds, WH_SLICES_MOST), 0);
}

/* Each bit flipped, each length cut. Then the check is corrected, so that the decoder itself must
 * detect the error. */
static void a_damaged_block_is_refused(void **state) {
    static uint8_t damaged[WH_SLICES_BYTES];
    (void)state;
    wh_test_seed();
    collect(60, 6);
    size_t from = 0;
    const size_t size = wh_slices_encode(&collected, &from, block);
    assert_true(wh_slices_decode(block, size, &decoded));
    for (size_t bit = 0; bit < 8 * size; bit += WH_TEST_SHARE) {
        memcpy(damaged, block, size);
        damaged[bit / 8] ^= (uint8_t)(1U << bit % 8);
        assert_false(wh_slices_decode(damaged, size, &decoded));
        wh_link_seal(damaged, size);
        if (bit < 8 * (size - 8) && wh_slices_decode(damaged, size, &decoded)) {
            assert_in_range(decoded.count, 1, WH_SLICES_MOST);
        }
    }
    for (size_t length = 0; length < size; ++length) {
        memcpy(damaged, block, length);
        wh_link_seal(damaged, length);
        assert_false(wh_slices_decode(damaged, length, &decoded));
    }
    /* The last slice's number, which stands behind fingerprint and utime, as far below the first
     * one's as is possible. */
    memcpy(damaged, block, size);
    memset(damaged + 16, 0, 8);
    damaged[16] = 0x80;
    wh_link_seal(damaged, size);
    assert_false(wh_slices_decode(damaged, size, &decoded));
    memset(block + size - 8, 0, 8);
    assert_false(wh_slices_decode(block, size, &decoded));
}

/* Collects the passing slices; a slice that does not fit is skipped. */
typedef struct {
    waferhand_command command;
    int64_t seq;
    size_t slices, left_out, bytes;
} passing_t;

static void flush_passing(passing_t *passing) {
    passing->slices += collected.count;
    (void)assert_all_come_back();
    for (size_t from = 0; from < collected.count;) {
        passing->bytes += wh_slices_encode(&collected, &from, block);
    }
    collected.count = 0;
}

static void on_passing_command(void *user, const void *data, size_t size) {
    assert_true(wh_link_decode_command(data, size, &((passing_t *)user)->command));
}

static void on_passing_state(void *user, const void *data, size_t size) {
    passing_t *passing = user;
    waferhand_state message;
    slice_t slice = {.command = passing->command};
    assert_true(wh_link_decode_state(data, size, &message));
    slice.hash = (uint64_t)message.hash;
    slice.command.check = 0;
    for (int32_t g = 0; g < message.gripper_count; ++g) {
        slice.told[g] = message.grippers[g].valve_told;
    }
    (void)waferhand_state_decode_cleanup(&message);
    /* On a busy machine commands are repeated. */
    if (message.seq == passing->seq) {
        return;
    }
    passing->seq = message.seq;
    if (collected.count == WH_SLICES_MOST) {
        flush_passing(passing);
    }
    if (!wh_slices_add(&collected, &slice.command, slice.told, slice.hash)) {
        ++passing->left_out;
        flush_passing(passing);
        return;
    }
    given[collected.count - 1] = slice;
}

static void the_examples_fit_blocks(void **state) {
    static const char *const scripts[] = {
        "lua/examples/01_transfer.lua",    "lua/examples/02_prealigner.lua",
        "lua/examples/03_missed_pick.lua", "lua/examples/04_scrape.lua",
        "lua/examples/05_leak.lua",        "lua/examples/06_cross_slotted.lua",
        "lua/examples/08_corrections.lua", "lua/examples/12_three_foups.lua"};
    (void)state;
    for (size_t i = 0; i<sizeof scripts / sizeof scripts[0]; i += WH_TEST_SHARE> 1 ? 4 : 1) {
        passing_t passing = {0};
        collected.count = 0;
        watched = &passing;
        (void)play(scripts[i], true);
        watched = NULL;
        flush_passing(&passing);
        print_message("%s: %zu slices, %zu left out, %.1f bytes each\n", scripts[i], passing.slices,
                      passing.left_out, (double)passing.bytes / (double)passing.slices);
        /* The slices in which a fault begins or ends. */
        assert_true(passing.left_out <= 2);
        assert_true(passing.slices > 3000 && passing.bytes < 20 * passing.slices);
    }
}

static void a_recording_says_what_it_is(void **state) {
    uint8_t bytes[300];
    const waferhand_recording message = {.version = 3,
                                         .id = 9,
                                         .part = 1,
                                         .program = wh_link_borrowed("sim"),
                                         .program_version = wh_link_borrowed("0.1.0")};
    waferhand_recording got;
    (void)state;
    const size_t size = (size_t)waferhand_recording_encode(bytes, 0, sizeof bytes, &message);
    assert_false(wh_link_decode_recording(bytes, size, &got));
    wh_link_seal(bytes, size);
    assert_true(wh_link_decode_recording(bytes, size, &got));
    assert_int_equal(got.version, 3);
    assert_string_equal(got.program, "sim");
    (void)waferhand_recording_decode_cleanup(&got);
    for (size_t length = 0; length < size; ++length) {
        assert_false(wh_link_decode_recording(bytes, length, &got));
    }
    bytes[44] ^= 1;
    assert_false(wh_link_decode_recording(bytes, size, &got));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(examples_have_the_same_hash),
        cmocka_unit_test(a_near_miss_keeps_its_verdict),
        cmocka_unit_test(a_block_gives_back_every_bit),
        cmocka_unit_test(a_block_takes_no_slice_that_it_could_not_give_back),
        cmocka_unit_test(a_damaged_block_is_refused),
        cmocka_unit_test(the_examples_fit_blocks),
        cmocka_unit_test(a_recording_says_what_it_is),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
