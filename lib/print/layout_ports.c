#include "layout_ports.h"

#include <stdio.h>

#include "../text/json.h"

static double seconds(int64_t us) {
    return (double)us / 1e6;
}

/* --------------------------------------------------------------------------------------------- as a table */

/* Those between placed and mapped, in the order of the columns. */
static const wh_load_port_step_t steps[] = {WH_LOAD_PORT_CLAMP,  WH_LOAD_PORT_DOCK,  WH_LOAD_PORT_OPENS,
                                            WH_LOAD_PORT_MAP,    WH_LOAD_PORT_CLOSE, WH_LOAD_PORT_UNDOCK,
                                            WH_LOAD_PORT_UNCLAMP};

#define STEPS (sizeof steps / sizeof steps[0])

static void put_handshake(wh_grid_t *grid, size_t column, const wh_load_port_of_t *of) {
    if (of->is_e84) {
        wh_grid_text(grid, column, WH_INK_PLAIN, "a vehicle, E84");
        wh_grid_text(grid, column + 1, WH_INK_PLAIN, "%.10g, %.10g, %.10g, %.10g, %.10g",
                     seconds(of->limit_us[1]), seconds(of->limit_us[2]), seconds(of->limit_us[3]),
                     seconds(of->limit_us[4]), seconds(of->limit_us[5]));
    } else {
        wh_grid_text(grid, column, WH_INK_PLAIN, "hand");
    }
}

void wh_layout_ports_fill(const wh_layout_t *layout, wh_grid_t *grid) {
    for (size_t s = 0; s < layout->station_count; ++s) {
        const wh_layout_port_t *port = layout->stations[s].port;
        if (!port) {
            continue;
        }
        wh_grid_named_row(grid, layout->stations[s].name);
        wh_grid_text(grid, 1, WH_INK_PLAIN, "%s", wh_load_port_state_name(port->of.begins));
        for (size_t i = 0; i < STEPS; ++i) {
            wh_grid_number(grid, 2 + i, WH_INK_PLAIN, seconds(port->of.us[steps[i]]));
        }
        wh_grid_text(grid, 2 + STEPS, WH_INK_PLAIN, "%s", wh_load_port_state_name(port->of.goes_to));
        put_handshake(grid, 3 + STEPS, &port->of);
    }
}

void wh_layout_carriers_fill(const wh_layout_t *layout, wh_grid_t *grid) {
    for (size_t c = 0; c < layout->carrier_count; ++c) {
        const wh_layout_carrier_t *carrier = &layout->carriers[c];
        wh_grid_named_row(grid, carrier->name);
        wh_grid_text(grid, 1, WH_INK_PLAIN, "%s",
                     carrier->at == WH_NONE ? "still to come" : layout->stations[carrier->at].name);
        wh_grid_text(grid, 2, WH_INK_PLAIN, "%d", (int)carrier->count);
    }
}

/* ------------------------------------------------------------------------------------------------ as JSON */

static json_t *handshake(const wh_load_port_of_t *of) {
    json_t *object = json_object();
    for (int i = 1; i <= WH_LOAD_PORT_TIMERS; ++i) {
        char limit[4], step[4];
        (void)snprintf(limit, sizeof limit, "tp%c", '0' + i);
        (void)snprintf(step, sizeof step, "t%c", '0' + i);
        wh_json_put(object, limit, json_real(seconds(of->limit_us[i])));
        wh_json_put(object, step, json_real(seconds(of->us[i])));
    }
    return object;
}

json_t *wh_layout_port_to_json(const wh_layout_port_t *port) {
    const wh_load_port_of_t *of = &port->of;
    json_t *object = wh_json_set(json_object(), "state %s goes %s", wh_load_port_state_name(of->begins),
                                 wh_load_port_state_name(of->goes_to));
    for (int step = WH_LOAD_PORT_PLACE; step < WH_LOAD_PORT_STEPS; ++step) {
        wh_json_put(object, wh_load_port_step_name((wh_load_port_step_t)step),
                    json_real(seconds(of->us[step])));
    }
    wh_json_put(object, "e84", of->is_e84 ? handshake(of) : json_null());
    return object;
}

json_t *wh_layout_carrier_to_json(const void *subject, size_t i) {
    const wh_layout_t *layout = subject;
    const wh_layout_carrier_t *carrier = &layout->carriers[i];
    json_t *wafers = json_array();
    for (int32_t w = 0; w < carrier->count; ++w) {
        (void)json_array_append_new(wafers, json_string(layout->wafers[carrier->first + w].name));
    }
    return wh_json_add(wh_json_set(json_object(), "name %s at %s", carrier->name,
                                   carrier->at == WH_NONE ? NULL : layout->stations[carrier->at].name),
                       "wafers", wafers, NULL);
}
