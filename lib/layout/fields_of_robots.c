/* The fields of robots, grippers and doors, and of what collisions look at. */
#include "layout_fields_internal.h"

/* -------------------------------------------------------------------------------------------- the robot */

const wh_reader_field_t wh_layout_robot_fields[] = {
    {"kind", WORD, "TRZY: theta, R, Z and a yaw axis at the wrist; TRZ: without yaw; SCARA: two links", false,
     APART_WORD(WH_CHAIN_TRZY, wh_layout_robot_words)},
    {"at", TRIPLE, "x, y, z in mm, in base: where the robot stands", false, .otherwise = "0, 0, 0"},
    {"heading", NUMBER, "degrees: where its x points, which is theta's zero and the rail's way", false,
     APART(-360, 360, 0)},
    {"rail", "waferhand.straight_axis", "the way along the robot's x; without it there is none", false},
    {"tilt", "waferhand.turning_axis", "of the column about x and about y; without it the robot keeps level",
     false},
    {"flip", "waferhand.flip_axis", "the turn of the blade about its x; without it the blade stays face up",
     false},
    {"arms", "waferhand.robot_arm[]", "TRZ: one or two, each with an r of its own over one theta and z",
     false},
    {"wrists", "waferhand.robot_wrist[]", "SCARA: one or two, each with a yaw of its own", false},
    {"links", "number[]", "mm, SCARA: from the shoulder to the elbow, from there to the wrist", false},
    {"elbow", WORD, "SCARA: its side at stations that do not say theirs", false,
     APART_WORD(0, wh_layout_side_words)},
    {"theta", "waferhand.turning_axis", "the turn about the robot's axis", false},
    {"r", "waferhand.straight_axis", "the way out", false},
    {"forearm", "waferhand.turning_axis", "SCARA: the turn of the second link; 0 is stretched", false},
    {"z", "waferhand.straight_axis", "the height", false},
    {"yaw", "waferhand.turning_axis", "the turn of the wrist", false},
    {"loaded", "waferhand.loaded", "limits while a gripper on it carries a wafer", false},
    {"transit", NUMBER,
     "mm: blades and wafers stay within this circle about theta's axis while the robot turns", false,
     APART(1, 1e5, FOLLOWS), .otherwise = "none"},
    {"urdf", "string", "a URDF file, beside the layout: the shapes of the arm's links", false},
    {"joints", "table<string, string|waferhand.joint>", "what each joint of the URDF that moves follows",
     false},
    {"tool", "string", "the URDF's link that is the end-effector", false},
    {"tool2", "string", "the same of the second arm or wrist", false},
    {"packages", "table<string, string>", "folders of package:// in the URDF, by name", false},
    END};

const wh_reader_field_t wh_layout_joint_fields[] = {
    {"axis", "string",
     "an axis of the robot, or of a polar arm's links fold, shoulder, elbow or wrist; without it the joint "
     "stands",
     false},
    {"factor", NUMBER, "what the axis counts: -2 for a link that folds back twice as far", false,
     APART(-1e6, 1e6, 1)},
    {"offset", NUMBER, "degrees or mm: the joint's value where the axis is at 0", false, APART(-1e6, 1e6, 0)},
    END};

const wh_reader_field_t wh_layout_turning_axis_fields[] = {
    {"min", NUMBER, "degrees: where the travel begins", false, .otherwise = "by axis"},
    {"max", NUMBER, "degrees: where the travel ends", false, .otherwise = "by axis"},
    {"home", NUMBER, "degrees", false, .otherwise = "by axis"},
    {"speed", NUMBER, "degrees/s", false, APART(1e-6, 1e6, FOLLOWS), .otherwise = "by axis"},
    {"acceleration", NUMBER, "degrees/s^2", false, APART(1e-6, 1e8, FOLLOWS), .otherwise = "by axis"},
    {"jerk", NUMBER, "degrees/s^3", false, APART(1e-6, 1e10, FOLLOWS), .otherwise = "by axis"},
    END};

const wh_reader_field_t wh_layout_straight_axis_fields[] = {
    {"min", NUMBER, "mm: where the travel begins", false, .otherwise = "by axis"},
    {"max", NUMBER, "mm: where the travel ends", false, .otherwise = "by axis"},
    {"home", NUMBER, "mm", false, .otherwise = "by axis"},
    {"speed", NUMBER, "mm/s", false, APART(1e-6, 1e6, FOLLOWS), .otherwise = "by axis"},
    {"acceleration", NUMBER, "mm/s^2", false, APART(1e-6, 1e8, FOLLOWS), .otherwise = "by axis"},
    {"jerk", NUMBER, "mm/s^3", false, APART(1e-6, 1e10, FOLLOWS), .otherwise = "by axis"},
    END};

