/* A layout: the cell that a Lua file describes, checked and with every default filled in.
 *
 * Lengths in mm, angles in rad, times in s, as in the library; names as the layout spells them.
 */
#ifndef WH_LAYOUT_LAYOUT_H
#define WH_LAYOUT_LAYOUT_H

#include "../cell/station.h"
#include "../collision/world.h"
#include "../flow/tool.h"
#include "../grasp/grips.h"
#include "../motion/machine.h"
#include "../motion/via.h"
#include "../sim/physics.h"
#include "errors.h"
#include "sizes.h"

/* The longest name of a station, gripper, wafer or valve, with its terminator. */
#define WH_NAME_SIZE 64

/* The most robots of a layout, and the most arms of all of them. */
#define WH_LAYOUT_ROBOTS (WH_AXES / WH_ROBOT_AXES)
#define WH_LAYOUT_ARMS WH_WORLD_ARMS

/* The most robots that are times alone beside robots with axes. */
#define WH_LAYOUT_TIMED 16

/* The most wafers, stations, and slots of a station that a layout may have. */
#define WH_LAYOUT_WAFERS 1000000
#define WH_LAYOUT_STATIONS 1000
#define WH_LAYOUT_SLOTS 1000

/* The height that a wafer may fall, mm: placing.drop of a layout that does not say it. */
#define WH_USUAL_DROP WH_REAL(0.5)

/* The limits of a tolerance: projz, projxy, planar. */
#define WH_TOLERANCE_LIMITS 3

/* The most parts that a collision check may have, and the most obstacles among them. */
#define WH_LAYOUT_PARTS 100000
#define WH_LAYOUT_OBSTACLES 1000

/* The wafers that sensors and beams can see, mm. */
#define WH_SENSED_LEAST 20
#define WH_SENSED_MOST 600

/* The most slices by which a valve acts late in a trial of a study. */
#define WH_STUDY_LAG_SLICES 8000

typedef struct {
    char name[WH_NAME_SIZE];
    char valve[WH_NAME_SIZE + 8]; /* the output's name, such as eeVacValve[0] */
    /* the prealigner whose chuck or pins it is, or the flipper; WH_NONE: on a robot's end-effector */
    int32_t station;
    wh_limits_t loaded; /* its own, of each 0: no limit; see wh_layout_loaded */
} wh_layout_gripper_t;

/* A door: machine.doors has how it moves at the same index. */
typedef struct {
    char name[WH_NAME_SIZE];
    double timeout; /* how long a command waits for it once it should be there, s */
} wh_layout_door_t;

/* How a STOP ends a motion. */
typedef enum {
    WH_LAYOUT_STOP_USUAL, /* the layout does not say: it slows down for hosts alone */
    WH_LAYOUT_STOP_RAMP,
    WH_LAYOUT_STOP_FREEZE
} wh_layout_stop_t;

/* A robot: machine.mounts[].robot counts them. */
typedef struct {
    char name[WH_NAME_SIZE];    /* "robot" of a layout that has one */
    wh_elbow_t elbow;           /* SCARA: its usual side */
    wh_carrier_t carrier;       /* what machine.carrier and its `next` point to, unless that is null */
    wh_limits_t loaded;         /* while any gripper on it carries a wafer, of each 0: no limit */
    wh_arm_t arm;               /* the links of any robot but the first, which has shapes.arm; and */
    wh_real_t lowest;           /* the least height of its contact plane, mm */
    wh_real_t transit;          /* mm, see transit.h; 0: the arm turns as it stands */
    const wh_part_list_t *urdf; /* its links' parts from a URDF; null: the usual ones of shapes.h */
} wh_layout_robot_t;

/* The most points that an arm passes for a station; a way between two stations has the points of both. */
#define WH_LAYOUT_VIAS 2

/* One of them, by the robot's own axes. */
typedef struct {
    bool is_given[WH_CARRIER_AXES]; /* false: as in front of the station */
    wh_via_point_t point;
} wh_layout_via_t;

/* All of them, from the way to the station on. */
typedef struct {
    size_t count;
    wh_layout_via_t at[WH_LAYOUT_VIAS];
} wh_layout_vias_t;

/* The farthest that a robot's taught place may be from the station's, mm. */
#define WH_LAYOUT_ASIDE 5

