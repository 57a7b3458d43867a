#include "budget.h"

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../math/trig.h"
#include "../text/array.h"
#include "budget_internal.h"

/* ------------------------------------------------------------------------------------------------ threads */

typedef struct {
    wh_budget_crew_t *crew;
    size_t count, next, done;
    wh_budget_work_t *work;
    void *user;
    const char *what;
    pthread_mutex_t lock;
} queue_t;

typedef struct {
    queue_t *queue;
    wh_budget_player_t *player;
} hand_t;

/* The next piece of work, or `count`. `done`: a piece was finished. */
static size_t take(queue_t *queue, bool done) {
    const wh_budget_options_t *options = &queue->crew->budget->options;
    pthread_mutex_lock(&queue->lock);
    if (options->is_enough && options->is_enough()) {
        queue->crew->budget->incomplete = true;
        queue->next = queue->count;
    }
    const size_t index = queue->next < queue->count ? queue->next++ : queue->count;
    queue->done += done ? 1 : 0;
    if (queue->what && options->tell) {
        options->tell(options->user, queue->what, queue->done, queue->count);
    }
    pthread_mutex_unlock(&queue->lock);
    return index;
}

static void *work_off(void *user) {
    const hand_t *hand = user;
    queue_t *queue = hand->queue;
    for (size_t i = take(queue, false); i < queue->count; i = take(queue, true)) {
        queue->work(hand->player, queue->user, i);
    }
    return NULL;
}

bool wh_budget_share_out(wh_budget_crew_t *crew, size_t count, wh_budget_work_t *work, void *user,
                         const char *what) {
    queue_t queue = {.crew = crew, .count = count, .work = work, .user = user, .what = what};
    const size_t most = crew->budget->options.threads;
    const size_t wanted = count < most ? count : most;
    hand_t *hands = wh_array_new(wanted + 1, sizeof *hands);
    pthread_t *threads = wh_array_new(wanted + 1, sizeof *threads);
    size_t begun = 0;
    pthread_mutex_init(&queue.lock, NULL);
    for (size_t i = 0; i < wanted; ++i) {
        hands[i] = (hand_t){&queue, &crew->players[i]};
        begun += begun == i && pthread_create(&threads[i], NULL, work_off, &hands[i]) == 0 ? 1 : 0;
    }
    for (size_t i = 0; i < begun; ++i) {
        pthread_join(threads[i], NULL);
    }
    pthread_mutex_destroy(&queue.lock);
    free(hands);
    free(threads);
    if (begun == 0 && count > 0) {
        fputs("waferhand budget: no threads (expected fewer with --threads)\n", stderr);
    }
    return !crew->budget->incomplete && (begun > 0 || count == 0);
}

/* ---------------------------------------------------------------------------------------- one error alone */

/* How a search goes outwards: from `first` on each step is `step` times the way before it, but no longer than
 * `longest`. */
typedef struct {
    int32_t first, longest;
    double step;
} pace_t;

/* A search in one direction. */
typedef struct {
    wh_budget_player_t *player;
    size_t at; /* of the point */
    int32_t sign;
    wh_budget_level_t level;
    wh_budget_side_t *side;
    bool (*is_enough)(void); /* null: nobody ends it */
    bool differs, ended;
} search_t;

/* Tries a value above `inside`. A search that is ended tries nothing more. */
static bool try(search_t *search, int32_t value) {
    wh_budget_side_t *side = search->side;
    int32_t *point = search->player->point;
    search->ended = search->ended || (search->is_enough && search->is_enough());
    if (search->ended) {
        return false;
    }
    point[search->at] = search->sign * value;
    const bool passes = wh_budget_passes(search->player, point, search->level);
    point[search->at] = 0;
    search->differs = search->differs || search->player->differs;
    ++side->trials;
    if (!passes) {
        side->outside = value;
    } else {
        const int32_t step = value - side->inside;
        side->widest = step > side->widest ? step : side->widest;
        side->inside = value;
    }
    return passes;
}

static bool is_between(const wh_budget_side_t *side, int32_t value) {
    return side->inside < value && value < side->outside;
}

/* Begins at the result of another search: it is often equal or near. */
static void take_hint(search_t *search, int32_t hint) {
    wh_budget_side_t *side = search->side;
    if (is_between(side, hint)) {
        const bool passes = try(search, hint);
        const int32_t way = passes ? 1 : -1;
        for (int32_t step = way; is_between(side, hint + step) && try(search, hint + step) == passes;) {
            step *= 8;
        }
    }
}

