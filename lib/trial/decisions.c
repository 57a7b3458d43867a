#include "decisions.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../layout/grips.h"
#include "../text/array.h"
#include "decisions_ways.h"
#include "origins.h"

/* ------------------------------------------------------------------------------------------------- slices */

static bool make_room(wh_decisions_t *decisions, const wh_command_t *command) {
    const size_t bytes =
        command->gripper_count * sizeof *decisions->poses + command->axis_count * sizeof *decisions->axes;
    if (decisions->slice_count < decisions->slice_capacity) {
        return true;
    }
    size_t poses = (size_t)decisions->slice_capacity;
    size_t axes = poses;
    const size_t wanted = poses > 0 ? 2 * poses : 4096;
    if (wanted > WH_DECISIONS_BYTES / bytes) {
        decisions->unfit = "the run has too many slices";
        return false;
    }
    decisions->gripper_count = command->gripper_count;
    decisions->axis_count = command->axis_count;
    decisions->poses = wh_array_reserve(decisions->poses, wanted, &poses,
                                        decisions->gripper_count * sizeof *decisions->poses);
    size_t ways = (size_t)decisions->slice_capacity / WH_DECISIONS_STRETCH;
    decisions->ways = wh_array_reserve(decisions->ways, wanted / WH_DECISIONS_STRETCH, &ways,
                                       decisions->gripper_count * sizeof *decisions->ways);
    decisions->axes =
        wh_array_reserve(decisions->axes, wanted, &axes, decisions->axis_count * sizeof *decisions->axes);
    decisions->slice_capacity = (int64_t)wanted;
    return true;
}

static void keep_valve(wh_decisions_t *decisions, size_t g, int64_t slice, int32_t valve) {
    const size_t count = decisions->valve_count[g];
    const int32_t before = count > 0 ? decisions->valves[g][count - 1].valve : WH_VALVE_CLOSED;
    if (valve != before) {
        decisions->valves[g] = wh_array_grow(decisions->valves[g], count, &decisions->valve_capacity[g],
                                             sizeof *decisions->valves[g]);
        decisions->valves[g][count] = (wh_decisions_valve_t){slice, valve};
        ++decisions->valve_count[g];
    }
}

void wh_decisions_slice(wh_decisions_t *decisions, const wh_command_t *command) {
    if (!decisions || decisions->unfit) {
        return;
    }
    if (command->fault_count > 0) {
        decisions->unfit = "the script makes faults on purpose";
        return;
    }
    if (!make_room(decisions, command)) {
        return;
    }
    const size_t slice = (size_t)decisions->slice_count++;
    for (size_t g = 0; g < command->gripper_count; ++g) {
        decisions->poses[slice * decisions->gripper_count + g] = command->grippers[g].base_from_gripper;
        wh_decisions_widen(decisions, g, decisions->slice_count);
        keep_valve(decisions, g, command->seq, command->grippers[g].valve);
    }
    memcpy(&decisions->axes[slice * decisions->axis_count], command->axes,
           decisions->axis_count * sizeof *decisions->axes);
}

/* ----------------------------------------------------------------------------------------------- readings */

void wh_decisions_read(wh_decisions_t *decisions, wh_decisions_kind_t kind, int32_t index, int32_t answer) {
    if (decisions) {
        decisions->entries = wh_array_grow(decisions->entries, decisions->entry_count,
                                           &decisions->entry_capacity, sizeof *decisions->entries);
        decisions->entries[decisions->entry_count++] =
            (wh_decisions_entry_t){kind, index, answer, decisions->slice_count};
    }
}

void wh_decisions_claim(wh_decisions_t *decisions, const wh_decisions_claim_t *claim, int32_t verdict) {
    if (decisions) {
        decisions->claims = wh_array_grow(decisions->claims, decisions->claim_count,
                                          &decisions->claim_capacity, sizeof *decisions->claims);
        decisions->claims[decisions->claim_count] = *claim;
        wh_decisions_read(decisions, WH_DECISION_CLAIM, (int32_t)decisions->claim_count++, verdict);
    }
}

void wh_decisions_asked(wh_decisions_t *decisions, wh_decisions_kind_t kind,
                        const wh_decisions_asked_t *asked, bool is_elsewhere) {
    if (decisions) {
        decisions->asked = wh_array_grow(decisions->asked, decisions->asked_count, &decisions->asked_capacity,
                                         sizeof *decisions->asked);
        decisions->asked[decisions->asked_count] = *asked;
        wh_decisions_read(decisions, kind, (int32_t)decisions->asked_count++, is_elsewhere);
    }
}

