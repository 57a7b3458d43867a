/* A small cell for tests of stations: two stacks and a chuck. */
#ifndef WH_TESTS_SUPPORT_STATION_H
#define WH_TESTS_SUPPORT_STATION_H

#include "cell/station.h"
#include "math/trig.h"
#include "support/pose.h"

enum { STATIONS = 3 };

/* 0: 25 slots of 10 mm from (700, 0, 900) up; 1: tilted by 30 degrees; 2: the chuck of gripper 1. */
static wh_station_t stations[STATIONS];
static wh_cell_t cell;

static inline wh_station_t station_at(double x, double y, double z, int slots, int chuck) {
    wh_station_t station;
    station.base_from_station = wh_test_at(x, y, z);
    station.slots = slots;
    station.pitch = 10;
    station.chuck = chuck;
    return station;
}

static inline int set_up(void **state) {
    (void)state;
    stations[0] = station_at(700, 0, 900, 25, WH_NONE);
    stations[1] = station_at(0, 700, 900, 25, WH_NONE);
    stations[1].base_from_station.R = wh_mat3_from_rpy_deg(30, 0, 90);
    stations[2] = station_at(-600, 0, 950, 1, 1);
    cell.stations = stations;
    cell.count = STATIONS;
    cell.tolerance = wh_tolerance_paper();
    return 0;
}

/* A wafer at (x, y, z) in the frame of a station's slot 1. */
static inline wh_pose_t in_station(size_t station, double x, double y, double z) {
    const wh_pose_t station_from_wafer = wh_test_at(x, y, z);
    return wh_pose_compose(&stations[station].base_from_station, &station_from_wafer);
}

#endif
