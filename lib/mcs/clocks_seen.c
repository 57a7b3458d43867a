/* Where the wafers of stations that take time are: in a slot, lifted within the station, or away. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "clocks.h"
#include "flow_played.h"

/* A wafer that lies nowhere near its slot is out of the cell, mm: see wafer_missing. */
#define OUT_OF_THE_CELL 1e4

/* The least height of a slot's room, mm up and down, where no other slot begins. */
#define ROOM 20.0

static double aside_of(const wh_place_t *place) {
    return (double)wh_real_sqrt(place->dx * place->dx + place->dy * place->dy);
}

static double distance_of(const wh_place_t *place) {
    return (double)wh_real_sqrt(place->dx * place->dx + place->dy * place->dy + place->dz * place->dz);
}

/* The wafer as it is in the station's nearest slot. */
static wh_place_t measure_nearest(const struct wh_clocks *clocks, const wh_clocked_t *of,
                                  const wh_wafer_t *wafer) {
    const wh_cell_t *cell = &clocks->mcs->real->cell;
    const wh_station_t *station = &cell->stations[of->station];
    const wh_place_t first = wh_cell_measure(cell, station, 1, &wafer->base_from_wafer);
    const double above = fmin(fmax((double)(first.dz / station->pitch), 0), station->slots - 1);
    return wh_cell_measure(cell, station, (int32_t)lround(above) + 1, &wafer->base_from_wafer);
}

/* True if the wafer is in the room of that slot: at most its radius aside. */
static bool is_in_room(const struct wh_clocks *clocks, const wh_clocked_t *of, const wh_place_t *place) {
    const double half = (double)clocks->mcs->real->cell.stations[of->station].pitch / 2;
    return aside_of(place) < clocks->mcs->layout->wafer_diameter / 2 &&
           fabs((double)place->dz) < fmax(half, ROOM);
}

typedef struct {
    int32_t place; /* by number, or WH_NONE */
    bool is_bad;
} found_t;

/* The nearest slot in whose room a wafer is that lies in no slot. */
static found_t find_room(const struct wh_clocks *clocks, const wh_wafer_t *wafer) {
    found_t found = {WH_NONE, true};
    double best = HUGE_VAL;
    for (size_t i = 0; i < clocks->count; ++i) {
        const wh_clocked_t *of = &clocks->of[i];
        const wh_place_t place = measure_nearest(clocks, of, wafer);
        const double far = distance_of(&place);
        if (is_in_room(clocks, of, &place) && far < best) {
            best = far;
            found.place = (int32_t)of->first + place.slot - 1;
        }
    }
    return found;
}

static found_t find_lying(const struct wh_clocks *clocks, const wh_wafer_t *wafer) {
    wh_place_t place;
    if (!wh_cell_locate(&clocks->mcs->real->cell, &wafer->base_from_wafer, &place)) {
        return find_room(clocks, wafer);
    }
    const int32_t number = clocks->by_station[place.station];
    return (found_t){number == WH_NONE ? WH_NONE : (int32_t)clocks->of[number].first + place.slot - 1, false};
}

/* Most wafers lie where they lay, to the bit. */
static found_t find(const struct wh_clocks *clocks, const wh_state_t *state, size_t number) {
    const wh_wafer_t *wafer = &state->wafers[number];
    wh_clocks_found_t *last = &clocks->found[number];
    if (wafer->holder != WH_NONE) {
        return (found_t){WH_NONE, false};
    }
    if (!last->is_known || memcmp(&last->pose, &wafer->base_from_wafer, sizeof last->pose) != 0) {
        const found_t found = find_lying(clocks, wafer);
        *last = (wh_clocks_found_t){true, found.is_bad, found.place, wafer->base_from_wafer};
    }
    return (found_t){last->place, last->is_bad};
}

/* The first of two in one slot counts. */
void wh_clocks_place_all(struct wh_clocks *clocks, const wh_state_t *state) {
    for (size_t i = 0; i < clocks->place_count; ++i) {
        wh_clock_seen_t *seen = &clocks->seen[i];
        if (seen->wafer != WH_NONE && find(clocks, state, (size_t)seen->wafer).place != (int32_t)i) {
            seen->wafer = WH_NONE;
        }
    }
    for (size_t w = 0; w < state->wafer_count; ++w) {
        const found_t found = find(clocks, state, w);
        wh_clock_seen_t *seen = found.place == WH_NONE ? NULL : &clocks->seen[found.place];
        if (seen && (seen->wafer == WH_NONE || seen->wafer == (int32_t)w)) {
            seen->wafer = (int32_t)w;
            seen->recipe = clocks->mcs->layout->wafers[w].recipe;
            seen->is_bad = found.is_bad;
        }
    }
}

