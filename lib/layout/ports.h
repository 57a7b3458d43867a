/* Load ports of a cell with axes, and the carriers that come to them. */
#ifndef WH_LAYOUT_PORTS_H
#define WH_LAYOUT_PORTS_H

#include "../flow/load_port.h"
#include "layout.h"

/* The most carriers of a layout. */
#define WH_LAYOUT_CARRIERS 100

/* A station that is a load port. */
struct wh_layout_port {
    wh_load_port_of_t of;
    wh_mapping_t mapping; /* how its own mapper judges */
};

/* Its wafers are `count` of the layout's from `first` on, each with its slot. Others may lie in it, too. */
struct wh_layout_carrier {
    char name[WH_NAME_SIZE];
    int32_t at; /* the station where it is when a run begins, or WH_NONE: it is not there */
    int32_t first, count;
    int32_t recipe;  /* of its wafers, by its number; 0: none */
    const bool *has; /* by slot from 0, WH_LAYOUT_SLOTS of them; null: it has no wafers of its own */
};

/* A wafer of a carrier that has not come is out of the cell: far below it, each at a place of its own. */
wh_pose_t wh_layout_outside(size_t wafer);

/* True if a wafer is there. */
bool wh_layout_is_outside(const wh_pose_t *base_from_wafer);

bool wh_layout_has_ports(const wh_layout_t *layout);

/* The index of a carrier's name, or WH_NONE. */
int32_t wh_layout_find_carrier(const wh_layout_t *layout, const char *name);

/* Continues a hash with load ports and carriers; it is the same if there are none. */
uint64_t wh_layout_hash_ports(const wh_layout_t *layout, uint64_t hash);

#endif
