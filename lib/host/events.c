#include "events.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../record/record.h"
#include "../text/array.h"
#include "conditions.h"
#include "status.h"
#include "telling.h"
#include "values.h"

/* Tells an event to a port's client, if its dialect asks for that kind. */
static void tell_event(wh_controller_t *controller, wh_host_event_kind_t kind, wh_host_event_t event) {
    const wh_told_t told = {.event = &event};
    const wh_dialect_t *dialect = controller->dialect;
    event.client = (wh_client_t){controller->role, controller->line.client};
    if (dialect->encodes[WH_ENCODE_EVENT] && (dialect->clients.events >> kind & 1U) != 0) {
        wh_controller_tell(controller, WH_ENCODE_EVENT, &told, false);
    }
}

static void tell_wafer(wh_controller_t *controller, const wh_event_t *event, double seconds) {
    const wh_layout_t *layout = wh_session_layout(controller->host->session);
    const bool has_wafer = event->wafer >= 0 && (size_t)event->wafer < layout->wafer_count;
    const bool has_gripper = event->gripper >= 0 && (size_t)event->gripper < layout->machine.gripper_count;
    const wh_host_event_t told = {.kind = wh_event_name(event->kind),
                                  .is_complaint = wh_record_is_complaint(event->kind),
                                  .wafer = has_wafer ? layout->wafers[event->wafer].name : "",
                                  .gripper = has_gripper ? layout->grippers[event->gripper].name : "",
                                  .seconds = seconds,
                                  .value = -1};
    if (!has_gripper || (controller->mechanism.grippers >> event->gripper & 1U) != 0) {
        tell_event(controller, WH_HOST_WAFER, told);
    }
}

static void tell_owners(wh_host_t *host, wh_host_event_kind_t kind, size_t gripper, wh_host_event_t told) {
    for (size_t i = 0; i < host->count; ++i) {
        if ((host->controllers[i]->mechanism.grippers >> gripper & 1U) != 0) {
            tell_event(host->controllers[i], kind, told);
        }
    }
}

/* A gripper's sensor or valve has changed. */
static void tell_change(wh_host_t *host, wh_host_event_kind_t kind, size_t gripper, int value) {
    const wh_layout_t *layout = wh_session_layout(host->session);
    const wh_host_event_t told = {.kind = wh_host_event_names[kind],
                                  .wafer = "",
                                  .gripper = layout->grippers[gripper].name,
                                  .seconds = (double)wh_session_time_us(host->session) / 1e6,
                                  .value = value};
    tell_owners(host, kind, gripper, told);
}

/* A plunger sets out, or stands: it holds its wafer, jams or has missed it. */
static void tell_grip(wh_host_t *host, size_t gripper, const wh_grip_state_t *grip) {
    const wh_layout_t *layout = wh_session_layout(host->session);
    const bool has_wafer = grip->wafer >= 0 && (size_t)grip->wafer < layout->wafer_count;
    const wh_host_event_t told = {.kind = wh_host_event_names[WH_HOST_GRIP],
                                  .wafer = has_wafer ? layout->wafers[grip->wafer].name : "",
                                  .gripper = layout->grippers[gripper].name,
                                  .seconds = (double)wh_session_time_us(host->session) / 1e6,
                                  .value = -1,
                                  .grip = grip};
    tell_owners(host, WH_HOST_GRIP, gripper, told);
}

/* At the ports of the station that the door belongs to, of the whole cell, and of testers. */
static bool concerns_door(const wh_controller_t *controller, size_t door) {
    const wh_layout_t *layout = wh_session_layout(controller->host->session);
    const wh_port_mechanism_t *mechanism = &controller->mechanism;
    bool is_its = mechanism->kind == WH_MECHANISM_CELL;
    for (size_t robot = 0; robot < layout->robot_count && mechanism->kind > WH_MECHANISM_ROBOT; ++robot) {
        is_its = is_its || mechanism->index == WH_NONE ||
                 wh_layout_door_of(layout, (size_t)mechanism->index, robot) == (int32_t)door;
    }
    return is_its;
}

/* A door is open, shut (1, 0), or neither (-1). */
static void tell_door(wh_host_t *host, size_t door, int value) {
    const wh_host_event_t told = {.kind = wh_host_event_names[WH_HOST_DOOR],
                                  .wafer = "",
                                  .gripper = "",
                                  .seconds = (double)wh_session_time_us(host->session) / 1e6,
                                  .value = value,
                                  .door = wh_session_layout(host->session)->door_list[door].name};
    for (size_t i = 0; i < host->count; ++i) {
        if (concerns_door(host->controllers[i], door)) {
            tell_event(host->controllers[i], WH_HOST_DOOR, told);
        }
    }
}