void wh_decisions_visit(wh_decisions_t *decisions, int32_t station, int32_t robot) {
    for (size_t i = 0; decisions && i < decisions->visits.count; ++i) {
        if (decisions->visits.items[i].station == station && decisions->visits.items[i].robot == robot) {
            return;
        }
    }
    if (decisions) {
        decisions->visits.items = wh_array_grow(decisions->visits.items, decisions->visits.count,
                                                &decisions->visits.capacity, sizeof *decisions->visits.items);
        decisions->visits.items[decisions->visits.count++] = (wh_decisions_visit_t){station, robot};
    }
}

void wh_decisions_look(wh_decisions_t *decisions, int32_t wafer) {
    if (decisions) {
        decisions->looked = wh_array_grow(decisions->looked, decisions->looked_count,
                                          &decisions->looked_capacity, sizeof *decisions->looked);
        decisions->looked[decisions->looked_count++] = wafer;
    }
}

void wh_decisions_measured(wh_decisions_t *decisions, const char *what) {
    if (decisions && !decisions->unfit) {
        decisions->unfit = what;
    }
}

void wh_vacuum_watch_slice(wh_vacuum_watch_t *watch, uint32_t sensors) {
    watch->was_off |= ~sensors;
}

int32_t wh_vacuum_watch_lost(const wh_vacuum_watch_t *watch, const int32_t valves[], size_t gripper_count) {
    for (size_t g = 0; g < gripper_count; ++g) {
        if ((watch->watched & watch->was_off & 1U << g) != 0 && valves[g] == WH_VALVE_OPEN) {
            return (int32_t)g;
        }
    }
    return WH_NONE;
}

int32_t wh_decisions_judge(const wh_decisions_claim_t *claim, const wh_cell_t *cell,
                           const wh_wafer_t wafers[]) {
    const wh_pose_t *base_from_wafer = &wafers[claim->wafer].base_from_wafer;
    wh_place_t place;
    if (!wh_cell_locate(cell, base_from_wafer, &place) || place.station != claim->station ||
        place.slot != claim->slot) {
        return 0;
    }
    place = wh_cell_measure(cell, &cell->stations[claim->station], claim->slot, base_from_wafer);
    const bool is_met = fabs(place.dx - claim->dx) < claim->tolerance &&
                        fabs(place.dy - claim->dy) < claim->tolerance && fabs(place.dz) < claim->height;
    return is_met ? 2 : 1;
}

bool wh_decisions_is_elsewhere(const wh_decisions_asked_t *asked, const wh_cell_t *cell,
                               const wh_pose_t *base_from_wafer) {
    const wh_station_t *station = &cell->stations[asked->station];
    wh_place_t place;
    if (!base_from_wafer || !wh_cell_locate(cell, base_from_wafer, &place) ||
        (place.station == asked->station && place.slot == asked->slot)) {
        return false;
    }
    place = wh_cell_measure(cell, station, asked->slot, base_from_wafer);
    const wh_vec3_t aside = wh_vec3(place.dx, place.dy, 0);
    return wh_real_abs(place.dz) >= station->pitch / 2 || wh_vec3_norm(&aside) >= cell->tolerance.projxy;
}

void wh_decisions_free(wh_decisions_t *decisions) {
    free(decisions->poses);
    free(decisions->axes);
    free(decisions->ways);
    free(decisions->entries);
    free(decisions->claims);
    free(decisions->asked);
    free(decisions->visits.items);
    free(decisions->looked);
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        free(decisions->valves[g]);
    }
    memset(decisions, 0, sizeof *decisions);
}

/* ------------------------------------------------------------------------------------------------ playing */

/* `at` is the slice that the trial has come to, `stepped` the last one that the simulator was stepped
 * through. In between only the poses of grippers and held wafers have changed. */
typedef struct {
    const wh_decisions_t *decisions;
    const wh_trial_cell_t *trial_cell;
    wh_simulator_t *simulator;
    wh_decisions_watch_t *watch;
    void *user;
    bool may_skip, broken;
    int64_t at, stepped;
    wh_origins_t origins;
    wh_command_t command;
    wh_state_t state;
    size_t next[WH_GRIPPERS]; /* the change of its valve that is still to come */
    /* For the running segment. */
    int32_t waits;
    wh_vacuum_watch_t vacuum;
} player_t;

