#include "trial_cell.h"
#include "../math/hash.h"

#include <math.h>
#include <string.h>

#include "../layout/beam_errors.h"
#include "../layout/grips.h"
#include "../layout/ports.h"
#include "../math/trig.h"

/* The longest time that wh_vacuum_validate allows, s. */
#define LONGEST_BUILD 3600

static wh_mat3_t turn_of(const wh_displacement_t *drawn) {
    return wh_mat3_from_rpy_deg(drawn->turn[0], drawn->turn[1], drawn->turn[2]);
}

static void place_station(wh_pose_t *base_from_station, const wh_displacement_t *drawn) {
    const wh_mat3_t turn = turn_of(drawn);
    base_from_station->R = wh_mat3_multiply(&turn, &base_from_station->R);
    base_from_station->r = wh_vec3_add(&base_from_station->r, &drawn->moved);
}

/* The noise is the trial's own. With errors by name it is the plain run's: they change only what they
 * name. */
static uint64_t noise_of(const wh_trial_cell_t *trial_cell, uint64_t seed) {
    if (trial_cell->layout.errors->given) {
        return seed;
    }
    return wh_hash_word(wh_hash_word(seed, trial_cell->trial.seed), trial_cell->trial.trial);
}

/* A chuck moves with its station, and so does its edge sensor. */
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
        scanner->seed = noise_of(trial_cell, scanner->seed);
    }
}

/* Beams move with their station, too; faces have no own offset in it. */
static void place_beams(wh_trial_cell_t *trial_cell) {
    wh_layout_t *layout = &trial_cell->layout;
    for (size_t b = 0; b < layout->beam_count; ++b) {
        double drawn[WH_BEAM_DRAWS] = {0};
        if (layout->doors[b].kind == WH_DOOR_LIGHT) {
            wh_errors_draw_beam(layout->errors, &trial_cell->trial, b, drawn);
        }
        wh_beam_draw_apply(drawn, layout, b);
        wh_layout_place_beam(layout, b);
        layout->doors[b].seed = noise_of(trial_cell, layout->doors[b].seed);
    }
}

/* True if they are equal to the last bit. */
static bool is_same(const wh_pose_t *a, const wh_pose_t *b) {
    return wh_hash_pose(WH_HASH_START, a) == wh_hash_pose(WH_HASH_START, b);
}

void wh_trial_cell_displace(const wh_displacement_t *drawn, wh_pose_t *slot_from_wafer) {
    const wh_mat3_t turn = turn_of(drawn);
    slot_from_wafer->R = wh_mat3_multiply(&turn, &slot_from_wafer->R);
    slot_from_wafer->r = wh_vec3_add(&slot_from_wafer->r, &drawn->moved);
}

/* Each wafer lies in its slot as the layout says; then what was drawn moves it along the slot's axes and
 * turns it about its own centre. */
static void place_wafers(wh_trial_cell_t *trial_cell, const wh_layout_t *layout, const wh_station_t places[],
                         wh_wafer_t *start) {
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        const wh_layout_wafer_t *lies = &layout->wafers[w];
        const wh_displacement_t drawn = wh_errors_draw_wafer(layout->errors, &trial_cell->trial, w);
        start[w] = layout->start[w];
        if (wh_layout_is_outside(&start[w].base_from_wafer)) {
            continue; /* it is displaced when its carrier comes */
        }
        if (!wh_displacement_is_any(&drawn) && is_same(&places[lies->station].base_from_station,
                                                       &layout->places[lies->station].base_from_station)) {
            continue;
        }
        const wh_pose_t taught = wh_station_slot(&layout->places[lies->station], lies->slot);
        const wh_pose_t real = wh_station_slot(&places[lies->station], lies->slot);
        wh_pose_t slot_from_wafer = wh_pose_relative(&taught, &layout->start[w].base_from_wafer);
        wh_trial_cell_displace(&drawn, &slot_from_wafer);
        start[w].base_from_wafer = wh_pose_compose(&real, &slot_from_wafer);
    }
}

/* Only edge sensors and beams see rims, and only edge grips touch them. */
static void place_rims(wh_trial_cell_t *trial_cell, const wh_layout_t *layout, const wh_trial_room_t *room) {
    const bool has_edge = wh_layout_has_edge(layout);
    const bool has_rims = wh_layout_has_rims(layout);
    for (size_t w = 0; has_rims && w < layout->wafer_count; ++w) {
        double drawn[WH_RIM_DRAWS];
        room->rims[w] = *layout->rims[w];
        wh_errors_draw_rim(layout->errors, &trial_cell->trial, w, &room->rims[w], drawn);
        room->rim_of[w] = wh_rim_draw_apply(drawn, &room->rims[w]) ? &room->rims[w] : layout->rims[w];
    }
    trial_cell->layout.rims = has_rims ? room->rim_of : layout->rims;
    for (size_t w = 0; has_edge && w < layout->wafer_count; ++w) {
        room->edge_wafers[w] = wh_layout_edge_wafer(room->rim_of[w]);
    }
    trial_cell->layout.edge_wafers = has_edge ? room->edge_wafers : NULL;
}

