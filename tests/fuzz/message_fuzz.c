/* Any datagrams on the channels of the two processes, to the real handlers of the simulator or of
 * motion control. The network is a function call and the clock is a number.
 *
 * The simulator: a datagram that is neither stepped nor taken over leaves the state unchanged.
 * Another simulator takes over every state that it reaches, with the same hash. Motion control:
 * every state that it takes over is sound and has the hash that it names, and each of its events
 * can be reported. Otherwise the known state stays unchanged. */
#include <string.h>

#include "fake_node.h"
#include "fuzz.h"
#include "grasp/grasp.h"
#include "grasp/restore.h"
#include "layout/layout.h"
#include "link/mcs_process.h"
#include "link/sim_process.h"
#include "print/record_print.h"
#include "reading/layout_read.h"
#include "record/seat.h"
#include "text/array.h"
#include "wire/messages.h"

/* ------------------------------------------------------------------------------------------------- datagrams */

/* A sequence of datagrams in the bytes of an input; fields that a fuzzer cannot guess are corrected. */

/* Each begins with four bytes: channel, the fields to correct, and the length, big-endian. */
typedef struct {
    const char *channel;
    uint8_t *bytes; /* in memory of the frame's own, free for use until the next */
    size_t size;
} frame_t;

typedef struct {
    const uint8_t *at;
    size_t left;
    const wh_link_identity_t *identity; /* a message can be made to belong to this run and layout */
    int64_t next_seq;                   /* likewise */
} frames_t;

/* The fields to correct, or-ed. */
enum { FINGERPRINT = 1, IDENTITY = 2, SEQ = 4, HASH = 8, SEAL = 16, SLICE_LATER = 32 };

static const char *const channels[] = {WH_CHANNEL_COMMAND,   WH_CHANNEL_STATE,   WH_CHANNEL_RESTORE,
                                       WH_CHANNEL_MCS,       WH_CHANNEL_REQUEST, WH_CHANNEL_CELL,
                                       WH_CHANNEL_EDGE_SCAN, WH_CHANNEL_LATCH};

static int64_t fingerprint_of(const char *channel) {
    if (strcmp(channel, WH_CHANNEL_COMMAND) == 0) {
        return __waferhand_command_get_hash();
    }
    if (strcmp(channel, WH_CHANNEL_MCS) == 0) {
        return __waferhand_mcs_get_hash();
    }
    if (strcmp(channel, WH_CHANNEL_REQUEST) == 0) {
        return __waferhand_request_get_hash();
    }
    if (strcmp(channel, WH_CHANNEL_CELL) == 0) {
        return __waferhand_cell_get_hash();
    }
    if (strcmp(channel, WH_CHANNEL_EDGE_SCAN) == 0) {
        return __waferhand_edge_scan_get_hash();
    }
    if (strcmp(channel, WH_CHANNEL_LATCH) == 0) {
        return __waferhand_centring_get_hash();
    }
    return __waferhand_state_get_hash();
}

static void put_word(const frame_t *frame, size_t at, int64_t value) {
    for (size_t i = 0; i < 8 && frame->size >= at + 8; ++i) {
        frame->bytes[at + i] = (uint8_t)((uint64_t)value >> (56 - 8 * i) & 0xffU);
    }
}

/* wh_grasp_hash over a state message, computed from the message's fields; 0 if it cannot be computed. */
static uint64_t hash_of(const waferhand_state *message) {
    static wh_link_arrays_t arrays;
    const wh_tolerance_t tolerance = wh_tolerance_paper();
    wh_state_t state;
    wh_grasp_t table;
    if (message->missed < 0 || message->seq < message->missed ||
        wh_link_state_from_message(message, &tolerance, &arrays, &state) != WH_OK) {
        return 0;
    }
    memset(&table, 0, sizeof table);
    table.slice = (uint64_t)(message->seq - message->missed);
    table.storage.wafers = arrays.wafers;
    table.storage.wafer_count = state.wafer_count;
    table.storage.grippers = arrays.grippers;
    table.storage.gripper_count = state.gripper_count;
    return wh_physics_state_hash(&arrays.physics, &table);
}

/* The offset of the hash: fingerprint, four words, status and five counts stand before it. */
#define HASH_AT (8 + 4 * 8 + 6 * 4)

static void put_hash(frame_t *frame) {
    waferhand_state message;
    wh_link_seal(frame->bytes, frame->size);
    if (wh_link_decode_state(frame->bytes, frame->size, &message)) {
        put_word(frame, HASH_AT, (int64_t)hash_of(&message));
        (void)waferhand_state_decode_cleanup(&message);
    }
}

