#include "replay.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../text/array.h"
#include "replay_internal.h"

static void lose(wh_replay_t *replay, wh_replay_loss_t loss) {
    if (replay->losses[loss].count++ == 0) {
        replay->losses[loss].first = replay->at;
    }
}

/* ---------------------------------------------------------------------------------------------------- runs */

static wh_replay_run_t *find_run(wh_replay_t *replay, int64_t run) {
    for (size_t i = replay->run_count; i > 0; --i) {
        if (replay->runs[i - 1].run == run) {
            return &replay->runs[i - 1];
        }
    }
    return NULL;
}

/* The entry of a run, made if it is not there; null if there are too many. */
static wh_replay_run_t *entry(wh_replay_t *replay, int64_t run) {
    wh_replay_run_t *found = find_run(replay, run);
    if (found || replay->run_count == WH_REPLAY_RUNS) {
        replay->runs_left_out += found ? 0 : 1;
        return found;
    }
    wh_replay_run_t *made = &replay->runs[replay->run_count++];
    memset(made, 0, sizeof *made);
    made->run = run;
    return made;
}

static wh_replay_cell_t *find_cell(wh_replay_t *replay, uint64_t hash) {
    for (size_t i = 0; i < replay->cell_count; ++i) {
        if (replay->cells[i].hash == hash) {
            return &replay->cells[i];
        }
    }
    return NULL;
}

static bool is_wanted(const wh_replay_t *replay, int64_t run) {
    return replay->only_run == 0 || replay->only_run == run;
}

static void begin_run(wh_replay_t *replay, wh_replay_run_t *run, const wh_replay_cell_t *cell) {
    replay->run = run;
    run->is_begun = true;
    run->layout_hash = cell->hash;
    replay->seq = replay->last_pending = 0;
    replay->is_synchronous = replay->is_unsure = false;
    if (replay->cell != cell) {
        wh_protocol_server_close(&replay->server);
        (void)wh_protocol_server_open(&replay->server, cell->layout);
        replay->server.identity.layout_hash = cell->hash;
        replay->cell = cell;
    }
}

/* Makes the run of a command or a state the current one. False, and counted, if it cannot go through. */
static bool enter_run(wh_replay_t *replay, int64_t id, uint64_t layout_hash) {
    if (replay->run && replay->run->run == id) {
        return true;
    }
    const wh_replay_cell_t *cell = find_cell(replay, layout_hash);
    wh_replay_run_t *run = cell ? entry(replay, id) : NULL;
    if (!cell) {
        lose(replay, WH_REPLAY_HOMELESS);
    } else if (run && run->is_begun) {
        lose(replay, WH_REPLAY_LATE);
        return false;
    }
    if (!run) {
        return false;
    }
    wh_replay_finish(replay);
    begin_run(replay, run, cell);
    return true;
}

static void note_slice(wh_replay_t *replay) {
    wh_replay_run_t *run = replay->run;
    if (run->first_slice == 0) {
        run->first_slice = replay->server.seq;
    }
    run->last_slice = replay->server.seq;
    run->missed = replay->server.missed;
    run->hash = wh_protocol_server_hash(&replay->server);
}

/* ------------------------------------------------------------------------------------------------- waiting */

static wh_replay_slot_t *slot_of(wh_replay_t *replay, int64_t seq) {
    return &replay->slots[seq % WH_REPLAY_WINDOW];
}

static bool has_command(wh_replay_t *replay, int64_t seq) {
    return slot_of(replay, seq)->seq == seq && slot_of(replay, seq)->has_command;
}

static bool has_state(wh_replay_t *replay, int64_t seq) {
    return slot_of(replay, seq)->seq == seq && slot_of(replay, seq)->state;
}

static void empty(wh_replay_slot_t *slot) {
    free(slot->state);
    memset(slot, 0, offsetof(wh_replay_slot_t, command));
    slot->state = NULL;
    slot->size = 0;
}

