#include "live.h"

#include <errno.h>
#include <inttypes.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include "../text/array.h"
#include "../text/clock.h"
#include "../view/http.h"
#include "connection.h"
#include "live_browser.h"
#include "live_files.h"
#include "live_kept.h"
#include "live_news.h"
#include "live_pace.h"

/* A look at least so long after the one before, and what is told that may wait, us. */
#define LOOK_US 16000
#define GROWTH_US 250000

/* Room for an entry of a port in its written form. */
#define FRAME_BYTES 2000

struct wh_live {
    wh_live_options_t options;
    wh_mcs_listener_t next;
    wh_live_control_t control;
    wh_live_pace_t pace;        /* the stepping thread's */
    void (*attend)(void *user); /* likewise; null: nobody commands it */
    void *attend_user;
    wh_showing_t *showing; /* null: no cell. The stepping thread changes it, with the lock */
    pthread_t thread;
    int wake;             /* ends a wait of the page's thread */
    bool is_ending;       /* atomic */
    pthread_mutex_t lock; /* of all below: the page's thread has it while it works */
    wh_live_kept_t kept;
    wh_feed_t feed;
    wh_http_t *http;
    char id[40];
    wh_live_files_t files;
    int64_t looked_us, told_us; /* by the wall clock */
    wh_live_meter_t meter;
};

const wh_option_t wh_live_options[] = {
    {"page", 0, "ADDRESS:PORT",
     "Show the cell live in a browser: serve its page there, in this machine alone unless another address is "
     "given (default 127.0.0.1:8765)",
     WH_OPTION_ADDRESS, .variable = offsetof(wh_live_arguments_t, address)},
    {"page-control", 0, NULL,
     "With --page: let who has the token that is printed pause, step and pace a run, command a prompt's "
     "cell, or test a "
     "served one",
     WH_OPTION_FLAG, .variable = offsetof(wh_live_arguments_t, controls)},
    {"open", 0, NULL, "With --page: open it in the browser", WH_OPTION_FLAG,
     .variable = offsetof(wh_live_arguments_t, opens)},
    {0}};

void wh_live_check(const void *filled, struct argp_state *state) {
    const wh_live_arguments_t *arguments = filled;
    if ((arguments->opens || arguments->controls) && !arguments->address) {
        argp_error(state, "--%s goes with --page", arguments->opens ? "open" : "page-control");
    }
}

/* -------------------------------------------------------------------------------------- the page's thread */

static wh_live_state_t state_of(const wh_live_t *live) {
    static const char *const controlled[] = {NULL, "run", "tester", "prompt"};
    const wh_live_control_t *control = &live->control;
    return (wh_live_state_t){.title = live->options.title,
                             .reproduce = live->options.reproduce,
                             .id = live->id,
                             .rate = control->controlled != WH_LIVE_NO_CONTROL && control->paces
                                         ? (double)__atomic_load_n(&control->rate_ppm, __ATOMIC_RELAXED) / 1e6
                                         : live->options.rate,
                             .pace = live->meter.pace,
                             .control = controlled[control->controlled],
                             .lists_faults = control->controlled == WH_LIVE_TESTER ||
                                             control->controlled == WH_LIVE_PROMPT,
                             .lists_robots = control->controlled == WH_LIVE_RUN,
                             .paces = control->paces,
                             .is_paused = __atomic_load_n(&control->is_paused, __ATOMIC_RELAXED),
                             .stands = __atomic_load_n(&control->stands, __ATOMIC_ACQUIRE)};
}

static void tell_growth(wh_live_t *live) {
    const wh_live_state_t state = state_of(live);
    char *text = wh_live_kept_growth(&live->kept, &state);
    wh_feed_add(&live->feed, "growth", text);
    free(text);
    live->told_us = wh_clock_us(CLOCK_MONOTONIC);
}

/* The messages so far do not count any more: browsers fetch the document. */
static void tell_anew(wh_live_t *live) {
    const wh_live_state_t state = state_of(live);
    if (live->kept.record.layout) {
        free(wh_live_kept_growth(&live->kept, &state)); /* so that nothing is due */
    }
    live->kept.is_anew = false;
    wh_feed_add(&live->feed, "anew", "{}");
}