static bool is_checked(const char *channel) {
    return strcmp(channel, WH_CHANNEL_COMMAND) == 0 || strcmp(channel, WH_CHANNEL_STATE) == 0 ||
           strcmp(channel, WH_CHANNEL_RESTORE) == 0;
}

static void put_right(const frames_t *frames, frame_t *frame, unsigned what) {
    if (what & FINGERPRINT) {
        put_word(frame, 0, fingerprint_of(frame->channel));
    }
    if (what & SEQ) {
        put_word(frame, 16, frames->next_seq + (what & SLICE_LATER ? 1 : 0));
    }
    if (what & IDENTITY) {
        put_word(frame, 24, frames->identity->run);
        put_word(frame, 32, (int64_t)frames->identity->layout_hash);
    }
    if (what & HASH && is_checked(frame->channel) && strcmp(frame->channel, WH_CHANNEL_COMMAND) != 0) {
        put_hash(frame);
    }
    if (what & SEAL && is_checked(frame->channel)) {
        wh_link_seal(frame->bytes, frame->size);
    }
}

/* The next frame; false if there is none. */
static bool next_frame(frames_t *frames, frame_t *frame) {
    static uint8_t bytes[WH_LINK_DATAGRAM + 1];
    if (frames->left < 4) {
        return false;
    }
    const uint8_t *const head = frames->at;
    const size_t length = (size_t)head[2] << 8 | head[3];
    frames->at += 4;
    frames->left -= 4;
    frame->channel = channels[head[0] % (sizeof channels / sizeof channels[0])];
    frame->bytes = bytes;
    frame->size = length < frames->left ? length : frames->left;
    memcpy(bytes, frames->at, frame->size);
    frames->at += frame->size;
    frames->left -= frame->size;
    put_right(frames, frame, head[1]);
    return true;
}

static uint8_t again[2 * WH_LINK_DATAGRAM];

#define DEFINE_CHECK(name)                                                                                   \
    static bool again_##name(const frame_t *frame) {                                                         \
        waferhand_##name message;                                                                            \
        if (!wh_link_decode_##name(frame->bytes, frame->size, &message)) {                                   \
            return false;                                                                                    \
        }                                                                                                    \
        const int size = waferhand_##name##_encode(again, 0, (int)sizeof again, &message);                   \
        REQUIRE(size >= 0 && (size_t)size == frame->size);                                                   \
        REQUIRE(memcmp(again, frame->bytes, frame->size) == 0);                                              \
        REQUIRE(waferhand_##name##_decode_cleanup(&message) == 0);                                           \
        return true;                                                                                         \
    }

DEFINE_CHECK(command)
DEFINE_CHECK(state)
DEFINE_CHECK(mcs)
DEFINE_CHECK(request)
DEFINE_CHECK(cell)
DEFINE_CHECK(edge_scan)
DEFINE_CHECK(centring)

/* LCM encodes every message that its channel's decoder accepts to the same bytes. True if it was accepted. */
static bool check_decoding(const frame_t *frame) {
    static bool (*const checks[])(const frame_t *frame) = {again_command,   again_state,   again_state,
                                                           again_mcs,       again_request, again_cell,
                                                           again_edge_scan, again_centring};
    for (size_t i = 0; i < sizeof channels / sizeof channels[0]; ++i) {
        if (frame->channel == channels[i]) {
            return checks[i](frame);
        }
    }
    return false;
}

/* ----------------------------------------------------------------------------------------------- the cell */

/* An input's first byte. */
enum { TO_MOTION_CONTROL = 1, FREE_RUNNING = 2, SWEPT = 4 };

/* A fixed value instead of a random one. */
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

/* Both arrays in a table, which takes over only sound ones. */
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

