#include "tryout.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../layout/doors.h"
#include "../layout/ports.h"
#include "../mcs/other_cell.h"
#include "../sim/event_text.h"
#include "../text/array.h"

void wh_tryout_open(wh_tryout_t *tryout, wh_mcs_t *mcs, const wh_layout_t *layout) {
    memset(tryout, 0, sizeof *tryout);
    tryout->mcs = mcs;
    tryout->layout = layout;
    tryout->station = WH_NONE;
    tryout->lifts = wh_array_new(layout->station_count, sizeof *tryout->lifts);
}

static void forget_tryout(wh_tryout_t *tryout) {
    free(tryout->full.wafers);
    free(tryout->full.start);
    free(tryout->edge_wafers);
    free(tryout->storage.wafers);
    free(tryout->storage.buckets);
    free(tryout->grips.seen);
    free(tryout->world_memory);
    memset(&tryout->storage, 0, sizeof tryout->storage);
    tryout->full.wafers = NULL;
    tryout->full.start = NULL;
    tryout->edge_wafers = NULL;
    tryout->world_memory = NULL;
    tryout->grips.seen = NULL;
}

/* ----------------------------------------------------------------------------------------- full of wafers */

static size_t slots_of(const wh_layout_t *layout, size_t station) {
    const bool has_any = station < layout->station_count && layout->stations[station].taught;
    return has_any ? (size_t)layout->places[station].slots : 0;
}

size_t wh_tryout_slots(const wh_tryout_t *tryout) {
    size_t count = 0;
    for (size_t s = 0; s < tryout->layout->station_count; ++s) {
        count += slots_of(tryout->layout, s);
    }
    return count;
}

/* A layout without edge grips has none. */
static void set_edge(wh_tryout_t *tryout, size_t w, const wh_rim_t *rim) {
    if (tryout->edge_wafers) {
        tryout->edge_wafers[w] = wh_layout_edge_wafer(rim);
    }
}

static void add_station(wh_tryout_t *tryout, size_t station) {
    wh_layout_t *full = &tryout->full;
    for (int32_t slot = 1; slot <= (int32_t)slots_of(full, station); ++slot) {
        const size_t w = full->wafer_count++;
        full->wafers[w].station = (int32_t)station;
        full->wafers[w].slot = slot;
        snprintf(full->wafers[w].name, sizeof full->wafers[w].name, "a wafer of %.35s slot %d",
                 full->stations[station].name, (int)slot);
        full->start[w].base_from_wafer = wh_layout_lying(full, (int32_t)station, slot);
        full->start[w].holder = WH_NONE;
        set_edge(tryout, w, full->nominal_rim);
    }
}

/* Moves the layout's own wafers to where it puts them. `firsts`: the index of each station's first wafer. */
static void move_known(wh_tryout_t *tryout, const size_t firsts[]) {
    const wh_layout_t *layout = tryout->layout;
    wh_layout_t *full = &tryout->full;
    for (size_t known = 0; known < layout->wafer_count; ++known) {
        const wh_layout_wafer_t *wafer = &layout->wafers[known];
        const size_t w = firsts[wafer->station] + (size_t)wafer->slot - 1;
        const bool is_there = !wh_layout_is_outside(&layout->start[known].base_from_wafer);
        if (is_there && w < full->wafer_count && full->wafers[w].station == wafer->station) {
            full->start[w] = layout->start[known];
            set_edge(tryout, w, layout->rims[known]);
            memcpy(full->wafers[w].name, wafer->name, sizeof wafer->name);
        }
    }
}

static void fill_station(wh_tryout_t *tryout, size_t station) {
    const wh_layout_t *layout = tryout->layout;
    wh_layout_t *full = &tryout->full;
    const size_t own = slots_of(layout, station);
    const size_t all = wh_tryout_slots(tryout);
    const bool alone = all > own + WH_TRYOUT_WAFERS;
    size_t *firsts = wh_array_new(layout->station_count, sizeof *firsts);
    forget_tryout(tryout);
    *full = *layout;
    full->wafer_count = 0;
    full->wafers = wh_array_new(alone ? own : all, sizeof *full->wafers);
    full->start = wh_array_new(alone ? own : all, sizeof *full->start);
    if (wh_layout_has_edge(layout)) {
        tryout->edge_wafers = wh_array_new(alone ? own : all, sizeof *tryout->edge_wafers);
    }
    full->edge_wafers = tryout->edge_wafers;
    full->physics.fault_count = 0;
    for (size_t s = 0; s < layout->station_count; ++s) {
        firsts[s] = full->wafer_count;
        if (!alone || s == station) {
            add_station(tryout, s);
        }
    }
    move_known(tryout, firsts);
    free(firsts);
    full->world.wafer_count = full->wafer_count;
    tryout->station = (int32_t)station;
}

