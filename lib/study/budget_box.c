/* The largest box of all errors together in which no trial fails. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../math/philox.h"
#include "../text/array.h"
#include "budget_internal.h"

/* The number of points that all threads try at a time: the result does not depend on the number of threads.
 * With collisions it is smaller, because points behind one that fails are tried again. */
#define BATCH 64
#define BATCH_WITH 8

/* How many corners one station has. */
#define CORNERS (1U << WH_SPREADS)

/* The number of places at which a ray is tried before it is bisected. */
#define PLACES 8

/* With collisions there is one ray for this number of samples. */
#define SAMPLES_WITH 16

typedef struct {
    wh_budget_crew_t *crew;
    wh_budget_t *budget;
    wh_budget_box_t *box;
    wh_budget_player_t *player; /* of the thread that leads */
    size_t size;                /* of points */
    size_t *order;              /* of each station among those that are searched */
    size_t wanted;              /* so many are */
    const int32_t **width;      /* of each error; null: not searched */
    int8_t *signs;              /* of the corner that failed last */
    wh_budget_level_t level;    /* of the list that is tried */
    bool stuck;                 /* there were no threads, or it was ended */
    /* A batch. */
    size_t first;
    int32_t *points;
    bool passes[BATCH];
} boxing_t;

/* --------------------------------------------------------------------------------------------------- size */

static int32_t width_of(const boxing_t *boxing, size_t i) {
    return boxing->width[i] ? *boxing->width[i] : 0;
}

static void set_share(boxing_t *boxing, int64_t share) {
    wh_budget_box_t *box = boxing->box;
    box->share = share;
    for (size_t i = 0; i < boxing->size; ++i) {
        box->half[i] = (int32_t)(width_of(boxing, i) * share / box->whole);
    }
}

/* The least share whose box has the point in it. */
static int64_t share_of(const boxing_t *boxing, const int32_t point[]) {
    int64_t share = 0;
    for (size_t i = 0; i < boxing->size; ++i) {
        const int64_t width = width_of(boxing, i);
        if (point[i] != 0 && width > 0) {
            const int64_t needed = (llabs(point[i]) * boxing->box->whole + width - 1) / width;
            share = needed > share ? needed : share;
        }
    }
    return share;
}

static int32_t clip(int32_t value, int32_t most) {
    return value > most ? most : value < -most ? -most : value;
}

/* ------------------------------------------------------------------------------------------------- points */

static size_t count_beside(const boxing_t *boxing, bool with) {
    const size_t errors = WH_SPREADS * boxing->wanted;
    if (!boxing->box->outside) {
        return 0;
    }
    return with ? errors : errors * (errors + 1) / 2;
}

static size_t count_alone(const boxing_t *boxing, bool with) {
    return boxing->wanted > 1 && !with ? CORNERS * boxing->wanted : 0;
}

static size_t count_drawn(const boxing_t *boxing, bool with) {
    const uint64_t samples = boxing->budget->options.samples;
    return (size_t)(with ? (samples + SAMPLES_WITH - 1) / SAMPLES_WITH : samples);
}

static size_t count_of(const boxing_t *boxing, wh_box_kind_t kind) {
    const bool with = boxing->level == WH_BUDGET_WITH && boxing->budget->study->layout->collision;
    switch (kind) {
    case WH_BOX_ALIKE:
        return CORNERS;
    case WH_BOX_OPPOSITE:
        return boxing->wanted > 1 ? CORNERS : 0;
    case WH_BOX_ALONE:
        return count_alone(boxing, with);
    case WH_BOX_BESIDE:
        return count_beside(boxing, with);
    case WH_BOX_CORNER:
    case WH_BOX_INSIDE:
    default:
        return count_drawn(boxing, with);
    }
}