/* Wafers come and go with events; all are looked for where a state may have been missed. */
void wh_clocks_see_wafers(struct wh_clocks *clocks, const wh_state_t *state) {
    bool is_any = state->seq != clocks->state->seq + 1 || state->has_lost_events;
    for (size_t i = 0; i < state->event_count; ++i) {
        is_any = is_any || wh_is_index(state->events[i].wafer, state->wafer_count);
    }
    if (is_any) {
        wh_clocks_place_all(clocks, state);
    }
}

int32_t wh_clocks_robot_of(const wh_mcs_t *mcs, const wh_wafer_t *wafer) {
    const int32_t gripper = wafer->holder;
    const bool is_on_robot = gripper != WH_NONE && mcs->layout->grippers[gripper].station == WH_NONE;
    return is_on_robot ? (int32_t)mcs->layout->machine.mounts[gripper].robot : WH_NONE;
}

/* A blade that a command has brought in holds the wafer within the station until it is out. Else the wafer
 * has left with its edge beyond the slot's middle, or if it lies in another slot, or is out of the cell. */
static bool keeps(const struct wh_clocks *clocks, const wh_clocked_t *of, const wh_wafer_t *wafer,
                  int32_t out) {
    const wh_mcs_t *mcs = clocks->mcs;
    const int32_t robot = wh_clocks_robot_of(mcs, wafer);
    wh_place_t place;
    if (robot != WH_NONE && (robot == out || clocks->state->inside[robot] == of->station)) {
        return robot != out;
    } else if (wafer->holder != WH_NONE) {
        const wh_place_t near = measure_nearest(clocks, of, wafer);
        return aside_of(&near) < mcs->layout->wafer_diameter / 2;
    } else if (wh_cell_locate(&mcs->real->cell, &wafer->base_from_wafer, &place)) {
        return false;
    }
    place = measure_nearest(clocks, of, wafer);
    return distance_of(&place) < OUT_OF_THE_CELL;
}

static bool is_awaited(const struct wh_clocks *clocks, size_t place, bool is_any) {
    for (size_t r = 0; r < WH_MCS_ROBOTS; ++r) {
        is_any = is_any || clocks->state->bringing[r] == (int32_t)place;
    }
    return is_any;
}

void wh_clocks_see_places(struct wh_clocks *clocks, const wh_clocked_t *of, const wh_state_t *state,
                          int32_t out) {
    for (size_t i = of->first; i < of->first + (size_t)of->of.slots; ++i) {
        const int32_t wafer = clocks->places[i].wafer;
        const bool may_keep = wafer != WH_NONE && wafer != clocks->seen[i].wafer;
        clocks->seen[i].keeps = may_keep && keeps(clocks, of, &state->wafers[wafer], out);
        const wh_flow_use_t use = wh_flow_timed_use(clocks->mcs, of->station, (int32_t)(i - of->first));
        clocks->seen[i].is_lifted = use.takes;
        clocks->seen[i].is_awaited = is_awaited(clocks, i, use.brings);
    }
}

const char *wh_clocks_why_bad(const struct wh_clocks *clocks, const wh_clocked_t *of, int32_t slot,
                              char text[WH_CLOCKS_WHY_BYTES]) {
    const wh_clock_place_t *place = &clocks->places[of->first + (size_t)slot];
    const wh_cell_t *cell = &clocks->mcs->real->cell;
    if (place->is_away) {
        return "it does not lie in its slot";
    } else if (!place->is_bad) {
        return NULL;
    }
    const wh_place_t is = wh_cell_measure(cell, &cell->stations[of->station], slot + 1,
                                          &clocks->mcs->state.wafers[place->wafer].base_from_wafer);
    (void)snprintf(
        text, WH_CLOCKS_WHY_BYTES,
        "it lies badly, %.3f mm aside and %.3f degrees askew (expected less than %.10g mm and %.3f degrees)",
        aside_of(&is), (double)wh_deg_from_rad(is.tilt), (double)cell->tolerance.projxy,
        (double)wh_deg_from_rad(wh_acos(cell->tolerance.planar)));
    return text;
}