static void take_all(wh_live_t *live) {
    const wh_glimpse_t *look = wh_showing_take(live->showing);
    wh_news_t *news = wh_showing_take_news(live->showing);
    while (news) {
        wh_news_t *next = news->next;
        if (news->kind == WH_NEWS_ANSWER) {
            wh_feed_add(&live->feed, "answer", news->text);
        } else {
            wh_live_kept_news(&live->kept, news);
        }
        wh_news_free(news);
        news = next;
    }
    if (look) {
        wh_live_kept_look(&live->kept, look);
    }
    wh_showing_ask(live->showing);
}

/* Tells what is new since `before`, the last slice shown. */
static void tell(wh_live_t *live, int64_t before) {
    wh_live_kept_t *kept = &live->kept;
    const bool has_moved = kept->signals.last > before;
    const bool is_due = live->looked_us - live->told_us >= GROWTH_US;
    if (kept->is_anew || wh_tracks_are_anew(&kept->signals, &kept->written)) {
        tell_anew(live);
    } else if (kept->has_news || wh_tracks_have_news(&kept->signals, &kept->written) ||
               (has_moved && is_due) || wh_live_meter_has_stopped(&live->meter)) {
        tell_growth(live);
    } else if (has_moved) {
        char *text = wh_live_kept_now(kept);
        wh_feed_add(&live->feed, "frame", text);
        free(text);
    }
}

static void look(wh_live_t *live) {
    const int64_t now = wh_clock_us(CLOCK_MONOTONIC);
    if (now - live->looked_us < LOOK_US) {
        return;
    }
    const int64_t before = live->kept.signals.last;
    live->looked_us = now;
    if (live->showing) {
        take_all(live);
        wh_live_meter_add(&live->meter, now, live->kept.signals.last * live->kept.record.layout->slice_us);
        tell(live, before);
    } else if (live->kept.is_anew) {
        tell_anew(live);
    }
}

static char *make_document(void *user, size_t *size) {
    wh_live_t *live = user;
    const wh_live_state_t state = state_of(live);
    if (!live->showing) {
        return NULL;
    }
    take_all(live);
    if (live->kept.is_anew) {
        tell_anew(live);
    } else {
        tell_growth(live); /* so that nothing in the document is told again */
    }
    return wh_live_kept_document(&live->kept, &state, live->feed.last + 1, size);
}

static unsigned take_control(void *user, const char *body, size_t size, char **answer) {
    wh_live_t *live = user;
    const unsigned status = wh_live_control_take(&live->control, body, size, answer);
    live->kept.has_news = live->kept.record.layout; /* so that all pages hear of it */
    return status;
}

static void *serve(void *user) {
    wh_live_t *live = user;
    while (!__atomic_load_n(&live->is_ending, __ATOMIC_ACQUIRE)) {
        wh_http_wait(live->http, LOOK_US, live->wake);
        pthread_mutex_lock(&live->lock);
        look(live);
        wh_live_tester_drain(&live->control.tester);
        wh_http_serve(live->http);
        pthread_mutex_unlock(&live->lock);
    }
    return NULL;
}

/* ------------------------------------------------------------------------------------ the stepping thread */

static void begin(void *user, const wh_layout_t *layout) {
    wh_live_t *live = user;
    if (live->next.begins) {
        live->next.begins(live->next.user, layout);
    }
    pthread_mutex_lock(&live->lock);
    wh_showing_close(live->showing);
    live->showing = layout && !layout->tool ? wh_showing_open(layout) : NULL;
    wh_live_kept_begin(&live->kept, live->showing ? layout : NULL);
    live->meter = (wh_live_meter_t){.pace = -1};
    pthread_mutex_unlock(&live->lock);
    wh_live_pace_begin(&live->pace);
}

/* While nothing moves, or may move. */
static void idle(void *user) {
    const wh_live_t *live = user;
    wh_live_rest(user);
    if (live->attend) {
        live->attend(live->attend_user);
    }
}

static void take_slice(void *user, const wh_command_t *command, const wh_state_t *state) {
    wh_live_t *live = user;
    if (live->next.slice) {
        live->next.slice(live->next.user, command, state);
    }
    if (live->showing) {
        wh_showing_slice(live->showing, command, state);
    }
    if (live->attend && wh_live_lines_wait(&live->control.lines)) {
        live->attend(live->attend_user);
    }
    if (live->control.paces && state->status == WH_OK) {
        wh_live_control_slice(&live->control, &live->pace, state->utime, idle, live);
    }
}

static void set_back(void *user, const wh_command_t *command, const wh_state_t *state) {
    wh_live_t *live = user;
    if (live->next.set_back) {
        live->next.set_back(live->next.user, command, state);
    }
    if (live->showing) {
        wh_showing_set_back(live->showing, command, state);
    }
    wh_live_pace_begin(&live->pace);
}