/* Slices up to this one have gone through. */
static void advance_to(wh_replay_t *replay, int64_t seq) {
    const int64_t last = seq < replay->last_pending ? seq : replay->last_pending;
    for (int64_t i = replay->seq + 1; i <= last; ++i) {
        if (slot_of(replay, i)->seq == i) {
            empty(slot_of(replay, i));
        }
    }
    replay->seq = seq;
}

static int64_t first_command(wh_replay_t *replay) {
    int64_t seq = replay->seq + 1;
    while (seq <= replay->last_pending && !has_command(replay, seq)) {
        ++seq;
    }
    return seq <= replay->last_pending ? seq : 0;
}

static int64_t first_state(wh_replay_t *replay) {
    int64_t seq = replay->seq + 1;
    while (seq <= replay->last_pending && !has_state(replay, seq)) {
        ++seq;
    }
    return seq <= replay->last_pending ? seq : 0;
}

/* True if the next slice can be stepped, once it is there: the run is known up to here. */
static bool is_at_hand(wh_replay_t *replay) {
    return replay->is_synchronous || (replay->seq == 0 && has_command(replay, 1));
}

static int64_t missed_so_far(const wh_replay_t *replay) {
    return replay->is_synchronous ? replay->server.missed : 0;
}

/* ---------------------------------------------------------------------------------------------- comparing */

static void tell(const wh_replay_t *replay, const waferhand_command *command,
                 const waferhand_state *message) {
    if (replay->listener) {
        replay->listener(replay->user, command, message);
    }
}

static void note_difference(wh_replay_run_t *run, int64_t slice, const wh_replay_difference_t *difference) {
    if (run->differing++ == 0) {
        run->difference = *difference;
        run->difference.slice = slice;
    }
}

static int64_t count_collisions(const waferhand_state *message) {
    int64_t count = 0;
    for (int32_t i = 0; i < message->event_count; ++i) {
        count += wh_replay_is_collision(message->events[i].kind) ? 1 : 0;
    }
    return count;
}

/* Goes on from a recorded state. False if no simulator could have been in it. */
static bool restore(wh_replay_t *replay, const waferhand_state *message) {
    if (replay->server.identity.run == message->run) {
        replay->server.identity.run = 0; /* else what is behind it is refused */
    }
    replay->is_unsure = false;
    replay->is_synchronous = wh_protocol_server_restore(&replay->server, message) == WH_SERVER_RESTORED;
    if (replay->is_synchronous) {
        note_slice(replay);
    }
    return replay->is_synchronous;
}

/* The recorded state with the server's answer. */
static void compare(wh_replay_t *replay, const waferhand_state *message, const uint8_t *bytes, size_t size) {
    const wh_protocol_server_t *server = &replay->server;
    wh_replay_run_t *run = replay->run;
    wh_replay_difference_t difference;
    ++run->compared;
    run->collisions += count_collisions(message);
    const bool same = size == server->encoded_size && memcmp(bytes, server->encoded, size - 8) == 0;
    if (same || !wh_replay_differs(server->layout, message, &server->room.message, &difference)) {
        replay->is_unsure = false;
    } else if (replay->is_unsure) {
        ++run->doubtful;
        (void)restore(replay, message);
    } else {
        note_difference(run, message->seq, &difference);
    }
}

/* A command that the simulator took and the replay refuses, or the other way round. */
static void differ_in_status(wh_replay_run_t *run, int64_t slice, int32_t recorded, int32_t replayed) {
    wh_replay_difference_t difference = {.recorded = recorded, .replayed = replayed};
    (void)snprintf(difference.what, sizeof difference.what, "status");
    ++run->compared;
    note_difference(run, slice, &difference);
}

