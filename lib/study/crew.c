#include "crew.h"

#include <pthread.h>
#include <stdlib.h>

#include "../text/array.h"
#include "../text/interrupt.h"

typedef struct {
    wh_crew_play_t *play;
    void *user;
    size_t count;
    size_t next; /* the first run that no thread has taken; an atomic */
} crew_t;

static void *work(void *argument) {
    crew_t *crew = argument;
    wh_script_run_t *run = wh_array_new(1, sizeof *run);
    size_t i = __atomic_fetch_add(&crew->next, 1, __ATOMIC_RELAXED);
    while (i < crew->count && !wh_interrupt_came()) {
        crew->play(crew->user, i, run);
        i = __atomic_fetch_add(&crew->next, 1, __ATOMIC_RELAXED);
    }
    free(run);
    return NULL;
}

bool wh_crew_play(size_t count, size_t threads, wh_crew_play_t *play, void *user) {
    crew_t crew = {play, user, count, 0};
    const size_t wanted = threads < count ? threads : count;
    wh_interrupt_catch();
    pthread_t *started = wh_array_new(wanted, sizeof *started);
    size_t begun = 0;
    while (begun < wanted && pthread_create(&started[begun], NULL, work, &crew) == 0) {
        ++begun;
    }
    for (size_t i = 0; i < begun; ++i) {
        pthread_join(started[i], NULL);
    }
    free(started);
    if (begun == 0) {
        fprintf(stderr, "waferhand sweep: no thread for it\n");
    }
    return begun > 0;
}
