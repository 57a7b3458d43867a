/* The load ports of a layout and the carriers that come to them: rows of tables, and JSON. */
#ifndef WH_PRINT_LAYOUT_PORTS_H
#define WH_PRINT_LAYOUT_PORTS_H

#include <jansson.h>

#include "../layout/ports.h"
#include "../text/grid.h"

#define WH_LAYOUT_PORTS_COLUMNS                                                                              \
    "load port;when a run begins;clamp s{0,6};dock s{0,6};open s{0,6};map s{0,6};close s{0,6};undock "       \
    "s{0,6};unclamp s{0,6};goes to;brought by;TP1 to TP5 s"

void wh_layout_ports_fill(const wh_layout_t *layout, wh_grid_t *grid);

#define WH_LAYOUT_CARRIERS_COLUMNS "carrier;when a run begins;wafers{0}"

void wh_layout_carriers_fill(const wh_layout_t *layout, wh_grid_t *grid);

/* { state, goes, seconds by step, e84 (null: by hand): { tp1, t1, ... } }, times in s. */
json_t *wh_layout_port_to_json(const wh_layout_port_t *port);

/* One of the carriers: { name, at (null: it is still to come), wafers: their names }. */
json_t *wh_layout_carrier_to_json(const void *layout, size_t i);

#endif
