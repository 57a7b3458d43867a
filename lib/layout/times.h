/* Stations that take time, in a cell with axes: processes, cleans, load locks. */
#ifndef WH_LAYOUT_TIMES_H
#define WH_LAYOUT_TIMES_H

#include "layout.h"

/* The longest time of a station, s: a week. */
#define WH_LAYOUT_LONGEST_S 604800.0

/* The times of a station. */
struct wh_layout_times {
    wh_flow_station_t of;   /* as in a flow; it has no name, and its places are the slots */
    uint32_t doors;         /* bits: all doors that lead into it */
    uint32_t side_doors[2]; /* of a lock, by its pressure behind them: atmosphere, vacuum */
    wh_flow_side_t side;    /* of a lock, with one robot: where that comes */
};

/* True if any station takes time. */
bool wh_layout_takes_time(const wh_layout_t *layout);

/* The side of a station on which the robot comes; WH_FLOW_BOTH if it is no lock. */
wh_flow_side_t wh_layout_side_of(const wh_layout_t *layout, size_t station, size_t robot);

/* Continues a hash with the stations' times; it is the same if there are none. */
uint64_t wh_layout_hash_times(const wh_layout_t *layout, uint64_t hash);

#endif