const wh_reader_field_t wh_layout_robot_arm_fields[] = {
    {"heading", NUMBER, "degrees: where it points when theta is 0", false, APART(-360, 360, 0)},
    {"height", NUMBER, "mm: of its contact plane above z", false, APART(-500, 500, 0)},
    END};

const wh_reader_field_t wh_layout_robot_wrist_fields[] = {
    {"heading", NUMBER, "degrees: how far its blade is turned at home", false, APART(-360, 360, 0)},
    {"height", NUMBER, "mm: of its contact plane above z", false, APART(-500, 500, 0)},
    END};

const wh_reader_field_t wh_layout_flip_axis_fields[] = {
    {"min", NUMBER, "degrees, at most 0: where the travel begins", false, APART(-360, 0, 0)},
    {"max", NUMBER, "degrees, at least 180: where the travel ends", false, APART(180, 360, 180)},
    {"height", NUMBER, "mm: its axis above the contact plane", false, APART(-500, 500, 0)},
    {"seconds", NUMBER, "s: what half a turn takes, in place of the three that follow", false,
     APART(0.05, 1000, FOLLOWS), .otherwise = "none"},
    {"speed", NUMBER, "degrees/s", false, APART(1e-6, 1e6, 180)},
    {"acceleration", NUMBER, "degrees/s^2", false, APART(1e-6, 1e8, 720)},
    {"jerk", NUMBER, "degrees/s^3", false, APART(1e-6, 1e10, 7200)},
    END};

const wh_reader_field_t wh_layout_chuck_fields[] = {
    {"speed", NUMBER, "degrees/s", false, APART(1e-6, 1e6, FOLLOWS), .otherwise = "yaw's"},
    {"acceleration", NUMBER, "degrees/s^2", false, APART(1e-6, 1e8, FOLLOWS), .otherwise = "yaw's"},
    {"jerk", NUMBER, "degrees/s^3", false, APART(1e-6, 1e10, FOLLOWS), .otherwise = "yaw's"},
    END};

const wh_reader_field_t wh_layout_gripper_fields[] = {
    {"name", "string", "how commands name it", true},
    {"on", "string", "what carries it: \"robot\", one of the robots by name, a prealigner or a flipper",
     false, .otherwise = "\"robot\""},
    {"arm", "integer", "of a robot with two arms: which one carries it, 1 or 2", false, APART(1, 2, 1)},
    {"wrist", "integer", "of a SCARA with two wrists: which one carries it, 1 or 2", false, APART(1, 2, 1)},
    {"valve", "string", "the name of the output that switches it", false},
    {"grip", "\"vacuum\"|\"edge\"|\"passive\"|waferhand.edge_grip",
     "what holds a wafer: vacuum, rests and a plunger, or its weight on pads", false,
     .otherwise = "\"vacuum\""},
    {"at", TRIPLE, "x, y, z in mm: where it sits on the end-effector", false, .otherwise = "0, 0, 0"},
    {"rpy", TRIPLE, "0, 0 and yaw in degrees", false, .otherwise = "0, 0, 0"},
    {"loaded", "waferhand.loaded", "limits while it carries a wafer", false, .otherwise = "the robot's"},
    {"stage", "waferhand.stage", "of a chuck: what moves it along the station's x and y", false},
    {"pins", "waferhand.pins", "this gripper is pins, which lift wafers off the prealigner's chuck", false},
    {"probe", "waferhand.probe", "a pin that feels the blocks of stations; one in a cell", false},
    {"flipper", "waferhand.flipper", "of a gripper on a flipper: how fast it turns over", false},
    END};

#define LIMITS(least, most, speed, acceleration, jerk)                                                       \
    {"speed", NUMBER, "mm/s", false, APART(least, most, speed)},                                             \
        {"acceleration", NUMBER, "mm/s^2", false, APART(least, 1e8, acceleration)}, {                        \
        "jerk", NUMBER, "mm/s^3", false, APART(least, 1e10, jerk)                                            \
    }

const wh_reader_field_t wh_layout_loaded_fields[] = {LIMITS(1, 1e6, FOLLOWS, FOLLOWS, FOLLOWS), END};

