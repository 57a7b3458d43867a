/* Any datagrams on the channels of the two processes, to the simulator's real handlers or to motion control's, over a network
 * that is a function call and a clock that is a number.
 *
 * The simulator: a datagram that is not stepped or taken over leaves the state as it was; whatever state it comes to,
 * another simulator takes over with the same hash. Motion control: every state that it takes is sound and of the hash that
 * it says, every event of it can be reported; else what it knows stays as it was. */
#include "message_frames.h"

#include <string.h>

#include "fake_node.h"
#include "fuzz.h"
#include "grasp/restore.h"
#include "layout/layout.h"
#include "link/mcs_process.h"
#include "link/messages.h"
#include "link/sim_process.h"
#include "print/record_print.h"
#include "text/array.h"

/* An input's first byte. */
enum { TO_MOTION_CONTROL = 1, FREE_RUNNING = 2, SWEPT = 4 };

/* Not a random one. */
#define RUN 4711

static const wh_layout_t *sampled, *swept;
static const wh_layout_t *layout; /* one of them */
static wh_node_t node;
static FILE *nowhere;

static const wh_layout_t *load(const char *path) {
    wh_sandbox_result_t result;
    wh_sandbox_t *const sandbox = wh_sandbox_new(NULL);
    const wh_layout_t *const loaded = sandbox ? wh_layout_load(sandbox, path, &result) : NULL;
    REQUIRE(loaded != NULL);
    return loaded;
}

int LLVMFuzzerInitialize(int *argc, char ***argv) {
    (void)argc;
    (void)argv;
    sampled = load("lua/layouts/paper.lua");
    swept = load("tests/fuzz/cell.lua");
    nowhere = fopen("/dev/null", "w");
    REQUIRE(nowhere != NULL);
    return 0;
}

/* Both arrays in a table that takes over only what is sound. */
static void check_sound(const wh_wafer_t *wafers, const wh_gripper_t *grippers,
                        const wh_physics_state_t *condition, uint64_t slice, uint64_t hash) {
    static wh_link_arrays_t arrays;
    wh_grasp_t table;
    memset(&table, 0, sizeof table);
    table.config = layout->grasp;
    table.mark = WH_GRASP_MARK;
    table.storage.wafers = arrays.wafers;
    table.storage.wafer_count = layout->wafer_count;
    table.storage.grippers = arrays.grippers;
    table.storage.gripper_count = layout->machine.gripper_count;
    REQUIRE(wh_grasp_restore(&table, slice, wafers, grippers) == WH_OK);
    REQUIRE(wh_physics_state_validate(condition, table.storage.gripper_count, table.storage.wafer_count) ==
            WH_OK);
    REQUIRE(wh_physics_state_hash(condition, &table) == hash);
}

/* ------------------------------------------------------------------------------------------------- any cell */

static void check_cell(const fuzz_frame_t *frame) {
    static wh_protocol_server_t server;
    waferhand_cell cell;
    if (!wh_link_decode_cell(frame->bytes, frame->size, &cell)) {
        return;
    }
    wh_layout_t *const made = wh_link_layout_from_cell(&cell);
    if (made) {
        REQUIRE(wh_protocol_server_open(&server, made) == WH_OK);
        /* A table of nothing would be one that was refused. */
        REQUIRE(server.simulator.table.storage.gripper_count == (size_t)cell.gripper_count);
        REQUIRE(server.simulator.table.storage.wafer_count == (size_t)cell.wafer_count);
    }
    wh_link_layout_free(made);
    (void)waferhand_cell_decode_cleanup(&cell);
}

/* ------------------------------------------------------------------------------------------------ simulator */

static wh_sim_process_t simulation;

static void check_counters(void) {
    const wh_protocol_server_counters_t *const c = &simulation.server.counters;
    REQUIRE(c->commands == c->stepped + c->repeated + c->stale + c->refused + c->unknown_run +
                               c->other_layout + c->run_over + c->malformed);
    REQUIRE(c->restores == c->restored + c->restore_ignored + c->restore_refused);
}