/* The valves in force as the state tells; null if they are the command's. */
static const int32_t *find_valves(const waferhand_command *command, const waferhand_state *message,
                                  int32_t valves[WH_GRIPPERS]) {
    bool outside = false;
    for (int32_t g = 0; g < message->gripper_count && g < command->gripper_count && g < WH_GRIPPERS; ++g) {
        valves[g] = message->grippers[g].valve_told;
        outside = outside || valves[g] != command->valve[g];
    }
    return outside ? valves : NULL;
}

static void step(wh_replay_t *replay, const waferhand_command *command, const waferhand_state *message,
                 const wh_replay_slot_t *slot) {
    int32_t told[WH_GRIPPERS] = {0};
    const int32_t *valves = find_valves(command, message, told);
    const wh_protocol_server_result_t result = wh_protocol_server_command(&replay->server, command, valves);
    if (result == WH_SERVER_STEPPED || result == WH_SERVER_NEW_RUN) {
        replay->is_synchronous = true;
        replay->run->outside_valves += valves ? 1 : 0;
        note_slice(replay);
        compare(replay, message, slot->state, slot->size);
    } else {
        differ_in_status(replay->run, message->seq, WH_OK, replay->server.room.message.status);
        (void)restore(replay, message);
    }
}

/* A slice of which command and state are there. */
static void resolve(wh_replay_t *replay, int64_t seq) {
    const wh_replay_slot_t *slot = slot_of(replay, seq);
    waferhand_state message;
    if (wh_link_decode_state(slot->state, slot->size, &message)) {
        step(replay, &slot->command, &message, slot);
        tell(replay, &slot->command, &message);
        (void)waferhand_state_decode_cleanup(&message);
    }
    advance_to(replay, seq);
}

/* A slice whose state is not in the log, though later ones are. */
static void step_unanswered(wh_replay_t *replay, int64_t seq) {
    const wh_protocol_server_result_t result =
        wh_protocol_server_command(&replay->server, &slot_of(replay, seq)->command, NULL);
    ++replay->run->unanswered;
    replay->is_unsure = true;
    replay->is_synchronous = result == WH_SERVER_STEPPED || result == WH_SERVER_NEW_RUN;
    if (replay->is_synchronous) {
        note_slice(replay);
    }
    advance_to(replay, seq);
}

/* A state whose command, or one before it, is not in the log. */
static void take_up(wh_replay_t *replay, int64_t seq) {
    const wh_replay_slot_t *slot = slot_of(replay, seq);
    const int64_t skipped = seq - replay->seq - 1;
    waferhand_state message;
    if (wh_link_decode_state(slot->state, slot->size, &message)) {
        if (restore(replay, &message)) {
            ++replay->run->taken_up;
            replay->run->skipped += skipped;
            tell(replay, slot->has_command ? &slot->command : NULL, &message);
        } else {
            lose(replay, WH_REPLAY_GARBAGE);
        }
        (void)waferhand_state_decode_cleanup(&message);
    }
    advance_to(replay, seq);
}

/* ------------------------------------------------------------------------------------------ going through */

/* Free-running: true if the simulator says that it missed all commands before this state's. */
static bool is_behind_missed(wh_replay_t *replay, int64_t state) {
    const wh_replay_slot_t *slot = slot_of(replay, state);
    return has_command(replay, state) && slot->command.lockstep == 0 &&
           slot->missed - missed_so_far(replay) == state - replay->seq - 1;
}

/* Lets the next slice through if it is there. */
static bool let_through(wh_replay_t *replay) {
    const int64_t state = first_state(replay);
    if (state == 0) {
        return false;
    }
    if (!is_at_hand(replay) && !(replay->seq == 0 && state == 1)) {
        take_up(replay, state);
        return true;
    }
    const bool is_next = state == replay->seq + 1 && has_command(replay, state);
    if (is_next || is_behind_missed(replay, state)) {
        resolve(replay, state);
        return true;
    }
    return false;
}

