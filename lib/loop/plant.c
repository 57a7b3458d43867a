#include "plant.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../layout/axes.h"
#include "../layout/words.h"
#include "../link/outcome.h"
#include "../link/protocol_client.h"
#include "../record/record.h"
#include "../sim/event_text.h"

/* A jump of less than this is rounding: mm or rad. */
#define WH_PLANT_ROUNDING 1e-6

double wh_plant_axis_out(const wh_layout_t *layout, size_t axis, wh_real_t value) {
    return wh_layout_axis_turns(layout, axis) ? wh_deg_from_rad(value) : value;
}

wh_real_t wh_plant_axis_in(const wh_layout_t *layout, size_t axis, double value) {
    return wh_layout_axis_turns(layout, axis) ? wh_rad_from_deg(value) : value;
}

/* ------------------------------------------------------------------------------------------------ opening */

static void close_valves(wh_command_t *command) {
    for (size_t g = 0; g < command->gripper_count; ++g) {
        command->grippers[g].valve = WH_VALVE_CLOSED;
    }
}

void wh_plant_open(wh_plant_t *plant, wh_sim_process_t *simulation) {
    const wh_layout_t *layout = simulation->server.layout;
    memset(plant, 0, sizeof *plant);
    plant->layout = layout;
    plant->simulation = simulation;
    plant->identity.run = wh_protocol_client_draw_run();
    plant->identity.layout_hash = simulation->server.identity.layout_hash;
    plant->command.axis_count = layout->machine.axis_count;
    plant->command.gripper_count = layout->machine.gripper_count;
    wh_machine_home(&layout->machine, plant->command.axes);
    close_valves(&plant->command);
}

/* ------------------------------------------------------------------------------------------------ driving */

static const char *unit_of(const wh_layout_t *layout, size_t axis) {
    return wh_layout_axis_turns(layout, axis) ? "degrees" : "mm";
}

/* The first axis whose number is not finite; axis_count: none. */
static size_t find_not_finite(const wh_plant_t *plant, const wh_real_t q[]) {
    size_t axis = 0;
    while (axis < plant->command.axis_count && isfinite(q[axis])) {
        ++axis;
    }
    return axis;
}

/* The first axis that is beyond its travel if the others stand where they were; axis_count: none alone. */
static size_t find_beyond(const wh_plant_t *plant, const wh_real_t q[]) {
    const wh_machine_t *machine = &plant->layout->machine;
    wh_real_t alone[WH_AXES];
    for (size_t axis = 0; axis < machine->axis_count; ++axis) {
        wh_machine_home(machine, alone);
        alone[axis] = q[axis];
        if (wh_machine_check_travel(machine, alone) != WH_OK) {
            return axis;
        }
    }
    return machine->axis_count;
}

static void say_axis(const wh_plant_t *plant, size_t axis, const wh_real_t q[], wh_status_t status,
                     char text[WH_PLANT_TEXT]) {
    char name[WH_NAME_SIZE * 2];
    if (axis == plant->command.axis_count) {
        (void)snprintf(text, WH_PLANT_TEXT, "axes: %s", wh_status_text(status));
        return;
    }
    wh_layout_name_axis(plant->layout, axis, name, sizeof name);
    (void)snprintf(text, WH_PLANT_TEXT, "axis %zu, %s: %.9g %s: %s", axis + 1, name,
                   wh_plant_axis_out(plant->layout, axis, q[axis]), unit_of(plant->layout, axis),
                   wh_status_text(status));
}

static wh_status_t refuse(wh_plant_t *plant, size_t axis, const wh_real_t q[], wh_status_t status,
                          char text[WH_PLANT_TEXT]) {
    ++plant->found.refused;
    say_axis(plant, axis, q, status, text);
    return status;
}

/* How far an axis may have gone since its last number came; 0: the layout does not say how fast it is. */
static double reach_of(const wh_plant_t *plant, size_t axis) {
    const wh_limits_t *limits = wh_machine_limits(&plant->layout->machine, axis);
    return limits->speed * (double)plant->layout->slice_us / 1e6 * (double)(plant->since + 1);
}

/* Counts a slice in which an axis goes farther than it can, and says which. */
static void look_for_jump(wh_plant_t *plant, const wh_real_t q[], char text[WH_PLANT_TEXT]) {
    for (size_t axis = 0; plant->is_driven && axis < plant->command.axis_count; ++axis) {
        const double gone = fabs(q[axis] - plant->command.axes[axis]);
        const double reach = reach_of(plant, axis);
        if (reach > 0 && gone > WH_PLANT_JUMP * reach + WH_PLANT_ROUNDING) {
            char name[WH_NAME_SIZE * 2];
            wh_layout_name_axis(plant->layout, axis, name, sizeof name);
            ++plant->found.jumps;
            (void)snprintf(text, WH_PLANT_TEXT, "axis %zu, %s, jumps by %.6g %s (expected at most %.6g)",
                           axis + 1, name, wh_plant_axis_out(plant->layout, axis, gone),
                           unit_of(plant->layout, axis), wh_plant_axis_out(plant->layout, axis, reach));
            return;
        }
    }
}

wh_status_t wh_plant_move(wh_plant_t *plant, const wh_real_t q[], uint32_t valves, char text[WH_PLANT_TEXT]) {
    wh_command_t *command = &plant->command;
    const size_t odd = find_not_finite(plant, q);
    text[0] = '\0';
    if (odd < command->axis_count) {
        return refuse(plant, odd, q, WH_STATUS_NOT_FINITE, text);
    }
    const wh_status_t status = wh_machine_check_travel(&plant->layout->machine, q);
    if (status != WH_OK) {
        return refuse(plant, find_beyond(plant, q), q, status, text);
    }
    look_for_jump(plant, q, text);
    memcpy(command->axes, q, command->axis_count * sizeof *q);
    for (size_t g = 0; g < command->gripper_count; ++g) {
        command->grippers[g].valve = (valves >> g & 1U) != 0 ? WH_VALVE_OPEN : WH_VALVE_CLOSED;
    }
    plant->is_driven = true;
    plant->since = -1; /* the slice that is next counts as none */
    return WH_OK;
}