/* The times of a station: times.h. */
typedef struct wh_layout_times wh_layout_times_t;

/* A load port, and a carrier that comes to it: ports.h. */
typedef struct wh_layout_port wh_layout_port_t;
typedef struct wh_layout_carrier wh_layout_carrier_t;

/* How one of several robots comes to a station. */
typedef struct {
    bool serves;      /* the layout says so, or the robot alone decides by its reach */
    bool is_turned;   /* its way in is not the station's own */
    wh_mat3_t R;      /* then: x is its way in, z goes up through the slots */
    double rail;      /* where its rail stands, mm */
    wh_elbow_t elbow; /* and a SCARA's elbow */
    int32_t effector; /* its gripper that serves the station unless a command names another one */
    int32_t door;     /* that it comes through, or WH_NONE */
    /* How far its taught slot 1 is from the true one, in base, mm. The places where it expects the beams are
     * off by as much. */
    wh_vec3_t aside;
    int32_t first_beam, beam_count; /* those of the station's beams that it passes on its way in */
    bool centre;                    /* its PUT corrects by what these say */
    wh_layout_vias_t vias;
    wh_flow_side_t side; /* of a load lock */
} wh_layout_approach_t;

/* The order in which the valves switch when a chuck and an end-effector pass a wafer on. */
typedef enum {
    WH_HANDOVER_NEW_FIRST, /* the new gripper opens a slice before the old one closes */
    WH_HANDOVER_SAME_SLICE
} wh_handover_t;

/* Which commands wait for the vacuum sensor. The others move and assume success. */
typedef enum {
    WH_VACUUM_CHECK_BOTH,
    WH_VACUUM_CHECK_GET,
    WH_VACUUM_CHECK_PUT,
    WH_VACUUM_CHECK_NONE
} wh_vacuum_check_t;

/* Which face of a wafer points up in a station. */
typedef enum { WH_STATION_ANY_FACE, WH_STATION_FACE_UP, WH_STATION_FACE_DOWN } wh_station_face_t;

/* The part of a station that a probe touches: a block with flat faces, along the station's axes. */
typedef struct {
    bool is_there;
    double at[3];   /* middle of its upper face, mm */
    double size[3]; /* mm */
} wh_layout_block_t;

/* Its faces: towards the robot, to the right, upwards. */
#define WH_BLOCK_FACES 3

/* A pin with a ball and a switch, on a gripper. */
typedef struct {
    bool is_there;
    int32_t gripper;
    double at[3]; /* of the ball's centre in the gripper's frame, mm */
    double radius, noise;
    uint64_t seed;
    wh_beam_stuck_t stuck;
} wh_layout_probe_t;

/* The station parameters that GET and PUT use. The geometry is in wh_layout_t.places at the same index. */
typedef struct {
    char name[WH_NAME_SIZE];
    bool prealigner;
    bool foup;              /* with walls and a load port around its slots */
    bool flipper;           /* its one gripper clamps wafers and turns them over */
    bool by_axes;           /* `axes`, its own or a robot's, say where it was taught */
    bool counts;            /* a wafer that is put here is done: for wafers per hour */
    wh_real_t stroke;       /* from entry below the wafer to exit above it */
    wh_real_t offset;       /* how far above the slot a GET leaves and a PUT starts */
    wh_real_t retract;      /* how far before the slot the end-effector enters the line */
    bool retract_default;   /* the layout does not say it */
    wh_real_t pickup_speed; /* of the strokes, mm/s */
    wh_real_t release;      /* height above the slot's plane at which a PUT switches the valves */
    bool release_default;   /* the layout does not say it: an edge grip lets go in the plane */
    wh_real_t vacuum_delay; /* from the stroke's end until the sensor is asked, s */
    wh_real_t timeout;      /* the longest wait for the sensor after that, s */
    wh_handover_t handover;
    bool taught;                   /* false: every command at the station is refused */
    bool check_map;                /* GET and PUT need a MAP first */
    wh_vacuum_check_t check;       /* which commands wait for the sensor */
    wh_real_t pickup_acceleration; /* of the strokes, mm/s^2; 0: the axes' own */
    wh_real_t wait;                /* in the station before the stroke, s */
    wh_real_t map_speed;           /* of a MAP's sweep, mm/s */
    int32_t retries;               /* how often a GET that took nothing repeats its stroke */
    /* the gripper on the robot that serves the station unless a command names another one */
    int32_t effector;
    wh_station_face_t face; /* as wafers must lie there */
    bool centre;            /* a PUT corrects by what the station's beams say */
    wh_layout_block_t block;
    double rail;           /* where the robot's rail stands for it, mm */
    wh_elbow_t elbow;      /* and a SCARA's elbow */
    int32_t door;          /* that wafers come through, or WH_NONE */
    wh_layout_vias_t vias; /* with one robot */
    /* With several robots: how each comes there, and who serves the station unless a command says otherwise;
     * WH_NONE: a command must say. Else null and 0. */
    wh_layout_approach_t *by;
    int32_t robot;
    const wh_layout_times_t *times; /* null: it takes no time */
    wh_layout_port_t *port;         /* null: it is no load port */
} wh_layout_station_t;

