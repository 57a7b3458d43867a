/* A layout: the cell that a Lua file describes, checked and with every default filled in.
 *
 * Lengths in mm, angles in rad, times in s, as in the library; names as the layout spells them.
 */
#ifndef WH_LAYOUT_LAYOUT_H
#define WH_LAYOUT_LAYOUT_H

#include <lua.h>

#include "../cell/station.h"
#include "../collision/world.h"
#include "../motion/machine.h"
#include "../sim/physics.h"
#include "errors.h"
#include "shapes.h"

/* Longest name of a station, gripper, wafer or valve, with its terminator. */
#define WH_NAME_SIZE 64

/* How many wafers, stations and slots of a station a layout may have. */
#define WH_LAYOUT_WAFERS 1000000
#define WH_LAYOUT_STATIONS 1000
#define WH_LAYOUT_SLOTS 1000

/* How many parts a collision check may have, and how many of them a layout may add by itself. */
#define WH_LAYOUT_PARTS 100000
#define WH_LAYOUT_OBSTACLES 1000

/* A valve acts at most so many slices late in a trial of a study. */
#define WH_STUDY_LAG_SLICES 8000

typedef struct {
    char name[WH_NAME_SIZE];
    char valve[WH_NAME_SIZE]; /* the output's name, such as eeVacValve[0] */
    int32_t station;          /* the prealigner whose chuck it is, or WH_NONE: the robot's end-effector */
} wh_layout_gripper_t;

/* In which order the valves switch when a chuck and an end-effector pass a wafer on. */
typedef enum {
    WH_HANDOVER_NEW_FIRST, /* the new gripper opens a slice before the old one closes */
    WH_HANDOVER_SAME_SLICE
} wh_handover_t;

/* Whose success the vacuum sensor decides; a command whose it does not goes through its motions and trusts them. */
typedef enum {
    WH_VACUUM_CHECK_BOTH,
    WH_VACUUM_CHECK_GET,
    WH_VACUUM_CHECK_PUT,
    WH_VACUUM_CHECK_NONE
} wh_vacuum_check_t;

/* The station parameters that GET and PUT use; geometry is in wh_layout_t.places at the same index. */
typedef struct {
    char name[WH_NAME_SIZE];
    bool prealigner;
    bool foup;              /* with walls and a load port around its slots */
    wh_real_t stroke;       /* from entry below the wafer to exit above it */
    wh_real_t offset;       /* how far above the slot a GET leaves and a PUT starts */
    wh_real_t retract;      /* how far before the slot the end-effector enters the line */
    wh_real_t pickup_speed; /* of the strokes, mm/s */
    wh_real_t release;      /* height above the slot's plane at which a PUT switches the valves */
    wh_real_t vacuum_delay; /* after the stroke before the sensor is asked, s */
    wh_real_t timeout;      /* how long the sensor is then waited for, s */
    wh_handover_t handover;
    bool taught;                   /* false: every command at it is refused */
    bool check_map;                /* GET and PUT need a MAP first */
    wh_vacuum_check_t check;       /* which commands the sensor decides */
    wh_real_t pickup_acceleration; /* of the strokes, mm/s^2; 0: the axes' own */
    wh_real_t wait;                /* in the station before the stroke, s */
    wh_real_t map_speed;           /* of a MAP's sweep, mm/s */
    int32_t retries;               /* how often a GET that took nothing goes up again */
    int32_t effector; /* the gripper on the robot that serves it unless a command says otherwise */
} wh_layout_station_t;

typedef struct {
    char name[WH_NAME_SIZE];
    int32_t station, slot; /* slot from 1 */
} wh_layout_wafer_t;

/* Lives as long as the Lua state that it was read in. Nothing in it changes during a run. */
typedef struct {
    const char *path;        /* as it was asked for */
    char tolerance_name[16]; /* the preset's, or "own" */
    double wafer_diameter, wafer_thickness;
    double notch,
        notch_depth; /* its direction in the wafer's frame, rad about e3 from e1, and how deep, mm */
    wh_grasp_config_t grasp;
    int64_t slice_us;
    wh_physics_t physics; /* vacuum, pads, faults from the beginning */
    wh_machine_t machine; /* machine.gripper_count is the number of grippers */
    bool homed;           /* false: HOME comes before whatever counts on where the arm stands */
    wh_layout_gripper_t grippers[WH_GRIPPERS];
    size_t station_count;
    wh_layout_station_t *stations; /* sorted by name */
    wh_station_t *places;
    size_t wafer_count;
    wh_layout_wafer_t *wafers;
    wh_wafer_t *start; /* where each wafer is when a run begins */
    wh_cell_t cell;    /* places, with the tolerance and how wafers are set down */
    bool collision;    /* check it while stepping */
    bool look_ahead;   /* and before each command that moves */
    wh_shapes_t shapes;
    wh_world_config_t world; /* whether it is checked or not; without parts when they are too many */
    const char (*part_names)[WH_PART_NAME_SIZE];
    wh_errors_t *errors; /* what a study draws; null: the layout has no `study` */
    size_t hung_count;   /* of the world's parts the last so many: obstacles on the robot and on grippers */
} wh_layout_t;

/* Reads the table on top of L's stack (what the layout file returned, which is left there), fills in the
 * defaults and checks everything that can be checked without moving: fields, ranges, names, who lies and who
 * rides where, strokes against slices. Raises a Lua error that names file, field path, value and what was
 * expected. The layout's memory is Lua's; the reference is kept in the registry. Cost: linear in wafers, plus
 * a sort. */
wh_layout_t *wh_layout_read(lua_State *L, const char *path);

/* Reads anew, for a copy of a layout whose stations stand elsewhere, what the collision check knows of them. The layout's
 * table is on top of the stack; the copy must outlive the state. Raises what wh_layout_read does. */
void wh_layout_read_reality(lua_State *L, wh_layout_t *trial_cell);

/* Reads `study` from the table on top of the stack, which the script `path` holds, in place of the layout's own. */
void wh_layout_read_own_study(lua_State *L, const char *path, wh_layout_t *layout);

/* Makes `cell` of the places and the tolerance, which are read by then. */
void wh_layout_place(wh_layout_t *layout);

/* 64 bits over all that two processes must agree on: slice, tolerances, checking, vacuum, pads, faults, machine, and of stations, grippers and
 * wafers the names and places. The path is left out. Cost: linear. */
uint64_t wh_layout_hash(const wh_layout_t *layout);

/* What a part of the collision world is called, a wafer's number among them; null when there is none. */
const char *wh_layout_part_name(const wh_layout_t *layout, int32_t part);

/* The index of a name, or WH_NONE. Cost: linear. */
int32_t wh_layout_find_station(const wh_layout_t *layout, const char *name);
int32_t wh_layout_find_gripper(const wh_layout_t *layout, const char *name);
int32_t wh_layout_find_wafer(const wh_layout_t *layout, const char *name);

#endif
