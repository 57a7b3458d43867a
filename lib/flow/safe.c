#include "safe.h"

#include <stdlib.h>
#include <string.h>

#include "../text/array.h"
#include "calls.h"
#include "failed.h"

/* More than one place of a station. */
#define SEVERAL (-2)

#define SIDES ((size_t)WH_FLOW_BOTH + 1)

/* How many answers are kept until a wafer goes anywhere: robots and locks ask the same again and again. */
#define ANSWERS 16

typedef struct {
    wh_flow_into_t into;
    bool is_safe;
} answer_t;

typedef struct {
    int32_t wafer, step, place;
    bool comes; /* it does not lie there yet */
} inside_t;

/* A station with room for the wafer that walks, at SEVERAL places or one. */
typedef struct {
    int32_t station, place;
} stand_t;

/* A question touches the few places of the wafers inside and of their ways: what is known of the others is of
 * an earlier one. */
struct wh_flow_safety {
    bool *carries;    /* by side of a slot, station from and to: some robot carries between them */
    uint32_t stamp;   /* of the question */
    uint32_t *stamps; /* by place: the question that counted its wafers */
    int32_t *counts;
    stand_t *reached, *next; /* where the wafer that walks may stand */
    size_t reached_count;
    inside_t *wafers;
    size_t wafer_count, wafer_capacity;
    answer_t answers[ANSWERS];
    size_t answer_count;
    uint64_t changes; /* when they were given */
};

/* The question's own view. */
typedef struct {
    const wh_flow_state_t *state;
    struct wh_flow_safety *safety;
    const wh_flow_into_t *into;
    size_t into_count;
} world_t;

/* ------------------------------------------------------------------------------------------------ opening */

static bool is_any_carrier(const wh_flow_tool_t *tool, wh_flow_side_t side, int32_t from, int32_t to) {
    bool found = false;
    for (int32_t r = 0; r < (int32_t)tool->robot_count; ++r) {
        const size_t of = wh_flow_of(tool, r, to);
        found = found || (tool->serves[of] && tool->serves[wh_flow_of(tool, r, from)] &&
                          wh_flow_sides_agree(tool->sides[of], side));
    }
    return found;
}

static size_t way_of(const wh_flow_tool_t *tool, wh_flow_side_t side, int32_t from, int32_t to) {
    return ((size_t)side * tool->station_count + (size_t)from) * tool->station_count + (size_t)to;
}

struct wh_flow_safety *wh_flow_safety_open(const wh_flow_tool_t *tool) {
    struct wh_flow_safety *safety = wh_array_new(1, sizeof *safety);
    const int32_t stations = (int32_t)tool->station_count;
    safety->carries = wh_array_new(SIDES * tool->station_count * tool->station_count, sizeof(bool));
    for (size_t side = 0; side < SIDES; ++side) {
        for (int32_t from = 0; from < stations; ++from) {
            for (int32_t to = 0; to < stations; ++to) {
                safety->carries[way_of(tool, (wh_flow_side_t)side, from, to)] =
                    is_any_carrier(tool, (wh_flow_side_t)side, from, to);
            }
        }
    }
    safety->stamps = wh_array_new(tool->place_count, sizeof *safety->stamps);
    safety->counts = wh_array_new(tool->place_count, sizeof *safety->counts);
    safety->reached = wh_array_new(tool->station_count, sizeof *safety->reached);
    safety->next = wh_array_new(tool->station_count, sizeof *safety->next);
    return safety;
}

void wh_flow_safety_close(struct wh_flow_safety *safety) {
    if (safety) {
        free(safety->carries);
        free(safety->stamps);
        free(safety->counts);
        free(safety->reached);
        free(safety->next);
        free(safety->wafers);
        free(safety);
    }
}

/* ------------------------------------------------------------------------------------------------- places */

/* A wafer that is to go elsewhere is there already. */
static bool goes_elsewhere(const world_t *world, int32_t wafer) {
    bool goes = false;
    for (size_t i = 0; i < world->into_count; ++i) {
        goes = goes || world->into[i].wafer == wafer;
    }
    return goes;
}

static bool lies(const world_t *world, int32_t place) {
    const wh_flow_place_t *at = &world->state->places[place];
    return at->wafer != WH_FLOW_NONE && at->leaving_us == WH_FLOW_NEVER && !goes_elsewhere(world, at->wafer);
}

static bool comes(const world_t *world, int32_t place) {
    const int32_t coming = world->state->places[place].coming;
    return coming != WH_FLOW_NONE && !goes_elsewhere(world, coming);
}

/* The wafers of a place, to be read and changed. */
static int32_t *count_of(const world_t *world, int32_t place) {
    struct wh_flow_safety *safety = world->safety;
    if (safety->stamps[place] != safety->stamp) {
        int32_t count = lies(world, place) + comes(world, place);
        for (size_t i = 0; i < world->into_count; ++i) {
            count += world->into[i].place == place ? 1 : 0;
        }
        safety->stamps[place] = safety->stamp;
        safety->counts[place] = count;
    }
    return &safety->counts[place];
}