typedef struct {
    char name[WH_NAME_SIZE];
    int32_t station, slot; /* slot from 1 */
    double thickness;      /* as MAP measures it, mm; all else goes by that of the layout's wafers */
    int32_t carrier;       /* its number from 1, with which it comes; 0: it is there when a run begins */
    int32_t recipe;        /* its number, by which stations process it; 0: none */
} wh_layout_wafer_t;

/* How MAP judges what its beams see: mcs/slot_codes.h. */
typedef struct {
    double x, y; /* where the beams stand, before the slot's middle and to either side: shares of a radius */
    double crossed;            /* how far from its slot's plane a wafer may lie, a share of the pitch */
    double level;              /* how far apart in height the beams may see it, mm; 0: half the pitch */
    double protruded;          /* how far out it may lie, mm */
    double thinnest, thickest; /* mm */
} wh_mapping_t;

/* How far a GET, PUT or SWAP may go beside what was taught: along the slot's axes, mm, and about its z. */
typedef struct {
    double x, y, z, turn_deg;
} wh_corrections_t;

/* A beam of light at a station's door, as motion control believes it to be, and as it truly is. It stands
 * upright in the station's frame. */
typedef struct {
    char
        name[WH_NAME_SIZE + 8]; /* as "LL.beam1": the station's name, and its number there; a face has none */
    int32_t station;
    double x, y, low, high;     /* mm; from `low` to `high` over the station's z = 0 */
    double sd;                  /* how well x and y are known, mm: standard deviation */
    double delay_on, delay_off; /* s */
    double dx, dy, late;        /* it truly stands off by this, and both delays are longer by `late` */
} wh_layout_beam_t;

/* Nothing in it changes during a run. Whoever made it keeps its memory: reading/layout_read.h,
 * wire/told_layout.h. */
