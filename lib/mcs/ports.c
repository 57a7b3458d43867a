#include "ports.h"

#include <math.h>
#include <string.h>

#include "../math/hash.h"
#include "../script/wh_module_values.h"
#include "clocks.h"

/* --------------------------------------------------------------------------------------------- setting up */

static void *lua_memory(lua_State *L, size_t bytes) {
    void *memory = lua_newuserdatauv(L, bytes > 0 ? bytes : 1, 0);
    memset(memory, 0, bytes);
    lua_rawsetp(L, LUA_REGISTRYINDEX, memory);
    return memory;
}

/* A trial draws how long each step takes. */
static void draw_steps(const wh_mcs_t *mcs, wh_ported_t *of) {
    for (size_t step = 1; mcs->wanted.trial && mcs->layout->errors && step < WH_LOAD_PORT_STEPS; ++step) {
        const wh_real_t s =
            wh_errors_draw_port(mcs->layout->errors, mcs->wanted.trial, (size_t)of->station, step);
        if (wh_load_port_has(&of->of, (wh_load_port_step_t)step)) {
            const int64_t us = of->of.us[step] + llround((double)s * 1e6);
            of->of.us[step] = us > 1 ? us : 1;
        }
    }
}

static void number_ports(struct wh_ports *ports, const wh_layout_t *real) {
    for (size_t s = 0; s < real->station_count; ++s) {
        const wh_layout_port_t *port = real->stations[s].port;
        ports->by_station[s] = WH_NONE;
        if (port) {
            ports->by_station[s] = (int32_t)ports->count;
            ports->of[ports->count] = (wh_ported_t){(int32_t)s, port->of, ports->slot_count};
            draw_steps(ports->mcs, &ports->of[ports->count++]);
            ports->slot_count += (size_t)real->places[s].slots;
        }
    }
}

/* The arrays are of 8-byte words and then of smaller ones: all are aligned. */
static void make_state(lua_State *L, struct wh_ports *ports, const wh_layout_t *real) {
    const size_t sizes[] = {sizeof *ports->state,
                            ports->count * sizeof *ports->ports,
                            real->carrier_count * sizeof *ports->carriers,
                            real->wafer_count * sizeof *ports->wafers,
                            real->wafer_count * sizeof *ports->orders,
                            ports->slot_count * sizeof *ports->codes};
    char *at[sizeof sizes / sizeof sizes[0]];
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; ++i) {
        ports->state_bytes += sizes[i];
    }
    at[0] = lua_memory(L, ports->state_bytes);
    for (size_t i = 1; i < sizeof sizes / sizeof sizes[0]; ++i) {
        at[i] = at[i - 1] + sizes[i - 1];
    }
    ports->state = (void *)at[0];
    ports->ports = (void *)at[1];
    ports->carriers = (void *)at[2];
    ports->wafers = (void *)at[3];
    ports->orders = (void *)at[4];
    ports->codes = (void *)at[5];
}

static void begin_state(struct wh_ports *ports, const wh_layout_t *real) {
    for (size_t i = 0; i < ports->count; ++i) {
        wh_load_port_start(&ports->of[i].of, &ports->ports[i].clock);
        ports->ports[i].carrier = WH_NONE;
    }
    for (size_t c = 0; c < real->carrier_count; ++c) {
        const int32_t at = real->carriers[c].at;
        ports->carriers[c].port = at == WH_NONE ? WH_NONE : ports->by_station[at];
        if (at != WH_NONE) {
            ports->ports[ports->by_station[at]].carrier = (int32_t)c;
        }
    }
    wh_ports_begin_wafers(ports);
}

struct wh_ports *wh_ports_begin(lua_State *L, wh_mcs_t *mcs) {
    const wh_layout_t *real = mcs->real;
    if (!wh_layout_has_ports(real)) {
        return NULL;
    }
    struct wh_ports *ports = lua_memory(L, sizeof *ports);
    ports->mcs = mcs;
    ports->of = lua_memory(L, real->station_count * sizeof *ports->of);
    ports->by_station = lua_memory(L, real->station_count * sizeof *ports->by_station);
    number_ports(ports, real);
    make_state(L, ports, real);
    begin_state(ports, real);
    return ports;
}

/* ----------------------------------------------------------------------------------------------- stepping */