/* True if each slice up to this one's has its command, and the simulator missed none. */
static bool is_stepped_to(wh_replay_t *replay, int64_t state) {
    bool whole = is_at_hand(replay);
    for (int64_t seq = replay->seq + 1; whole && seq <= state; ++seq) {
        whole = has_command(replay, seq);
    }
    return whole && slot_of(replay, state)->missed == missed_so_far(replay);
}

/* Something does not come any more: what waits longest goes through without it. False if only commands
 * wait. */
static bool force(wh_replay_t *replay) {
    const int64_t state = first_state(replay);
    if (state == 0) {
        return false;
    }
    if (!is_stepped_to(replay, state)) {
        take_up(replay, state);
    } else if (state > replay->seq + 1) {
        step_unanswered(replay, replay->seq + 1);
    } else {
        resolve(replay, state);
    }
    return true;
}

/* The same where only commands wait. False if none does. */
static bool force_command(wh_replay_t *replay) {
    const int64_t command = first_command(replay);
    if (command == 0) {
        return false;
    }
    if (command == replay->seq + 1 && is_at_hand(replay)) {
        step_unanswered(replay, command);
    } else {
        ++replay->run->unanswered;
        replay->is_synchronous = false;
        advance_to(replay, command);
    }
    return true;
}

/* The slice's place in the window, which moves on for it. */
static wh_replay_slot_t *make_slot(wh_replay_t *replay, int64_t seq) {
    while (seq - replay->seq > WH_REPLAY_WINDOW && (force(replay) || force_command(replay))) {
    }
    if (seq - replay->seq > WH_REPLAY_WINDOW) {
        replay->is_synchronous = false;
        replay->seq = seq - 2; /* the state before the first command may come again */
    }
    wh_replay_slot_t *slot = slot_of(replay, seq);
    if (slot->seq != seq) {
        empty(slot);
        slot->seq = seq;
    }
    replay->last_pending = seq > replay->last_pending ? seq : replay->last_pending;
    return slot;
}

void wh_replay_finish(wh_replay_t *replay) {
    while (replay->run && (let_through(replay) || force(replay))) {
    }
    while (replay->run && first_command(replay) > 0) {
        ++replay->run->last_unanswered;
        advance_to(replay, first_command(replay));
        replay->is_synchronous = false;
    }
}

/* -------------------------------------------------------------------------------------- commands and states */

static bool is_slice(int64_t run, int64_t seq) {
    return run != 0 && seq >= 1 && seq <= WH_LINK_SLICES;
}

static void count_check(wh_replay_t *replay, int64_t check) {
    ++replay->messages;
    if (check == 0) {
        lose(replay, WH_REPLAY_UNCHECKED);
    }
}

static void on_command(wh_replay_t *replay, const void *data, size_t size) {
    waferhand_command message;
    if (!wh_link_decode_command(data, size, &message) || !is_slice(message.run, message.seq)) {
        lose(replay, WH_REPLAY_GARBAGE);
        return;
    }
    if (!is_wanted(replay, message.run)) {
        return;
    }
    count_check(replay, message.check);
    const wh_replay_run_t *known = find_run(replay, message.run);
    const bool is_again = known && known != replay->run && message.seq <= known->last_slice;
    if (is_again || !enter_run(replay, message.run, (uint64_t)message.layout_hash) ||
        message.seq <= replay->seq) {
        return;
    }
    wh_replay_slot_t *slot = make_slot(replay, message.seq);
    if (!slot->has_command) {
        slot->has_command = true;
        slot->command = message;
        while (let_through(replay)) {
        }
    }
}

/* What depends on more than the run: what another simulator knew. */
static bool is_refusal_of_protocol(int32_t status) {
    return status == WH_STATUS_UNKNOWN_RUN || status == WH_STATUS_RUN_OVER ||
           status == WH_STATUS_OTHER_LAYOUT;
}