/* What goes out can be read; a whole state, by another simulator. */
static void check_published(const char *channel, const void *data, size_t size) {
    static wh_protocol_server_t twin;
    waferhand_state message;
    if (strcmp(channel, WH_CHANNEL_STATE) != 0) {
        return;
    }
    REQUIRE(wh_link_decode_state(data, size, &message));
    if (message.status == WH_OK && message.seq >= 1) {
        if (twin.layout != layout) {
            REQUIRE(wh_protocol_server_open(&twin, layout) == WH_OK);
        }
        twin.identity.run = 0;
        twin.past_count = 0;
        REQUIRE(wh_protocol_server_restore(&twin, &message) == WH_SERVER_RESTORED);
        REQUIRE(wh_protocol_server_hash(&twin) == (uint64_t)message.hash);
        REQUIRE(wh_protocol_server_hash(&twin) == wh_protocol_server_hash(&simulation.server));
    }
    REQUIRE(waferhand_state_decode_cleanup(&message) == 0);
}

static void deliver_to_simulator(const fuzz_frame_t *frame) {
    wh_protocol_server_t *const server = &simulation.server;
    const uint64_t hash = wh_protocol_server_hash(server);
    const uint64_t done = server->counters.stepped + server->counters.restored;
    const int64_t run = server->identity.run;
    const int64_t seq = server->seq;
    fuzz_deliver(&node, frame->channel, frame->bytes, frame->size);
    check_counters();
    if (done == server->counters.stepped + server->counters.restored && run == server->identity.run) {
        REQUIRE(wh_protocol_server_hash(server) == hash && server->seq == seq);
    }
    const wh_grasp_storage_t *const storage = &server->simulator.table.storage;
    check_sound(storage->wafers, storage->grippers, &server->simulator.physics, server->simulator.table.slice,
                wh_protocol_server_hash(server));
    REQUIRE(server->seq == (int64_t)server->simulator.table.slice + server->missed);
}

static void run_simulator(fuzz_frames_t *frames) {
    fuzz_frame_t frame;
    fuzz_on_publish = check_published;
    REQUIRE(wh_sim_process_open(&simulation, &node, layout, true) == WH_OK);
    wh_link_identity_t identity = simulation.server.identity;
    frames->identity = &identity;
    while (true) {
        identity.run = simulation.server.identity.run != 0 ? simulation.server.identity.run : RUN;
        frames->next_seq = simulation.server.seq + 1;
        if (!fuzz_next_frame(frames, &frame)) {
            break;
        }
        (void)fuzz_check_decoding(&frame);
        deliver_to_simulator(&frame);
        fuzz_clock_us += WH_SIMULATION_SILENCE_US / 2;
        wh_sim_process_tick(&simulation);
    }
    wh_sim_process_close(&simulation);
}

/* ------------------------------------------------------------------------------------------- motion control */

static wh_mcs_process_t control;
static fuzz_frames_t *incoming;
static volatile sig_atomic_t stop;
static wh_record_t record;
static wh_record_t asked; /* what STATUS looks at */

static bool next_message(wh_node_t *to) {
    fuzz_frame_t frame;
    incoming->next_seq = control.client.command.seq;
    if (!fuzz_next_frame(incoming, &frame)) {
        stop = 1;
        return false;
    }
    (void)fuzz_check_decoding(&frame);
    if (strcmp(frame.channel, WH_CHANNEL_CELL) == 0) {
        check_cell(&frame);
    }
    /* What the state that is known has as its hash, it has after each datagram. */
    fuzz_deliver(to, frame.channel, frame.bytes, frame.size);
    const wh_protocol_client_t *const client = &control.client;
    if (client->has_state) {
        check_sound(client->state.wafers, client->state.grippers, client->state.physics,
                    (uint64_t)(client->state.seq - client->missed), client->hash);
    }
    return true;
}

static bool is_index(int32_t index, size_t count) {
    return index >= 0 && (size_t)index < count;
}

/* As grasp/event.h has it: whoever explains an event looks its wafer and grippers up. */
static void check_event(const wh_event_t *event, int64_t seq) {
    const size_t wafers = layout->wafer_count;
    const size_t grippers = layout->machine.gripper_count;
    static const uint32_t nameless = 1U << WH_EVENT_HIT | 1U << WH_EVENT_UNDECIDED |
                                     1U << WH_EVENT_TOO_CLOSE | 1U << WH_EVENT_FAULT_ARMED |
                                     1U << WH_EVENT_FAULT_CLEARED;
    const bool of_parts = (nameless >> (unsigned)event->kind & 1U) != 0;
    const bool no_wafer = event->kind == WH_EVENT_BAD_INPUT || of_parts;
    REQUIRE(strcmp(wh_event_name(event->kind), "unknown") != 0);
    REQUIRE((no_wafer && event->wafer == WH_NONE) || is_index(event->wafer, wafers));
    REQUIRE((of_parts && event->gripper == WH_NONE) || is_index(event->gripper, grippers));
    REQUIRE(event->measured_slice <= (uint64_t)seq);
    if (event->kind == WH_EVENT_SLOT_OCCUPIED) {
        REQUIRE(is_index(event->other, wafers));
    } else if (event->kind == WH_EVENT_HANDED_OVER || event->kind == WH_EVENT_CONTESTED) {
        REQUIRE(is_index(event->other, grippers));
    }
}