wh_status_t wh_plant_drive(wh_plant_t *plant, const double axes[], uint32_t valves,
                           char text[WH_PLANT_TEXT]) {
    wh_real_t q[WH_AXES] = {0};
    for (size_t axis = 0; axis < plant->command.axis_count; ++axis) {
        q[axis] = wh_plant_axis_in(plant->layout, axis, axes[axis]);
    }
    return wh_plant_move(plant, q, valves, text);
}

/* ------------------------------------------------------------------------------------------------- slices */

static const char *find_name(const void *user, wh_name_kind_t kind, int32_t index) {
    const wh_layout_t *layout = user;
    if (kind == WH_NAME_PART) {
        return wh_layout_part_name(layout, index);
    }
    const size_t count = kind == WH_NAME_WAFER ? layout->wafer_count : layout->machine.gripper_count;
    if (index < 0 || (size_t)index >= count) {
        return NULL;
    }
    return kind == WH_NAME_WAFER ? layout->wafers[index].name : layout->grippers[index].name;
}

static void tell_event(wh_plant_t *plant, const wh_event_t *event) {
    const wh_layout_t *layout = plant->layout;
    const wh_event_names_t names = {find_name, layout, 1, &layout->grasp.tolerance, NULL};
    const bool is_complaint = wh_record_is_complaint(event->kind);
    char text[WH_EVENT_TEXT_SIZE];
    ++plant->found.events[event->kind];
    if (is_complaint) {
        ++plant->found.complaints;
        plant->found.complaint = event->kind;
    }
    if (plant->heard) {
        (void)wh_event_text(event, &names, text, sizeof text);
        plant->heard(plant->heard_user, plant->command.utime, text, is_complaint);
    }
}

/* The plunger of an edge grip stands, and holds nothing. */
static void tell_grip(wh_plant_t *plant, size_t gripper, const wh_grip_state_t *grip) {
    const char *name = find_name(plant->layout, WH_NAME_GRIPPER, (int32_t)gripper);
    const char *wafer = find_name(plant->layout, WH_NAME_WAFER, grip->wafer);
    const bool jams = grip->phase == WH_GRIP_JAMMED;
    char text[WH_EVENT_TEXT_SIZE];
    plant->found.jammed += jams ? 1 : 0;
    plant->found.missed += jams ? 0 : 1;
    if (jams && grip->excess > 0) {
        (void)snprintf(text, sizeof text, "jammed: %s, %s: %.3f mm beyond the clearance",
                       wafer ? wafer : "no wafer", name, grip->excess);
    } else {
        (void)snprintf(text, sizeof text, "%s: %s, %s: the plunger stands at %.3f mm, and holds nothing",
                       wh_layout_phase_words[grip->phase], wafer ? wafer : "no wafer", name, grip->s);
    }
    if (plant->heard) {
        plant->heard(plant->heard_user, plant->command.utime, text, false);
    }
}

static void tell_grips(wh_plant_t *plant, const wh_physics_state_t *physics) {
    for (size_t g = 0; physics && g < plant->command.gripper_count; ++g) {
        const wh_grip_phase_t phase = physics->grips[g].phase;
        if (phase != plant->grips[g] && (phase == WH_GRIP_JAMMED || phase == WH_GRIP_MISSED)) {
            tell_grip(plant, g, &physics->grips[g]);
        }
        plant->grips[g] = phase;
    }
}

wh_status_t wh_plant_step(wh_plant_t *plant) {
    wh_command_t *command = &plant->command;
    waferhand_command message;
    wh_state_t state;
    command->seq = wh_plant_slice(plant) + 1;
    command->utime = command->seq * plant->layout->slice_us;
    wh_machine_update(&plant->layout->machine, command->axes, &plant->cache, command->grippers);
    wh_link_command_to_message(command, &plant->identity, true, &message);
    wh_protocol_client_publish(plant->simulation->node, &message);
    const wh_status_t status = wh_sim_process_step(plant->simulation, &message, &state);
    if (status != WH_OK) {
        return status;
    }
    plant->simulation->running = false; /* no motion control that could fall silent */
    ++plant->since;
    for (size_t i = 0; i < state.event_count; ++i) {
        tell_event(plant, &state.events[i]);
    }
    tell_grips(plant, state.physics);
    return WH_OK;
}

void wh_plant_tell_over(wh_plant_t *plant, bool passed, const char *reason) {
    uint8_t encoded[4096];
    const wh_run_told_t told = {.verdict = passed ? WH_OUTCOME_PASSED : WH_OUTCOME_FAILED};
    char text[WH_OUTCOME_BYTES + WH_PLANT_TEXT];
    char nothing[] = "";
    wh_outcome_write(&told, reason, text, sizeof text);
    const waferhand_mcs message = {.utime = plant->command.utime,
                                   .seq = wh_plant_slice(plant),
                                   .run = plant->identity.run,
                                   .layout_hash = (int64_t)plant->identity.layout_hash,
                                   .phase = WH_LINK_PHASE_OVER,
                                   .command = nothing,
                                   .text = text};
    const int size = waferhand_mcs_encode(encoded, 0, (int)sizeof encoded, &message);
    if (size > 0) {
        (void)wh_node_publish(plant->simulation->node, WH_CHANNEL_MCS, encoded, (size_t)size);
    }
}