static void check_cell(const frame_t *frame) {
    static wh_protocol_server_t server;
    waferhand_cell cell;
    if (!wh_link_decode_cell(frame->bytes, frame->size, &cell)) {
        return;
    }
    wh_layout_t *const made = wh_link_layout_from_cell(&cell);
    if (made) {
        REQUIRE(wh_protocol_server_open(&server, made) == WH_OK);
        /* A table of nothing would count as refused. */
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

/* Sent messages can be read; a whole state can be read by another simulator. */
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

static void deliver_to_simulator(const frame_t *frame) {
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

static void run_simulator(frames_t *frames) {
    frame_t frame;
    fuzz_on_publish = check_published;
    REQUIRE(wh_sim_process_open(&simulation, &node, layout, true) == WH_OK);
    wh_link_identity_t identity = simulation.server.identity;
    frames->identity = &identity;
    while (true) {
        identity.run = simulation.server.identity.run != 0 ? simulation.server.identity.run : RUN;
        frames->next_seq = simulation.server.seq + 1;
        if (!next_frame(frames, &frame)) {
            break;
        }
        (void)check_decoding(&frame);
        deliver_to_simulator(&frame);
        fuzz_clock_us += WH_SIMULATION_SILENCE_US / 2;
        wh_sim_process_tick(&simulation);
    }
    wh_sim_process_close(&simulation);
}

/* ------------------------------------------------------------------------------------------- motion control */

static wh_mcs_process_t control;
static frames_t *incoming;
static volatile sig_atomic_t stop;
static wh_record_t record;
static wh_record_t asked; /* the data that STATUS reads */

static bool next_message(wh_node_t *to) {
    frame_t frame;
    incoming->next_seq = control.client.command.seq;
    if (!next_frame(incoming, &frame)) {
        stop = 1;
        return false;
    }
    (void)check_decoding(&frame);
    if (strcmp(frame.channel, WH_CHANNEL_CELL) == 0) {
        check_cell(&frame);
    }
    /* After each datagram, the known state has the hash that it names. */
    fuzz_deliver(to, frame.channel, frame.bytes, frame.size);
    const wh_protocol_client_t *const client = &control.client;
    if (client->taken.is_there) {
        check_sound(client->taken.state.wafers, client->taken.state.grippers, client->taken.state.physics,
                    (uint64_t)(client->taken.state.seq - client->taken.missed), client->taken.hash);
    }
    return true;
}

static bool is_index(int32_t index, size_t count) {
    return index >= 0 && (size_t)index < count;
}

/* True if `other` names what this kind of event has there. */
static bool other_is_known(const wh_event_t *event, size_t wafers, size_t grippers) {
    const wh_event_kind_t kind = event->kind;
    const bool is_pushed = kind == WH_EVENT_PUSHED_THROUGH;
    if (kind == WH_EVENT_HANDED_OVER || kind == WH_EVENT_CONTESTED) {
        return is_index(event->other, grippers);
    }
    if (is_pushed && event->other == WH_NONE) {
        return event->wafer != WH_NONE;
    }
    return (!is_pushed && kind != WH_EVENT_SLOT_OCCUPIED) || is_index(event->other, wafers);
}

/* The rule of grasp/event.h: the code that explains an event looks its wafer and grippers up. */
static void check_event(const wh_event_t *event, int64_t seq) {
    const size_t wafers = layout->wafer_count;
    const size_t grippers = layout->machine.gripper_count;
    static const uint32_t nameless = 1U << WH_EVENT_HIT | 1U << WH_EVENT_UNDECIDED |
                                     1U << WH_EVENT_TOO_CLOSE | 1U << WH_EVENT_FAULT_ARMED |
                                     1U << WH_EVENT_FAULT_CLEARED;
    static const uint32_t waferless = 1U << WH_EVENT_BAD_INPUT | 1U << WH_EVENT_PUSHED_THROUGH;
    const bool of_parts = (nameless >> (unsigned)event->kind & 1U) != 0;
    const bool no_wafer = ((nameless | waferless) >> (unsigned)event->kind & 1U) != 0;
    REQUIRE(strcmp(wh_event_name(event->kind), "unknown") != 0);
    REQUIRE((no_wafer && event->wafer == WH_NONE) || is_index(event->wafer, wafers));
    REQUIRE((of_parts && event->gripper == WH_NONE) || is_index(event->gripper, grippers));
    REQUIRE(event->measured_slice <= (uint64_t)seq);
    REQUIRE(other_is_known(event, wafers, grippers));
}

/* The events of the accepted states, in the form of a run's report. */
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
    REQUIRE(control.requests.waiting_count <= WH_CONTROL_REQUESTS);
    while (wh_mcs_process_next_request(&control, line)) {
        REQUIRE(control.requests.executing.seq != 0);
        wh_mcs_process_answer(&control, strlen(line) % 2 == 0 ? WH_OK : WH_STATUS_BAD_ARGUMENT, line);
        REQUIRE(control.requests.executing.seq == 0);
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

static void run_motion_control(frames_t *frames, bool free_running) {
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
            const wh_seat_t seat = wh_seat_of(layout, &state, &state.events[i]);
            wh_record_add_event(&record, state.utime, WH_NONE, &state.events[i], &seat);
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
    frames_t frames = {.at = data + 1, .left = size - 1};
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