static void rest(void *user, const wh_layout_t *layout) {
    wh_live_t *live = user;
    if (live->next.boundary) {
        live->next.boundary(live->next.user, layout);
    }
    wh_live_rest(live);
}

void wh_live_rest(void *user) {
    wh_live_t *live = user;
    if (live && live->showing) {
        wh_showing_rest(live->showing);
    }
}

static void hear_news(void *user, const wh_mcs_t *mcs, wh_mcs_news_t what,
                      const wh_command_record_t *command) {
    wh_live_t *live = user;
    if (live->next.tell) {
        live->next.tell(live->next.user, mcs, what, command);
    }
    wh_news_t *news = live->showing ? wh_live_news_of(mcs, what, command) : NULL;
    if (news) {
        wh_showing_rest(live->showing);
        wh_showing_tell(live->showing, news);
    }
    if (what == WH_MCS_COMMAND_ENDED) {
        wh_live_control_command(&live->control, idle, live);
    }
}

static void hear_turn(void *user, const wh_mcs_t *mcs, const char *what) {
    wh_live_t *live = user;
    if (live->next.turn) {
        live->next.turn(live->next.user, mcs, what);
    }
    if (live->showing) {
        wh_showing_tell(live->showing, wh_live_news_of_turn(mcs, what));
    }
}

static void take_holds(void *user, wh_mcs_t *mcs) {
    wh_live_t *live = user;
    if (live->next.flow_slice) {
        live->next.flow_slice(live->next.user, mcs);
    }
    if (live->control.controlled == WH_LIVE_RUN) {
        wh_live_hold_take(&live->control.hold, mcs);
    }
}

void wh_live_tell(wh_live_t *live, wh_news_t *news) {
    if (live->showing) {
        wh_showing_tell(live->showing, news);
    } else {
        wh_news_free(news);
    }
}

wh_mcs_listener_t wh_live_listener(wh_live_t *live, const wh_mcs_listener_t *next) {
    if (!live) {
        return *next;
    }
    live->next = *next;
    return (wh_mcs_listener_t){.slice = take_slice,
                               .boundary = rest,
                               .begins = begin,
                               .set_back = set_back,
                               .tell = hear_news,
                               .turn = hear_turn,
                               .flow_slice = take_holds,
                               .user = live};
}

void wh_live_heard(void *user, const wh_transcript_entry_t *entry) {
    wh_live_t *live = user;
    char text[FRAME_BYTES];
    if (live->showing) {
        text[0] = '\0';
        if (entry->size > 0) {
            (void)wh_transcript_escape(text, sizeof text, entry->bytes, entry->size);
        }
        wh_news_t *news = wh_news_make(WH_NEWS_FRAME, entry->time_us, text, entry->port);
        news->line = (int)entry->kind;
        wh_showing_tell(live->showing, news);
    }
}

void wh_live_set_attendant(wh_live_t *live, void (*attend)(void *user), void *user) {
    if (live) {
        live->attend = attend;
        live->attend_user = user;
    }
}

int wh_live_descriptor(const wh_live_t *live) {
    return live ? live->control.lines.wake : -1;
}

bool wh_live_take_line(wh_live_t *live, wh_live_line_t *line) {
    return live && wh_live_lines_take(&live->control.lines, line);
}

bool wh_live_has_asked(const wh_live_t *live, int64_t number) {
    return live && number > live->control.base && number - live->control.base < WH_LIVE_NUMBERS;
}

void wh_live_go_on(wh_live_t *live) {
    if (live) {
        wh_live_control_go_on(&live->control);
    }
}

bool wh_live_shows(const wh_live_t *live, const wh_layout_t *layout) {
    if (!live || !layout->tool) {
        return true;
    }
    (void)fprintf(stderr,
                  "%s: --page: nothing to show (expected robots with axes: here they are times alone)\n",
                  layout->path);
    return false;
}

/* ------------------------------------------------------------------------------------------------ opening */

static bool open_server(wh_live_t *live, const char *address) {
    char problem[WH_HTTP_PROBLEM_BYTES];
    const wh_http_source_t source = {.files = live->files.files,
                                     .file_count = WH_LIVE_FILES,
                                     .feed = &live->feed,
                                     .id = live->id,
                                     .document = make_document,
                                     .control =
                                         live->control.controlled != WH_LIVE_NO_CONTROL ? take_control : NULL,
                                     .user = live};
    live->http = wh_http_open(address, &source, problem);
    if (!live->http) {
        (void)fprintf(stderr, "--page: %s\n", problem);
    }
    return live->http;
}