typedef struct {
    /* ------------------------------------------------------------------------------------------ the file */
    const char *path;           /* as the caller named it */
    const char *patterns;       /* the file of patterns that it names, as it is opened; null: none */
    uint64_t patterns_hash;     /* of that file's text */
    const wh_flow_tool_t *tool; /* a cell of times alone, which has no stations and wafers here; else null */
    /* ------------------------------------------------------------------------------- how a run is judged */
    char tolerance_name[16]; /* the preset's, or "own" */
    /* of "own": the layout does not give projz, projxy, planar, and the paper's stands */
    bool tolerance_default[WH_TOLERANCE_LIMITS];
    double wafer_diameter, wafer_thickness;
    double wafer_spread; /* standard deviation of true diameters, by which centring goes; 0: they are exact */
    /* direction of the notch, rad about e3 from e1, and its depth, mm; depth 0: no notch */
    double notch, notch_depth;
    wh_grasp_config_t grasp;
    double debounce_given; /* ms, as the layout's file says; 0: it says nothing */
    int64_t slice_us;
    wh_corrections_t corrections; /* the largest ones that a command may ask for */
    wh_mapping_t mapping;
    /* --------------------------------------------------------------------------------------- the machine */
    wh_physics_t physics; /* vacuum, pads, faults at the start */
    wh_machine_t machine; /* machine.gripper_count is the number of grippers */
    bool axes_untold;     /* made of a message, which tells what an axis moves only for doors */
    size_t robot_count;
    wh_layout_robot_t *robots; /* sorted by name */
    /* Robots that are times alone beside these: their times, with the stations as here; null: there are
     * none. */
    wh_flow_tool_t *timed;
    wh_carrier_t carrier;                /* the first one's, unless machine.carrier is null */
    wh_elbow_t elbow;                    /* the first one's */
    wh_world_arm_t arms[WH_LAYOUT_ARMS]; /* robot by robot: see arms.h */
    size_t arm_count;
    uint8_t carried_by[WH_GRIPPERS]; /* the arm of each gripper, or WH_WORLD_NO_ARM */
    int32_t stop;                    /* wh_layout_stop_t */
    bool homed;                      /* false: commands that rely on the arm's position need a HOME first */
    wh_layout_door_t *door_list;     /* machine.door_count of them, sorted by name */
    /* --------------------------------------------------------------------- grippers, stations and wafers */
    wh_layout_gripper_t grippers[WH_GRIPPERS];
    size_t station_count;
    wh_layout_station_t *stations; /* sorted by name */
    wh_station_t *places;
    size_t wafer_count;
    wh_layout_wafer_t *wafers;
    wh_wafer_t *start; /* where each wafer is at the start */
    size_t carrier_count;
    wh_layout_carrier_t *carriers;    /* sorted by name */
    const wh_flow_recipes_t *recipes; /* of stations' processes and cleans */
    /* ----------------------------------------------------------------------------------- faces and grips */
    /* Wafers may come to lie face down: cell.thickness is theirs, and simulators have grips (grips.h). */
    bool has_faces;
    wh_grip_t grips[WH_GRIPPERS];
    const wh_edge_wafer_t *edge_wafers; /* by wafer what edge grips meet; null where there are none */
    const wh_pose_t *supports;          /* the planes that take wafers over from passive pads */
    size_t support_count;
    /* --------------------------------------------------------------------- beams, probe and edge sensors */
    /* The beams at stations' doors, those of a station one after another, with their electronics as they
     * truly are, and by gripper the blades that break them. */
    wh_layout_beam_t beams[WH_BEAMS];
    wh_door_beam_t doors[WH_BEAMS];
    size_t beam_count; /* with the faces of the stations' blocks, which come behind the beams, likewise */
    wh_blade_outline_t blades[WH_GRIPPERS];
    wh_layout_probe_t probe;
    /* The edge sensors, and by wafer the rims that they, beams and edge grips meet. Without any of these the
     * rims have no effect. Wafers that the layout does not describe have the nominal rim. */
    wh_scanner_t scanners[WH_GRIPPERS];
    wh_sensor_error_t believed[WH_GRIPPERS]; /* what motion control takes each one's errors to be */
    size_t scanner_count;
    const wh_rim_t *nominal_rim;
    const wh_rim_t *const *rims;
    /* ----------------------------------------------------------------------------- places and collisions */
    wh_cell_t cell;  /* the places, with the tolerance and how wafers are set down */
    bool collision;  /* check for contact in each slice */
    bool look_ahead; /* and before each command that moves */
    wh_shapes_t shapes;
    wh_world_config_t world; /* filled in also without a check; without parts if there are too many */
    const char (*part_names)[WH_PART_NAME_SIZE];
    size_t hung_count; /* how many of the last parts of `world` are obstacles on robot, grippers and doors */
    /* --------------------------------------------------------------------- what reports and studies take */
    wh_errors_t *errors;  /* what a study draws; null: no `study` */
    const char **guesses; /* numbers that look as if they were in another unit: field, value, unit; sorted */
    size_t guess_count;
} wh_layout_t;

/* Fills in `cell` from the places and the tolerance, which must have been read. */
void wh_layout_place(wh_layout_t *layout);

/* The limits of the way of a wafer on this gripper: mm/s, mm/s^2, mm/s^3 of its centre in base. They are
 * the stricter ones of the gripper's and its robot's limits. Each is 0 if there is no limit. */
wh_limits_t wh_layout_loaded(const wh_layout_t *layout, size_t gripper);

/* True if there is such a limit for any gripper. */
bool wh_layout_has_loaded(const wh_layout_t *layout);

/* True if stations say by whom they are served: there are several robots, timed ones among them. */
bool wh_layout_is_shared(const wh_layout_t *layout);

/* True if a robot with axes serves the station; elsewhere `by` may name timed ones alone. */
bool wh_layout_is_served(const wh_layout_t *layout, size_t station);