/* One fault of the station that acts while this step runs. */
static void slow_down(wh_load_port_time_t *time, const wh_fault_t *fault, wh_load_port_step_t step) {
    const bool is_step = fault->other == (int32_t)step;
    if (fault->kind == WH_FAULT_STATION_STUCK || (fault->kind == WH_FAULT_E84_STUCK && is_step)) {
        time->rate = 0;
    } else if (fault->kind == WH_FAULT_STATION_SLOW) {
        time->rate = fmin(time->rate, 1 / fmax((double)fault->value, 1));
    } else if (fault->kind == WH_FAULT_E84_LATE && is_step) {
        time->late_us = fmax(time->late_us, (double)fault->value * 1e6);
    }
}

/* How time passes there: faults make it slow, or stop it. */
static wh_load_port_time_t time_of(const wh_state_t *state, const struct wh_ports *ports, size_t number,
                                   double us) {
    wh_load_port_time_t time = {us, 1, 0, state->utime};
    const wh_physics_state_t *physics = state->physics;
    const wh_load_port_step_t step = ports->ports[number].clock.step;
    for (size_t i = 0; physics && i < physics->faults.count; ++i) {
        const wh_fault_slot_t *slot = &physics->faults.slots[i];
        if (slot->phase == WH_FAULT_ACTING && wh_fault_is_of_station(slot->fault.kind) &&
            slot->fault.target == ports->of[number].station) {
            slow_down(&time, &slot->fault, step);
        }
    }
    return time;
}

/* A carrier that is to come to the port, the one that comes first; WH_NONE: none is. */
static int32_t find_due(const struct wh_ports *ports, int32_t number) {
    int32_t due = WH_NONE;
    for (size_t c = 0; c < ports->mcs->real->carrier_count; ++c) {
        const wh_carrier_now_t *carrier = &ports->carriers[c];
        const bool is_its = carrier->is_due && carrier->port == number;
        if (is_its && (due == WH_NONE || carrier->comes_us < ports->carriers[due].comes_us)) {
            due = (int32_t)c;
        }
    }
    return due;
}

static bool is_free(const wh_load_port_now_t *port) {
    return port->clock.is == WH_LOAD_PORT_ABSENT && port->clock.step == WH_LOAD_PORT_STANDS;
}

/* A vehicle waits until the port is free. */
static void look(struct wh_ports *ports, int32_t number, int64_t now_us,
                 const wh_load_port_teller_t *teller) {
    wh_load_port_now_t *port = &ports->ports[number];
    const int32_t due = is_free(port) ? find_due(ports, number) : WH_NONE;
    if (is_free(port)) {
        port->carrier = WH_NONE;
    }
    if (due != WH_NONE && ports->carriers[due].comes_us <= now_us) {
        ports->carriers[due].is_due = false;
        port->carrier = due;
        port->is_told = false;
        wh_load_port_bring(&ports->of[number].of, &port->clock, now_us, teller);
    }
}

bool wh_ports_is_same_place(const wh_pose_t *a, const wh_pose_t *b) {
    return wh_hash_pose(WH_HASH_START, a) == wh_hash_pose(WH_HASH_START, b);
}

/* The simulator has done what its state shows. */
static void confirm_orders(struct wh_ports *ports, const wh_state_t *state) {
    size_t left = 0;
    for (size_t i = 0; i < ports->state->order_count; ++i) {
        const wh_load_port_order_t *order = &ports->orders[i];
        if (!wh_ports_is_same_place(&state->wafers[order->wafer].base_from_wafer, &order->base_from_wafer)) {
            ports->orders[left++] = *order;
        }
    }
    ports->state->order_count = left;
}

void wh_ports_hear(struct wh_ports *ports, const wh_state_t *state, double us) {
    confirm_orders(ports, state);
    for (size_t i = 0; i < ports->count; ++i) {
        wh_ports_telling_t telling = {ports, (int32_t)i};
        const wh_load_port_teller_t teller = {wh_ports_tell, &telling};
        const wh_load_port_time_t time = time_of(state, ports, i, us);
        wh_load_port_pass(&ports->of[i].of, &ports->ports[i].clock, &time, &teller);
        look(ports, (int32_t)i, state->utime, &teller);
    }
}

/* A slot that has no fault and will get none with this command, from the last one down: scripts' faults take
 * the first ones. WH_FAULTS: there is none. */