/* The replay must refuse the same command for the same reason. */
static void take_refusal(wh_replay_t *replay, const waferhand_state *message, const void *data, size_t size) {
    wh_replay_run_t *run = replay->run;
    wh_protocol_server_t *server = &replay->server;
    if (!run || run->run != message->run || message->seq != replay->seq + 1 || !is_at_hand(replay) ||
        !has_command(replay, message->seq)) {
        if (!run || run->run != message->run || message->seq > run->last_refused) {
            lose(replay, WH_REPLAY_LATE);
        }
        return;
    }
    wh_replay_slot_t *slot = slot_of(replay, message->seq);
    const wh_protocol_server_result_t result = wh_protocol_server_command(server, &slot->command, NULL);
    slot->has_command = false;
    run->last_refused = message->seq;
    if (result != WH_SERVER_ANSWERED || server->encoded_size != size ||
        memcmp(server->encoded, data, size - 8) != 0) {
        differ_in_status(run, message->seq, message->status, server->room.message.status);
        replay->is_synchronous = result == WH_SERVER_ANSWERED && replay->is_synchronous;
        return;
    }
    ++run->refused;
    tell(replay, NULL, message);
}

static void take_state(wh_replay_t *replay, const waferhand_state *message, const void *data, size_t size) {
    const wh_replay_run_t *known = find_run(replay, message->run);
    const bool is_again = known && known != replay->run && message->seq <= known->last_slice;
    if (is_again || !enter_run(replay, message->run, (uint64_t)message->layout_hash) ||
        message->seq <= replay->seq) {
        return;
    }
    wh_replay_slot_t *slot = make_slot(replay, message->seq);
    if (!slot->state) {
        slot->state = wh_array_new(size, 1);
        memcpy(slot->state, data, size);
        slot->size = size;
        slot->missed = message->missed;
        while (let_through(replay)) {
        }
    }
}

static void on_state(wh_replay_t *replay, const void *data, size_t size) {
    waferhand_state message;
    if (!wh_link_decode_state(data, size, &message)) {
        lose(replay, WH_REPLAY_GARBAGE);
        return;
    }
    if (!is_slice(message.run, message.seq)) {
        lose(replay, WH_REPLAY_GARBAGE);
    } else if (is_wanted(replay, message.run)) {
        count_check(replay, message.check);
        if (message.status == WH_OK) {
            take_state(replay, &message, data, size);
        } else if (!is_refusal_of_protocol(message.status)) {
            take_refusal(replay, &message, data, size);
        }
    }
    (void)waferhand_state_decode_cleanup(&message);
}

/* ------------------------------------------------------------------------------------------ other messages */

/* The cell as it is told each time: without when and in which run. Returns its size. */
static size_t encode_cell(waferhand_cell *message, uint8_t bytes[WH_LINK_DATAGRAM]) {
    message->utime = message->seq = message->run = 0;
    const int size = waferhand_cell_encode(bytes, 0, WH_LINK_DATAGRAM, message);
    return size > 0 ? (size_t)size : 0;
}

static void add_cell(wh_replay_t *replay, waferhand_cell *message) {
    static uint8_t bytes[WH_LINK_DATAGRAM];
    const uint64_t hash = (uint64_t)message->layout_hash;
    wh_replay_cell_t *known = find_cell(replay, hash);
    const size_t size = encode_cell(message, bytes);
    if (known) {
        if (known->size != size || memcmp(known->told, bytes, size) != 0) {
            known->is_contradicted = true;
            lose(replay, WH_REPLAY_CONTRADICTS);
        }
        return;
    }
    wh_layout_t *layout = replay->cell_count < WH_REPLAY_CELLS ? wh_link_layout_from_cell(message) : NULL;
    if (!layout) {
        lose(replay, WH_REPLAY_GARBAGE);
        return;
    }
    wh_replay_cell_t *cell = &replay->cells[replay->cell_count++];
    *cell = (wh_replay_cell_t){.hash = hash, .layout = layout, .told = wh_array_new(size, 1), .size = size};
    memcpy(cell->told, bytes, size);
}

