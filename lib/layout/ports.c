#include "ports.h"

#include <string.h>

#include "../math/hash.h"

/* Below every part of a cell, mm, as a wafer that a fault has taken out of it; and how far apart. */
#define FAR_BELOW WH_REAL(-1e5)
#define APART WH_REAL(10)
#define PLACES 10000

/* A wafer below this is out of the cell. */
#define OUTSIDE WH_REAL(-5e4)

wh_pose_t wh_layout_outside(size_t wafer) {
    wh_pose_t pose = wh_pose_identity();
    pose.r.z = FAR_BELOW - APART * (wh_real_t)(wafer % PLACES);
    return pose;
}

bool wh_layout_is_outside(const wh_pose_t *base_from_wafer) {
    return base_from_wafer->r.z < OUTSIDE;
}

bool wh_layout_has_ports(const wh_layout_t *layout) {
    bool is_any = false;
    for (size_t s = 0; s < layout->station_count; ++s) {
        is_any = is_any || layout->stations[s].port;
    }
    return is_any;
}

int32_t wh_layout_find_carrier(const wh_layout_t *layout, const char *name) {
    for (size_t c = 0; c < layout->carrier_count; ++c) {
        if (strcmp(layout->carriers[c].name, name) == 0) {
            return (int32_t)c;
        }
    }
    return WH_NONE;
}

static uint64_t hash_port(uint64_t hash, const wh_layout_port_t *port) {
    const wh_mapping_t *mapping = &port->mapping;
    const double limits[] = {mapping->x,         mapping->y,        mapping->crossed, mapping->level,
                             mapping->protruded, mapping->thinnest, mapping->thickest};
    hash = wh_hash_int(wh_hash_int(hash, (int32_t)port->of.goes_to), (int32_t)port->of.begins);
    hash = wh_hash_int(hash, port->of.is_e84 ? 1 : 0);
    for (int i = 1; i < WH_LOAD_PORT_STEPS; ++i) {
        hash = wh_hash_word(hash, (uint64_t)port->of.us[i]);
    }
    for (int i = 1; i <= WH_LOAD_PORT_TIMERS; ++i) {
        hash = wh_hash_word(hash, (uint64_t)port->of.limit_us[i]);
    }
    for (size_t i = 0; i < sizeof limits / sizeof limits[0]; ++i) {
        hash = wh_hash_real(hash, (wh_real_t)limits[i]);
    }
    return hash;
}

uint64_t wh_layout_hash_ports(const wh_layout_t *layout, uint64_t hash) {
    for (size_t s = 0; s < layout->station_count; ++s) {
        if (layout->stations[s].port) {
            hash = hash_port(wh_hash_word(wh_hash_text(hash, "port"), s), layout->stations[s].port);
        }
    }
    for (size_t c = 0; c < layout->carrier_count; ++c) {
        const wh_layout_carrier_t *carrier = &layout->carriers[c];
        hash = wh_hash_text(wh_hash_text(hash, "carrier"), carrier->name);
        hash = wh_hash_int(wh_hash_int(hash, carrier->at), carrier->first);
        for (int32_t i = 0; i < carrier->count; ++i) {
            hash = wh_hash_int(hash, layout->wafers[carrier->first + i].slot);
        }
    }
    return hash;
}
