#include "safe.h"

#include <stdlib.h>
#include <string.h>

#include "../text/array.h"

typedef struct {
    int32_t wafer, step, place;
} inside_t;

/* More than one place of a station. */
#define SEVERAL (-2)

typedef struct {
    const wh_flow_state_t *state;
    int32_t *counts;  /* wafers by place */
    int32_t *reached; /* by station: where the wafer that walks may stand, as SEVERAL or one place */
    int32_t *next;
    inside_t *wafers;
    size_t count;
} world_t;

static bool is_free(const world_t *world, const inside_t *at, int32_t place) {
    return world->counts[place] == (place == at->place ? 1 : 0) || world->counts[place] == 0;
}

/* True if some robot carries from where the wafer may stand into this place: another one than that. */
static bool is_carried(const world_t *world, int32_t place) {
    const wh_flow_tool_t *tool = world->state->tool;
    const int32_t to = tool->place_stations[place];
    for (int32_t r = 0; r < (int32_t)tool->robot_count; ++r) {
        const size_t of = wh_flow_of(tool, r, to);
        if (!tool->serves[of] || !wh_flow_sides_agree(tool->sides[of], tool->slot_sides[place])) {
            continue;
        }
        for (int32_t from = 0; from < (int32_t)tool->station_count; ++from) {
            if (world->reached[from] != WH_FLOW_NONE && world->reached[from] != place &&
                tool->serves[wh_flow_of(tool, r, from)]) {
                return true;
            }
        }
    }
    return false;
}

/* The places of a station with room, as SEVERAL or one, or WH_FLOW_NONE; adds to those that are free. `end`:
 * that place alone, or WH_FLOW_NONE. */
static int32_t find_room(const world_t *world, const inside_t *at, const wh_flow_station_t *station,
                         int32_t end, int32_t *first, int32_t *free_places) {
    int32_t room = WH_FLOW_NONE;
    for (int32_t p = station->first_place; p < station->first_place + station->slots; ++p) {
        if ((end != WH_FLOW_NONE && p != end) || !is_free(world, at, p)) {
            continue;
        }
        ++*free_places;
        if (room != SEVERAL && is_carried(world, p)) {
            *first = *first == WH_FLOW_NONE ? p : *first;
            room = room == WH_FLOW_NONE ? p : SEVERAL;
        }
    }
    return room;
}

/* Goes on to a step: marks the stations with room, and returns the first place with room, or WH_FLOW_NONE. */
static int32_t walk_on(world_t *world, const inside_t *at, int32_t number) {
    const wh_flow_state_t *state = world->state;
    const wh_flow_step_t *step = wh_flow_step_of(state->plan, at->wafer, number);
    const int32_t end = wh_flow_end_of(state->plan, at->wafer, number);
    int32_t first = WH_FLOW_NONE, free_places = 0;
    memset(world->next, 0xff, state->tool->station_count * sizeof *world->next);
    for (size_t i = 0; i < step->station_count; ++i) {
        world->next[step->stations[i]] =
            find_room(world, at, &state->tool->stations[step->stations[i]], end, &first, &free_places);
    }
    int32_t *reached = world->reached;
    world->reached = world->next;
    world->next = reached;
    return free_places > step->kept_empty ? first : WH_FLOW_NONE;
}

/* Takes the wafer to its end if it can go there while all others stand. */
static bool walk_out(world_t *world, const inside_t *at) {
    const wh_flow_state_t *state = world->state;
    const int32_t last = wh_flow_last_step(state->plan, at->wafer);
    int32_t end = at->place;
    memset(world->reached, 0xff, state->tool->station_count * sizeof *world->reached);
    world->reached[state->tool->place_stations[at->place]] = at->place;
    for (int32_t k = at->step + 1; k <= last; ++k) {
        end = walk_on(world, at, k);
        if (end == WH_FLOW_NONE) {
            return false;
        }
    }
    --world->counts[at->place];
    ++world->counts[end];
    return true;
}

static void put(world_t *world, int32_t wafer, int32_t step, int32_t place) {
    ++world->counts[place];
    if (step > 0 && !world->state->wafers[wafer].is_over) {
        world->wafers[world->count++] = (inside_t){wafer, step, place};
    }
}

static void look(world_t *world, const wh_flow_into_t into[], size_t count) {
    const wh_flow_state_t *state = world->state;
    for (int32_t p = 0; p < (int32_t)state->tool->place_count; ++p) {
        const wh_flow_place_t *at = &state->places[p];
        bool lies = at->wafer != WH_FLOW_NONE && at->leaving_us == WH_FLOW_NEVER,
             comes = at->coming != WH_FLOW_NONE;
        for (size_t i = 0; i < count; ++i) {
            lies = lies && into[i].wafer != at->wafer;
            comes = comes && into[i].wafer != at->coming;
        }
        if (lies) {
            put(world, at->wafer, state->wafers[at->wafer].step, p);
        }
        if (comes) {
            put(world, at->coming, state->wafers[at->coming].step + 1, p);
        }
    }
    for (size_t i = 0; i < count; ++i) {
        put(world, into[i].wafer, state->wafers[into[i].wafer].step + 1, into[i].place);
    }
}

bool wh_flow_is_safe(const wh_flow_state_t *state, const wh_flow_into_t into[], size_t count) {
    return wh_flow_find_blocked(state, into, count) == WH_FLOW_NONE;
}

int32_t wh_flow_find_blocked(const wh_flow_state_t *state, const wh_flow_into_t into[], size_t count) {
    const size_t places = state->tool->place_count, stations = state->tool->station_count;
    world_t world = {state,
                     wh_array_new(places, sizeof *world.counts),
                     wh_array_new(stations, sizeof *world.reached),
                     wh_array_new(stations, sizeof *world.next),
                     wh_array_new(2 * places + count, sizeof *world.wafers),
                     0};
    look(&world, into, count);
    bool goes_on = true;
    while (goes_on && world.count > 0) {
        goes_on = false;
        for (size_t i = 0; i < world.count; ++i) {
            if (walk_out(&world, &world.wafers[i])) {
                world.wafers[i--] = world.wafers[--world.count];
                goes_on = true;
            }
        }
    }
    int32_t blocked = WH_FLOW_NONE;
    for (size_t i = 0; i < world.count; ++i) {
        blocked = i == 0 || world.wafers[i].wafer < blocked ? world.wafers[i].wafer : blocked;
    }
    free(world.counts);
    free(world.reached);
    free(world.next);
    free(world.wafers);
    return blocked;
}