/* The kind of a point of the list; `index` becomes its number within the kind. False behind the list. */
static bool find_kind(const boxing_t *boxing, size_t *index, wh_box_kind_t *kind) {
    for (*kind = WH_BOX_ALIKE; *kind < WH_BOX_KINDS; ++*kind) {
        const size_t count = count_of(boxing, *kind);
        if (*index < count) {
            return true;
        }
        *index -= count;
    }
    return false;
}

static uint32_t draw(const boxing_t *boxing, wh_box_kind_t kind, size_t index, size_t i) {
    const uint64_t seed = boxing->budget->options.seed;
    const uint32_t counter[4] = {(uint32_t)kind, (uint32_t)i, (uint32_t)index, 0};
    const uint32_t key[2] = {(uint32_t)seed, (uint32_t)(seed >> 32)};
    return wh_philox(counter, key).words[0];
}

/* Corner number `pattern` has bit `axis` set where that error is upwards. */
static int32_t corner_of(size_t pattern, size_t axis, int32_t half) {
    return (pattern >> axis & 1U) != 0 ? half : -half;
}

/* The pair with number `index`: `one` and `other`, which is at most `one`. Both may be equal. */
static void find_pair(size_t index, size_t *one, size_t *other) {
    *one = 0;
    while (index > *one) {
        index -= ++*one;
    }
    *other = index;
}

/* The corner that failed last: for the first numbers with one error turned over, then with two. */
static int32_t beside(const boxing_t *boxing, size_t index, size_t i, int32_t half) {
    const size_t errors = WH_SPREADS * boxing->wanted;
    if (boxing->order[i / WH_SPREADS] == SIZE_MAX) {
        return 0;
    }
    const size_t number = boxing->order[i / WH_SPREADS] * WH_SPREADS + i % WH_SPREADS;
    size_t one = index;
    size_t other = index;
    if (index >= errors) {
        find_pair(index - errors, &one, &other);
        ++one;
    }
    return (number == one || number == other ? -1 : 1) * boxing->signs[i] * half;
}

static int32_t coordinate(const boxing_t *boxing, wh_box_kind_t kind, size_t index, size_t i) {
    const int32_t half = boxing->box->half[i];
    const size_t axis = i % WH_SPREADS;
    const size_t place = boxing->order[i / WH_SPREADS];
    switch (kind) {
    case WH_BOX_ALIKE:
        return corner_of(index, axis, half);
    case WH_BOX_OPPOSITE:
        return corner_of(index, axis, place % 2 == 0 ? half : -half);
    case WH_BOX_ALONE:
        return place == index / CORNERS ? corner_of(index % CORNERS, axis, half) : 0;
    case WH_BOX_CORNER:
        return corner_of(draw(boxing, kind, index, i) >> 31, 0, half);
    case WH_BOX_BESIDE:
        return beside(boxing, index, i, half);
    case WH_BOX_INSIDE:
    default:
        return (int32_t)((2 * (uint64_t)half + 1) * draw(boxing, kind, index, i) >> 32) - half;
    }
}

/* False behind the list's end. */
static bool make_point(const boxing_t *boxing, size_t index, int32_t point[]) {
    wh_box_kind_t kind;
    if (!find_kind(boxing, &index, &kind)) {
        return false;
    }
    for (size_t i = 0; i < boxing->size; ++i) {
        point[i] = coordinate(boxing, kind, index, i);
    }
    return true;
}

/* ---------------------------------------------------------------------------------------------- shrinking */

static void put_on_ray(const boxing_t *boxing, const int32_t end[], int64_t at, int64_t length,
                       int32_t point[]) {
    for (size_t i = 0; i < boxing->size; ++i) {
        point[i] = (int32_t)(end[i] * at / length);
    }
}

/* A ray, and which of its places pass. */
typedef struct {
    const boxing_t *boxing;
    const int32_t *end;
    int64_t length;
    bool passes[PLACES];
} ray_t;

