#include "trial_cell.h"
#include "../math/hash.h"

#include <math.h>
#include <string.h>

#include "../math/trig.h"

/* What wh_vacuum_validate allows, s. */
#define LONGEST_BUILD 3600

static wh_mat3_t turn_of(const wh_displacement_t *drawn) {
    return wh_mat3_from_rpy_deg(drawn->turn[0], drawn->turn[1], drawn->turn[2]);
}

static void place_station(wh_pose_t *base_from_station, const wh_displacement_t *drawn) {
    const wh_mat3_t turn = turn_of(drawn);
    base_from_station->R = wh_mat3_multiply(&turn, &base_from_station->R);
    base_from_station->r = wh_vec3_add(&base_from_station->r, &drawn->moved);
}

/* A chuck goes with its station, and so does its edge sensor, whose noise is the trial's own. */
static void place_chucks(wh_trial_cell_t *trial_cell, int32_t station, const wh_displacement_t *drawn) {
    wh_machine_t *machine = &trial_cell->layout.machine;
    for (size_t g = 0; g < machine->gripper_count; ++g) {
        if (machine->mounts[g].axis != WH_NONE && trial_cell->layout.grippers[g].station == station) {
            place_station(&machine->mounts[g].base_from_station, drawn);
            trial_cell->chucks_moved = true;
        }
    }
}

static void place_stations(wh_trial_cell_t *trial_cell, const wh_layout_t *layout, wh_station_t *places) {
    for (size_t s = 0; s < layout->station_count; ++s) {
        const wh_displacement_t drawn = wh_errors_draw_station(layout->errors, &trial_cell->trial, s);
        places[s] = layout->places[s];
        if (wh_displacement_is_any(&drawn)) {
            place_station(&places[s].base_from_station, &drawn);
            place_chucks(trial_cell, (int32_t)s, &drawn);
        }
    }
}

static void place_scanners(wh_trial_cell_t *trial_cell) {
    wh_layout_t *layout = &trial_cell->layout;
    for (size_t i = 0; i < layout->scanner_count; ++i) {
        wh_scanner_t *scanner = &layout->scanners[i];
        const int32_t station = layout->grippers[scanner->gripper].station;
        scanner->base_from_station = layout->places[station].base_from_station;
        scanner->seed = wh_hash_word(scanner->seed, trial_cell->trial.seed);
        scanner->seed = wh_hash_word(scanner->seed, trial_cell->trial.trial);
    }
}

/* Beams go with their station, too. */
static void place_beams(wh_trial_cell_t *trial_cell) {
    wh_layout_t *layout = &trial_cell->layout;
    for (size_t b = 0; b < layout->beam_count; ++b) {
        wh_layout_place_beam(layout, b);
        layout->doors[b].seed = wh_hash_word(layout->doors[b].seed, trial_cell->trial.seed);
        layout->doors[b].seed = wh_hash_word(layout->doors[b].seed, trial_cell->trial.trial);
    }
}

/* To the last bit. */
static bool is_same(const wh_pose_t *a, const wh_pose_t *b) {
    return wh_hash_pose(WH_HASH_START, a) == wh_hash_pose(WH_HASH_START, b);
}

/* Each wafer lies in its slot as the layout says; then what was drawn moves it along the slot's axes and
 * turns it about its own centre. */
static void place_wafers(wh_trial_cell_t *trial_cell, const wh_layout_t *layout, const wh_station_t places[],
                         wh_wafer_t *start) {
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        const wh_layout_wafer_t *lies = &layout->wafers[w];
        const wh_displacement_t drawn = wh_errors_draw_wafer(layout->errors, &trial_cell->trial, w);
        start[w] = layout->start[w];
        if (!wh_displacement_is_any(&drawn) && is_same(&places[lies->station].base_from_station,
                                                       &layout->places[lies->station].base_from_station)) {
            continue;
        }
        const wh_pose_t taught = wh_station_slot(&layout->places[lies->station], lies->slot);
        const wh_pose_t real = wh_station_slot(&places[lies->station], lies->slot);
        wh_pose_t slot_from_wafer = wh_pose_relative(&taught, &layout->start[w].base_from_wafer);
        const wh_mat3_t turn = turn_of(&drawn);
        slot_from_wafer.R = wh_mat3_multiply(&turn, &slot_from_wafer.R);
        slot_from_wafer.r = wh_vec3_add(&slot_from_wafer.r, &drawn.moved);
        start[w].base_from_wafer = wh_pose_compose(&real, &slot_from_wafer);
    }
}

/* Only edge sensors see them. */
static void place_rims(wh_trial_cell_t *trial_cell, const wh_layout_t *layout, const wh_trial_room_t *room) {
    for (size_t w = 0; layout->scanner_count > 0 && w < layout->wafer_count; ++w) {
        double drawn[WH_RIM_DRAWS];
        room->rims[w] = *layout->rims[w];
        wh_errors_draw_rim(layout->errors, &trial_cell->trial, w, &room->rims[w], drawn);
        room->rim_of[w] = wh_rim_draw_apply(drawn, &room->rims[w]) ? &room->rims[w] : layout->rims[w];
    }
    trial_cell->layout.rims = layout->scanner_count > 0 ? room->rim_of : layout->rims;
}

static int64_t lag_of(const wh_trial_cell_t *trial_cell, wh_real_t seconds) {
    const double slices = ceil((double)seconds * 1e6 / (double)trial_cell->layout.slice_us);
    return slices < WH_STUDY_LAG_SLICES ? (int64_t)slices : WH_STUDY_LAG_SLICES;
}

void wh_trial_cell_fill(wh_trial_cell_t *trial_cell, const wh_layout_t *layout, const wh_trial_t *trial,
                        const wh_trial_room_t *room) {
    trial_cell->trial = *trial;
    trial_cell->layout = *layout;
    trial_cell->chucks_moved = false;
    trial_cell->layout.places = room->places;
    trial_cell->layout.start = room->start;
    trial_cell->layout.cell.stations = room->places;
    place_stations(trial_cell, layout, room->places);
    place_scanners(trial_cell);
    place_beams(trial_cell);
    place_wafers(trial_cell, layout, room->places, room->start);
    place_rims(trial_cell, layout, room);
    wh_real_t *build = &trial_cell->layout.physics.vacuum.build;
    *build += wh_errors_draw_vacuum(layout->errors, trial);
    *build = *build < LONGEST_BUILD ? *build : LONGEST_BUILD;
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        trial_cell->lag[g] = lag_of(trial_cell, wh_errors_draw_valve(layout->errors, trial, g));
    }
}

void wh_trial_cell_delay(wh_trial_cell_t *trial_cell, wh_command_t *command) {
    uint8_t *now = &trial_cell->told[command->seq % WH_TRIAL_CELL_PAST];
    *now = 0;
    for (size_t g = 0; g < command->gripper_count; ++g) {
        *now |= (uint8_t)(command->grippers[g].valve == WH_VALVE_CLOSED ? 1U << g : 0);
    }
    for (size_t g = 0; g < command->gripper_count; ++g) {
        const int64_t slice = command->seq - trial_cell->lag[g];
        const unsigned told = slice < 1 ? ~0U : trial_cell->told[(size_t)slice % WH_TRIAL_CELL_PAST];
        const bool closed = (told >> g & 1U) != 0;
        command->grippers[g].valve = closed ? WH_VALVE_CLOSED : WH_VALVE_OPEN;
    }
}
