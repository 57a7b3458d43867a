/* Runs that go on from a state of an earlier one, as after RESTORE and UNDO. A look through the log before
 * the replay finds these states. So the replay keeps one hash for each run, and not one for each slice. */
#include <endian.h>
#include <string.h>

#include "replay_internal.h"

/* The place of the run's number in a message, after fingerprint, time and slice. */
#define RUN_AT 24

static wh_replay_return_t *find(wh_replay_t *replay, int64_t run) {
    for (size_t i = replay->return_count; i > 0; --i) {
        if (replay->returns[i - 1].run == run) {
            return &replay->returns[i - 1];
        }
    }
    return NULL;
}

/* The run of a message; null if it cannot be one, or there are too many runs. */
static wh_replay_return_t *entry_of(wh_replay_t *replay, const void *data, size_t size) {
    uint64_t big = 0;
    if (size < RUN_AT + sizeof big) {
        return NULL;
    }
    memcpy(&big, (const uint8_t *)data + RUN_AT, sizeof big);
    const int64_t run = (int64_t)be64toh(big);
    wh_replay_return_t *found = find(replay, run);
    if (!found && run != 0 && replay->return_count < WH_REPLAY_RUNS) {
        found = &replay->returns[replay->return_count++];
        *found = (wh_replay_return_t){.run = run, .first_command = INT64_MAX};
    }
    return found;
}

static void look_at_state(wh_replay_return_t *entry, const void *data, size_t size) {
    waferhand_state message;
    if (!wh_link_decode_state(data, size, &message)) {
        return;
    }
    if (message.status == WH_OK && message.check != 0) {
        const bool returns =
            message.seq > 1 && message.seq <= WH_LINK_SLICES && message.seq <= entry->first_command;
        entry->is_begun = true;
        entry->seq = returns ? message.seq : 0;
        entry->hash = (uint64_t)message.hash;
        entry->layout_hash = (uint64_t)message.layout_hash;
    }
    (void)waferhand_state_decode_cleanup(&message);
}

static void look_at_command(wh_replay_return_t *entry, const void *data, size_t size) {
    waferhand_command message;
    if (wh_link_decode_command(data, size, &message) && message.seq < entry->first_command) {
        entry->first_command = message.seq;
    }
}

void wh_replay_look_ahead(wh_replay_t *replay, const char *channel, const void *data, size_t size) {
    const bool is_state = strcmp(channel, WH_CHANNEL_STATE) == 0;
    const bool is_command = strcmp(channel, WH_CHANNEL_COMMAND) == 0;
    if (!is_state && !is_command && strcmp(channel, WH_CHANNEL_SLICES) != 0) {
        return;
    }
    wh_replay_return_t *entry = entry_of(replay, data, size);
    if (!entry || entry->is_begun) {
        return;
    }
    if (is_state) {
        look_at_state(entry, data, size);
    } else if (is_command) {
        look_at_command(entry, data, size);
    } else {
        entry->is_begun = true;
    }
}

void wh_replay_pass_slice(wh_replay_t *replay) {
    const wh_replay_run_t *run = replay->run;
    for (size_t i = 0; i < replay->return_count; ++i) {
        wh_replay_return_t *entry = &replay->returns[i];
        if (entry->seq == run->last_slice && entry->hash == run->hash &&
            entry->layout_hash == run->layout_hash && entry->of == 0 && entry->run != run->run) {
            entry->of = run->run;
        }
    }
}

const wh_replay_return_t *wh_replay_find_return(wh_replay_t *replay, int64_t run) {
    const wh_replay_return_t *found = find(replay, run);
    return found && found->of != 0 ? found : NULL;
}