/* Tells a change of this robot's own controller, at its ports and at those of all robots. */
static void tell_mode(wh_host_t *host, size_t robot) {
    char *text = host->texts->mode;
    const wh_host_event_t told = {.kind = wh_host_event_names[WH_HOST_MODE],
                                  .wafer = "",
                                  .gripper = "",
                                  .seconds = (double)wh_session_time_us(host->session) / 1e6,
                                  .value = -1,
                                  .at = wh_session_layout(host->session)->robots[robot].name,
                                  .state = text};
    wh_host_tell_conditions(host, robot, text, sizeof host->texts->mode);
    for (size_t i = 0; i < host->count; ++i) {
        const wh_port_mechanism_t *mechanism = &host->controllers[i]->mechanism;
        const bool is_its = mechanism->kind <= WH_MECHANISM_ROBOT &&
                            (mechanism->index == WH_NONE || mechanism->index == (int32_t)robot);
        if (is_its) {
            tell_event(host->controllers[i], WH_HOST_MODE, told);
        }
    }
}

/* "is=placed does=clamp carrier=C1"; TP3 as `failed` if that step ended the last handshake. */
static void write_load_port(const wh_mcs_load_port_t *port, char *text, size_t size) {
    char carrier[4 * WH_NAME_SIZE + 3] = "";
    if (port->carrier) {
        (void)wh_value_spell(port->carrier, carrier, sizeof carrier);
    }
    (void)snprintf(text, size, "is=%s%s%s%s%s%s%s", port->is, port->does ? " does=" : "",
                   port->does ? port->does : "", carrier[0] != '\0' ? " carrier=" : "", carrier,
                   port->failed ? " failed=" : "", port->failed ? port->failed : "");
}

/* Tells what a load port does, at its ports, at those of the whole cell, and to testers. */
static void tell_load_port(wh_host_t *host, size_t station, const wh_mcs_load_port_t *port) {
    char *text = host->texts->load_port;
    const wh_host_event_t told = {.kind = wh_host_event_names[WH_HOST_LOAD_PORT],
                                  .wafer = "",
                                  .gripper = "",
                                  .seconds = (double)wh_session_time_us(host->session) / 1e6,
                                  .value = -1,
                                  .at = wh_session_layout(host->session)->stations[station].name,
                                  .load_port = text};
    write_load_port(port, text, sizeof host->texts->load_port);
    for (size_t i = 0; i < host->count; ++i) {
        const wh_port_mechanism_t *mechanism = &host->controllers[i]->mechanism;
        const bool is_its = mechanism->index == WH_NONE || mechanism->index == (int32_t)station;
        if (mechanism->kind == WH_MECHANISM_CELL || (mechanism->kind == WH_MECHANISM_LOAD_PORT && is_its)) {
            tell_event(host->controllers[i], WH_HOST_LOAD_PORT, told);
        }
    }
}

static bool is_same_name(const char *a, const char *b) {
    return a == b || (a && b && strcmp(a, b) == 0);
}

void wh_host_tell_load_ports(wh_host_t *host) {
    const wh_layout_t *layout = wh_session_layout(host->session);
    const bool is_first = !host->seen.ports;
    if (is_first) {
        host->seen.ports = wh_array_new(layout->station_count + 1, sizeof *host->seen.ports);
    }
    for (size_t s = 0; s < layout->station_count; ++s) {
        wh_mcs_load_port_t now;
        wh_mcs_load_port_t *seen = &host->seen.ports[s];
        if (wh_mcs_see_load_port(&host->session->mcs, s, &now)) {
            const bool is_same = is_same_name(seen->is, now.is) && is_same_name(seen->does, now.does) &&
                                 is_same_name(seen->carrier, now.carrier) &&
                                 is_same_name(seen->failed, now.failed);
            *seen = now;
            if (!is_first && !is_same) {
                tell_load_port(host, s, &now);
            }
        }
    }
}

void wh_host_tell_modes(wh_host_t *host) {
    const wh_layout_t *layout = wh_session_layout(host->session);
    for (size_t robot = 0; layout && robot < layout->robot_count; ++robot) {
        const wh_mcs_controller_t *now = wh_mcs_controller(&host->session->mcs, robot);
        if (memcmp(&host->seen.controllers[robot], now, sizeof *now) != 0) {
            host->seen.controllers[robot] = *now;
            tell_mode(host, robot);
        }
    }
}

