#include "replay.h"

#include <stdlib.h>
#include <string.h>

#include "../text/array.h"
#include "replay_internal.h"

void wh_replay_lose(wh_replay_t *replay, wh_replay_loss_t loss) {
    if (replay->heard.losses[loss].count++ == 0) {
        replay->heard.losses[loss].first = replay->place.at;
        replay->heard.losses[loss].file = replay->place.file;
    }
}

/* --------------------------------------------------------------------------------------------------- runs */

wh_replay_run_t *wh_replay_find_run(wh_replay_t *replay, int64_t run) {
    for (size_t i = replay->run_count; i > 0; --i) {
        if (replay->runs[i - 1].run == run) {
            return &replay->runs[i - 1];
        }
    }
    return NULL;
}

wh_replay_run_t *wh_replay_entry(wh_replay_t *replay, int64_t run) {
    wh_replay_run_t *found = wh_replay_find_run(replay, run);
    if (found || replay->run_count == WH_REPLAY_RUNS) {
        replay->runs_left_out += found ? 0 : 1;
        return found;
    }
    wh_replay_run_t *made = &replay->runs[replay->run_count++];
    memset(made, 0, sizeof *made);
    made->run = run;
    return made;
}

wh_replay_cell_t *wh_replay_find_cell(wh_replay_t *replay, uint64_t hash) {
    for (size_t i = 0; i < replay->cell_count; ++i) {
        if (replay->cells[i].hash == hash) {
            return &replay->cells[i];
        }
    }
    return NULL;
}

static void begin_run(wh_replay_t *replay, wh_replay_run_t *run, const wh_replay_cell_t *cell) {
    replay->run = run;
    run->is_begun = true;
    run->layout_hash = cell->hash;
    replay->returned = wh_replay_find_return(replay, run->run);
    replay->seq = replay->returned ? replay->returned->seq - 1 : 0;
    replay->last_pending = 0;
    replay->told_count = 0;
    replay->is_synchronous = replay->is_unsure = false;
    if (replay->cell != cell) {
        wh_protocol_server_close(&replay->server);
        (void)wh_protocol_server_open(&replay->server, cell->layout);
        replay->server.identity.layout_hash = cell->hash;
        replay->server.encodes_later = true;
        replay->cell = cell;
    }
}

/* Makes the run of a command or a state the current one. False, and counted, if it cannot go through. */
static bool enter_run(wh_replay_t *replay, int64_t id, uint64_t layout_hash) {
    if (replay->run && replay->run->run == id) {
        return true;
    }
    const wh_replay_cell_t *cell = wh_replay_find_cell(replay, layout_hash);
    wh_replay_run_t *run = cell ? wh_replay_entry(replay, id) : NULL;
    if (!cell) {
        wh_replay_lose(replay, WH_REPLAY_HOMELESS);
    } else if (run && run->is_begun) {
        wh_replay_lose(replay, WH_REPLAY_LATE);
        return false;
    }
    if (!run) {
        return false;
    }
    wh_replay_finish(replay);
    begin_run(replay, run, cell);
    return true;
}

/* ------------------------------------------------------------------------------------------------ waiting */

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

/* The first waiting slice for which `has` is true; 0: none. */
static int64_t first_with(wh_replay_t *replay, bool (*has)(wh_replay_t *replay, int64_t seq)) {
    int64_t seq = replay->seq + 1;
    while (seq <= replay->last_pending && !has(replay, seq)) {
        ++seq;
    }
    return seq <= replay->last_pending ? seq : 0;
}

/* True if the next slice can be stepped when it comes: the run is known up to here. */
static bool is_at_hand(wh_replay_t *replay) {
    return replay->is_synchronous || (replay->seq == 0 && has_command(replay, 1));
}

static int64_t missed_so_far(const wh_replay_t *replay) {
    return replay->is_synchronous ? replay->server.missed : 0;
}

/* Handles a slice with command and state. */
static void resolve(wh_replay_t *replay, int64_t seq) {
    const wh_replay_slot_t *slot = slot_of(replay, seq);
    waferhand_state message;
    if (wh_link_decode_state(slot->state, slot->size, &message)) {
        wh_replay_step(replay, &slot->command, &message, slot->state, slot->size);
        wh_replay_tell(replay, &slot->command, &message);
        (void)waferhand_state_decode_cleanup(&message);
    }
    advance_to(replay, seq);
}