static void try_place(wh_budget_player_t *player, void *user, size_t index) {
    ray_t *ray = user;
    const boxing_t *boxing = ray->boxing;
    int32_t *point = wh_array_new(boxing->size, sizeof *point);
    put_on_ray(boxing, ray->end, ray->length * (int64_t)(index + 1) / PLACES, ray->length, point);
    ray->passes[index] = wh_budget_passes(player, point, boxing->level);
    free(point);
}

/* Finds the first failing point on the way from 0 to `end`, which fails itself; the point replaces `end`.
 * False if there are no threads. */
static bool go_back(boxing_t *boxing, int32_t end[]) {
    ray_t ray = {.boxing = boxing, .end = end};
    for (size_t i = 0; i < boxing->size; ++i) {
        ray.length = llabs(end[i]) > ray.length ? llabs(end[i]) : ray.length;
    }
    if (!wh_budget_share_out(boxing->crew, PLACES - 1, try_place, &ray, NULL)) {
        return false;
    }
    int64_t place = 1;
    while (place < PLACES && ray.passes[place - 1]) {
        ++place;
    }
    const int64_t length = ray.length;
    int64_t inside = length * (place - 1) / PLACES;
    int64_t outside = length * place / PLACES;
    int32_t *point = wh_array_new(boxing->size, sizeof *point);
    while (outside - inside > 1) {
        const int64_t middle = inside + (outside - inside) / 2;
        put_on_ray(boxing, end, middle, length, point);
        *(wh_budget_passes(boxing->player, point, boxing->level) ? &inside : &outside) = middle;
    }
    put_on_ray(boxing, end, outside, length, point);
    memcpy(end, point, boxing->size * sizeof *end);
    free(point);
    return true;
}

static void note_corner(boxing_t *boxing) {
    for (size_t i = 0; i < boxing->size; ++i) {
        const int32_t value = boxing->box->outside[i];
        boxing->signs[i] = (int8_t)(value > 0 ? 1 : value < 0 ? -1 : boxing->signs[i]);
    }
}

static bool is_origin(const boxing_t *boxing, const int32_t point[]) {
    bool all_zero = true;
    for (size_t i = 0; i < boxing->size; ++i) {
        all_zero = all_zero && point[i] == 0;
    }
    return all_zero;
}

/* Shrinks the box until a point that fails is outside, and the point of the box next to it passes: these are
 * its witnesses. If even a run without errors fails, for example because a file was changed meanwhile, no box
 * is left. */
static void shrink(boxing_t *boxing, const int32_t failing[]) {
    wh_budget_box_t *box = boxing->box;
    const size_t bytes = boxing->size * sizeof *failing;
    box->inside = box->inside ? box->inside : wh_array_new(boxing->size, sizeof *box->inside);
    box->outside = box->outside ? box->outside : wh_array_new(boxing->size, sizeof *box->outside);
    memcpy(box->inside, failing, bytes);
    do {
        memcpy(box->outside, box->inside, bytes);
        if (is_origin(boxing, box->outside)) {
            set_share(boxing, 0);
            return;
        }
        if (!go_back(boxing, box->outside)) {
            boxing->stuck = true;
            return;
        }
        note_corner(boxing);
        set_share(boxing, share_of(boxing, box->outside) - 1);
        for (size_t i = 0; i < boxing->size; ++i) {
            box->inside[i] = clip(box->outside[i], box->half[i]);
        }
    } while (!wh_budget_passes(boxing->player, box->inside, boxing->level));
}

/* -------------------------------------------------------------------------------------------------- tries */

static void try_point(wh_budget_player_t *player, void *user, size_t index) {
    boxing_t *boxing = user;
    int32_t *point = boxing->points + index * boxing->size;
    boxing->passes[index] =
        !make_point(boxing, boxing->first + index, point) || wh_budget_passes(player, point, boxing->level);
}

/* `batch` if all passed. */
static size_t first_failed(const boxing_t *boxing, size_t batch) {
    size_t failed = 0;
    while (failed < batch && boxing->passes[failed]) {
        ++failed;
    }
    return failed;
}

