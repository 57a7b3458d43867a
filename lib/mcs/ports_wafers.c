/* The events of load ports are kept and told, and wafers come and go with carriers. */
#include <math.h>
#include <stdio.h>

#include "../layout/grips.h"
#include "../trial/trial_cell.h"
#include "clocks.h"
#include "ports.h"

/* ------------------------------------------------------------------------------------------------- wafers */

/* Face up a wafer lies in its slot's frame to the last bit. */
static wh_pose_t lying_in_slot(const wh_layout_t *layout, int32_t station, int32_t slot) {
    wh_pose_t pose = wh_pose_identity();
    if (layout->stations[station].face == WH_STATION_FACE_DOWN) {
        const wh_pose_t base_from_slot = wh_station_slot(&layout->places[station], slot);
        const wh_pose_t lying = wh_layout_lying(layout, station, slot);
        pose = wh_pose_relative(&base_from_slot, &lying);
    }
    return pose;
}

void wh_ports_begin_wafers(struct wh_ports *ports) {
    const wh_mcs_t *mcs = ports->mcs;
    const wh_layout_t *layout = mcs->layout;
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        const wh_layout_wafer_t *wafer = &layout->wafers[w];
        wh_carried_t *carried = &ports->wafers[w];
        carried->carrier = wafer->carrier - 1;
        carried->slot = wafer->slot;
        if (wafer->carrier == 0 || layout->carriers[wafer->carrier - 1].at != WH_NONE) {
            carried->carrier = WH_NONE;
            carried->slot_from_wafer = wh_pose_identity();
            continue;
        }
        carried->slot_from_wafer = lying_in_slot(layout, wafer->station, wafer->slot);
        if (mcs->wanted.trial && layout->errors) {
            const wh_displacement_t drawn = wh_errors_draw_wafer(layout->errors, mcs->wanted.trial, w);
            wh_trial_cell_displace(&drawn, &carried->slot_from_wafer);
        }
    }
}

/* The last order about a wafer counts. */
static void order(struct wh_ports *ports, int32_t wafer, const wh_pose_t *base_from_wafer) {
    size_t i = 0;
    while (i < ports->state->order_count && ports->orders[i].wafer != wafer) {
        ++i;
    }
    ports->orders[i].wafer = wafer;
    ports->orders[i].base_from_wafer = *base_from_wafer;
    ports->state->order_count += i == ports->state->order_count ? 1 : 0;
}

static wh_pose_t place_of(const struct wh_ports *ports, int32_t number, const wh_carried_t *carried) {
    const wh_station_t *place = &ports->mcs->real->places[ports->of[number].station];
    const wh_pose_t base_from_slot = wh_station_slot(place, carried->slot);
    wh_pose_t base_from_wafer;
    wh_pose_compose_to(&base_from_slot, &carried->slot_from_wafer, &base_from_wafer);
    if (wh_pose_validate(&base_from_wafer) != WH_OK) {
        wh_mat3_orthonormalise(&base_from_wafer.R);
    }
    return base_from_wafer;
}

void wh_ports_bring_wafers(struct wh_ports *ports, int32_t number) {
    const int32_t carrier = ports->ports[number].carrier;
    for (size_t w = 0; w < ports->mcs->layout->wafer_count; ++w) {
        wh_carried_t *carried = &ports->wafers[w];
        if (carried->carrier == carrier && !carried->stays) {
            const wh_pose_t base_from_wafer = place_of(ports, number, carried);
            carried->carrier = WH_NONE;
            order(ports, (int32_t)w, &base_from_wafer);
        }
    }
}

/* The slot of the port in whose room a wafer lies: at most its radius aside, and nearer than the next slot.
 * 0: it lies in none. */
static int32_t slot_in(const struct wh_ports *ports, int32_t number, const wh_pose_t *base_from_wafer) {
    const wh_cell_t *cell = &ports->mcs->real->cell;
    const wh_station_t *station = &cell->stations[ports->of[number].station];
    const wh_place_t first = wh_cell_measure(cell, station, 1, base_from_wafer);
    const double above = fmin(fmax((double)(first.dz / station->pitch), 0), station->slots - 1);
    const int32_t slot = (int32_t)lround(above) + 1;
    const wh_place_t place = wh_cell_measure(cell, station, slot, base_from_wafer);
    const double aside = sqrt((double)(place.dx * place.dx + place.dy * place.dy));
    const bool is_in = aside < ports->mcs->layout->wafer_diameter / 2 &&
                       fabs((double)place.dz) < fmax((double)station->pitch, 10);
    return is_in ? slot : 0;
}

/* A wafer that lies where its carrier had brought it keeps its place to the last bit. */
static void keep_place(const struct wh_ports *ports, int32_t number, wh_carried_t *carried, int32_t slot,
                       const wh_pose_t *base_from_wafer) {
    const wh_station_t *place = &ports->mcs->real->places[ports->of[number].station];
    const wh_pose_t base_from_slot = wh_station_slot(place, slot);
    const wh_pose_t as_brought = place_of(ports, number, carried);
    if (slot != carried->slot || !wh_ports_is_same_place(&as_brought, base_from_wafer)) {
        carried->slot = slot;
        carried->slot_from_wafer = wh_pose_relative(&base_from_slot, base_from_wafer);
    }
}