/* The events of the states that were taken, as a run's report has them. */
static void check_report(void) {
    static const wh_style_t style = {.utf8 = true, .width = 80};
    if (record.event_count > 0) {
        record.layout = layout;
        record.script = wh_text_copy("fuzz");
        record.wafers = calloc(layout->wafer_count + 1, sizeof *record.wafers);
        for (size_t w = 0; record.wafers && w < layout->wafer_count; ++w) {
            record.wafers[w].base_from_wafer = wh_pose_identity();
            record.wafers[w].holder = record.wafers[w].place.station = WH_NONE;
        }
        REQUIRE(wh_record_print_json(&record, nowhere) == 0);
        REQUIRE(wh_record_print_table(&record, nowhere, &style, NULL) == 0);
    }
    wh_record_free(&record);
}

static void take_requests(void) {
    char line[WH_LINK_LINE];
    REQUIRE(control.waiting_count <= WH_CONTROL_REQUESTS);
    while (wh_mcs_process_next_request(&control, line)) {
        REQUIRE(control.executing.seq != 0);
        wh_mcs_process_answer(&control, strlen(line) % 2 == 0 ? WH_OK : WH_STATUS_BAD_ARGUMENT, line);
        REQUIRE(control.executing.seq == 0);
    }
}

static void fill_command(wh_command_t *command, int64_t seq) {
    memset(command, 0, sizeof *command);
    command->seq = seq;
    command->utime = seq * layout->slice_us;
    command->gripper_count = layout->machine.gripper_count;
    command->axis_count = layout->machine.axis_count;
    for (size_t g = 0; g < command->gripper_count; ++g) {
        command->grippers[g].base_from_gripper = wh_pose_identity();
        command->grippers[g].valve = WH_VALVE_CLOSED;
    }
}

static wh_link_t *open_control(bool free_running) {
    static wh_mcs_t mcs;
    const wh_protocol_client_options_t options = {.rate = free_running ? 1 : 0, .stop = &stop};
    mcs.layout = layout;
    if (!mcs.recorder.record) {
        wh_recorder_open(&mcs.recorder, &asked, "fuzz");
    }
    REQUIRE(wh_mcs_process_open(&control, &node, &options));
    const wh_mcs_partners_t partners = wh_mcs_process_partners(&control);
    wh_link_t *const link = partners.connect(partners.user, &mcs);
    REQUIRE(link != NULL);
    control.client.identity.run = RUN;
    control.script = free_running ? "fuzz.lua" : NULL;
    return link;
}

static void run_motion_control(fuzz_frames_t *frames, bool free_running) {
    wh_command_t command;
    wh_state_t state;
    fuzz_on_publish = NULL;
    incoming = frames;
    stop = 0;
    wh_link_t *const link = open_control(free_running);
    frames->identity = &control.client.identity;
    memset(&state, 0, sizeof state);
    for (int64_t seq = 1; stop == 0; ++seq) {
        fill_command(&command, seq);
        const wh_status_t status = link->exchange(link, &command, &state);
        REQUIRE(status != WH_OK || free_running || (state.seq == seq && state.status == WH_OK));
        for (size_t i = 0; i < state.event_count; ++i) {
            check_event(&state.events[i], seq);
            wh_record_add_event(&record, state.utime, WH_NONE, &state.events[i]);
        }
        wh_mcs_process_idle(&control);
        take_requests();
    }
    (void)link->hash(link);
    wh_mcs_process_finish(&control);
    wh_mcs_process_close(&control);
    check_report();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size == 0) {
        return 0;
    }
    fuzz_frames_t frames = {.at = data + 1, .left = size - 1};
    layout = data[0] & SWEPT ? swept : sampled;
    fuzz_next_message = next_message;
    fuzz_clock_us = 1000000;
    REQUIRE(wh_node_open(&node, NULL, NULL));
    if (data[0] & TO_MOTION_CONTROL) {
        run_motion_control(&frames, (data[0] & FREE_RUNNING) != 0);
    } else {
        run_simulator(&frames);
    }
    return 0;
}
