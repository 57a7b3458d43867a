/* Plays the output of `waferhand run --segments` with the library alone, as a firmware test would: as C99 to
 * C23, and C++11 to C++23. PLAYED is the file and RUN the beginning of its names; ALSO and ALSO_RUN are a
 * second one. Or LIST is a file that includes any number of them, and has PLAY(NAME) for each in RUNS. A
 * file's hashes are for double; float has its own. */
#include <stdio.h>
#include <string.h>

#if defined(LIST)
#include LIST
#else
#include PLAYED
#if defined(ALSO)
#include ALSO
#define RUNS PLAY(RUN) PLAY(ALSO_RUN)
#else
#define RUNS PLAY(RUN)
#endif
#endif

static void print_hash(uint64_t hash) {
    for (int shift = 60; shift >= 0; shift -= 4) {
        putchar("0123456789abcdef"[hash >> shift & 15]);
    }
    putchar('\n');
}

/* True if it ended as it was recorded. In float only the slices are the same. */
static bool play(const char *name, wh_player_t *player, wh_status_t status) {
    const bool exact = sizeof(wh_real_t) == sizeof(double);
    while (status == WH_OK && wh_player_next(player)) {
        status = player->state.status;
    }
    status = status == WH_OK ? player->status : status;
    if (status != WH_OK) {
        printf("%s: %s after %ld slices\n", name, wh_status_text(status), (long)player->track.slice);
        return false;
    }
    printf("%s %s ", exact ? "double" : "float", name);
    print_hash(wh_simulator_hash(&player->simulator));
    return exact ? wh_player_is_as_recorded(player) : player->track.slice == player->run->slices;
}

#define PLAY(name) PLAY_(name)
#define PLAY_(name)                                                                                          \
    {                                                                                                        \
        static name##_player_t memory;                                                                       \
        memset(&memory, 0xa5, sizeof memory);                                                                \
        good = play(#name, &memory.player, name##_begin(&memory)) && good;                                   \
    }

int main(void) {
    bool good = true;
    RUNS return good ? 0 : 1;
}
