/* Plays the output of `waferhand run --segments` with the library alone, as a firmware test would:
 * as C99 to C23, and C++11 to C++23. PLAYED is the file, RUN its run; ALSO and ALSO_RUN are a
 * second one. A file's hash is for double; float has its own. */
#include <stdio.h>

#include PLAYED
#if defined(ALSO)
#include ALSO
#endif

enum { WAFERS = 64 };

static wh_wafer_t wafers[WAFERS];
static wh_gripper_t grippers[WH_GRIPPERS];
static wh_player_t player;

static void print_hash(uint64_t hash) {
    for (int shift = 60; shift >= 0; shift -= 4) {
        putchar("0123456789abcdef"[hash >> shift & 15]);
    }
    putchar('\n');
}

/* True if it ended as it was recorded. */
static bool play(const wh_played_t *run) {
    const wh_grasp_storage_t storage = {wafers, run->wafer_count, grippers, run->machine->gripper_count, NULL,
                                        0};
    const bool exact = sizeof(wh_real_t) == sizeof(double);
    wh_status_t status = run->wafer_count > WAFERS ? WH_STATUS_BAD_CAPACITY : WH_OK;
    status = status == WH_OK ? wh_player_init(&player, run, &storage) : status;
    while (status == WH_OK && wh_player_next(&player)) {
        status = player.state.status;
    }
    status = status == WH_OK ? player.status : status;
    if (status != WH_OK) {
        printf("%s after %ld slices\n", wh_status_text(status), (long)player.track.slice);
        return false;
    }
    const uint64_t hash = wh_simulator_hash(&player.simulator);
    printf(exact ? "double transfer " : "float transfer ");
    print_hash(hash);
    return !exact || (player.track.slice == run->slices && hash == run->hash);
}

int main(void) {
    bool good = play(&RUN);
#if defined(ALSO)
    good = play(&ALSO_RUN) && good;
#endif
    return good ? 0 : 1;
}