void wh_ports_take_wafers(struct wh_ports *ports, int32_t number) {
    const wh_state_t *state = &ports->mcs->state;
    for (size_t w = 0; w < state->wafer_count; ++w) {
        const wh_wafer_t *wafer = &state->wafers[w];
        const bool is_there = wafer->holder == WH_NONE && ports->wafers[w].carrier == WH_NONE;
        const int32_t slot = is_there ? slot_in(ports, number, &wafer->base_from_wafer) : 0;
        if (slot > 0) {
            const wh_pose_t outside = wh_layout_outside(w);
            keep_place(ports, number, &ports->wafers[w], slot, &wafer->base_from_wafer);
            ports->wafers[w].carrier = ports->ports[number].carrier;
            ports->wafers[w].stays = false;
            order(ports, (int32_t)w, &outside);
        }
    }
}

/* ------------------------------------------------------------------------------------------------- events */

static void keep_event(const struct wh_ports *ports, int32_t number, const wh_load_port_event_t *event) {
    static const wh_clock_kind_t kinds[] = {[WH_LOAD_PORT_BEGINS] = WH_CLOCK_PORT_BEGINS,
                                            [WH_LOAD_PORT_ENDS] = WH_CLOCK_PORT_ENDS,
                                            [WH_LOAD_PORT_TIMEOUT] = WH_CLOCK_PORT_TIMEOUT,
                                            [WH_LOAD_PORT_CAME] = WH_CLOCK_CARRIER_CAME,
                                            [WH_LOAD_PORT_WENT] = WH_CLOCK_CARRIER_WENT};
    const int32_t carrier = ports->ports[number].carrier;
    wh_station_event_record_t record = {.station = ports->of[number].station,
                                        .step = event->step,
                                        .event = {.kind = kinds[event->kind],
                                                  .slot = WH_FLOW_NONE,
                                                  .wafer = WH_FLOW_NONE,
                                                  .side = WH_FLOW_BOTH,
                                                  .at_us = event->at_us,
                                                  .us = event->us}};
    if (carrier != WH_NONE) {
        snprintf(record.carrier, sizeof record.carrier, "%s", ports->mcs->layout->carriers[carrier].name);
    }
    wh_record_add_station_event(ports->mcs->recorder.record, &record);
    wh_mcs_tell(ports->mcs, WH_MCS_STATION_TOLD, NULL);
}

static void map_slots(struct wh_ports *ports, int32_t number) {
    const int32_t station = ports->of[number].station;
    const wh_station_t *place = &ports->mcs->real->places[station];
    int codes[WH_LAYOUT_SLOTS];
    wh_mcs_see_slots(ports->mcs, place, &ports->mcs->layout->stations[station].port->mapping, codes);
    for (int32_t slot = 0; slot < place->slots; ++slot) {
        ports->codes[ports->of[number].first + (size_t)slot] = (int8_t)codes[slot];
    }
    ports->ports[number].is_mapped = true;
    ++ports->ports[number].changes;
}

/* The vehicle has the carrier again, or still; or the port has it. */
static void give_up(struct wh_ports *ports, int32_t number) {
    wh_load_port_now_t *port = &ports->ports[number];
    if (port->clock.is == WH_LOAD_PORT_ABSENT && port->carrier != WH_NONE) {
        ports->carriers[port->carrier].port = WH_NONE;
        port->carrier = WH_NONE;
    }
}

static void let_go(struct wh_ports *ports, int32_t number) {
    wh_ports_take_wafers(ports, number);
    ports->ports[number].is_mapped = false;
    ++ports->ports[number].changes;
    if (ports->ports[number].carrier != WH_NONE) {
        ports->carriers[ports->ports[number].carrier].port = WH_NONE;
    }
}

void wh_ports_tell(void *user, const wh_load_port_event_t *event) {
    const wh_ports_telling_t *telling = user;
    struct wh_ports *ports = telling->ports;
    const int32_t number = telling->number;
    keep_event(ports, number, event);
    if (event->kind == WH_LOAD_PORT_CAME) {
        wh_ports_bring_wafers(ports, number);
    } else if (event->kind == WH_LOAD_PORT_WENT) {
        let_go(ports, number);
    } else if (event->kind == WH_LOAD_PORT_TIMEOUT) {
        give_up(ports, number);
    } else if (event->kind == WH_LOAD_PORT_ENDS && event->step == WH_LOAD_PORT_MAP) {
        map_slots(ports, number);
    }
}

void wh_ports_judge(const struct wh_ports *ports) {
    for (size_t i = 0; ports && i < ports->count; ++i) {
        const wh_load_port_now_t *port = &ports->ports[i];
        char text[200];
        if (port->clock.failed != WH_LOAD_PORT_STANDS && !port->is_told) {
            (void)snprintf(text, sizeof text,
                           "the handshake of %s comes to its end; %s ran out after %.10g s",
                           ports->mcs->layout->stations[ports->of[i].station].name,
                           wh_load_port_step_name(port->clock.failed),
                           (double)ports->of[i].of.limit_us[port->clock.failed] / 1e6);
            wh_clocks_imply(ports->mcs, text, false);
        }
    }
}