/* Signals are the stepping thread's. */
static bool start(wh_live_t *live) {
    sigset_t all;
    sigset_t before;
    (void)sigfillset(&all);
    (void)pthread_sigmask(SIG_SETMASK, &all, &before);
    const int problem = pthread_create(&live->thread, NULL, serve, live);
    (void)pthread_sigmask(SIG_SETMASK, &before, NULL);
    if (problem != 0) {
        (void)fprintf(stderr, "--page: no thread: %s\n", strerror(problem));
    }
    return problem == 0;
}

static void free_live(wh_live_t *live) {
    wh_live_control_end(&live->control);
    wh_http_close(live->http);
    wh_showing_close(live->showing);
    wh_live_kept_begin(&live->kept, NULL);
    wh_feed_close(&live->feed);
    wh_live_files_free(&live->files);
    if (live->wake >= 0) {
        (void)close(live->wake);
    }
    (void)pthread_mutex_destroy(&live->lock);
    free(live);
}

/* False, with a message: nobody can command this, or there is no token. */
static bool open_control(wh_live_t *live, const wh_live_arguments_t *arguments) {
    const wh_live_options_t *options = &live->options;
    const wh_live_controlled_t controlled = arguments->controls ? options->controlled : WH_LIVE_NO_CONTROL;
    if (arguments->controls && options->uncontrolled) {
        (void)fprintf(stderr, "--page-control: %s\n", options->uncontrolled);
        return false;
    }
    if (!wh_live_control_begin(&live->control, controlled, options->paces, options->rate)) {
        (void)fprintf(stderr, "--page-control: no token: %s\n", strerror(errno));
        return false;
    }
    return true;
}

void wh_live_set_tester(wh_live_t *live, const char *address) {
    if (live) {
        pthread_mutex_lock(&live->lock);
        (void)snprintf(live->control.tester.address, sizeof live->control.tester.address, "%s", address);
        pthread_mutex_unlock(&live->lock);
    }
}

/* Says where the page is. The token stands behind a #, which no browser sends to anybody. */
static void tell_place(const wh_live_t *live, bool opens) {
    const bool is_controlled = live->control.controlled != WH_LIVE_NO_CONTROL;
    char place[WH_HTTP_PLACE_BYTES + WH_LIVE_TOKEN + 16];
    (void)snprintf(place, sizeof place, "%s/%s%s", wh_http_place(live->http), is_controlled ? "#token=" : "",
                   is_controlled ? live->control.token : "");
    (void)fprintf(stderr, "%s: page at http://%s%s\n", live->options.speaker, place,
                  wh_http_is_local(live->http) ? "" : ": whoever reaches this machine can see the cell");
    if (opens) {
        wh_live_browse(live->options.speaker, place);
    }
}

bool wh_live_open(wh_live_t **made, const wh_live_arguments_t *arguments, const wh_live_options_t *options) {
    *made = NULL;
    if (!arguments->address) {
        return true;
    }
    wh_live_t *live = wh_array_new(1, sizeof *live);
    live->options = *options;
    live->meter.pace = -1;
    live->control.lines.wake = -1;
    (void)snprintf(live->id, sizeof live->id, "%" PRIx64 "-%x", (uint64_t)wh_clock_us(CLOCK_REALTIME),
                   (unsigned)getpid());
    live->wake = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    (void)pthread_mutex_init(&live->lock, NULL);
    if (live->wake < 0 || !open_control(live, arguments) ||
        !wh_live_files_make(&live->files, live->options.title) || !open_server(live, arguments->address) ||
        !start(live)) {
        free_live(live);
        return false;
    }
    tell_place(live, arguments->opens);
    *made = live;
    return true;
}

void wh_live_stay(const wh_live_t *live) {
    if (live && live->options.stays) {
        wh_catch_signals();
        (void)fprintf(stderr, "%s: the run is over; its page stays until Ctrl-C\n", live->options.speaker);
        while (!wh_stop_requested) {
            (void)pause();
        }
    }
}

void wh_live_close(wh_live_t *live) {
    const uint64_t one = 1;
    if (!live) {
        return;
    }
    __atomic_store_n(&live->is_ending, true, __ATOMIC_RELEASE);
    (void)!write(live->wake, &one, sizeof one);
    (void)pthread_join(live->thread, NULL);
    free_live(live);
}