const wh_reader_field_t wh_layout_edge_grip_fields[] = {
    {"kind", "\"edge\"", "two rests and a plunger", false},
    {"rest", NUMBER, "mm: the radius of its rests", false, AS_NUMBER(wh_edge_t, rest, 0.1, 20, KEPT)},
    {"plunger", NUMBER, "mm: the radius of its plunger", false, AS_NUMBER(wh_edge_t, plunger, 0.1, 20, KEPT)},
    {"alpha", NUMBER, "degrees: the rests' directions to both sides of the blade's x", false,
     AS_DEGREES(wh_edge_t, alpha, 25, 60, KEPT)},
    {"clearance", NUMBER, "mm: how far off centre a wafer may lie", false,
     AS_NUMBER(wh_edge_t, clearance, 0, 10, FOLLOWS)},
    {"retracted", NUMBER, "mm, below 0: where the open plunger is; 0 is where it touches a nominal wafer",
     false, AS_NUMBER(wh_edge_t, retracted, -50, 0, FOLLOWS)},
    {"gripped_from", NUMBER, "mm: where the window in which a wafer is held begins", false,
     AS_NUMBER(wh_edge_t, gripped_from, -5, 5, FOLLOWS)},
    {"gripped_to", NUMBER, "mm: where that window ends", false,
     AS_NUMBER(wh_edge_t, gripped_to, -5, 5, FOLLOWS)},
    {"stroke", NUMBER, "mm: how far the plunger comes, from retracted", false,
     .otherwise = "12, at least to 1 beyond the window"},
    {"speed", NUMBER, "mm/s: of the plunger", false, AS_NUMBER(wh_edge_t, speed, 0.01, 1e4, KEPT)},
    END};

const wh_reader_field_t wh_layout_stage_fields[] = {
    {"travel", NUMBER, "mm: how far it goes to either side, along x and along y", false,
     APART(0.1, 1000, 10)},
    LIMITS(1e-6, 1e6, 50, 500, 5000),
    END};

const wh_reader_field_t wh_layout_pins_fields[] = {
    {"up", NUMBER, "mm: how far they come up above the chuck's plane", false, APART(0.6, 1000, 5)},
    {"down", NUMBER, "mm: how far below it they are at rest", false, APART(0.6, 1000, 3)},
    LIMITS(1e-6, 1e6, 50, 500, 5000),
    END};

const wh_reader_field_t wh_layout_flipper_fields[] = {
    {"seconds", NUMBER, "s: what half a turn takes, in place of the three that follow", false,
     APART(0.05, 1000, FOLLOWS), .otherwise = "none"},
    {"speed", NUMBER, "degrees/s", false, APART(1e-6, 1e6, 180)},
    {"acceleration", NUMBER, "degrees/s^2", false, APART(1e-6, 1e8, 720)},
    {"jerk", NUMBER, "degrees/s^3", false, APART(1e-6, 1e10, 7200)},
    END};

#define SHAPE_FIELDS                                                                                         \
    {"at", TRIPLE, "x, y, z in mm: its middle", true},                                                       \
        {"rpy", TRIPLE, "roll, pitch, yaw in degrees", false, .otherwise = "0, 0, 0"},                       \
        {"box", TRIPLE, "x, y, z in mm: its sizes", false},                                                  \
        {"cylinder", "waferhand.round", "along z", false},                                                   \
        {"capsule", "waferhand.round", "along z; the height is without its caps", false},                    \
        {"mesh", "string", "an STL file of a convex body, beside the layout", false}, {                      \
        "unit", WORD, "of the mesh, which wants it", false, APART_WORD(FOLLOWS, wh_layout_unit_words)        \
    }

const wh_reader_field_t wh_layout_door_fields[] = {
    SHAPE_FIELDS,
    {"open", TRIPLE, "x, y, z in mm, in base: how far the wall goes as the door opens", true},
    {"home", WORD, "how it is when a run begins", false, APART_WORD(0, wh_layout_door_words)},
    {"seconds", NUMBER, "s: what opening takes, in place of the three that follow", false,
     APART(0.05, 1000, FOLLOWS), .otherwise = "none"},
    LIMITS(1e-6, 1e4, 200, 800, 8000),
    {"timeout", NUMBER, "s: how long a command waits for it once it should be there", false,
     APART(0, 3600, 1)},
    END};

/* ------------------------------------------------------------------------------------------- collisions */

const wh_reader_field_t wh_layout_shapes_fields[] = {
    {"blade", "waferhand.blade", "a horseshoe below the wafer", false},
    {"arm", "waferhand.arm", "two links below the end-effector", false},
    {"arms", "table<string, waferhand.arm>", "with several robots: each one's arm, by name", false},
    {"ledge", "waferhand.ledge", "the two supports of a wafer in each slot", false},
    {"foup", "waferhand.foup", "the walls about a FOUP's wafers", false},
    {"chuck", "waferhand.spindle", "a prealigner's chuck and what it stands on", false},
    END};

const wh_reader_field_t wh_layout_blade_fields[] = {
    {"thickness", NUMBER, "mm", false, AS_NUMBER(wh_blade_t, thickness, 0.1, 50, KEPT)},
    {"half_width", NUMBER, "mm from its middle to its side", false,
     AS_NUMBER(wh_blade_t, half_width, 1, 500, KEPT)},
    {"finger", NUMBER, "mm: the width of a finger", false, AS_NUMBER(wh_blade_t, finger, 0.1, 495, FOLLOWS)},
    {"length", NUMBER, "mm by which the fingers reach before its origin", false,
     AS_NUMBER(wh_blade_t, length, 1, 1000, KEPT)},
    {"palm", NUMBER, "mm by which it ends behind its origin", false,
     AS_NUMBER(wh_blade_t, palm, 0.1, 1000, FOLLOWS)},
    END};

