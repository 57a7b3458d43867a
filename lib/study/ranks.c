#include "ranks.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../text/array.h"
#include "../text/clock.h"
#include "checkpoint.h"

#define LIBRARY "waferhand_mpi.so"

/* The interval, in seconds, at which a rank tells its progress. */
#define TELL_S 1.0

/* The first byte of a message to rank 0; then comes the progress, or why it failed. */
enum { WANTS_MORE = 'M', HAS_DONE = 'D', HAS_ENDED = 'E', HAS_FAILED = 'F' };

/* A number of processes as mpirun tells it; 1 without mpirun. */
static int number_of(const char *variable) {
    const char *text = getenv(variable);
    return text ? (int)strtol(text, NULL, 10) : 1;
}

int wh_ranks_here(void) {
    const int here = number_of("OMPI_COMM_WORLD_LOCAL_SIZE");
    return here > 1 ? here : 1;
}

/* ------------------------------------------------------------------------------------------------ joining */

/* Loads the library: it is beside the program, or where `make install` puts it. */
static void *open_library(void) {
    static const char *const places[] = {"/" LIBRARY, "/../lib/waferhand/" LIBRARY};
    char program[4096];
    char path[4200];
    void *library = NULL;
    const ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    if (length <= 0) {
        return NULL;
    }
    program[length] = '\0';
    *strrchr(program, '/') = '\0';
    for (size_t i = 0; i < sizeof places / sizeof places[0] && !library; ++i) {
        snprintf(path, sizeof path, "%s%s", program, places[i]);
        library = dlopen(path, RTLD_NOW | RTLD_GLOBAL);
    }
    return library;
}

bool wh_ranks_open(wh_ranks_t *ranks) {
    *ranks = (wh_ranks_t){.size = 1};
    if (number_of("OMPI_COMM_WORLD_SIZE") <= 1) {
        return true;
    }
    ranks->library = open_library();
    ranks->calls = ranks->library ? dlsym(ranks->library, "wh_ranks_calls") : NULL;
    if (!ranks->calls || ranks->calls->version != WH_RANKS_VERSION) {
        fprintf(stderr, "waferhand study: started by mpirun, but " LIBRARY
                        " is not there (expected it beside the program: libopenmpi-dev must be installed "
                        "when it is built)\n");
        return false;
    }
    if (ranks->calls->open(&ranks->rank, &ranks->size) != 0) {
        fprintf(stderr, "waferhand study: MPI does not start\n");
        return false;
    }
    return true;
}

void wh_ranks_close(wh_ranks_t *ranks, int status) {
    if (ranks->calls && status != 0) {
        ranks->calls->quit(status);
    }
    if (ranks->calls) {
        ranks->calls->close();
        ranks->calls = NULL;
    }
}

/* ------------------------------------------------------------------------------------------------- rank 0 */

static bool take_progress(wh_pool_t *pool, int from, const char *text, size_t size) {
    char message[1024];
    pthread_mutex_lock(&pool->lock);
    const bool taken = wh_checkpoint_read(pool->study, text, size, &pool->progress, message, sizeof message);
    pthread_mutex_unlock(&pool->lock);
    if (!taken) {
        fprintf(stderr, "rank %d: %s\n", from, message);
    }
    return taken;
}

/* Sends fewer and fewer trials, so that all ranks end at about the same time; none at all means that there
 * are no more. */
static bool send_trials(const wh_ranks_t *ranks, wh_pool_t *pool, int to) {
    const wh_pool_news_t news = wh_pool_look(pool);
    const wh_stretch_t sent = wh_pool_take(pool, news.queued / (4 * (uint64_t)ranks->size) + news.pace);
    return ranks->calls->send(to, &sent, sizeof sent) == 0;
}

static bool answer(wh_ranks_t *ranks, wh_pool_t *pool, int from, const char *text, size_t size) {
    if (size == 0 || text[0] == HAS_FAILED) {
        fprintf(stderr, "%.*s\n", size > 0 ? (int)size - 1 : 0, text + 1);
        return false;
    }
    if (!take_progress(pool, from, text + 1, size - 1)) {
        return false;
    }
    if (text[0] == HAS_ENDED) {
        ++ranks->ended;
        return true;
    }
    return text[0] == HAS_DONE || send_trials(ranks, pool, from);
}