/* Steps a slice whose state is not in the log, though later ones are. */
static void step_unanswered(wh_replay_t *replay, int64_t seq) {
    wh_replay_step_alone(replay, &slot_of(replay, seq)->command);
    advance_to(replay, seq);
}

/* Counts the slices after the last one, up to this one, as passed over, except those that an earlier part
 * of the recording has. */
static void skip_to(wh_replay_t *replay, int64_t seq) {
    replay->run->slices.skipped += replay->files.part_begins ? 0 : seq - replay->seq;
}

/* For the first state of a run: true if it was replayed before. Else all slices before it are passed
 * over. */
static bool returns_to(wh_replay_t *replay, int64_t seq, bool is_restored) {
    const wh_replay_return_t *returned = replay->returned;
    replay->returned = NULL;
    if (returned && is_restored && returned->seq == seq && returned->hash == replay->run->hash) {
        replay->run->goes_on_from = returned->of;
        return true;
    }
    replay->run->slices.skipped += returned ? returned->seq - 1 : 0;
    return false;
}

/* Continues from a state whose command, or an earlier one, is not in the log. */
static void take_up(wh_replay_t *replay, int64_t seq) {
    const wh_replay_slot_t *slot = slot_of(replay, seq);
    waferhand_state message;
    if (wh_link_decode_state(slot->state, slot->size, &message)) {
        const bool is_restored = wh_replay_restore(replay, &message);
        const bool returns = returns_to(replay, seq, is_restored);
        if (!returns) {
            skip_to(replay, seq);
        }
        if (is_restored) {
            replay->run->begins_in_part = replay->run->begins_in_part || replay->files.part_begins;
            replay->run->slices.taken_up += replay->files.part_begins || returns ? 0 : 1;
            replay->files.part_begins = false;
            wh_replay_tell(replay, slot->has_command ? &slot->command : NULL, &message);
        } else {
            wh_replay_lose(replay, WH_REPLAY_GARBAGE);
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
    const int64_t state = first_with(replay, has_state);
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

/* A message will not come any more: the longest waiting one goes through without it. False if only
 * commands wait. */
static bool force(wh_replay_t *replay) {
    const int64_t state = first_with(replay, has_state);
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

/* Like force, if only commands wait. False if none waits. */
static bool force_command(wh_replay_t *replay) {
    const int64_t command = first_with(replay, has_command);
    if (command == 0) {
        return false;
    }
    if (command == replay->seq + 1 && is_at_hand(replay)) {
        step_unanswered(replay, command);
    } else {
        ++replay->run->slices.unanswered;
        skip_to(replay, command - 1);
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
        const int64_t before = seq - 2; /* the state before the first command may come again */
        skip_to(replay, before);
        replay->is_synchronous = false;
        replay->seq = before;
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
    wh_replay_tell_last(replay);
    while (replay->run && (let_through(replay) || force(replay))) {
    }
    while (replay->run && first_with(replay, has_command) > 0) {
        ++replay->run->slices.last_unanswered;
        advance_to(replay, first_with(replay, has_command));
        replay->is_synchronous = false;
    }
    if (replay->run && replay->seq > replay->run->reached) {
        replay->run->reached = replay->seq;
    }
}

/* ------------------------------------------------------------------------------------ commands and states */

/* True if a slice may still go through: its run is the current one, and it has not gone through already. */
static bool is_new(wh_replay_t *replay, int64_t run, int64_t seq, int64_t layout_hash) {
    const wh_replay_run_t *known = wh_replay_find_run(replay, run);
    const bool is_again = known && known != replay->run && seq <= known->last_slice;
    return !is_again && enter_run(replay, run, (uint64_t)layout_hash) && seq > replay->seq;
}

/* Counts a command of a layout whose cell is not in the log. It is not lost if the simulator answers that
 * it has another layout. */
static bool is_homeless(wh_replay_t *replay, const waferhand_command *message) {
    const bool is_current = replay->run && replay->run->run == message->run;
    if (is_current || wh_replay_find_cell(replay, (uint64_t)message->layout_hash)) {
        return false;
    }
    wh_replay_run_t *run = wh_replay_entry(replay, message->run);
    if (run && run->homeless.count++ == 0) {
        run->homeless.at = replay->place.at;
    }
    return true;
}

void wh_replay_take_command(wh_replay_t *replay, const waferhand_command *message) {
    if (is_homeless(replay, message) || !is_new(replay, message->run, message->seq, message->layout_hash)) {
        return;
    }
    wh_replay_slot_t *slot = make_slot(replay, message->seq);
    if (!slot->has_command) {
        slot->has_command = true;
        slot->command = *message;
        while (let_through(replay)) {
        }
    }
}

/* The replay must refuse the same command for the same reason. */
static void refuse_again(wh_replay_t *replay, const waferhand_state *message, const void *data, size_t size) {
    wh_replay_run_t *run = replay->run;
    wh_protocol_server_t *server = &replay->server;
    wh_replay_slot_t *slot = slot_of(replay, message->seq);
    const wh_protocol_server_result_t result = wh_protocol_server_command(server, &slot->command, NULL);
    slot->has_command = false;
    run->last_refused = message->seq;
    if (result != WH_SERVER_ANSWERED || server->encoded_size != size ||
        memcmp(server->encoded, data, size - 8) != 0) {
        wh_replay_differ_in_status(run, message->seq, message->status, server->room.message.status);
        replay->is_synchronous = result == WH_SERVER_ANSWERED && replay->is_synchronous;
        return;
    }
    ++run->refused;
    wh_replay_tell(replay, NULL, message);
}

void wh_replay_take_refusal(wh_replay_t *replay, const waferhand_state *message, const void *data,
                            size_t size) {
    const bool is_current = replay->run && replay->run->run == message->run;
    wh_replay_tell_last(replay);
    if (is_current && message->seq == replay->seq + 1 && is_at_hand(replay) &&
        has_command(replay, message->seq)) {
        refuse_again(replay, message, data, size);
    } else if (!is_current || message->seq > replay->run->last_refused) {
        wh_replay_lose(replay, WH_REPLAY_LATE);
    }
}

static void keep_state(wh_replay_t *replay, const waferhand_state *message, const void *data, size_t size) {
    wh_replay_slot_t *slot = make_slot(replay, message->seq);
    if (!slot->state) {
        slot->state = wh_array_new(size, 1);
        memcpy(slot->state, data, size);
        slot->size = size;
        slot->missed = message->missed;
        while (let_through(replay)) {
        }
    } else if (slot->size != size || memcmp(slot->state, data, size - 8) != 0) {
        wh_replay_lose(replay, WH_REPLAY_CONTRADICTS);
    }
}

static bool is_of_last(const wh_replay_t *replay, const waferhand_state *message) {
    return replay->run && replay->run->run == message->run && message->seq == replay->seq;
}

void wh_replay_take_state(wh_replay_t *replay, const waferhand_state *message, const void *data,
                          size_t size) {
    const bool is_last = is_of_last(replay, message);
    if (is_last && replay->block.is_there) {
        wh_replay_take_last_state(replay, message, data, size);
        return;
    }
    wh_replay_tell_last(replay);
    if (is_last && replay->files.file_begins && replay->is_synchronous) {
        wh_replay_take_first_state(replay, message, data, size);
        return;
    }
    replay->files.file_begins = false;
    if (is_last && !replay->is_synchronous && replay->seq > 0) {
        --replay->seq; /* after a block that could not be stepped, and was counted */
        --replay->run->slices.skipped;
    }
    if (is_new(replay, message->run, message->seq, message->layout_hash)) {
        keep_state(replay, message, data, size);
    } else {
        wh_replay_check_repeat(replay, message, data, size);
    }
}

void wh_replay_take_slices(wh_replay_t *replay, const wh_slices_t *slices) {
    const int64_t end = slices->first + (int64_t)slices->count - 1;
    if (!is_new(replay, slices->identity.run, end, (int64_t)slices->identity.layout_hash)) {
        return;
    }
    if (replay->seq + 1 != slices->first || replay->last_pending > replay->seq) {
        wh_replay_finish(replay); /* no waiting message belongs after a block */
    }
    for (size_t i = 0; i < slices->count; ++i) {
        int32_t told[WH_GRIPPERS];
        uint64_t hash;
        const int64_t seq = slices->first + (int64_t)i;
        const bool follows = replay->is_synchronous || (replay->seq == 0 && seq == 1);
        if (seq <= replay->seq) {
            continue;
        }
        if (!follows || seq != replay->seq + 1) {
            skip_to(replay, end);
            replay->is_synchronous = false;
            replay->seq = end;
            return;
        }
        wh_replay_tell_last(replay);
        wh_slices_get(slices, i, &replay->block.last, told, &hash);
        wh_replay_step_hashed(replay, told, hash);
    }
}