/* True if time and number of a slice fit each other, and the layout the run. */
static bool is_placed(wh_replay_t *replay, int64_t utime, int64_t seq, int64_t run, int64_t layout_hash) {
    const wh_replay_run_t *known = find_run(replay, run);
    const wh_replay_cell_t *cell = find_cell(replay, (uint64_t)layout_hash);
    const bool fits = !known || !known->is_begun || known->layout_hash == (uint64_t)layout_hash;
    return fits && (!cell || (seq >= 0 && seq <= WH_LINK_SLICES && utime == seq * cell->layout->slice_us));
}

static void on_cell(wh_replay_t *replay, const void *data, size_t size) {
    waferhand_cell message;
    if (!wh_link_decode_cell(data, size, &message)) {
        lose(replay, WH_REPLAY_GARBAGE);
        return;
    }
    ++replay->messages;
    if (!is_placed(replay, message.utime, message.seq, message.run, message.layout_hash)) {
        lose(replay, WH_REPLAY_CONTRADICTS);
    } else if (message.run != 0 && !find_run(replay, message.run) && replay->unknown_run == 0) {
        replay->unknown_run = message.run;
        replay->unknown_at = replay->at;
    }
    add_cell(replay, &message);
    (void)waferhand_cell_decode_cleanup(&message);
}

static void take_mcs(wh_replay_t *replay, const waferhand_mcs *message) {
    const bool tells = message->run != 0 && message->phase != WH_LINK_PHASE_IDLE &&
                       message->phase != WH_LINK_PHASE_GOES_ON && is_wanted(replay, message->run);
    wh_replay_run_t *run = tells ? entry(replay, message->run) : NULL;
    if (!run) {
        return;
    }
    if (message->phase == WH_LINK_PHASE_OVER) {
        run->over = true;
        (void)wh_outcome_read(message->text, &run->told);
    } else if (message->phase == WH_LINK_PHASE_MET || message->phase == WH_LINK_PHASE_UNMET) {
        const uint64_t doubled = run->expectations.doubled;
        wh_log_numbers_take(&run->expectations, (uint64_t)message->error - 1, replay->at);
        if (message->phase == WH_LINK_PHASE_UNMET && run->expectations.doubled == doubled) {
            ++run->unmet;
        }
    }
}

static void on_mcs(wh_replay_t *replay, const void *data, size_t size) {
    waferhand_mcs message;
    if (!wh_link_decode_mcs(data, size, &message)) {
        lose(replay, WH_REPLAY_GARBAGE);
        return;
    }
    ++replay->messages;
    if (message.phase < 0 || message.phase >= WH_LINK_PHASES) {
        lose(replay, WH_REPLAY_GARBAGE);
    } else if (!is_placed(replay, message.utime, message.seq, message.run, message.layout_hash)) {
        lose(replay, WH_REPLAY_CONTRADICTS);
    } else {
        take_mcs(replay, &message);
    }
    (void)waferhand_mcs_decode_cleanup(&message);
}

/* What was sent again to a simulator that was started anew: nothing follows from it that its state does not
 * tell. */
static void on_restore(wh_replay_t *replay, const void *data, size_t size) {
    waferhand_state message;
    if (!wh_link_decode_state(data, size, &message)) {
        lose(replay, WH_REPLAY_GARBAGE);
        return;
    }
    count_check(replay, message.check);
    (void)waferhand_state_decode_cleanup(&message);
}

static void on_request(wh_replay_t *replay, const void *data, size_t size) {
    waferhand_request message;
    if (!wh_link_decode_request(data, size, &message)) {
        lose(replay, WH_REPLAY_GARBAGE);
        return;
    }
    ++replay->messages;
    (void)waferhand_request_decode_cleanup(&message);
}