void wh_controller_tell_others(const wh_controller_t *controller, wh_host_event_kind_t kind, int value) {
    const wh_host_t *host = controller->host;
    const wh_host_event_t told = {.kind = wh_host_event_names[kind],
                                  .wafer = "",
                                  .gripper = "",
                                  .seconds = (double)wh_session_time_us(host->session) / 1e6,
                                  .value = value,
                                  .at = wh_controller_known_as(controller)};
    for (size_t i = 0; i < host->count && !controller->leader->is_tester; ++i) {
        const bool concerns =
            host->controllers[i]->leader == controller->leader || host->controllers[i]->leader->is_tester;
        if (concerns) {
            tell_event(host->controllers[i], kind, told);
        }
    }
}

/* ------------------------------------------------------------------------------------------------- slices */

static void tell_events(wh_host_t *host, const wh_state_t *state) {
    for (size_t e = 0; e < state->event_count; ++e) {
        const wh_event_kind_t kind = state->events[e].kind;
        host->seen.complaint = wh_record_is_complaint(kind) ? kind : host->seen.complaint;
        for (size_t i = 0; i < host->count; ++i) {
            tell_wafer(host->controllers[i], &state->events[e], (double)state->utime / 1e6);
        }
    }
}

/* Tells which sensors and valves have changed since the slice before. */
static void tell_changes(wh_host_t *host, const wh_command_t *command, const wh_state_t *state) {
    uint32_t valves = 0;
    for (size_t g = 0; g < command->gripper_count; ++g) {
        valves |= command->grippers[g].valve == WH_VALVE_OPEN ? 1U << g : 0;
    }
    for (size_t g = 0; g < command->gripper_count; ++g) {
        if (((valves ^ host->seen.valves) >> g & 1U) != 0) {
            tell_change(host, WH_HOST_VALVE, g, (int)(valves >> g & 1U));
        }
        if (((state->sensors ^ host->seen.sensors) >> g & 1U) != 0) {
            tell_change(host, WH_HOST_SENSOR, g, (int)(state->sensors >> g & 1U));
        }
    }
    host->seen.valves = valves;
    host->seen.sensors = state->sensors;
}

static void tell_grips(wh_host_t *host, const wh_command_t *command, const wh_state_t *state) {
    for (size_t g = 0; state->physics && g < command->gripper_count; ++g) {
        const wh_grip_state_t *grip = &state->physics->grips[g];
        if (grip->phase != host->seen.grips[g]) {
            host->seen.grips[g] = grip->phase;
            tell_grip(host, g, grip);
        }
    }
}

static uint32_t find_doors(const wh_host_t *host, const char *word) {
    const wh_mcs_t *mcs = &host->session->mcs;
    uint32_t doors = 0;
    for (size_t d = 0; d < wh_mcs_layout(mcs)->machine.door_count; ++d) {
        doors |= strcmp(wh_mcs_door_word(mcs, d), word) == 0 ? 1U << d : 0;
    }
    return doors;
}

/* Tells which doors have come to an end, or have left it. */
static void tell_doors(wh_host_t *host) {
    const uint32_t open = find_doors(host, "open");
    const uint32_t shut = find_doors(host, "shut");
    const uint32_t changed = (open ^ host->seen.open) | (shut ^ host->seen.shut);
    for (size_t d = 0; d < WH_DOORS; ++d) {
        if ((changed >> d & 1U) != 0) {
            const bool stands = ((open | shut) >> d & 1U) != 0;
            tell_door(host, d, stands ? (int)(open >> d & 1U) : -1);
        }
    }
    host->seen.open = open;
    host->seen.shut = shut;
}

/* A run begins: what is there now is no event. */
void wh_host_look(wh_host_t *host) {
    if (!host->seen.ports) {
        host->seen.open = find_doors(host, "open");
        host->seen.shut = find_doors(host, "shut");
        host->seen.sensors = wh_session_sensors(host->session);
        host->seen.valves = wh_session_valves(host->session);
        wh_session_grips(host->session, host->seen.grips);
    }
    wh_host_tell_load_ports(host);
}

void wh_host_tell_slice(wh_host_t *host, const wh_command_t *command, const wh_state_t *state) {
    tell_events(host, state);
    tell_changes(host, command, state);
    tell_grips(host, command, state);
    tell_doors(host);
    wh_host_tell_load_ports(host);
    wh_host_tell_modes(host);
}