/* ------------------------------------------------------------------------------------------------- slices */

static int64_t next_change(const player_t *player, size_t g) {
    const wh_decisions_t *decisions = player->decisions;
    return player->next[g] < decisions->valve_count[g]
               ? decisions->valves[g][player->next[g]].slice + player->trial_cell->lag[g]
               : INT64_MAX;
}

/* The grippers' poses in the run. */
static const wh_pose_t *poses_in(const player_t *player, int64_t slice) {
    return &player->decisions->poses[(size_t)(slice - 1) * player->decisions->gripper_count];
}

/* The grippers' poses in the trial; `moved` is room for them if needed. */
static const wh_pose_t *find_poses(const player_t *player, int64_t slice, wh_pose_t moved[WH_GRIPPERS]) {
    const wh_decisions_t *decisions = player->decisions;
    if (!player->trial_cell->chucks_moved) {
        return poses_in(player, slice);
    }
    const wh_real_t *axes = &decisions->axes[(size_t)(slice - 1) * decisions->axis_count];
    wh_machine_grippers(&player->trial_cell->layout.machine, axes, moved);
    return moved;
}

static void load_slice(player_t *player, int64_t slice) {
    const wh_decisions_t *decisions = player->decisions;
    wh_command_t *command = &player->command;
    wh_pose_t moved[WH_GRIPPERS];
    const wh_pose_t *poses = find_poses(player, slice, moved);
    for (size_t g = 0; g < decisions->gripper_count; ++g) {
        command->grippers[g].base_from_gripper = poses[g];
        while (next_change(player, g) <= slice) {
            command->grippers[g].valve = decisions->valves[g][player->next[g]++].valve;
        }
    }
    command->seq = slice;
    command->utime = slice * player->trial_cell->layout.slice_us;
}

/* The pose of a gripper's wafer when the gripper is here. */
static wh_pose_t carried_pose(const player_t *player, size_t g, const wh_pose_t *base_from_gripper) {
    return wh_pose_compose(base_from_gripper, &player->state.grippers[g].gripper_from_wafer);
}

/* Moves held wafers to their grippers' poses at the end of this slice. */
static void carry_wafers(player_t *player, int64_t slice) {
    wh_pose_t moved[WH_GRIPPERS];
    const wh_pose_t *poses = find_poses(player, slice, moved);
    for (size_t g = 0; g < player->decisions->gripper_count; ++g) {
        const int32_t wafer = player->state.grippers[g].wafer;
        if (wafer != WH_NONE) {
            player->simulator->table.storage.wafers[wafer].base_from_wafer =
                carried_pose(player, g, &poses[g]);
        }
    }
}

/* Steps one slice. The slices that were skipped before it have changed only the poses of held wafers. */
static void step_slice(player_t *player, int64_t slice) {
    if (slice > player->stepped + 1 && player->stepped > 0) {
        carry_wafers(player, slice - 1);
    }
    load_slice(player, slice);
    player->simulator->table.slice = (uint64_t)slice - 1;
    player->broken = wh_simulator_step(player->simulator, &player->command, &player->state) != WH_OK;
    player->stepped = slice;
    wh_origins_hear(&player->origins, &player->state);
    if (player->state.event_count > 0) {
        player->broken =
            !player->watch(player->user, player->state.events, player->state.event_count) || player->broken;
    }
}

/* The last slice up to `to` that is like this one: no valve changes, and no gripper looks for a wafer. */
static int64_t quiet_until(const player_t *player, int64_t to) {
    if (!player->may_skip || player->at == 0) {
        return player->at;
    }
    for (size_t g = 0; g < player->decisions->gripper_count; ++g) {
        const wh_gripper_t *gripper = &player->state.grippers[g];
        const int64_t change = next_change(player, g);
        if (gripper->valve == WH_VALVE_OPEN && gripper->wafer == WH_NONE) {
            return player->at;
        }
        to = change <= to ? change - 1 : to;
    }
    return to;
}

/* True if the wafer of gripper g is pushed through a slot in this slice: the simulator must step it. */
static bool is_pushed(const player_t *player, size_t g, int64_t slice) {
    wh_pose_t moved[2][WH_GRIPPERS];
    wh_passing_t passing;
    if (wh_decisions_is_still(&poses_in(player, slice)[g], &poses_in(player, slice - 1)[g])) {
        return false;
    }
    const wh_pose_t before = carried_pose(player, g, &find_poses(player, slice - 1, moved[0])[g]);
    const wh_pose_t next = carried_pose(player, g, &find_poses(player, slice, moved[1])[g]);
    return wh_cell_passes(&player->simulator->cell, (int32_t)g, &before, &next, &passing);
}