/* Narrows down the place where it fails first. */
static void bisect(search_t *search, const int32_t hints[], size_t hint_count) {
    wh_budget_side_t *side = search->side;
    for (size_t i = 0; i < hint_count; ++i) {
        take_hint(search, hints[i]);
    }
    while (!search->ended && side->outside - side->inside > 1) {
        (void)try(search, side->inside + (side->outside - side->inside) / 2);
    }
}

static int32_t next_value(const pace_t *pace, int32_t value, int32_t most) {
    const int32_t grown = (int32_t)(value * pace->step);
    const int32_t step = value == 0 ? pace->first : grown < pace->longest ? grown : pace->longest;
    const int32_t next = value + (step > 1 ? step : 1);
    return next < most ? next : most;
}

/* Goes outwards from 0 up to `most`, until a trial fails. */
static bool go_outwards(search_t *search, const pace_t *pace, int32_t most) {
    bool passes = true;
    for (int32_t value = 0; passes && value < most;) {
        value = next_value(pace, value, most);
        passes = try(search, value);
    }
    return passes;
}

/* With collisions a trial takes long: about this time in seconds for a slice. */
#define SLICE_S 2e-6

/* The seconds that all searches together may spend outwards; the least and the most trials of each. */
#define OUTWARDS_S 60
#define OUTWARDS_LEAST 8
#define OUTWARDS_MOST 100

/* Each step is a fifth of the way so far, until there are `steps` to the end. */
static pace_t dense_pace(uint64_t steps, int32_t most) {
    const int32_t longest = (int32_t)((uint64_t)most / steps);
    return (pace_t){WH_BUDGET_UNIT / 100, longest > 1 ? longest : 1, 0.2};
}

/* Fewer and longer steps: their number follows from the number of slices, so it is equal on every machine. */
static pace_t sparse_pace(const wh_budget_t *budget, int32_t most) {
    const double slices = (double)budget->study->nominal.record.slices;
    const double searches = 2.0 * WH_SPREADS * (double)budget->study->layout->station_count;
    double trials = OUTWARDS_S / (SLICE_S * slices * searches + 1e-9);
    trials = trials < OUTWARDS_LEAST ? OUTWARDS_LEAST : trials > OUTWARDS_MOST ? OUTWARDS_MOST : trials;
    pace_t pace = dense_pace((uint64_t)trials / 3, most);
    pace.first = WH_BUDGET_UNIT / 10;
    pace.step = 10 / trials;
    return pace;
}

/* One direction of an error: first without collisions if that decides, because it costs little. */
static void search_side(const wh_budget_t *budget, search_t *search, int32_t most, const int32_t hints[],
                        size_t hint_count) {
    wh_budget_side_t *side = search->side;
    const uint64_t steps = budget->options.steps;
    const pace_t dense = dense_pace(steps > 0 ? steps : 100, most);
    const pace_t sparse = steps > 0 ? dense : sparse_pace(budget, most);
    const bool costly = budget->study->layout->collision;
    search->level = budget->two_ways ? WH_BUDGET_WITHOUT : WH_BUDGET_WITH;
    if (!go_outwards(search, costly && !budget->two_ways ? &sparse : &dense, most)) {
        bisect(search, hints, hint_count);
    }
    if (budget->two_ways) {
        const wh_budget_side_t without = *side;
        *side = (wh_budget_side_t){.trials = without.trials};
        search->level = WH_BUDGET_WITH;
        if (go_outwards(search, &sparse, without.inside)) {
            side->outside = without.outside;
        } else {
            bisect(search, hints, hint_count);
        }
    }
}

/* All errors, one by one: number `index` is error index % WH_SPREADS of a station. */
typedef struct {
    wh_budget_t *budget;
    const size_t *stations;           /* which */
    const wh_budget_station_t *model; /* a station that may be like these; null: none yet */
    bool *sound;                      /* of each error: its witnesses behave as found */
} errors_t;

/* Plays the result once more, by the script itself. */
static bool confirm(const wh_budget_t *budget, search_t *search) {
    wh_budget_side_t *side = search->side;
    wh_budget_player_t *player = search->player;
    wh_budget_why_t ignored;
    bool sound = true;
    if (budget->two_ways || !budget->study->whole) { /* else all trials were the script */
        player->point[search->at] = search->sign * side->inside;
        sound = wh_budget_run(player, player->point, &ignored);
    }
    if (side->outside > 0) {
        player->point[search->at] = search->sign * side->outside;
        sound = !wh_budget_run(player, player->point, &side->why) && sound;
    }
    player->point[search->at] = 0;
    return sound;
}