/* ------------------------------------------------------------------------------------------------- a cell */

static void take_memory(wh_tryout_t *tryout) {
    const wh_layout_t *full = &tryout->full;
    wh_grasp_storage_t *storage = &tryout->storage;
    storage->wafer_count = full->wafer_count;
    storage->gripper_count = full->machine.gripper_count;
    storage->wafers = wh_array_new(full->wafer_count, sizeof *storage->wafers);
    storage->grippers = tryout->grippers;
    tryout->grips.seen = wh_array_new(wh_layout_seen(full), sizeof *tryout->grips.seen);
    storage->bucket_count = wh_layout_buckets(full);
    storage->buckets = wh_array_new(storage->bucket_count, sizeof *storage->buckets);
    if (full->part_names) {
        tryout->world_memory = wh_array_new(1, wh_collision_bytes(full));
    }
}

/* Farther away than anything in a cell, mm. */
#define ELSEWHERE WH_REAL(5e5)

static void take_away(wh_tryout_t *tryout, size_t station, int32_t slot) {
    const wh_layout_t *full = &tryout->full;
    for (size_t w = 0; w < full->wafer_count; ++w) {
        if (full->wafers[w].station == (int32_t)station && full->wafers[w].slot == slot) {
            tryout->storage.wafers[w].base_from_wafer.r.z -= ELSEWHERE;
        }
    }
}

static wh_status_t set_up_tryout(wh_tryout_t *tryout) {
    const wh_layout_t *full = &tryout->full;
    wh_status_t status = wh_simulator_init(&tryout->simulator, &full->grasp, &tryout->storage, &full->cell);
    if (status == WH_OK) {
        status = wh_simulator_set_physics(&tryout->simulator, &full->physics);
    }
    if (status == WH_OK) {
        status = wh_layout_give_doors(full, &tryout->simulator);
    }
    if (status == WH_OK) {
        status = wh_layout_give_grips(full, &tryout->simulator, &tryout->grips);
    }
    if (status == WH_OK) {
        status = wh_other_cell_enter(tryout->mcs, full, &tryout->simulator);
    }
    return status;
}

wh_status_t wh_tryout_begin(wh_tryout_t *tryout, size_t station, const wh_real_t axes[WH_AXES], size_t to,
                            int32_t empty) {
    if (tryout->station != (int32_t)station) {
        fill_station(tryout, station);
        take_memory(tryout);
    }
    const wh_layout_t *full = &tryout->full;
    tryout->slices += wh_other_cell_slices(tryout->mcs);
    memcpy(tryout->storage.wafers, full->start, full->wafer_count * sizeof *full->start);
    take_away(tryout, to, empty);
    const wh_status_t status = set_up_tryout(tryout);
    if (status == WH_OK) {
        wh_tryout_move(tryout, axes);
    }
    return status;
}

/* A tried command goes through open doors. */
void wh_tryout_move(wh_tryout_t *tryout, const wh_real_t axes[WH_AXES]) {
    const wh_machine_t *machine = &tryout->full.machine;
    wh_other_cell_place(tryout->mcs, axes);
    for (size_t d = 0; d < machine->door_count; ++d) {
        tryout->simulator.physics.doors.at[d] = machine->doors[d].travel;
    }
    if (tryout->world_memory) {
        wh_collision_attach(&tryout->collision, &tryout->full, &tryout->simulator, tryout->world_memory);
    }
}

/* ------------------------------------------------------------------------------------------- on the blade */

/* Poses that are not farther apart count as equal, mm. */
#define SAME_PLACE WH_REAL(1e-3)
#define SAME_TILT WH_REAL(1e-5)

void wh_tryout_note_lift(wh_tryout_t *tryout, size_t station) {
    const wh_gripper_t *gripper =
        wh_other_cell_gripper(tryout->mcs, (size_t)tryout->layout->stations[station].effector);
    wh_tryout_lift_t *lift = &tryout->lifts[station];
    if (!lift->is_known && gripper->wafer != WH_NONE) {
        lift->is_known = true;
        lift->gripper_from_wafer = gripper->gripper_from_wafer;
    }
}