/* True for a gripper that is the pins beside a prealigner's chuck; true for one that is a flipper's clamp;
 * and the pins of a station, or WH_NONE. */
bool wh_layout_is_pins(const wh_layout_t *layout, size_t gripper);
bool wh_layout_is_flipper(const wh_layout_t *layout, size_t gripper);
int32_t wh_layout_find_pins(const wh_layout_t *layout, int32_t station);

/* A station's kind as a layout has it: see words.h. */
const char *wh_layout_station_kind(const wh_layout_station_t *station);

/* The door of a station for a robot, or WH_NONE. */
int32_t wh_layout_door_of(const wh_layout_t *layout, size_t station, size_t robot);

/* A robot's first gripper: each has one. */
int32_t wh_layout_first_gripper(const wh_layout_t *layout, size_t robot);

/* The points that a robot passes on its way to a station. */
const wh_layout_vias_t *wh_layout_vias_of(const wh_layout_t *layout, size_t station, size_t robot);

/* The edge sensors as a simulator takes them: a view of the layout. */
wh_scanning_t wh_layout_scanning(const wh_layout_t *layout);

/* The edge sensor at a gripper's chuck; null if it has none. */
const wh_scanner_t *wh_layout_scanner(const wh_layout_t *layout, int32_t gripper);

/* The beams as a simulator takes them: a view of the layout. */
wh_latching_t wh_layout_latching(const wh_layout_t *layout);

/* The order that arms a station's beams; count 0 if it has none. */
wh_latch_order_t wh_layout_beams_at(const wh_layout_t *layout, size_t station);

/* The order that arms the beams which a robot passes on its way in. Its count is 0 if the robot passes
 * none, or if beams are not for its kind. */
wh_latch_order_t wh_layout_beams_of(const wh_layout_t *layout, size_t station, size_t robot);

/* True if a PUT of the robot corrects by what the station's beams say. */
bool wh_layout_centres(const wh_layout_t *layout, size_t station, size_t robot);

/* True if the robot can use beams and blocks: see WH_AXES_USUAL. One of several robots may stand anywhere. */
bool wh_layout_is_usual(const wh_layout_t *layout, size_t robot);

/* How far from the layout's place one of several robots was taught a station, in base, mm. With one robot
 * it is zero. */
wh_vec3_t wh_layout_aside(const wh_layout_t *layout, size_t station, size_t robot);

/* The order that arms a face of a station's block; count 0 if it has none. */
wh_latch_order_t wh_layout_face_at(const wh_layout_t *layout, size_t station, size_t face);

/* A face of a block in its station's frame: its middle, which of x, y and z its normal is along, and the
 * normal's sign. */
typedef struct {
    double middle[3];
    size_t axis;
    double sign;
} wh_block_face_t;
wh_block_face_t wh_layout_block_face(const wh_layout_block_t *block, size_t face);

/* Sets up doors[b] anew, where its station stands. */
void wh_layout_place_beam(wh_layout_t *layout, size_t b);

/* 64 bits over all that two processes must agree on: slice, tolerances, checking, vacuum, pads, faults,
 * edge sensors, beams and rims, machine, and the names and places of stations, grippers and wafers. The
 * path is left out. Cost: linear. */
uint64_t wh_layout_hash(const wh_layout_t *layout);

/* The debounce of the vacuum sensors, ms: whole slices. */
double wh_layout_debounce_ms(const wh_layout_t *layout);

/* 64 bits over what the layout's hash leaves out of a collision check: shapes, the arm, and the limits of
 * gaps; 0: the layout asks for no check. Cost: linear in the parts' points. */
uint64_t wh_layout_world_hash(const wh_layout_t *layout);

/* The name of a part of the collision world, wafers included; null if there is no such part. */
const char *wh_layout_part_name(const wh_layout_t *layout, int32_t part);

/* The index of a name, or WH_NONE. Cost: linear. */
int32_t wh_layout_find_station(const wh_layout_t *layout, const char *name);
int32_t wh_layout_find_gripper(const wh_layout_t *layout, const char *name);
int32_t wh_layout_find_robot(const wh_layout_t *layout, const char *name);
int32_t wh_layout_find_door(const wh_layout_t *layout, const char *name);
int32_t wh_layout_find_beam(const wh_layout_t *layout, const char *name);
int32_t wh_layout_find_wafer(const wh_layout_t *layout, const char *name);

#endif