/* A replay with collisions may end otherwise than the script if a contact is just as deep as allowed, to
 * rounding. Then the script alone decides. */
static bool search_soundly(const wh_budget_t *budget, search_t *search, int32_t most, const int32_t hints[],
                           size_t hint_count) {
    search_side(budget, search, most, hints, hint_count);
    bool sound = search->ended || confirm(budget, search);
    if (!sound && budget->two_ways) {
        *search->side = (wh_budget_side_t){.trials = search->side->trials};
        search->player->by_script = true;
        search_side(budget, search, most, hints, hint_count);
        sound = search->ended || confirm(budget, search);
        search->player->by_script = false;
    }
    return sound;
}

static int32_t lesser_inside(const wh_budget_error_t *error) {
    return error->sides[0].inside < error->sides[1].inside ? error->sides[0].inside : error->sides[1].inside;
}

static void search_error(wh_budget_player_t *player, void *user, size_t index) {
    const errors_t *errors = user;
    wh_budget_t *budget = errors->budget;
    const size_t axis = index % WH_SPREADS;
    const size_t station = errors->stations[index / WH_SPREADS];
    wh_budget_error_t *error = &budget->stations[station].errors[axis];
    const wh_budget_error_t *model = errors->model ? &errors->model->errors[axis] : NULL;
    errors->sound[index] = error->known = true;
    for (int way = 0; way < 2; ++way) {
        search_t search = {.player = player,
                           .at = station * WH_SPREADS + axis,
                           .sign = way == 0 ? -1 : 1,
                           .side = &error->sides[way],
                           .is_enough = budget->options.is_enough};
        const int32_t hints[] = {error->sides[0].outside, model ? model->sides[0].outside : 0,
                                 model ? model->sides[1].outside : 0};
        const int32_t most = budget->options.most[axis < 3 ? 0 : 1];
        errors->sound[index] = search_soundly(budget, &search, most, hints, 3) && errors->sound[index];
        error->has_effect = error->has_effect || search.differs;
        error->known = error->known && !search.ended;
    }
    error->width = lesser_inside(error);
}

static bool tell_unsound(const wh_budget_t *budget, const errors_t *errors, size_t count) {
    for (size_t i = 0; i < count * WH_SPREADS; ++i) {
        if (!errors->sound[i]) {
            fprintf(stderr,
                    "waferhand budget: %s.%s: the script alone does not end as its trials did "
                    "(expected a script that does the same each time)\n",
                    budget->study->layout->stations[errors->stations[i / WH_SPREADS]].name,
                    wh_errors_teaching_name(i % WH_SPREADS));
            return false;
        }
    }
    return true;
}

/* The first station by itself: the others may be like it. */
static bool find_errors(wh_budget_crew_t *crew, const size_t stations[], size_t count) {
    wh_budget_t *budget = crew->budget;
    bool *sound = wh_array_new(WH_SPREADS * (count + 1), sizeof *sound);
    bool done = true;
    for (size_t begin = 0, end = count > 0 ? 1 : 0; done && begin < end; begin = end, end = count) {
        errors_t errors = {budget, stations + begin, begin > 0 ? &budget->stations[stations[0]] : NULL,
                           sound};
        done = wh_budget_share_out(crew, WH_SPREADS * (end - begin), search_error, &errors,
                                   begin > 0 ? "errors of the other stations" : "errors of one station") &&
               tell_unsound(budget, &errors, end - begin);
    }
    free(sound);
    return done;
}

/* ------------------------------------------------------------------------------------- which allows least */

static bool never_fails(const wh_budget_error_t *error) {
    return error->sides[0].outside == 0 && error->sides[1].outside == 0;
}

static double rim_of_width(const wh_budget_t *budget, size_t station, size_t axis) {
    const double width = (double)budget->stations[station].errors[axis].width / WH_BUDGET_UNIT;
    const double radius = budget->study->layout->wafer_diameter / 2;
    return axis < 3 ? width : width * (double)WH_PI / 180 * radius;
}

double wh_budget_rim(const wh_budget_t *budget, size_t station, size_t axis) {
    return never_fails(&budget->stations[station].errors[axis]) ? (double)INFINITY
                                                                : rim_of_width(budget, station, axis);
}