const wh_reader_field_t wh_layout_arm_fields[] = {
    {"reach", NUMBER, "mm from the wrist to the end-effector's origin", false,
     AS_NUMBER(wh_arm_t, reach, 0, 2000, KEPT), .hashed = WH_HASHED_ARM},
    {"link", NUMBER, "mm: the length of each link", false, AS_NUMBER(wh_arm_t, link, 10, 5000, KEPT),
     .hashed = WH_HASHED_ARM},
    {"right_handed", SWITCH, "true: the elbow is on the right", false,
     AS_SWITCH(wh_arm_t, right_handed, KEPT), .hashed = WH_HASHED_ARM},
    END};

const wh_reader_field_t wh_layout_ledge_fields[] = {
    {"inner", NUMBER, "mm beside the middle", false, AS_NUMBER(wh_ledge_t, inner, 0, 1998, FOLLOWS)},
    {"outer", NUMBER, "mm beside the middle", false, AS_NUMBER(wh_ledge_t, outer, 1, 2000, KEPT)},
    {"thickness", NUMBER, "mm", false, AS_NUMBER(wh_ledge_t, thickness, 0.05, 100, KEPT)},
    {"length", NUMBER, "mm", false, AS_NUMBER(wh_ledge_t, length, 0.1, 2000, KEPT)},
    END};

const wh_reader_field_t wh_layout_foup_fields[] = {
    {"room", NUMBER, "mm between a wafer's rim and the walls", false,
     AS_NUMBER(wh_shell_t, room, 0.1, 500, KEPT)},
    {"wall", NUMBER, "mm: their thickness", false, AS_NUMBER(wh_shell_t, wall, 0.1, 100, KEPT)},
    {"floor", NUMBER, "mm from the floor to the first slot", false,
     AS_NUMBER(wh_shell_t, floor, 1, 500, KEPT)},
    {"roof", NUMBER, "mm from the last slot to the roof", false, AS_NUMBER(wh_shell_t, roof, 1, 500, KEPT)},
    END};

const wh_reader_field_t wh_layout_spindle_fields[] = {
    {"radius", NUMBER, "mm: of the chuck", false, AS_NUMBER(wh_spindle_t, radius, 1, 500, KEPT)},
    {"height", NUMBER, "mm: of the chuck", false, AS_NUMBER(wh_spindle_t, height, 1, 200, KEPT)},
    {"body", NUMBER, "mm: the radius of the body that it stands on", false,
     AS_NUMBER(wh_spindle_t, body, 1, 1000, KEPT)},
    END};

const wh_reader_field_t wh_layout_obstacle_fields[] = {{"name", "string", "how hits name it", false},
                                                       {"on", "string",
                                                        "what carries it: \"base\", \"lift\", \"upper arm\", "
                                                        "\"forearm\", \"hand\", a gripper's or a door's name",
                                                        false, .otherwise = "\"base\""},
                                                       SHAPE_FIELDS,
                                                       END};

const wh_reader_field_t wh_layout_round_fields[] = {
    {"radius", NUMBER, "mm", true, APART(WH_CONVEX_THINNEST, 1e4, ASKED)},
    {"height", NUMBER, "mm", true},
    END};

const wh_reader_field_t wh_layout_clearance_fields[] = {
    {"blade_wafer_above", NUMBER, "mm from a blade to the wafer above it", false,
     APART(0, WH_CLEARANCE_RANGE, 0)},
    {"blade_wafer_below", NUMBER, "mm from a blade to the wafer below it", false,
     APART(0, WH_CLEARANCE_RANGE, 0)},
    {"blade_other", NUMBER, "mm from a blade to ledges, chucks, walls", false,
     APART(0, WH_CLEARANCE_RANGE, 0)},
    {"wafer_wafer", NUMBER, "mm from a held wafer to another one", false, APART(0, WH_CLEARANCE_RANGE, 0)},
    {"wafer_ledge", NUMBER, "mm from a held wafer to a ledge", false, APART(0, WH_CLEARANCE_RANGE, 0)},
    {"wafer_other", NUMBER, "mm from a held wafer to the rest", false, APART(0, WH_CLEARANCE_RANGE, 0)},
    {"arm_other", NUMBER, "mm from the arm to the rest", false, APART(0, WH_CLEARANCE_RANGE, 0)},
    {"arm_itself", NUMBER, "mm from the arm to its own blades and what they hold", false,
     APART(0, WH_CLEARANCE_RANGE, 0)},
    END};