static int64_t lag_of(const wh_trial_cell_t *trial_cell, wh_real_t seconds) {
    const double slices = ceil((double)seconds * 1e6 / (double)trial_cell->layout.slice_us);
    return slices < WH_STUDY_LAG_SLICES ? (int64_t)slices : WH_STUDY_LAG_SLICES;
}

/* Whole slices, the last one begun, as the layout's own. */
static int32_t debounce_of(const wh_layout_t *layout, wh_real_t later_s) {
    const double slices = ceil((double)later_s * 1e6 / (double)layout->slice_us - 1e-9);
    const double debounce = layout->physics.vacuum.debounce + slices;
    return debounce < WH_VACUUM_DEBOUNCE ? (int32_t)debounce : WH_VACUUM_DEBOUNCE;
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
    wh_layout_take_supports(&trial_cell->layout, room->supports);
    wh_real_t *build = &trial_cell->layout.physics.vacuum.build;
    *build += wh_errors_draw_vacuum(layout->errors, trial);
    *build = *build < LONGEST_BUILD ? *build : LONGEST_BUILD;
    trial_cell->layout.physics.vacuum.debounce =
        debounce_of(layout, wh_errors_draw_debounce(layout->errors, trial));
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        trial_cell->lag[g] = lag_of(trial_cell, wh_errors_draw_valve(layout->errors, trial, g));
    }
}

/* The angle by which the slot's way in must turn about base's z, so that an arm without a wrist still comes
 * there. The slot has moved; its distance from the arm's middle line is unchanged. */
static wh_real_t turn_along_arm(const wh_chain_t *chain, double rail, const wh_pose_t *before,
                                const wh_vec3_t *now) {
    const wh_vec3_t along = wh_mat3_column(&chain->base_from_robot.R, 0);
    const wh_vec3_t way = wh_vec3_scale(chain->has_rail ? (wh_real_t)rail : 0, &along);
    const wh_vec3_t foot = wh_vec3_add(&chain->base_from_robot.r, &way);
    const wh_vec3_t from = wh_vec3_subtract(&before->r, &foot);
    const wh_vec3_t to = wh_vec3_subtract(now, &foot);
    const wh_real_t c = before->R.m[0][0];
    const wh_real_t s = before->R.m[1][0];
    const wh_real_t in = c * from.x + s * from.y;
    const wh_real_t beside = (c * from.y - s * from.x) / wh_real_sqrt(c * c + s * s);
    const wh_real_t reach = wh_real_sqrt(to.x * to.x + to.y * to.y - beside * beside);
    const wh_real_t lead = wh_atan2(beside, in < 0 ? -reach : reach);
    return wh_atan2(to.y, to.x) - lead - wh_atan2(s, c);
}

void wh_taught_move(const wh_chain_t *chain, double rail, const wh_vec3_t *aside, wh_pose_t *base_from_slot) {
    const wh_vec3_t taught = wh_vec3_add(&base_from_slot->r, aside);
    if (!(wh_vec3_norm(aside) > 0)) {
        return;
    }
    if (chain->kind == WH_CHAIN_TRZ) {
        const wh_mat3_t turn = wh_mat3_about_z(turn_along_arm(chain, rail, base_from_slot, &taught));
        base_from_slot->R = wh_mat3_multiply(&turn, &base_from_slot->R);
    }
    base_from_slot->r = taught;
}

wh_vec3_t wh_trial_cell_aside(const wh_trial_cell_t *trial_cell, size_t station, size_t robot) {
    const wh_layout_t *layout = &trial_cell->layout;
    if (!layout->stations[station].by) {
        return wh_vec3(0, 0, 0);
    }
    const wh_vec3_t drawn = wh_errors_draw_taught(layout->errors, &trial_cell->trial, station, robot);
    return wh_vec3_scale(-1, &drawn);
}

void wh_trial_cell_teach(const wh_trial_cell_t *trial_cell, size_t station, size_t robot, double rail,
                         wh_pose_t *base_from_slot) {
    const wh_vec3_t aside = wh_trial_cell_aside(trial_cell, station, robot);
    wh_taught_move(&trial_cell->layout.robots[robot].carrier.chain, rail, &aside, base_from_slot);
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

/* The layout hands its tool on by const pointer; here it is still being made. */
void wh_trial_draw_tool(const wh_layout_t *layout, const wh_trial_t *trial) {
    wh_flow_tool_t *tool = NULL;
    memcpy(&tool, &layout->tool, sizeof(void *));
    for (size_t s = 0; s < tool->station_count; ++s) {
        const double drawn_s = wh_errors_draw_process(layout->errors, trial, s);
        wh_flow_lengthen(&tool->stations[s], llround(1e6 * drawn_s));
    }
}