/* A carrier in which wafers end is changed when it is full. */
static bool is_free(const world_t *world, const inside_t *at, int32_t place) {
    const int32_t count = *count_of(world, place);
    if (wh_flow_is_for_ends(world->state, world->state->tool->place_stations[place])) {
        return true;
    }
    return count == (place == at->place ? 1 : 0) || count == 0;
}

/* True if some robot carries from where the wafer may stand into this place: another one than that. */
static bool is_carried(const world_t *world, int32_t place) {
    const wh_flow_tool_t *tool = world->state->tool;
    const struct wh_flow_safety *safety = world->safety;
    const int32_t to = tool->place_stations[place];
    for (size_t i = 0; i < safety->reached_count; ++i) {
        const stand_t *from = &safety->reached[i];
        if (from->place != place &&
            safety->carries[way_of(tool, tool->slot_sides[place], from->station, to)]) {
            return true;
        }
    }
    return false;
}

/* -------------------------------------------------------------------------------------------------- walks */

/* The room of a step. */
typedef struct {
    int32_t first;       /* place with room, or WH_FLOW_NONE */
    int32_t free_places; /* up to more than are kept empty */
    int32_t kept_empty;
} room_t;

/* Adds a place to the room of its station, if it is free: WH_FLOW_NONE, that one, or SEVERAL. */
static int32_t look_at_place(const world_t *world, const inside_t *at, int32_t place, int32_t room,
                             room_t *found) {
    if (!is_free(world, at, place)) {
        return room;
    }
    ++found->free_places;
    if (room == SEVERAL || !is_carried(world, place)) {
        return room;
    }
    found->first = found->first == WH_FLOW_NONE ? place : found->first;
    return room == WH_FLOW_NONE ? place : SEVERAL;
}

/* The places of a station with room, as SEVERAL or one, or WH_FLOW_NONE; adds to those that are free. `end`:
 * that place alone, or WH_FLOW_NONE. */
static int32_t find_room(const world_t *world, const inside_t *at, const wh_flow_station_t *station,
                         int32_t end, room_t *found) {
    const int32_t behind = station->first_place + station->slots;
    int32_t room = WH_FLOW_NONE;
    if (end != WH_FLOW_NONE) {
        return end < station->first_place || end >= behind ? room
                                                           : look_at_place(world, at, end, room, found);
    }
    for (int32_t p = station->first_place;
         p < behind && (room != SEVERAL || found->free_places <= found->kept_empty); ++p) {
        room = look_at_place(world, at, p, room, found);
    }
    return room;
}

static int32_t count_free(const world_t *world, const inside_t *at, const wh_flow_station_t *station) {
    int32_t count = 0;
    for (int32_t p = station->first_place; p < station->first_place + station->slots; ++p) {
        count += is_free(world, at, p);
    }
    return count;
}

/* Goes on to a step: notes the stations with room, and returns the first place with room, or
 * WH_FLOW_NONE. */
static int32_t walk_on(const world_t *world, const inside_t *at, int32_t number) {
    const wh_flow_state_t *state = world->state;
    struct wh_flow_safety *safety = world->safety;
    const wh_flow_step_t *step = wh_flow_step_of(state->plan, at->wafer, number);
    const int32_t end = wh_flow_end_of(state->plan, at->wafer, number);
    room_t found = {WH_FLOW_NONE, 0, step->kept_empty};
    size_t count = 0;
    for (size_t i = 0; i < step->station_count; ++i) {
        const int32_t to = step->stations[i];
        if (wh_flow_has_failed(state, to)) {
            found.free_places +=
                count_free(world, at, &state->tool->stations[to]); /* among those kept empty */
            continue;
        }
        const int32_t room = find_room(world, at, &state->tool->stations[to], end, &found);
        if (room != WH_FLOW_NONE) {
            safety->next[count++] = (stand_t){to, room};
        }
    }
    stand_t *reached = safety->reached;
    safety->reached = safety->next;
    safety->reached_count = count;
    safety->next = reached;
    return found.free_places > step->kept_empty ? found.first : WH_FLOW_NONE;
}

/* True if the step has failed, or lies behind one that has and the wafer may stand in its place already. */
static bool is_left_out(const world_t *world, const inside_t *at, int32_t number, bool *is_out) {
    const wh_flow_state_t *state = world->state;
    const wh_flow_step_t *step = wh_flow_step_of(state->plan, at->wafer, number);
    const int32_t end = wh_flow_end_of(state->plan, at->wafer, number);
    if (wh_flow_step_has_failed(state, step)) {
        *is_out = true;
        return true;
    }
    for (size_t i = 0; *is_out && i < world->safety->reached_count; ++i) {
        const stand_t *reached = &world->safety->reached[i];
        if (wh_flow_step_has(step, reached->station) &&
            (end == WH_FLOW_NONE || reached->place == SEVERAL || reached->place == end)) {
            return true;
        }
    }
    return false;
}