/* True if they are equal; a turn of the wafer about its axis does not count. */
static bool is_same_lift(const wh_tryout_t *tryout, size_t a, size_t b) {
    const wh_pose_t *one = &tryout->lifts[a].gripper_from_wafer;
    const wh_pose_t *other = &tryout->lifts[b].gripper_from_wafer;
    const wh_vec3_t apart = wh_vec3_subtract(&one->r, &other->r);
    const wh_vec3_t up = wh_mat3_column(&one->R, 2);
    const wh_vec3_t other_up = wh_mat3_column(&other->R, 2);
    const wh_vec3_t tilt = wh_vec3_subtract(&up, &other_up);
    return wh_vec3_norm(&apart) < SAME_PLACE && wh_vec3_norm(&tilt) < SAME_TILT;
}

static bool can_be_carried(const wh_tryout_t *tryout, size_t from, size_t to) {
    const wh_layout_t *layout = tryout->layout;
    return tryout->lifts[from].is_known && tryout->lifts[to].is_known &&
           layout->stations[from].effector == layout->stations[to].effector;
}

bool wh_tryout_is_new(const wh_tryout_t *tryout, size_t from, size_t to) {
    const bool is_chuck = tryout->layout->places[to].chuck != WH_NONE;
    bool is_new = wh_tryout_slots(tryout) <= WH_TRYOUT_WAFERS && from != to &&
                  can_be_carried(tryout, from, to) && (is_chuck || !is_same_lift(tryout, from, to));
    for (size_t before = 0; is_new && before < from; ++before) {
        is_new = before == to || !can_be_carried(tryout, before, to) || !is_same_lift(tryout, before, from);
    }
    return is_new;
}

/* ------------------------------------------------------------------------------------------------ the end */

static const char *find_name(const void *user, wh_name_kind_t kind, int32_t index) {
    const wh_layout_t *full = user;
    switch (kind) {
    case WH_NAME_WAFER:
        return index >= 0 && (size_t)index < full->wafer_count ? full->wafers[index].name : NULL;
    case WH_NAME_GRIPPER:
        return index >= 0 && (size_t)index < full->machine.gripper_count ? full->grippers[index].name : NULL;
    case WH_NAME_PART:
        break;
    }
    return wh_layout_part_name(full, index);
}

/* For a contact it writes only the two parts: one may be the wafer that the whole text begins with. */
static void put_event(const wh_event_t *event, const wh_event_names_t *names, char *text, size_t size) {
    const bool close = event->kind == WH_EVENT_TOO_CLOSE;
    const bool contact = close || event->kind == WH_EVENT_HIT || event->kind == WH_EVENT_UNDECIDED;
    char reason[WH_EVENT_TEXT_SIZE];
    if (contact && wh_event_reason(event, names, 0, reason, sizeof reason) > 0) {
        snprintf(text, size, "%s%s", close && event->value > 0 ? "`clearance` is not kept: " : "", reason);
    } else {
        (void)wh_event_text(event, names, text, size);
    }
}

/* The first complaint; or the first contact, if the first complaint is only too close. */
static const wh_event_t *find_first_complaint(const wh_record_t *record) {
    const wh_event_t *first = NULL;
    for (size_t i = 0; i < record->event_count; ++i) {
        const wh_event_t *event = &record->events[i].event;
        const bool first_hit = first && event->kind == WH_EVENT_HIT;
        if (first_hit || (!first && wh_record_is_complaint(event->kind))) {
            first = event;
        }
        if (first && first->kind != WH_EVENT_TOO_CLOSE) {
            break;
        }
    }
    return first;
}

bool wh_tryout_touched(const wh_tryout_t *tryout) {
    const wh_event_t *complaint = find_first_complaint(wh_mcs_record(tryout->mcs));
    return complaint && wh_record_is_contact(complaint->kind);
}

bool wh_tryout_complained(const wh_tryout_t *tryout, char *text, size_t size) {
    const wh_event_names_t names = {find_name, &tryout->full, 1, &tryout->full.grasp.tolerance, NULL};
    const wh_event_t *complaint = find_first_complaint(wh_mcs_record(tryout->mcs));
    if (complaint) {
        put_event(complaint, &names, text, size);
    }
    return complaint != NULL;
}

void wh_tryout_end(wh_tryout_t *tryout) {
    tryout->slices += wh_other_cell_slices(tryout->mcs);
    wh_other_cell_leave(tryout->mcs, tryout->layout);
}

void wh_tryout_close(wh_tryout_t *tryout) {
    forget_tryout(tryout);
    free(tryout->lifts);
    memset(tryout, 0, sizeof *tryout);
}