static size_t find_slot(const wh_mcs_t *mcs, const wh_command_t *command) {
    for (size_t slot = WH_FAULTS; slot > 0; --slot) {
        const size_t i = slot - 1;
        const wh_physics_state_t *physics = mcs->state.physics;
        bool is_used = i < mcs->armed.fault_count && mcs->armed.faults[i].until > mcs->track.slice;
        if (physics && i < physics->faults.count) {
            const wh_fault_phase_t phase = physics->faults.slots[i].phase;
            is_used = is_used || (phase != WH_FAULT_FREE && phase != WH_FAULT_OVER);
        }
        for (size_t k = 0; k < command->fault_count; ++k) {
            is_used = is_used || command->faults[k].index == (int32_t)i;
        }
        if (!is_used) {
            return i;
        }
    }
    return WH_FAULTS;
}

void wh_ports_order(const wh_mcs_t *mcs, wh_command_t *command, int32_t wafer,
                    const wh_pose_t *base_from_wafer) {
    const size_t slot = command->fault_count < WH_COMMAND_FAULTS ? find_slot(mcs, command) : WH_FAULTS;
    if (slot == WH_FAULTS) {
        return;
    }
    wh_fault_request_t *request = &command->faults[command->fault_count++];
    request->index = (int32_t)slot;
    request->fault = wh_fault_make(WH_FAULT_WAFER_PLACED, wafer, 0, command->seq, WH_FAULT_FOREVER);
    request->fault.offset = *base_from_wafer;
}

void wh_ports_send(const struct wh_ports *ports, wh_command_t *command) {
    for (size_t i = 0; i < ports->state->order_count; ++i) {
        wh_ports_order(ports->mcs, command, ports->orders[i].wafer, &ports->orders[i].base_from_wafer);
    }
}

/* --------------------------------------------------------------------------------------------- questions */

int32_t wh_ports_find(const wh_mcs_t *mcs, int32_t station) {
    return mcs->clocks && mcs->clocks->ports ? mcs->clocks->ports->by_station[station] : WH_NONE;
}

bool wh_ports_is_idle(const struct wh_ports *ports, int32_t number) {
    const wh_load_port_now_t *port = &ports->ports[number];
    return port->clock.step == WH_LOAD_PORT_STANDS && !(is_free(port) && find_due(ports, number) != WH_NONE);
}

wh_load_port_t wh_ports_coming(const struct wh_ports *ports, int32_t number, int64_t now_us) {
    static const wh_load_port_teller_t nobody = {NULL, NULL};
    const wh_load_port_now_t *port = &ports->ports[number];
    const int32_t due = is_free(port) ? find_due(ports, number) : WH_NONE;
    wh_load_port_t next = port->clock;
    if (due != WH_NONE && ports->carriers[due].comes_us <= now_us) {
        wh_load_port_bring(&ports->of[number].of, &next, now_us, &nobody);
    }
    return next;
}

double wh_ports_quiet_us(const struct wh_ports *ports, int64_t now_us) {
    double us = ports->state->order_count > 0 ? 0 : (double)INFINITY;
    for (size_t i = 0; i < ports->count; ++i) {
        const int32_t due = is_free(&ports->ports[i]) ? find_due(ports, (int32_t)i) : WH_NONE;
        us = fmin(us, wh_load_port_quiet_us(&ports->of[i].of, &ports->ports[i].clock));
        us = due == WH_NONE ? us : fmin(us, (double)(ports->carriers[due].comes_us - now_us));
    }
    return us;
}

void wh_ports_pass(struct wh_ports *ports, int64_t us, int64_t now_us) {
    static const wh_load_port_teller_t nobody = {NULL, NULL};
    const wh_load_port_time_t time = {(double)us, 1, 0, now_us};
    for (size_t i = 0; i < ports->count; ++i) {
        wh_load_port_pass(&ports->of[i].of, &ports->ports[i].clock, &time, &nobody);
    }
}

double wh_ports_rest_us(const struct wh_ports *ports, int32_t number, int64_t now_us) {
    static const wh_load_port_teller_t nobody = {NULL, NULL};
    const wh_load_port_of_t *of = &ports->of[number].of;
    wh_load_port_t next = ports->ports[number].clock;
    const int32_t due = is_free(&ports->ports[number]) ? find_due(ports, number) : WH_NONE;
    double rest_us = 0;
    if (due != WH_NONE) {
        rest_us = fmax((double)(ports->carriers[due].comes_us - now_us), 0);
        wh_load_port_bring(of, &next, now_us, &nobody);
    }
    return rest_us + wh_load_port_left_us(of, &next);
}