/* Takes the wafer to its end if it can go there while all others stand. */
static bool walk_out(const world_t *world, const inside_t *at) {
    const wh_flow_state_t *state = world->state;
    const int32_t last = wh_flow_last_step(state->plan, at->wafer);
    int32_t end = at->place;
    world->safety->reached[0] = (stand_t){state->tool->place_stations[at->place], at->place};
    world->safety->reached_count = 1;
    bool is_out = false;
    for (int32_t k = at->step + 1; k <= last; ++k) {
        if (state->failures.stations > 0 && is_left_out(world, at, k, &is_out)) {
            continue;
        }
        is_out = false;
        end = walk_on(world, at, k);
        if (end == WH_FLOW_NONE) {
            return false;
        }
    }
    --*count_of(world, at->place);
    ++*count_of(world, end);
    return true;
}

/* ------------------------------------------------------------------------------------------------- wafers */

/* In the order of the places; one that lies there before one that comes. */
static bool is_behind(const inside_t *a, const inside_t *b) {
    return a->place != b->place ? a->place > b->place : a->comes && !b->comes;
}

static void put(const world_t *world, const inside_t *one, bool sorts) {
    struct wh_flow_safety *safety = world->safety;
    if (world->state->wafers[one->wafer].is_over) {
        return;
    }
    safety->wafers =
        wh_array_grow(safety->wafers, safety->wafer_count, &safety->wafer_capacity, sizeof *safety->wafers);
    size_t at = safety->wafer_count++;
    while (sorts && at > 0 && is_behind(&safety->wafers[at - 1], one)) {
        safety->wafers[at] = safety->wafers[at - 1];
        --at;
    }
    safety->wafers[at] = *one;
}

/* Those that lie in a step behind the first one. */
static void look_at_steps(const world_t *world) {
    const wh_flow_state_t *state = world->state;
    for (size_t i = 0; i < state->plan->route_count; ++i) {
        const wh_flow_route_t *route = &state->plan->routes[i];
        for (size_t k = 1; k <= route->step_count; ++k) {
            for (int32_t w = state->heads[route->first_step + k]; w != WH_FLOW_NONE;
                 w = state->wafers[w].next) {
                const int32_t place = state->wafers[w].place;
                if (place != WH_FLOW_NONE && state->places[place].wafer == w && lies(world, place)) {
                    put(world, &(inside_t){w, state->wafers[w].step, place, false}, true);
                }
            }
        }
    }
}

static void look(const world_t *world) {
    const wh_flow_state_t *state = world->state;
    world->safety->wafer_count = 0;
    look_at_steps(world);
    for (size_t i = 0; i < state->coming.count; ++i) {
        const int32_t place = state->coming.places[i], w = state->places[place].coming;
        if (comes(world, place)) {
            put(world, &(inside_t){w, wh_flow_next_step(state, w), place, true}, true);
        }
    }
    for (size_t i = 0; i < world->into_count; ++i) {
        const wh_flow_into_t *into = &world->into[i];
        put(world, &(inside_t){into->wafer, wh_flow_next_step(state, into->wafer), into->place, true}, false);
    }
}

/* A new question: nothing is known of any place. */
static void begin(struct wh_flow_safety *safety, size_t places) {
    if (++safety->stamp == 0) {
        memset(safety->stamps, 0, places * sizeof *safety->stamps);
        safety->stamp = 1;
    }
}

static const answer_t *find_answer(const struct wh_flow_safety *safety, const wh_flow_into_t *into) {
    for (size_t i = 0; i < safety->answer_count; ++i) {
        const answer_t *answer = &safety->answers[i];
        if (answer->into.wafer == into->wafer && answer->into.place == into->place) {
            return answer;
        }
    }
    return NULL;
}

bool wh_flow_is_safe(const wh_flow_state_t *state, const wh_flow_into_t into[], size_t count) {
    struct wh_flow_safety *safety = state->safety;
    if (count != 1) {
        return wh_flow_find_blocked(state, into, count) == WH_FLOW_NONE;
    }
    if (safety->changes != state->changes || safety->answer_count == ANSWERS) {
        safety->answer_count = 0;
        safety->changes = state->changes;
    }
    const answer_t *known = find_answer(safety, into);
    if (known) {
        return known->is_safe;
    }
    const bool is_safe = wh_flow_find_blocked(state, into, 1) == WH_FLOW_NONE;
    safety->answers[safety->answer_count++] = (answer_t){*into, is_safe};
    return is_safe;
}

int32_t wh_flow_find_blocked(const wh_flow_state_t *state, const wh_flow_into_t into[], size_t count) {
    struct wh_flow_safety *safety = state->safety;
    const world_t world = {state, safety, into, count};
    begin(safety, state->tool->place_count);
    look(&world);
    bool goes_on = true;
    while (goes_on && safety->wafer_count > 0) {
        goes_on = false;
        for (size_t i = 0; i < safety->wafer_count; ++i) {
            if (walk_out(&world, &safety->wafers[i])) {
                safety->wafers[i--] = safety->wafers[--safety->wafer_count];
                goes_on = true;
            }
        }
    }
    int32_t blocked = WH_FLOW_NONE;
    for (size_t i = 0; i < safety->wafer_count; ++i) {
        blocked = i == 0 || safety->wafers[i].wafer < blocked ? safety->wafers[i].wafer : blocked;
    }
    return blocked;
}