static void tell_points(const boxing_t *boxing) {
    const wh_budget_options_t *options = &boxing->budget->options;
    if (options->tell) {
        size_t count = 0;
        for (wh_box_kind_t kind = WH_BOX_ALIKE; kind < WH_BOX_KINDS; ++kind) {
            count += count_of(boxing, kind);
        }
        options->tell(options->user, "points of the box of all errors", boxing->first, count);
    }
}

/* Tries all points of the level's list, each in the box as it then is. False if there are no threads;
 * `*clean` becomes false if one failed. */
static bool try_list(boxing_t *boxing, wh_budget_level_t level, bool *clean) {
    int32_t *ignored = wh_array_new(boxing->size, sizeof *ignored);
    const bool costly = level == WH_BUDGET_WITH && boxing->budget->study->layout->collision;
    const size_t batch = costly ? BATCH_WITH : BATCH;
    boxing->level = level;
    boxing->first = 0;
    while (boxing->box->share > 0 && make_point(boxing, boxing->first, ignored)) {
        tell_points(boxing);
        if (!wh_budget_share_out(boxing->crew, batch, try_point, boxing, NULL)) {
            free(ignored);
            return false;
        }
        const size_t failed = first_failed(boxing, batch);
        if (failed < batch) {
            shrink(boxing, boxing->points + failed * boxing->size);
            *clean = false;
        }
        if (boxing->stuck) {
            break;
        }
        boxing->first += failed < batch ? failed + 1 : batch;
    }
    free(ignored);
    return !boxing->stuck;
}

/* Repeats until none of the points fails in a box that stays unchanged. */
static bool try_lists(boxing_t *boxing) {
    bool clean = false;
    while (!clean) {
        clean = true;
        if ((boxing->budget->two_ways && !try_list(boxing, WH_BUDGET_WITHOUT, &clean)) ||
            (clean && !try_list(boxing, WH_BUDGET_WITH, &clean))) {
            return false;
        }
    }
    return true;
}

/* ---------------------------------------------------------------------------------------------- witnesses */

static bool is_enough(boxing_t *boxing) {
    const wh_budget_options_t *options = &boxing->budget->options;
    if (options->is_enough && options->is_enough()) {
        boxing->stuck = boxing->budget->incomplete = true;
    }
    return boxing->stuck;
}

/* Takes errors out of a point that fails as long as it fails: `count` in a row from each `first`. */
static void take_out(boxing_t *boxing, int32_t point[], size_t count) {
    int32_t *less = wh_array_new(boxing->size, sizeof *less);
    for (size_t first = 0; first < boxing->size; first += count) {
        bool is_any = false;
        memcpy(less, point, boxing->size * sizeof *less);
        for (size_t i = first; i < first + count; ++i) {
            is_any = is_any || less[i] != 0;
            less[i] = 0;
        }
        if (is_any && !is_enough(boxing) && !wh_budget_passes(boxing->player, less, WH_BUDGET_WITH)) {
            memcpy(point, less, boxing->size * sizeof *less);
        }
    }
    free(less);
}

/* Leaves only the needed errors in the witnesses. False if a point of the box was found to fail on the way:
 * then the box has shrunk. */
static bool settle(boxing_t *boxing) {
    wh_budget_box_t *box = boxing->box;
    const int64_t share = box->share;
    if (!box->outside || is_origin(boxing, box->outside)) {
        return true;
    }
    boxing->level = WH_BUDGET_WITH;
    take_out(boxing, box->outside, WH_SPREADS);
    take_out(boxing, box->outside, 1);
    for (size_t i = 0; i < boxing->size; ++i) {
        box->inside[i] = clip(box->outside[i], box->half[i]);
    }
    const bool is_within = share_of(boxing, box->outside) <= share;
    const bool passes = !is_within && wh_budget_passes(boxing->player, box->inside, WH_BUDGET_WITH);
    if (!passes) {
        int32_t *failing = wh_array_new(boxing->size, sizeof *failing);
        memcpy(failing, is_within ? box->outside : box->inside, boxing->size * sizeof *failing);
        shrink(boxing, failing);
        free(failing);
    }
    return passes;
}