/* A message that has come, to be freed; null when there is none. `sound` becomes false when something is
 * wrong. */
static char *take_message(const wh_ranks_t *ranks, int *from, size_t *size, bool *sound) {
    const int any = ranks->calls->look(from, size);
    if (any <= 0) {
        *sound = any == 0;
        return NULL;
    }
    char *text = wh_array_new(*size + 1, 1);
    *sound = ranks->calls->receive(*from, text, *size) == 0;
    return text;
}

bool wh_ranks_serve(wh_ranks_t *ranks, wh_pool_t *pool) {
    bool sound = true;
    while (ranks->calls && sound) {
        int from = 0;
        size_t size = 0;
        char *text = take_message(ranks, &from, &size, &sound);
        if (!text) {
            break;
        }
        sound = sound && answer(ranks, pool, from, text, size);
        free(text);
    }
    return sound;
}

/* ------------------------------------------------------------------------------------------------- others */

static bool tell_rank(const wh_ranks_t *ranks, char kind, const char *text) {
    const size_t size = strlen(text) + 1;
    char *message = wh_array_new(size + 1, 1);
    message[0] = kind;
    memcpy(message + 1, text, size);
    const bool sent = ranks->calls->send(0, message, size) == 0;
    free(message);
    return sent;
}

/* Tells the progress since the last message. */
static bool tell_progress(const wh_ranks_t *ranks, wh_pool_t *pool, char kind) {
    pthread_mutex_lock(&pool->lock);
    char *text = wh_checkpoint_text(pool->study, &pool->progress);
    wh_progress_free(&pool->progress);
    wh_progress_init(&pool->progress, pool->study);
    pthread_mutex_unlock(&pool->lock);
    const bool told = text && tell_rank(ranks, kind, text);
    free(text);
    return told;
}

/* The state of another rank. */
typedef struct {
    bool wanting, more;
    uint64_t given; /* trials that came last */
    double told;    /* when progress was told last */
} helper_t;

/* Queues the trials that have come, if any have; none at all mean that there are no more. */
static bool take_trials(const wh_ranks_t *ranks, wh_pool_t *pool, helper_t *helper) {
    int from = 0;
    size_t size = 0;
    bool sound = true;
    char *text = take_message(ranks, &from, &size, &sound);
    if (text && sound && size == sizeof(wh_stretch_t)) {
        wh_stretch_t given;
        memcpy(&given, text, sizeof given);
        helper->wanting = false;
        helper->more = given.count > 0;
        helper->given = given.count;
        wh_pool_queue(pool, &given, given.count > 0 ? 1 : 0, given.count == 0);
    }
    free(text);
    return sound;
}

/* Asks for more trials before the queue is empty, and takes those that come. */
static bool go_on(const wh_ranks_t *ranks, wh_pool_t *pool, helper_t *helper) {
    bool sound = true;
    const bool wants = helper->more && !helper->wanting && wh_pool_look(pool).queued <= helper->given / 2;
    if (wants || wh_clock_seconds() - helper->told > TELL_S) {
        sound = tell_progress(ranks, pool, wants ? WANTS_MORE : HAS_DONE);
        helper->wanting = helper->wanting || wants;
        helper->told = wh_clock_seconds();
    }
    if (sound && helper->wanting) {
        sound = take_trials(ranks, pool, helper);
    }
    wh_pool_wait(pool, helper->wanting ? 2 : 20);
    return sound;
}

bool wh_ranks_help(wh_ranks_t *ranks, wh_pool_t *pool, bool (*interrupted)(void)) {
    helper_t helper = {.more = true, .told = wh_clock_seconds()};
    bool sound = true;
    while (sound && !interrupted() && (helper.more || !wh_pool_look(pool).idle)) {
        sound = !wh_pool_look(pool).failed && go_on(ranks, pool, &helper);
    }
    if (wh_pool_look(pool).failed) {
        tell_rank(ranks, HAS_FAILED, pool->message);
        return false;
    }
    return sound && !interrupted() && tell_progress(ranks, pool, HAS_ENDED);
}