/* It follows from its slice's state. */
static void on_proximity(wh_replay_t *replay, const void *data, size_t size) {
    const wh_protocol_server_t *server = &replay->server;
    waferhand_proximity message;
    waferhand_proximity made;
    uint8_t bytes[1024];
    if (size > sizeof bytes || waferhand_proximity_decode(data, 0, (int)size, &message) != (int)size) {
        lose(replay, WH_REPLAY_GARBAGE);
        return;
    }
    if (!is_wanted(replay, message.run)) {
        return;
    }
    ++replay->messages;
    if (!replay->is_synchronous || server->identity.run != message.run || server->seq != message.seq) {
        ++replay->proximities;
        return;
    }
    wh_link_proximity_to_message(&server->state, &server->identity, &server->layout->grasp.tolerance, &made);
    if (waferhand_proximity_encode(bytes, 0, (int)sizeof bytes, &made) != (int)size ||
        memcmp(bytes, data, size) != 0) {
        lose(replay, WH_REPLAY_CONTRADICTS);
    }
}

/* ---------------------------------------------------------------------------------------------- the whole */

/* True if a datagram begins with the fingerprint of one of our messages. */
static bool is_ours(const uint8_t *data, size_t size) {
    const int64_t fingerprints[] = {__waferhand_command_get_hash(), __waferhand_state_get_hash(),
                                    __waferhand_cell_get_hash(),    __waferhand_proximity_get_hash(),
                                    __waferhand_mcs_get_hash(),     __waferhand_request_get_hash()};
    uint64_t first = 0;
    bool ours = false;
    for (size_t i = 0; size >= 8 && i < 8; ++i) {
        first = first << 8 | data[i];
    }
    for (size_t i = 0; i < sizeof fingerprints / sizeof fingerprints[0]; ++i) {
        ours = ours || (uint64_t)fingerprints[i] == first;
    }
    return ours;
}

void wh_replay_event(wh_replay_t *replay, const char *channel, const void *data, size_t size) {
    static const struct {
        const char *channel;
        void (*handle)(wh_replay_t *replay, const void *data, size_t size);
    } handlers[] = {{WH_CHANNEL_CELL, on_cell},          {WH_CHANNEL_COMMAND, on_command},
                    {WH_CHANNEL_STATE, on_state},        {WH_CHANNEL_MCS, on_mcs},
                    {WH_CHANNEL_RESTORE, on_restore},    {WH_CHANNEL_REQUEST, on_request},
                    {WH_CHANNEL_PROXIMITY, on_proximity}};
    for (size_t i = 0; i < sizeof handlers / sizeof handlers[0]; ++i) {
        if (strcmp(handlers[i].channel, channel) == 0) {
            handlers[i].handle(replay, data, size);
            return;
        }
    }
    if (strncmp(channel, "WAFERHAND_", 10) == 0 || is_ours(data, size)) {
        lose(replay, WH_REPLAY_STRAY);
    }
}

void wh_replay_end(wh_replay_t *replay) {
    wh_replay_finish(replay);
    for (size_t i = 0; i < replay->run_count; ++i) {
        wh_log_numbers_finish(&replay->runs[i].expectations);
    }
    if (replay->unknown_run != 0 && !find_run(replay, replay->unknown_run)) {
        replay->at = replay->unknown_at;
        lose(replay, WH_REPLAY_CONTRADICTS);
    }
}

void wh_replay_close(wh_replay_t *replay) {
    for (size_t i = 0; i < WH_REPLAY_WINDOW; ++i) {
        empty(&replay->slots[i]);
    }
    for (size_t i = 0; i < replay->cell_count; ++i) {
        wh_link_layout_free(replay->cells[i].layout);
        free(replay->cells[i].told);
    }
    replay->cell_count = 0;
    if (replay->cell) {
        wh_protocol_server_close(&replay->server);
        replay->cell = NULL;
    }
}
