/* The reader of outputs.txt: when to look, and what a look means for the valves and the condition in force.
 */
#include <errno.h>
#include <string.h>
#include <unistd.h>

#include "../math/hash.h"
#include "outputs_internal.h"

/* Bad looks running after which a file that never comes to rest is reported. */
#define RESTLESS_LOOKS 64

static bool valves_are_good(const int32_t *valves, size_t count) {
    for (size_t i = 0; i < count; ++i) {
        if (valves[i] != WH_VALVE_OPEN && valves[i] != WH_VALVE_CLOSED) {
            return false;
        }
    }
    return true;
}

int wh_outputs_refuse(const char *path, const int32_t *valves, size_t count) {
    if (path == NULL || valves == NULL || count < 1 || count > WH_GRIPPERS ||
        !valves_are_good(valves, count)) {
        return EINVAL;
    }
    const size_t length = strlen(path);
    if (length == 0 || path[length - 1] == '/') {
        return EINVAL;
    }
    return length < WH_OUTPUTS_PATH ? 0 : ENAMETOOLONG;
}

int wh_outputs_open(wh_outputs_t *outputs, const char *path, const int32_t *valves, size_t count) {
    const int refused = outputs == NULL ? EINVAL : wh_outputs_refuse(path, valves, count);
    if (refused != 0) {
        return refused;
    }
    memset(outputs, 0, sizeof *outputs);
    memcpy(outputs->valves, valves, count * sizeof *valves);
    outputs->count = count;
    outputs->settle_us = WH_OUTPUTS_SETTLE_US;
    outputs->poll_us = WH_OUTPUTS_POLL_US;
    outputs->check_us = WH_OUTPUTS_CHECK_US;
    memcpy(outputs->path, path, strlen(path) + 1);
    const char *const slash = strrchr(outputs->path, '/');
    outputs->name = slash == NULL ? 0 : (size_t)(slash - outputs->path) + 1;
    wh_outputs_watch_open(outputs);
    return 0;
}

void wh_outputs_close(wh_outputs_t *outputs) {
    if (outputs->fd >= 0) {
        (void)close(outputs->fd);
    }
    outputs->fd = -1;
    outputs->watch = -1;
}

int wh_outputs_fd(const wh_outputs_t *outputs) {
    return outputs->fd;
}

int64_t wh_outputs_due(const wh_outputs_t *outputs) {
    return outputs->due_us;
}

/* Which file it is and when it last changed, in one word; zero fields when there is none. */
static uint64_t print_of(const struct stat *status) {
    uint64_t hash = wh_hash_word(WH_HASH_START, (uint64_t)status->st_dev);
    hash = wh_hash_word(hash, (uint64_t)status->st_ino);
    hash = wh_hash_word(hash, (uint64_t)status->st_size);
    hash = wh_hash_word(hash, (uint64_t)status->st_mtim.tv_sec);
    hash = wh_hash_word(hash, (uint64_t)status->st_mtim.tv_nsec);
    hash = wh_hash_word(hash, (uint64_t)status->st_ctim.tv_sec);
    return wh_hash_word(hash, (uint64_t)status->st_ctim.tv_nsec);
}

/* True if the file is not the one, or not in the state, that the last look saw. */
static bool has_moved(wh_outputs_t *outputs, const struct stat *status) {
    const uint64_t print = print_of(status);
    const bool moved = outputs->moved || print != outputs->print;
    outputs->moved = false;
    outputs->print = print;
    return moved;
}

static unsigned take_valves(wh_outputs_t *outputs, const int32_t *valves) {
    const size_t size = outputs->count * sizeof *valves;
    if (memcmp(outputs->valves, valves, size) == 0) {
        return 0;
    }
    memcpy(outputs->valves, valves, size);
    ++outputs->counters.switches;
    return WH_OUTPUTS_SWITCHED;
}

static unsigned announce(wh_outputs_t *outputs, const wh_outputs_look_t *look) {
    outputs->suspect = false;
    outputs->condition = look->condition;
    ++outputs->counters.reports;
    outputs->counters.recoveries += look->condition == WH_OUTPUTS_GOOD;
    wh_outputs_describe(outputs, look);
    return WH_OUTPUTS_REPORTED;
}

/* One more look at a bad state that is not the one in force. */
static void suspect(wh_outputs_t *outputs, bool moved, int64_t now_us) {
    if (!outputs->suspect) {
        ++outputs->counters.spells;
        outputs->suspect = true;
        outputs->suspect_looks = 0;
        outputs->suspect_us = now_us;
        moved = true;
    }
    ++outputs->suspect_looks;
    if (moved) {
        outputs->still_us = now_us;
    }
}

static bool has_settled(const wh_outputs_t *outputs, int64_t now_us) {
    const int64_t since_us =
        outputs->suspect_looks >= RESTLESS_LOOKS ? outputs->suspect_us : outputs->still_us;
    return now_us - since_us >= outputs->settle_us;
}

/* Decides whether the condition in force changes. */
static unsigned judge(wh_outputs_t *outputs, const wh_outputs_look_t *look, bool moved, int64_t now_us) {
    const bool same = look->condition == outputs->condition;
    if (same || look->condition == WH_OUTPUTS_GOOD) {
        outputs->counters.torn += outputs->suspect;
        outputs->suspect = false;
        return same ? 0 : announce(outputs, look);
    }
    suspect(outputs, moved, now_us);
    return has_settled(outputs, now_us) ? announce(outputs, look) : 0;
}

static int64_t next_look(const wh_outputs_t *outputs, int64_t now_us) {
    int64_t due_us = now_us + (outputs->quiet || outputs->linked ? outputs->poll_us : outputs->check_us);
    if (outputs->suspect && outputs->still_us + outputs->settle_us < due_us) {
        due_us = outputs->still_us + outputs->settle_us;
    }
    return due_us;
}

/* The folder is made sure of first: what changes after the look must make an event. */
unsigned wh_outputs_update(wh_outputs_t *outputs, int64_t now_us) {
    const bool told = wh_outputs_watch_drain(outputs);
    const bool due = now_us >= outputs->due_us;
    if (!told && !due) {
        return 0;
    }
    if (due || outputs->watch < 0) {
        wh_outputs_watch_renew(outputs);
    }
    int32_t valves[WH_GRIPPERS];
    memcpy(valves, outputs->valves, sizeof valves);
    struct stat status;
    const wh_outputs_look_t look = wh_outputs_look(outputs, valves, &status);
    ++outputs->counters.looks[look.condition];
    const bool moved = has_moved(outputs, &status);
    const unsigned switched = take_valves(outputs, valves);
    const unsigned reported = judge(outputs, &look, moved, now_us);
    outputs->due_us = next_look(outputs, now_us);
    return switched | reported;
}