/* False if it is pushed through no slot in any slice of the stretch that has this slice. */
static bool may_be_pushed(const player_t *player, size_t g, int64_t slice) {
    wh_pose_t moved[WH_GRIPPERS];
    return wh_decisions_may_pass(player->decisions, &player->simulator->cell, g, slice,
                                 &player->state.grippers[g].gripper_from_wafer.r,
                                 &find_poses(player, player->at, moved)[g].r,
                                 &poses_in(player, player->at)[g].r);
}

/* How far each gripper's places in the trial are at most from those in the run, in the slice's stretch. */
static void find_slack(const player_t *player, double slack[WH_GRIPPERS]) {
    wh_pose_t moved[WH_GRIPPERS];
    const wh_pose_t *here = find_poses(player, player->at, moved), *run = poses_in(player, player->at);
    for (size_t g = 0; g < player->decisions->gripper_count; ++g) {
        const wh_vec3_t way = wh_vec3_subtract(&here[g].r, &run[g].r);
        /* Only what goes with a station is elsewhere, and it goes no farther than a stage does. */
        slack[g] = wh_vec3_dot(&way, &way) > 0 ? 3 * sqrt(wh_vec3_dot(&way, &way)) + 10 : 0;
    }
}

/* True if gripper g might go through another wafer in the slice's stretch: the simulator must step that. */
static bool may_meet(const player_t *player, size_t g, int64_t slice) {
    double slack[WH_GRIPPERS];
    find_slack(player, slack);
    return wh_decisions_may_meet(player->decisions, &player->simulator->cell, &player->state, g, slice,
                                 slack);
}

/* The last slice up to `quiet` before the first one in which gripper g pushes its wafer through a slot, or
 * may go through another wafer. */
static int64_t until_pushed(const player_t *player, size_t g, int64_t quiet) {
    const bool holds = player->state.grippers[g].wafer != WH_NONE;
    int64_t slice = player->at + 1;
    while (slice <= quiet) {
        const int64_t next = slice + WH_DECISIONS_STRETCH - (slice - 1) % WH_DECISIONS_STRETCH;
        if (may_meet(player, g, slice)) {
            return slice - 1;
        }
        if (!holds || !may_be_pushed(player, g, slice)) {
            slice = next;
        }
        for (; slice < next && slice <= quiet; ++slice) {
            if (is_pushed(player, g, slice)) {
                return slice - 1;
            }
        }
    }
    return quiet;
}

/* The last slice up to `quiet` before the first one in which any gripper does so. */
static int64_t whole_until(const player_t *player, int64_t quiet) {
    for (size_t g = 0; g < player->decisions->gripper_count; ++g) {
        quiet = until_pushed(player, g, quiet);
    }
    return quiet;
}

static void settle_cell(player_t *player) {
    if (player->stepped < player->at) {
        step_slice(player, player->at);
    }
}

/* True if motion control goes on waiting before this slice, as it did in the run. */
static bool goes_on_waiting(const player_t *player) {
    return player->waits == WH_NONE || (player->state.sensors >> player->waits & 1U) == 0;
}

static void advance_to(player_t *player, int64_t to) {
    while (player->at < to && !player->broken) {
        player->broken = !goes_on_waiting(player);
        const int64_t quiet = player->waits == WH_NONE ? whole_until(player, quiet_until(player, to)) : 0;
        if (quiet > player->at) {
            player->at = quiet;
        } else if (!player->broken) {
            settle_cell(player);
            step_slice(player, ++player->at);
        }
        wh_vacuum_watch_slice(&player->vacuum, player->state.sensors);
    }
}

/* ----------------------------------------------------------------------------------------------- readings */

static int32_t find_lost(const player_t *player) {
    const wh_decisions_t *decisions = player->decisions;
    int32_t told[WH_GRIPPERS];
    for (size_t g = 0; g < decisions->gripper_count; ++g) {
        size_t i = decisions->valve_count[g];
        while (i > 0 && decisions->valves[g][i - 1].slice > player->at) {
            --i;
        }
        told[g] = i > 0 ? decisions->valves[g][i - 1].valve : WH_VALVE_CLOSED;
    }
    return wh_vacuum_watch_lost(&player->vacuum, told, decisions->gripper_count);
}

