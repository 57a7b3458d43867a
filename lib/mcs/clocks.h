/* Within motion control: the clockwork of the stations that take time (flow/clock.h), stepped with each
 * slice.
 *
 * What a station does by itself is the work of its own controller, not of the simulator: no motion depends
 * on it. Motion control carries it out from what it knows of the cell: the states, and in which stations
 * its arms stand. So all of it is here, with the rest of what a session saves. */
#ifndef WH_MCS_CLOCKS_H
#define WH_MCS_CLOCKS_H

#include "../flow/clock.h"
#include "../layout/times.h"
#include "native.h"

/* A station that takes time. */
typedef struct {
    int32_t station;
    const wh_layout_times_t *times;
    wh_flow_station_t of; /* as it truly is: a study draws times */
    size_t first;         /* of its places */
    int64_t error_us;     /* by which its processes are drawn longer */
    bool is_down;         /* a flow has it fail: nothing begins in it */
} wh_clocked_t;

/* All that changes, one block of memory; the arrays follow it. */
typedef struct {
    int64_t seq, utime;              /* of the last slice that was heard; 0: none */
    int32_t inside[WH_MCS_ROBOTS];   /* the station in which the robot stands, or WH_NONE */
    int32_t bringing[WH_MCS_ROBOTS]; /* the place to which its command brings a wafer, or WH_NONE */
    bool tells_late;                 /* a stay beyond a window is told, and fails nothing */
} wh_clocks_state_t;

/* Where a wafer that nobody holds was found when it was looked for, and at which pose. */
typedef struct {
    bool is_known, is_bad;
    int32_t place; /* by number, or WH_NONE */
    wh_pose_t pose;
} wh_clocks_found_t;

struct wh_clocks {
    wh_mcs_t *mcs;
    size_t count, place_count;
    wh_clocked_t *of;
    int32_t *by_station; /* the number among them of each of the layout's stations, or WH_NONE */
    wh_clocks_state_t *state;
    size_t state_bytes;
    wh_clock_t *clocks;       /* by number; within the state's block, as the next two */
    wh_clock_place_t *places; /* by place */
    wh_clock_seen_t *seen;    /* by place */
    wh_clocks_found_t *found; /* by wafer */
    struct wh_ports *ports;   /* load ports, see ports.h; null: there are none */
};

/* The user of wh_clocks_tell. */
typedef struct {
    const struct wh_clocks *clocks;
    const wh_clocked_t *of;
} wh_clocks_telling_t;

/* Keeps the event, tells it, and judges what it says: a wh_clock_teller_t. */
void wh_clocks_tell(void *user, const wh_clock_event_t *event);

/* States what should be so, as an expectation at the line of the command that runs, or of the last one. */
void wh_clocks_imply(const wh_mcs_t *mcs, const char *text, bool ok);

/* Looks where all wafers lie. */
void wh_clocks_place_all(struct wh_clocks *clocks, const wh_state_t *state);

/* Looks again after a slice, if one of its events may have moved a wafer. */
void wh_clocks_see_wafers(struct wh_clocks *clocks, const wh_state_t *state);

/* Finds which wafers of a station were lifted and have not left it, and which places await one. `out`: the
 * robot that has just come out, or WH_NONE. */
void wh_clocks_see_places(struct wh_clocks *clocks, const wh_clocked_t *of, const wh_state_t *state,
                          int32_t out);

/* The number of the layout's station among those that take time; WH_NONE: it takes none. */
int32_t wh_clocks_find(const wh_mcs_t *mcs, int32_t station);

/* wh_clocks_find() for the station at this stack index. */
int32_t wh_clocks_argument(lua_State *L, const wh_mcs_t *mcs, int argument);

/* One of these doors, bits by number, that is not shut, or WH_NONE. */
int32_t wh_clocks_find_open_door(const wh_mcs_t *mcs, uint32_t doors);

#define WH_CLOCKS_WHY_BYTES 200

/* Why no process may begin on the wafer of the place, as `text`; null: it may. */
const char *wh_clocks_why_bad(const struct wh_clocks *clocks, const wh_clocked_t *of, int32_t slot,
                              char text[WH_CLOCKS_WHY_BYTES]);

/* The robot that holds the wafer, or WH_NONE. */
int32_t wh_clocks_robot_of(const wh_mcs_t *mcs, const wh_wafer_t *wafer);

/* Sets them up if the layout has any; else nothing. Call it before the first slice. */
void wh_mcs_begin_clocks(lua_State *L, wh_mcs_t *mcs);

/* The number of next slices in which no station does anything new, if nothing comes or goes and there is no
 * fault; INT64_MAX: none ever. */
int64_t wh_mcs_clocks_quiet(const wh_mcs_t *mcs);

/* This number of these slices was left out. */
void wh_mcs_clocks_pass(const wh_mcs_t *mcs, int64_t slices);

/* True if nothing runs in the station, and nothing is to begin. */
bool wh_mcs_is_station_idle(const wh_mcs_t *mcs, int32_t station);

/* The lock begins to pump. False: a door of it is not shut, or a blade is in it, or it is on its way to the
 * other side. */
bool wh_mcs_pump(const wh_mcs_t *mcs, int32_t station, wh_flow_side_t to);

/* From now on nothing begins in the station, or it may again. */
void wh_mcs_set_down(const wh_mcs_t *mcs, int32_t station, bool is_down);

bool wh_mcs_is_pumping(const wh_mcs_t *mcs, int32_t station);

/* True if the station is no load port, or no step runs there. */
bool wh_mcs_does_port_stand(const wh_mcs_t *mcs, int32_t station);

/* Looks at the station once more in this slice: a robot that is times alone has begun something in it. */
void wh_mcs_clocks_look(const wh_mcs_t *mcs, int32_t station);

/* Adds to the command that goes out next the wafers that come and go with carriers, and with robots that are
 * times alone. */
void wh_mcs_clocks_send(wh_mcs_t *mcs);

/* At the end of a run: stays beyond windows of wafers that still lie there, and handshakes that failed. */
void wh_mcs_judge_stays(const wh_mcs_t *mcs);

/* The state of a station in one word: the process or the clean that runs in any of its slots, or the pumping.
 * With a wafer that waits, or is done, that; `left_us` is what is left of what runs, else 0. Null: the
 * station takes no time. */
const char *wh_mcs_station_word(const wh_mcs_t *mcs, int32_t station, double *left_us);

/* "vacuum" or "atmosphere"; null: the station is no lock. While it pumps: what it had. */
const char *wh_mcs_pressure_word(const wh_mcs_t *mcs, int32_t station);

#endif
