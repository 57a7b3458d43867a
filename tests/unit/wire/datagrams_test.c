/* The messages from LCM's side: their fingerprints tell them apart, and they are small enough for
 * one datagram. */
#include "support/support.h"

#include <waferhand_messages.h>

/* The part of an LCM message that one UDP datagram carries: the longest datagram less LCM's header
 * and the channel's name. LCM sends longer messages in fragments, which get lost one by one. */
enum {
    DATAGRAM = 65499,
    WAFERS = 256,
    GRIPPERS = 16,
    EVENTS = 128,
    FAULTS = 16,
    SAMPLES = 64,
    DOORS = 8,
    LATCHES = 16,
    NAME = 64
};

typedef struct {
    const char *name;
    int64_t fingerprint;
} message_t;

/* LCM's fingerprint leaves out a message's name: two with the same members would look the same. */
static void fingerprints_differ(void **state) {
    (void)state;
#define MESSAGE(name) {#name, __waferhand_##name##_get_hash()},
    const message_t messages[] = {WAFERHAND_MESSAGES(MESSAGE)};
    const size_t count = sizeof(messages) / sizeof(messages[0]);
    assert_true(count > 1);
    for (size_t i = 0; i < count; i++) {
        for (size_t k = 0; k < i; k++) {
            if (messages[i].fingerprint == messages[k].fingerprint) {
                fail_msg("%s and %s have the same fingerprint", messages[k].name, messages[i].name);
            }
        }
    }
}

static void largest_state_fits(void **state) {
    static waferhand_wafer_state wafers[WAFERS];
    static waferhand_gripper_state grippers[GRIPPERS];
    static waferhand_event events[EVENTS];
    static waferhand_fault_slot faults[FAULTS];
    static int32_t samples[SAMPLES];
    static waferhand_latch latches[LATCHES];
    static double doors[DOORS];
    (void)state;
    const waferhand_state message = {
        .wafer_count = WAFERS,
        .gripper_count = GRIPPERS,
        .event_count = EVENTS,
        .fault_count = FAULTS,
        .sample_count = SAMPLES,
        .door_count = DOORS,
        .doors = doors,
        .wafers = wafers,
        .grippers = grippers,
        .events = events,
        .faults = faults,
        .samples = samples,
        .latching = {
            .waiting_count = LATCHES, .latch_count = LATCHES, .waiting = latches, .latches = latches}};
    const int size = waferhand_state_encoded_size(&message);
    print_message("state of %d wafers: %d bytes\n", WAFERS, size);
    /* Computed by hand: a header of 122, doors of 8, a check of 8, beams of 41, wafers of 101,
     * grippers of 515, events of 157, slots of faults of 328, samples of 4 and latches of 24 bytes. */
    assert_int_equal(size, 171 + DOORS * 8 + SAMPLES * 4 + 2 * LATCHES * 24 + WAFERS * 101 + GRIPPERS * 515 +
                               EVENTS * 157 + FAULTS * 328);
    assert_true(size <= DATAGRAM);
}

/* Wafers and stations with names of 63 bytes each. */
static void large_cell_fits(void **state) {
    static waferhand_wafer_state wafers[WAFERS];
    static waferhand_station stations[16];
    static char name[NAME];
    char *names[WAFERS];
    (void)state;
    memset(name, 'x', sizeof(name) - 1);
    for (size_t i = 0; i < WAFERS; i++) {
        names[i] = name;
    }
    for (size_t i = 0; i < sizeof(stations) / sizeof(stations[0]); i++) {
        stations[i].name = name;
    }
    const waferhand_cell message = {.layout = name,
                                    .gripper_count = GRIPPERS,
                                    .station_count = sizeof(stations) / sizeof(stations[0]),
                                    .wafer_count = WAFERS,
                                    .gripper_names = names,
                                    .valve_names = names,
                                    .stations = stations,
                                    .wafer_names = names,
                                    .wafers = wafers};
    const int size = waferhand_cell_encoded_size(&message);
    print_message("cell of %d wafers: %d bytes\n", WAFERS, size);
    assert_true(size <= DATAGRAM);
}

static void fixed_sizes(void **state) {
    (void)state;
    const waferhand_command command = {0};
    const waferhand_proximity proximity = {0};
    assert_int_equal(waferhand_command_encoded_size(&command), 2493);
    assert_int_equal(waferhand_proximity_encoded_size(&proximity), 964);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fingerprints_differ),
        cmocka_unit_test(largest_state_fits),
        cmocka_unit_test(large_cell_fits),
        cmocka_unit_test(fixed_sizes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