static bool begin_entry(player_t *player, const wh_decisions_entry_t *entry) {
    player->waits = entry->index;
    player->vacuum = (wh_vacuum_watch_t){.watched = (uint32_t)entry->answer & player->state.sensors};
    return true;
}

static bool end_entry(player_t *player, const wh_decisions_entry_t *entry) {
    const bool done = goes_on_waiting(player) == (player->waits == WH_NONE);
    player->waits = WH_NONE;
    return done == (entry->answer != 0) && find_lost(player) == entry->index;
}

static bool holds_claim(player_t *player, const wh_decisions_entry_t *entry) {
    settle_cell(player);
    return !player->broken &&
           wh_decisions_judge(&player->decisions->claims[entry->index], &player->simulator->cell,
                              player->state.wafers) == entry->answer;
}

/* True if the wafer of a PUT lies elsewhere, or that of a GET lay elsewhere, as in the run. */
static bool ends_alike(player_t *player, const wh_decisions_entry_t *entry) {
    const wh_decisions_asked_t *asked = &player->decisions->asked[entry->index];
    settle_cell(player);
    const wh_pose_t *place = entry->kind == WH_DECISION_GET
                                 ? wh_origins_find(&player->origins, asked->gripper)
                                 : &player->state.wafers[asked->wafer].base_from_wafer;
    return !player->broken &&
           wh_decisions_is_elsewhere(asked, &player->simulator->cell, place) == (entry->answer != 0);
}

/* True if this trial reads what the run has read. */
static bool agrees_with_entry(player_t *player, const wh_decisions_entry_t *entry) {
    switch (entry->kind) {
    case WH_DECISION_BEGIN:
        return begin_entry(player, entry);
    case WH_DECISION_END:
        return end_entry(player, entry);
    case WH_DECISION_SENSOR:
        return (int32_t)(player->state.sensors >> entry->index & 1U) == entry->answer;
    case WH_DECISION_HELD:
        return player->state.grippers[entry->index].wafer == entry->answer;
    case WH_DECISION_HOLDER:
        return player->state.wafers[entry->index].holder == entry->answer;
    case WH_DECISION_CLAIM:
        return holds_claim(player, entry);
    case WH_DECISION_PUT:
    case WH_DECISION_GET:
        return ends_alike(player, entry);
    default:
        return false;
    }
}

/* ------------------------------------------------------------------------------------------------ playing */

static bool may_skip(const wh_trial_cell_t *trial_cell, const wh_simulator_t *simulator) {
    const wh_physics_t *physics = &trial_cell->layout.physics;
    return physics->vacuum.build <= 0 && physics->vacuum.vent <= 0 && physics->vacuum.debounce == 0 &&
           physics->pads.mass <= 0 && physics->fault_count == 0 && !simulator->observer.look &&
           !wh_layout_has_passive(&trial_cell->layout);
}

static void start_player(player_t *player) {
    const wh_decisions_t *decisions = player->decisions;
    player->waits = WH_NONE;
    player->may_skip = may_skip(player->trial_cell, player->simulator);
    player->command.gripper_count = decisions->gripper_count;
    player->command.axis_count = decisions->axis_count;
    for (size_t g = 0; g < decisions->gripper_count; ++g) {
        player->command.grippers[g].valve = WH_VALVE_CLOSED;
    }
    wh_simulator_view(player->simulator, &player->state);
    wh_origins_begin(&player->origins, &player->trial_cell->layout,
                     wh_array_new(player->state.wafer_count, sizeof *player->origins.lain), &player->state);
}

/* True if the whole run was played alike. */
static bool play_entries(player_t *player) {
    const wh_decisions_t *decisions = player->decisions;
    for (size_t i = 0; i < decisions->entry_count && !player->broken; ++i) {
        advance_to(player, decisions->entries[i].slice);
        if (player->broken || !agrees_with_entry(player, &decisions->entries[i])) {
            return false;
        }
    }
    advance_to(player, decisions->slice_count);
    settle_cell(player);
    return !player->broken;
}

bool wh_decisions_play(const wh_decisions_t *decisions, const wh_trial_cell_t *trial_cell,
                       wh_simulator_t *simulator, wh_decisions_watch_t *watch, void *user) {
    player_t player = {.decisions = decisions,
                       .trial_cell = trial_cell,
                       .simulator = simulator,
                       .watch = watch,
                       .user = user};
    start_player(&player);
    const bool is_alike = play_entries(&player);
    free(player.origins.lain);
    return is_alike;
}