size_t wh_budget_capped(const wh_budget_t *budget) {
    size_t count = 0;
    for (size_t i = 0; budget->tightest != WH_NONE && i < WH_SPREADS * budget->study->layout->station_count;
         ++i) {
        const wh_budget_station_t *station = &budget->stations[i / WH_SPREADS];
        const wh_budget_error_t *error = &station->errors[i % WH_SPREADS];
        const bool is_capped = station->wanted && error->has_effect && never_fails(error);
        count += is_capped && rim_of_width(budget, i / WH_SPREADS, i % WH_SPREADS) <
                                  wh_budget_tightness(budget, (size_t)budget->tightest)
                     ? 1
                     : 0;
    }
    return count;
}

size_t wh_budget_tightest_axis(const wh_budget_t *budget, size_t station) {
    size_t least = 0;
    for (size_t axis = 1; axis < WH_SPREADS; ++axis) {
        least = wh_budget_rim(budget, station, axis) < wh_budget_rim(budget, station, least) ? axis : least;
    }
    return least;
}

double wh_budget_tightness(const wh_budget_t *budget, size_t station) {
    return budget->stations[station].wanted
               ? wh_budget_rim(budget, station, wh_budget_tightest_axis(budget, station))
               : (double)INFINITY;
}

bool wh_budget_is_alike(const wh_budget_t *budget, size_t one, size_t other) {
    const double a = wh_budget_tightness(budget, one);
    const double b = wh_budget_tightness(budget, other);
    return a <= 1.05 * b && b <= 1.05 * a;
}

/* The tightest station that is not like `but`; WH_NONE if there is none. */
static int32_t find_tightest(const wh_budget_t *budget, int32_t but) {
    int32_t tightest = WH_NONE;
    double least = (double)INFINITY;
    for (size_t s = 0; s < budget->study->layout->station_count; ++s) {
        const double tightness = wh_budget_tightness(budget, s);
        if (tightness < least && (but == WH_NONE || !wh_budget_is_alike(budget, s, (size_t)but))) {
            tightest = (int32_t)s;
            least = tightness;
        }
    }
    return tightest;
}

/* ---------------------------------------------------------------------------------------------- all of it */

/* The indices of the stations that are searched, to be freed. */
static size_t *choose_stations(wh_budget_t *budget, size_t *count) {
    const size_t station_count = budget->study->layout->station_count;
    size_t *stations = wh_array_new(station_count + 1, sizeof *stations);
    *count = 0;
    for (size_t s = 0; s < station_count; ++s) {
        budget->stations[s].wanted = !budget->options.wanted || budget->options.wanted[s];
        if (budget->stations[s].wanted) {
            stations[(*count)++] = s;
        }
    }
    return stations;
}

static bool find(wh_budget_crew_t *crew) {
    size_t count = 0;
    size_t *stations = choose_stations(crew->budget, &count);
    const bool found = find_errors(crew, stations, count) && wh_budget_find_box(crew);
    free(stations);
    return found;
}

bool wh_budget_find(wh_budget_t *budget, const wh_study_t *study, const wh_budget_options_t *options) {
    const wh_layout_t *layout = study->layout;
    memset(budget, 0, sizeof *budget);
    budget->study = study;
    budget->options = *options;
    budget->stations = wh_array_new(layout->station_count, sizeof *budget->stations);
    budget->two_ways = wh_budget_has_two_ways(study);
    wh_budget_crew_t crew = {budget, wh_array_new(options->threads, sizeof *crew.players)};
    for (size_t i = 0; i < options->threads; ++i) {
        wh_budget_player_open(&crew.players[i], study);
    }
    const bool found = find(&crew);
    for (size_t i = 0; i < options->threads; ++i) {
        budget->trials += crew.players[i].trials;
        budget->caught = budget->caught || crew.players[i].caught;
        wh_budget_player_close(&crew.players[i]);
    }
    free(crew.players);
    budget->tightest = find_tightest(budget, WH_NONE);
    budget->next = budget->tightest == WH_NONE ? WH_NONE : find_tightest(budget, budget->tightest);
    return found;
}

void wh_budget_free(wh_budget_t *budget) {
    free(budget->stations);
    free(budget->box.half);
    free(budget->box.inside);
    free(budget->box.outside);
    memset(budget, 0, sizeof *budget);
}