static bool confirm(boxing_t *boxing) {
    wh_budget_box_t *box = boxing->box;
    wh_budget_why_t ignored;
    return !box->outside || (wh_budget_run(boxing->player, box->inside, &ignored) &&
                             !wh_budget_run(boxing->player, box->outside, &box->why));
}

static bool tell_unsound(void) {
    fputs(
        "waferhand budget: all errors together: the script alone does not end as its trials did (expected a "
        "script that does the same each time)\n",
        stderr);
    return false;
}

static void count_tried(boxing_t *boxing) {
    for (wh_box_kind_t kind = WH_BOX_ALIKE; kind < WH_BOX_KINDS; ++kind) {
        boxing->level = WH_BUDGET_WITH;
        boxing->box->tried[kind] = count_of(boxing, kind);
        boxing->level = WH_BUDGET_WITHOUT;
        boxing->box->tried_without[kind] = boxing->budget->two_ways ? count_of(boxing, kind) : 0;
    }
}

/* ---------------------------------------------------------------------------------------------- all of it */

static void open(boxing_t *boxing) {
    wh_budget_t *budget = boxing->budget;
    const size_t stations = budget->study->layout->station_count;
    boxing->size = WH_SPREADS * stations;
    boxing->order = wh_array_new(stations, sizeof *boxing->order);
    boxing->width = wh_array_new(boxing->size, sizeof *boxing->width);
    boxing->signs = wh_array_new(boxing->size, sizeof *boxing->signs);
    memset(boxing->signs, 1, boxing->size * sizeof *boxing->signs);
    boxing->points = wh_array_new(BATCH * boxing->size, sizeof *boxing->points);
    boxing->box->half = wh_array_new(boxing->size, sizeof *boxing->box->half);
    for (size_t s = 0; s < stations; ++s) {
        const wh_budget_station_t *station = &budget->stations[s];
        boxing->order[s] = station->wanted ? boxing->wanted++ : SIZE_MAX;
        for (size_t axis = 0; axis < WH_SPREADS && station->wanted; ++axis) {
            const int32_t *width = &station->errors[axis].width;
            boxing->width[s * WH_SPREADS + axis] = width;
            boxing->box->whole = *width > boxing->box->whole ? *width : boxing->box->whole;
        }
    }
}

/* Begins with the largest box. */
static bool find(boxing_t *boxing) {
    wh_budget_box_t *box = boxing->box;
    bool found = true;
    bool settled = false;
    free(box->inside);
    free(box->outside);
    box->inside = box->outside = NULL;
    set_share(boxing, box->whole);
    while (found && !settled) {
        found = try_lists(boxing);
        settled = !found || settle(boxing);
        found = found && !boxing->stuck;
    }
    count_tried(boxing);
    return found;
}

/* If a replay ended otherwise than the script, the script alone decides, as in the search of a single
 * error. */
static bool find_soundly(boxing_t *boxing) {
    wh_budget_crew_t *crew = boxing->crew;
    bool found = find(boxing);
    bool sound = !found || confirm(boxing);
    if (!sound && crew->budget->two_ways) {
        for (size_t i = 0; i < crew->budget->options.threads; ++i) {
            crew->players[i].by_script = true;
        }
        found = find(boxing);
        sound = !found || confirm(boxing);
    }
    return found && (sound || tell_unsound());
}

bool wh_budget_find_box(wh_budget_crew_t *crew) {
    boxing_t boxing = {
        .crew = crew, .budget = crew->budget, .box = &crew->budget->box, .player = &crew->players[0]};
    open(&boxing);
    const bool found = boxing.box->whole == 0 || find_soundly(&boxing);
    free(boxing.order);
    free(boxing.width);
    free(boxing.signs);
    free(boxing.points);
    return found;
}
