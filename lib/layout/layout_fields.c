#include "layout_fields.h"

#define NUMBER "number"
#define TRIPLE "number[]"
#define SWITCH "boolean"
#define SHAPE "\"normal\"|\"uniform\""
#define END                                                                                                  \
    { NULL, NULL, NULL, false }

/* --------------------------------------------------------------------------------------------- the cell */

const wh_reader_field_t wh_layout_top_fields[] = {
    {"wafer", "waferhand.wafer_size", "the wafers' size", false},
    {"tolerance", "\"paper\"|\"strict\"|waferhand.tolerance", "when a gripper may take a wafer", false},
    {"near", "waferhand.near", "how near a miss must be to be reported", false},
    {"check", "\"sampled\"|\"swept\"", "if the check runs between slices, too", false},
    {"slice", NUMBER, "s: the length of a slice, a whole number of microseconds", false},
    {"seat", SWITCH, "true: the pick draws the wafer onto the pads", false},
    {"settle", SWITCH, "true: a wafer let go above a slot comes to lie on it", false},
    {"placing", "waferhand.placing", "the limits above which a wafer's place is reported", false},
    {"collision", SWITCH, "true: look for collisions while stepping", false},
    {"look_ahead", SWITCH, "true: a command that would collide is refused", false},
    {"robot", "waferhand.robot", "the robot's axes", false},
    {"robots", "table<string, waferhand.robot>", "several robots by name, in place of robot", false},
    {"homed", SWITCH, "false: HOME comes first", false},
    {"doors", "table<string, waferhand.door>", "walls that move, by name", false},
    {"chuck", "waferhand.chuck", "the limits of the prealigners' chucks", false},
    {"grippers", "waferhand.gripper[]", "blades on the robot, and one on each prealigner", true},
    {"stations", "table<string, waferhand.station>", "the stations by name", true},
    {"wafers", "waferhand.wafer[]", "where wafers lie when a run begins", false},
    {"shapes", "waferhand.shapes", "sizes of blade, ledges, arm, FOUPs and chucks", false},
    {"obstacles", "waferhand.obstacle[]", "walls, tables, tools on the robot", false},
    {"clearance", "waferhand.clearance", "gaps that must be kept", false},
    {"vacuum", "\"ideal\"|\"delayed\"|waferhand.vacuum", "how the vacuum builds up and falls", false},
    {"pads", "waferhand.pads", "what the pads hold: a wafer that would slip is named", false},
    {"faults", "waferhand.fault[]", "faults on purpose", false},
    {"study", "waferhand.study", "what the trials of a study draw", false},
    {"corrections", "waferhand.corrections", "how far a command may go beside what was taught", false},
    {"mapping", "waferhand.mapping", "where the beams of MAP stand and how they judge", false},
    END};

const wh_reader_field_t wh_layout_wafer_size_fields[] = {{"diameter", NUMBER, "mm", false},
                                                         {"thickness", NUMBER, "mm", false},
                                                         {"spread", NUMBER,
                                                          "mm: standard deviation of true diameters, which "
                                                          "centring allows for; 0: none",
                                                          false},
                                                         {"notch", "waferhand.notch", "the notch", false},
                                                         END};

const wh_reader_field_t wh_layout_notch_fields[] = {
    {"at", NUMBER, "degrees about the wafer's axis, from its x", false}, {"depth", NUMBER, "mm", false}, END};

const wh_reader_field_t wh_layout_tolerance_fields[] = {
    {"projz", NUMBER, "mm: the limit of |dr_proj_z|", false},
    {"projxy", NUMBER, "mm: the limit of |dr_proj_xy|", false},
    {"planar", NUMBER, "the limit of n1_proj_n2, a cosine", false},
    END};

const wh_reader_field_t wh_layout_near_fields[] = {
    {"projz", NUMBER, "mm", false}, {"projxy", NUMBER, "mm", false}, END};

const wh_reader_field_t wh_layout_placing_fields[] = {
    {"off_centre", NUMBER, "mm beside the slot's centre; 0: never", false},
    {"askew", NUMBER, "degrees of tilt; 0: never", false},
    {"drop", NUMBER, "mm above the slot as it is let go, 0.5; 0: any height is good", false},
    END};

const wh_reader_field_t wh_layout_corrections_fields[] = {{"x", NUMBER, "mm", false},
                                                          {"y", NUMBER, "mm", false},
                                                          {"z", NUMBER, "mm", false},
                                                          {"turn", NUMBER, "degrees", false},
                                                          END};

const wh_reader_field_t wh_layout_mapping_fields[] = {
    {"x", NUMBER, "0 to 0.8: the beams before the slot's middle, a share of the wafers' radius", false},
    {"y", NUMBER, "the beams to either side, likewise; both are within the rim", false},
    {"crossed", NUMBER, "0.01 to 0.5: a wafer farther from its slot's plane is crossed, a share of the pitch",
     false},
    {"level", NUMBER, "mm: a wafer that the beams see so far apart in height is crossed; 0: half the pitch",
     false},
    {"protruded", NUMBER, "mm: a wafer farther out towards the arm is protruded", false},
    {"thinnest", NUMBER, "mm: a wafer below it is thin", false},
    {"thickest", NUMBER, "mm: a wafer above it is thick", false},
    END};

const wh_reader_field_t wh_layout_vacuum_fields[] = {
    {"model", "\"ideal\"|\"delayed\"", "whose values the other fields have by default", false},
    {"build", NUMBER, "s: time constant upwards", false},
    {"vent", NUMBER, "s: time constant downwards", false},
    {"idle", NUMBER, "0 to 1: the level of an open valve without a wafer", false},
    {"sensor_on", NUMBER, "0 to 1: the level at which the sensor goes on", false},
    {"sensor_off", NUMBER, "0 to 1: the level below which the sensor goes off", false},
    {"release", NUMBER, "0 to 1: the level below which a closed valve lets go", false},
    {"debounce", NUMBER, "ms for which the sensor's switch must stand until it is told", false},
    END};

const wh_reader_field_t wh_layout_pads_fields[] = {
    {"friction", NUMBER, "the coefficient between pads and wafer", true},
    {"force", NUMBER, "N: the force of the full vacuum", true},
    {"mass", NUMBER, "kg: of a wafer", false},
    {"gravity", NUMBER, "m/s^2, along -z of base", false},
    END};

/* -------------------------------------------------------------------------------------------- the robot */

const wh_reader_field_t wh_layout_robot_fields[] = {
    {"kind", "\"TRZY\"|\"TRZ\"|\"SCARA\"",
     "TRZY: theta, R, Z and a yaw axis at the wrist; TRZ: without yaw; SCARA: two links", false},
    {"at", TRIPLE, "x, y, z in mm, in base: where the robot stands", false},
    {"heading", NUMBER, "degrees: where its x points, which is theta's zero and the rail's way", false},
    {"rail", "waferhand.straight_axis", "the way along the robot's x; without it there is none", false},
    {"tilt", "waferhand.turning_axis", "of the column about x and about y; without it the robot keeps level",
     false},
    {"flip", "waferhand.flip_axis", "the turn of the blade about its x; without it the blade stays face up",
     false},
    {"arms", "waferhand.robot_arm[]", "TRZ: one or two, each with an r of its own over one theta and z",
     false},
    {"wrists", "waferhand.robot_wrist[]", "SCARA: one or two, each with a yaw of its own", false},
    {"links", "number[]", "mm, SCARA: from the shoulder to the elbow, from there to the wrist", false},
    {"elbow", "\"left\"|\"right\"", "SCARA: its side at stations that do not say theirs", false},
    {"theta", "waferhand.turning_axis", "the turn about the robot's axis", false},
    {"r", "waferhand.straight_axis", "the way out", false},
    {"forearm", "waferhand.turning_axis", "SCARA: the turn of the second link; 0 is stretched", false},
    {"z", "waferhand.straight_axis", "the height", false},
    {"yaw", "waferhand.turning_axis", "the turn of the wrist", false},
    {"loaded", "waferhand.loaded", "limits while a gripper on it carries a wafer", false},
    {"transit", NUMBER,
     "mm: blades and wafers stay within this circle about theta's axis while the robot turns", false},
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
    {"factor", NUMBER, "what the axis counts: -2 for a link that folds back twice as far", false},
    {"offset", NUMBER, "degrees or mm: the joint's value where the axis is at 0", false},
    END};

const wh_reader_field_t wh_layout_turning_axis_fields[] = {
    {"min", NUMBER, "degrees: where the travel begins", false},
    {"max", NUMBER, "degrees: where the travel ends", false},
    {"home", NUMBER, "degrees", false},
    {"speed", NUMBER, "degrees/s", false},
    {"acceleration", NUMBER, "degrees/s^2", false},
    {"jerk", NUMBER, "degrees/s^3", false},
    END};

const wh_reader_field_t wh_layout_straight_axis_fields[] = {
    {"min", NUMBER, "mm: where the travel begins", false},
    {"max", NUMBER, "mm: where the travel ends", false},
    {"home", NUMBER, "mm", false},
    {"speed", NUMBER, "mm/s", false},
    {"acceleration", NUMBER, "mm/s^2", false},
    {"jerk", NUMBER, "mm/s^3", false},
    END};

const wh_reader_field_t wh_layout_robot_arm_fields[] = {
    {"heading", NUMBER, "degrees: where it points when theta is 0", false},
    {"height", NUMBER, "mm: of its contact plane above z", false},
    END};

const wh_reader_field_t wh_layout_robot_wrist_fields[] = {
    {"heading", NUMBER, "degrees: how far its blade is turned at home", false},
    {"height", NUMBER, "mm: of its contact plane above z", false},
    END};

const wh_reader_field_t wh_layout_flip_axis_fields[] = {
    {"min", NUMBER, "degrees, at most 0: where the travel begins", false},
    {"max", NUMBER, "degrees, at least 180: where the travel ends", false},
    {"height", NUMBER, "mm: its axis above the contact plane", false},
    {"seconds", NUMBER, "s: what half a turn takes, in place of the three that follow", false},
    {"speed", NUMBER, "degrees/s", false},
    {"acceleration", NUMBER, "degrees/s^2", false},
    {"jerk", NUMBER, "degrees/s^3", false},
    END};

const wh_reader_field_t wh_layout_chuck_fields[] = {{"speed", NUMBER, "degrees/s", false},
                                                    {"acceleration", NUMBER, "degrees/s^2", false},
                                                    {"jerk", NUMBER, "degrees/s^3", false},
                                                    END};

const wh_reader_field_t wh_layout_gripper_fields[] = {
    {"name", "string", "how commands name it", true},
    {"on", "string", "what carries it: \"robot\", one of the robots by name, a prealigner or a flipper",
     false},
    {"arm", "integer", "of a robot with two arms: which one carries it, 1 or 2", false},
    {"wrist", "integer", "of a SCARA with two wrists: which one carries it, 1 or 2", false},
    {"valve", "string", "the name of the output that switches it", false},
    {"grip", "\"vacuum\"|\"edge\"|\"passive\"|waferhand.edge_grip",
     "what holds a wafer: vacuum, rests and a plunger, or its weight on pads", false},
    {"at", TRIPLE, "x, y, z in mm: where it sits on the end-effector", false},
    {"rpy", TRIPLE, "0, 0 and yaw in degrees", false},
    {"loaded", "waferhand.loaded", "limits while it carries a wafer", false},
    {"stage", "waferhand.stage", "of a chuck: what moves it along the station's x and y", false},
    {"pins", "waferhand.pins", "this gripper is pins, which lift wafers off the prealigner's chuck", false},
    {"probe", "waferhand.probe", "a pin that feels the blocks of stations; one in a cell", false},
    {"flipper", "waferhand.flipper", "of a gripper on a flipper: how fast it turns over", false},
    END};

#define LIMITS                                                                                               \
    {"speed", NUMBER, "mm/s", false}, {"acceleration", NUMBER, "mm/s^2", false}, {                           \
        "jerk", NUMBER, "mm/s^3", false                                                                      \
    }

const wh_reader_field_t wh_layout_loaded_fields[] = {LIMITS, END};

const wh_reader_field_t wh_layout_edge_grip_fields[] = {
    {"kind", "\"edge\"", "two rests and a plunger", false},
    {"rest", NUMBER, "mm: the radius of its rests", false},
    {"plunger", NUMBER, "mm: the radius of its plunger", false},
    {"alpha", NUMBER, "degrees: the rests' directions to both sides of the blade's x", false},
    {"clearance", NUMBER, "mm: how far off centre a wafer may lie", false},
    {"retracted", NUMBER, "mm, below 0: where the open plunger is; 0 is where it touches a nominal wafer",
     false},
    {"gripped_from", NUMBER, "mm: where the window in which a wafer is held begins", false},
    {"gripped_to", NUMBER, "mm: where that window ends", false},
    {"stroke", NUMBER, "mm: how far the plunger comes, from retracted", false},
    {"speed", NUMBER, "mm/s: of the plunger", false},
    END};

const wh_reader_field_t wh_layout_stage_fields[] = {
    {"travel", NUMBER, "mm: how far it goes to either side, along x and along y", false}, LIMITS, END};

const wh_reader_field_t wh_layout_pins_fields[] = {
    {"up", NUMBER, "mm: how far they come up above the chuck's plane", false},
    {"down", NUMBER, "mm: how far below it they are at rest", false},
    LIMITS,
    END};

const wh_reader_field_t wh_layout_flipper_fields[] = {
    {"seconds", NUMBER, "s: what half a turn takes, in place of the three that follow", false},
    {"speed", NUMBER, "degrees/s", false},
    {"acceleration", NUMBER, "degrees/s^2", false},
    {"jerk", NUMBER, "degrees/s^3", false},
    END};

#define SHAPE_FIELDS                                                                                         \
    {"at", TRIPLE, "x, y, z in mm: its middle", true},                                                       \
        {"rpy", TRIPLE, "roll, pitch, yaw in degrees", false},                                               \
        {"box", TRIPLE, "x, y, z in mm: its sizes", false},                                                  \
        {"cylinder", "waferhand.round", "along z", false},                                                   \
        {"capsule", "waferhand.round", "along z; the height is without its caps", false},                    \
        {"mesh", "string", "an STL file of a convex body, beside the layout", false}, {                      \
        "unit", "\"mm\"|\"cm\"|\"m\"|\"inch\"", "of the mesh, which wants it", false                         \
    }

const wh_reader_field_t wh_layout_door_fields[] = {
    SHAPE_FIELDS,
    {"open", TRIPLE, "x, y, z in mm, in base: how far the wall goes as the door opens", true},
    {"home", "\"shut\"|\"open\"", "how it is when a run begins", false},
    {"seconds", NUMBER, "s: what opening takes, in place of the three that follow", false},
    LIMITS,
    {"timeout", NUMBER, "s: how long a command waits for it once it should be there", false},
    END};

/* ---------------------------------------------------------------------------------- stations and wafers */

const wh_reader_field_t wh_layout_station_fields[] = {
    {"kind", "\"slots\"|\"prealigner\"|\"foup\"|\"flipper\"", "what stands there", false},
    {"at", TRIPLE, "x, y, z in mm, in base: the centre of a wafer's back face in slot 1; or `axes` says it",
     false},
    {"rpy", TRIPLE, "roll, pitch, yaw in degrees: x is the way in, z goes up through the slots", false},
    {"axes", "waferhand.axes", "in place of `at` and `rpy`: where the axes stand with the gripper in slot 1",
     false},
    {"taught", SWITCH, "false: every command at the station is refused", false},
    {"slots", "integer", "how many", false},
    {"pitch", NUMBER, "mm from slot to slot", false},
    {"effector", "string", "the gripper that serves it, unless a command names another", false},
    {"stroke", NUMBER, "mm: the height of the stroke", false},
    {"offset", NUMBER, "mm above the slot at which a GET leaves", false},
    {"retract", NUMBER, "mm before the slot, where the straight way in begins", false},
    {"pickup_speed", NUMBER, "mm/s: of the strokes", false},
    {"pickup_acceleration", NUMBER, "mm/s^2: of the strokes; 0: what the axes allow", false},
    {"release", NUMBER, "mm above the slot at which a PUT switches the valves", false},
    {"vacuum_delay", NUMBER, "s from the end of the stroke until the sensor is asked", false},
    {"vacuum_check", "\"both\"|\"get\"|\"put\"|\"none\"", "the commands that the sensor decides", false},
    {"timeout", NUMBER, "s: how long a command waits for the sensor", false},
    {"retries", "integer", "how often a GET that took nothing tries again", false},
    {"wait", NUMBER, "s: how long the arm stands in the station before the stroke", false},
    {"map_speed", NUMBER, "mm/s: of the sweep over the slots", false},
    {"check_map", SWITCH, "true: GET and PUT want a MAP before them", false},
    {"handover", "\"new_first\"|\"same_slice\"", "at a chuck: the order of the two valves", false},
    {"face", "\"up\"|\"down\"", "how wafers must lie there; without it either way", false},
    {"counts", SWITCH, "true: a wafer that is put here is done, for wafers per hour", false},
    {"sensor", "waferhand.sensor", "at a prealigner: what sees the wafer's edge", false},
    {"beams", "waferhand.beam[]", "light at the door, which wafers break on their way", false},
    {"centre", SWITCH, "true: a PUT corrects by what the beams say of the wafer", false},
    {"block", "waferhand.block", "what a probe touches to teach the station", false},
    {"rail", NUMBER, "mm: where the robot's rail stands for it", false},
    {"elbow", "\"left\"|\"right\"", "the side of a SCARA's elbow there", false},
    {"door", "string", "the door through which wafers come, by name", false},
    {"pins", "string", "the pins that lift wafers off its chuck, by name", false},
    {"via", "waferhand.via[]", "where the arm passes on its way there, and back on its way away", false},
    {"by", "table<string, waferhand.approach>", "with several robots: those that serve it, by name", false},
    END};

const wh_reader_field_t wh_layout_approach_fields[] = {
    {"rpy", TRIPLE, "roll, pitch, yaw in degrees, in base: x is this robot's way in", false},
    {"at", TRIPLE, "where it was taught slot 1, mm, in base, up to 5 mm beside the station's own `at`",
     false},
    {"axes", "waferhand.axes", "where its axes stand with its gripper in slot 1", false},
    {"rail", NUMBER, "mm: where its rail stands for it", false},
    {"elbow", "\"left\"|\"right\"", "the side of a SCARA's elbow there", false},
    {"door", "string", "the door through which it comes, by name", false},
    {"via", "waferhand.via[]", "where it passes on its way there, and back on its way away", false},
    END};

const wh_reader_field_t wh_layout_axes_fields[] = {
    {"theta", NUMBER, "degrees: where the axis stands", false},
    {"r", NUMBER, "mm, of two arms that of the one that goes there", false},
    {"forearm", NUMBER, "degrees, of a SCARA", false},
    {"z", NUMBER, "mm", false},
    {"yaw", NUMBER, "degrees, of two wrists that of the one that goes there", false},
    {"rail", NUMBER, "mm", false},
    {"tilt_x", NUMBER, "degrees", false},
    {"tilt_y", NUMBER, "degrees", false},
    END};

const wh_reader_field_t wh_layout_wafer_fields[] = {
    {"name", "string", "how commands name it", false},
    {"station", "string", "the station in which it lies", true},
    {"slot", "integer", "from 1, at the bottom", true},
    {"dx", NUMBER, "mm off the slot's centre, along its x", false},
    {"dy", NUMBER, "mm off the slot's centre, along its y", false},
    {"dz", NUMBER, "mm above the slot", false},
    {"rpy", TRIPLE, "roll, pitch, yaw in degrees, in the slot's frame", false},
    {"face", "\"up\"|\"down\"", "the way it lies; without it as its station says, else up", false},
    {"thickness", NUMBER, "mm: what MAP measures; all else goes by that of `wafer`", false},
    {"rim", "waferhand.rim", "its true rim, which edge sensors and beams see, and edge grips meet", false},
    END};

/* ------------------------------------------------------------------------- edge sensors, beams and rims */

const wh_reader_field_t wh_layout_via_fields[] = {
    {"theta", NUMBER,
     "degrees, of two arms where the one points that goes to the station; an axis that is not given is as in "
     "front of the station",
     false},
    {"r", NUMBER, "mm, of two arms that of the one that goes to the station", false},
    {"forearm", NUMBER, "degrees, of a SCARA", false},
    {"z", NUMBER, "mm", false},
    {"yaw", NUMBER, "degrees, of two wrists that of the one that goes to the station", false},
    {"rail", NUMBER, "mm", false},
    {"blend", NUMBER, "mm: how near the arm passes; 0: it stops there", false},
    END};

const wh_reader_field_t wh_layout_beam_fields[] = {
    {"x", NUMBER, "mm along the way in from the slot's centre, below 0 before it", false},
    {"y", NUMBER, "mm across the way, to the left", true},
    {"low", NUMBER, "mm above slot 1 where it begins", false},
    {"high", NUMBER, "mm above slot 1 where it ends", false},
    {"sd", NUMBER, "mm: how well x and y are known, standard deviation", false},
    {"delay_on", NUMBER, "s from being broken to the latch", false},
    {"delay_off", NUMBER, "s from being free to the latch", false},
    {"jitter", NUMBER, "s: standard deviation of both delays", false},
    {"seed", "integer", "names the jitter, with the number of the arming", false},
    {"dx", NUMBER, "mm by which it truly stands farther in than motion control believes", false},
    {"dy", NUMBER, "mm by which it truly stands farther to the left", false},
    {"late", NUMBER, "s by which both delays are truly longer", false},
    {"stuck", "\"no\"|\"dark\"|\"lit\"", "what a beam always says that is broken down", false},
    END};

const wh_reader_field_t wh_layout_block_fields[] = {
    {"at", TRIPLE, "x, y, z in mm, in the station's frame: the middle of its upper face", false},
    {"size", TRIPLE, "mm along the station's x, y and z", false},
    END};

const wh_reader_field_t wh_layout_probe_fields[] = {
    {"at", TRIPLE, "x, y, z in mm, in the gripper's frame: the middle of its ball", false},
    {"radius", NUMBER, "mm: of the ball", false},
    {"noise", NUMBER, "mm: of where a touch closes the switch, standard deviation", false},
    {"seed", "integer", "names the noise, with the number of the arming", false},
    {"stuck", "\"no\"|\"closed\"|\"open\"", "what a switch always says that is broken down", false},
    END};

const wh_reader_field_t wh_layout_sensor_fields[] = {
    {"samples", "integer", "how many in a turn", false},
    {"pixel", NUMBER, "mm: a pixel's length", false},
    {"length", NUMBER, "mm: the line's length", false},
    {"noise", NUMBER, "mm: standard deviation of one sample", false},
    {"seed", "integer", "names the noise, with the number of the scan", false},
    {"at", NUMBER, "degrees: where the line points from the chuck's axis, about the station's z", false},
    {"encoder", "integer", "counts in a turn of the chuck; 0: no steps", false},
    {"offset", NUMBER, "mm by which the line passes the axis, to the left", false},
    {"zero", NUMBER, "mm by which its inner end is farther out", false},
    {"gain", NUMBER, "the part of their length by which pixels are longer", false},
    {"latency", NUMBER, "s by which a sample is taken later than it is due", false},
    {"believed", "waferhand.believed", "what motion control takes these four to be: 0 without it", false},
    {"tilt", NUMBER, "degrees of its light out of the upright, outwards going up", false},
    {"hidden", "waferhand.arc[]", "arcs of the chuck in which something covers the line", false},
    END};

const wh_reader_field_t wh_layout_believed_fields[] = {
    {"offset", NUMBER, "mm", false},
    {"zero", NUMBER, "mm", false},
    {"gain", NUMBER, "a part of the pixels' length", false},
    {"latency", NUMBER, "s", false},
    END};

const wh_reader_field_t wh_layout_arc_fields[] = {
    {"from", NUMBER, "degrees", true}, {"width", NUMBER, "degrees", true}, END};

const wh_reader_field_t wh_layout_rim_fields[] = {
    {"diameter", NUMBER, "mm", false},
    {"notch", "waferhand.rim_notch", "the notch", false},
    {"flats", "waferhand.flat[]", "the flats", false},
    {"chips", "waferhand.chip[]", "what is broken off", false},
    {"bow", NUMBER, "mm: how far the rim is above the centre, the same all round", false},
    {"saddle", NUMBER, "mm: how far the rim is above the centre, twice up and down", false},
    {"saddle_at", NUMBER, "degrees: where the saddle is highest", false},
    {"glass", NUMBER, "0 to 0.9: the part of the light that comes through", false},
    END};

const wh_reader_field_t wh_layout_rim_notch_fields[] = {
    {"at", NUMBER, "degrees about the wafer's axis, from its x", false},
    {"depth", NUMBER, "mm; 0: none", false},
    {"angle", NUMBER, "degrees between its flanks", false},
    {"bottom", NUMBER, "mm: the radius at its bottom", false},
    {"corner", NUMBER, "mm: the radius where it meets the rim", false},
    END};

const wh_reader_field_t wh_layout_flat_fields[] = {
    {"at", NUMBER, "degrees about the wafer's axis, from its x", true}, {"length", NUMBER, "mm", true}, END};

const wh_reader_field_t wh_layout_chip_fields[] = {
    {"at", NUMBER, "degrees about the wafer's axis, from its x", true},
    {"width", NUMBER, "mm along the rim", true},
    {"depth", NUMBER, "mm", true},
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
    {"thickness", NUMBER, "mm", false},
    {"half_width", NUMBER, "mm from its middle to its side", false},
    {"finger", NUMBER, "mm: the width of a finger", false},
    {"length", NUMBER, "mm by which the fingers reach before its origin", false},
    {"palm", NUMBER, "mm by which it ends behind its origin", false},
    END};

const wh_reader_field_t wh_layout_arm_fields[] = {
    {"reach", NUMBER, "mm from the wrist to the end-effector's origin", false},
    {"link", NUMBER, "mm: the length of each link", false},
    {"right_handed", SWITCH, "true: the elbow is on the right", false},
    END};

const wh_reader_field_t wh_layout_ledge_fields[] = {{"inner", NUMBER, "mm beside the middle", false},
                                                    {"outer", NUMBER, "mm beside the middle", false},
                                                    {"thickness", NUMBER, "mm", false},
                                                    {"length", NUMBER, "mm", false},
                                                    END};

const wh_reader_field_t wh_layout_foup_fields[] = {
    {"room", NUMBER, "mm between a wafer's rim and the walls", false},
    {"wall", NUMBER, "mm: their thickness", false},
    {"floor", NUMBER, "mm from the floor to the first slot", false},
    {"roof", NUMBER, "mm from the last slot to the roof", false},
    END};

const wh_reader_field_t wh_layout_spindle_fields[] = {
    {"radius", NUMBER, "mm: of the chuck", false},
    {"height", NUMBER, "mm: of the chuck", false},
    {"body", NUMBER, "mm: the radius of the body that it stands on", false},
    END};

const wh_reader_field_t wh_layout_obstacle_fields[] = {{"name", "string", "how hits name it", false},
                                                       {"on", "string",
                                                        "what carries it: \"base\", \"lift\", \"upper arm\", "
                                                        "\"forearm\", \"hand\", a gripper's or a door's name",
                                                        false},
                                                       SHAPE_FIELDS,
                                                       END};

const wh_reader_field_t wh_layout_round_fields[] = {
    {"radius", NUMBER, "mm", true}, {"height", NUMBER, "mm", true}, END};

const wh_reader_field_t wh_layout_clearance_fields[] = {
    {"blade_wafer_above", NUMBER, "mm from a blade to the wafer above it", false},
    {"blade_wafer_below", NUMBER, "mm from a blade to the wafer below it", false},
    {"blade_other", NUMBER, "mm from a blade to ledges, chucks, walls", false},
    {"wafer_wafer", NUMBER, "mm from a held wafer to another one", false},
    {"wafer_ledge", NUMBER, "mm from a held wafer to a ledge", false},
    {"wafer_other", NUMBER, "mm from a held wafer to the rest", false},
    {"arm_other", NUMBER, "mm from the arm to the rest", false},
    {"arm_itself", NUMBER, "mm from the arm to its own blades and what they hold", false},
    END};

/* ----------------------------------------------------------------------------------------------- faults */

#define OF_EVERY_FAULT                                                                                       \
    {"after", NUMBER, "s until it begins", false}, {                                                         \
        "lasting", NUMBER, "s; without it until it is cleared", false                                        \
    }
#define GRIPPER                                                                                              \
    { "gripper", "string", "whose; without it the first on the robot", false }
#define DOOR                                                                                                 \
    { "door", "string", "which", true }
#define WAFER                                                                                                \
    { "wafer", "string", "which", true }

static const wh_reader_field_t of_gripper[] = {
    {"kind", "\"no_vacuum\"|\"sensor_on\"|\"sensor_off\"|\"valve_stuck\"|\"axis_stopped\"|\"plunger_stuck\"",
     "what happens: no vacuum; a sensor, a valve, the axes or the plunger of an edge grip are stuck", true},
    OF_EVERY_FAULT,
    GRIPPER,
    END};
static const wh_reader_field_t slow_plunger[] = {
    {"kind", "\"plunger_slow\"", "the plunger of an edge grip is slow", true},
    OF_EVERY_FAULT,
    GRIPPER,
    {"value", NUMBER, "mm/s: it goes no faster", true},
    END};
static const wh_reader_field_t slow_vacuum[] = {{"kind", "\"slow_vacuum\"", "the vacuum is slow", true},
                                                OF_EVERY_FAULT,
                                                GRIPPER,
                                                {"value", NUMBER, "s: the time constant upwards", true},
                                                END};
static const wh_reader_field_t leak[] = {{"kind", "\"leak\"", "the vacuum leaks", true},
                                         OF_EVERY_FAULT,
                                         GRIPPER,
                                         {"value", NUMBER, "0 to 1: the highest level", true},
                                         END};
static const wh_reader_field_t of_command[] = {
    {"kind", "\"command_lost\"", "all grippers and valves stay as they were", true}, OF_EVERY_FAULT, END};
static const wh_reader_field_t door_stuck[] = {
    {"kind", "\"door_stuck\"", "a door stays where it is", true}, OF_EVERY_FAULT, DOOR, END};
static const wh_reader_field_t door_slow[] = {{"kind", "\"door_slow\"", "a door is slow", true},
                                              OF_EVERY_FAULT,
                                              DOOR,
                                              {"value", NUMBER, "mm/s: as fast as it goes", true},
                                              END};
#define STATION                                                                                              \
    { "station", "string", "whose", true }
#define BEAM                                                                                                 \
    STATION, {                                                                                               \
        "beam", "integer", "which of the station's beams, from 1", false                                     \
    }
static const wh_reader_field_t of_beam[] = {
    {"kind", "\"beam_dark\"|\"beam_lit\"", "a beam at a door is broken down", true},
    OF_EVERY_FAULT,
    BEAM,
    END};
static const wh_reader_field_t late_beam[] = {
    {"kind", "\"beam_late\"", "the latches of a beam are late", true},
    OF_EVERY_FAULT,
    BEAM,
    {"value", NUMBER, "s by which they are", true},
    END};
static const wh_reader_field_t of_probe[] = {
    {"kind", "\"probe_closed\"|\"probe_open\"", "the switch of the cell's probe is stuck", true},
    OF_EVERY_FAULT,
    END};
static const wh_reader_field_t of_edge_sensor[] = {
    {"kind", "\"edge_sensor_stuck\"|\"edge_sensor_late\"",
     "the samples of an edge sensor are all the same, or late", true},
    OF_EVERY_FAULT,
    STATION,
    {"value", NUMBER,
     "stuck: the part of its line that seems to be covered, 0 to 1; late: s by which they are", true},
    END};
static const wh_reader_field_t missing[] = {
    {"kind", "\"wafer_missing\"", "the wafer is taken out of the cell", true}, OF_EVERY_FAULT, WAFER, END};
static const wh_reader_field_t doubled[] = {
    {"kind", "\"wafer_doubled\"", "the wafer lies on another one, in the same slot", true},
    OF_EVERY_FAULT,
    WAFER,
    {"onto", "string", "the other wafer", true},
    END};
static const wh_reader_field_t crossed[] = {
    {"kind", "\"wafer_crossed\"", "one edge lies higher than the other", true},
    OF_EVERY_FAULT,
    WAFER,
    {"value", NUMBER, "mm by which it does", false},
    END};
static const wh_reader_field_t shifted[] = {
    {"kind", "\"wafer_shifted\"", "the wafer is moved, in its own frame", true},
    OF_EVERY_FAULT,
    WAFER,
    {"dx", NUMBER, "mm", false},
    {"dy", NUMBER, "mm", false},
    {"dz", NUMBER, "mm", false},
    END};
static const wh_reader_field_t tilted[] = {
    {"kind", "\"wafer_tilted\"", "the wafer is turned, in its own frame", true},
    OF_EVERY_FAULT,
    WAFER,
    {"rpy", TRIPLE, "roll, pitch, yaw in degrees", true},
    END};

const wh_reader_field_t *const wh_layout_fault_fields[WH_FAULT_KINDS] = {
    [WH_FAULT_NO_VACUUM] = of_gripper,
    [WH_FAULT_SLOW_VACUUM] = slow_vacuum,
    [WH_FAULT_SENSOR_ON] = of_gripper,
    [WH_FAULT_SENSOR_OFF] = of_gripper,
    [WH_FAULT_LEAK] = leak,
    [WH_FAULT_VALVE_STUCK] = of_gripper,
    [WH_FAULT_AXIS_STOPPED] = of_gripper,
    [WH_FAULT_COMMAND_LOST] = of_command,
    [WH_FAULT_WAFER_MISSING] = missing,
    [WH_FAULT_WAFER_DOUBLED] = doubled,
    [WH_FAULT_WAFER_CROSSED] = crossed,
    [WH_FAULT_WAFER_SHIFTED] = shifted,
    [WH_FAULT_WAFER_TILTED] = tilted,
    [WH_FAULT_PLUNGER_STUCK] = of_gripper,
    [WH_FAULT_PLUNGER_SLOW] = slow_plunger,
    [WH_FAULT_DOOR_STUCK] = door_stuck,
    [WH_FAULT_DOOR_SLOW] = door_slow,
    [WH_FAULT_BEAM_DARK] = of_beam,
    [WH_FAULT_BEAM_LIT] = of_beam,
    [WH_FAULT_BEAM_LATE] = late_beam,
    [WH_FAULT_PROBE_CLOSED] = of_probe,
    [WH_FAULT_PROBE_OPEN] = of_probe,
    [WH_FAULT_EDGE_SENSOR_STUCK] = of_edge_sensor,
    [WH_FAULT_EDGE_SENSOR_LATE] = of_edge_sensor,
};

/* ---------------------------------------------------------------------------------------------- studies */

#define PLACEMENT_FIELDS                                                                                     \
    {"dx", NUMBER, "mm, in the slot's frame", false}, {"dy", NUMBER, "mm", false},                           \
        {"dz", NUMBER, "mm", false}, {"tilt", NUMBER, "degrees, about the slot's x and about its y", false}, \
        {"turn", NUMBER, "degrees, about z", false}, {                                                       \
        "shape", SHAPE, "how they are spread", false                                                         \
    }

#define TEACHING_FIELDS                                                                                      \
    {"x", NUMBER, "mm, along base's x", false}, {"y", NUMBER, "mm, along base's y", false},                  \
        {"z", NUMBER, "mm, along base's z", false}, {"roll", NUMBER, "degrees, about base's x", false},      \
        {"pitch", NUMBER, "degrees, about base's y", false},                                                 \
        {"yaw", NUMBER, "degrees, about base's z", false}, {                                                 \
        "shape", SHAPE, "how they are spread", false                                                         \
    }

const wh_reader_field_t wh_layout_study_fields[] = {
    {"shape", SHAPE, "how all errors are spread", false},
    {"placement", "waferhand.placement", "of every wafer in its slot", false},
    {"teaching", "waferhand.teaching", "of every station, beside where it was taught", false},
    {"timing", "waferhand.timing", "of valves and vacuum", false},
    {"rim", "waferhand.rim_width", "of every wafer's rim, which edge sensors see", false},
    {"beam", "waferhand.beam_width", "of every beam, beside where it is taken to stand", false},
    {"wafers", "table<string, waferhand.placement>", "of one wafer alone, by name", false},
    {"rims", "table<string, waferhand.rim_width>", "of one wafer's rim alone, by the wafer's name", false},
    {"beams", "table<string, waferhand.beam_width>", "of one station's beams alone, by its name", false},
    {"stations", "table<string, waferhand.teaching>", "of one station alone, by name", false},
    {"grippers", "table<string, waferhand.valve>", "of one gripper's valve alone, by name", false},
    END};

const wh_reader_field_t wh_layout_placement_fields[] = {PLACEMENT_FIELDS, END};
const wh_reader_field_t wh_layout_teaching_fields[] = {TEACHING_FIELDS, END};
const wh_reader_field_t wh_layout_timing_fields[] = {
    {"valve", NUMBER, "s by which a valve acts late", false},
    {"vacuum", NUMBER, "s by which the vacuum builds up more slowly", false},
    {"shape", SHAPE, "how they are spread", false},
    END};
const wh_reader_field_t wh_layout_valve_fields[] = {
    {"valve", NUMBER, "s by which it acts late", false}, {"shape", SHAPE, "how that is spread", false}, END};
const wh_reader_field_t wh_layout_rim_width_fields[] = {
    {"diameter", NUMBER, "mm, of the true diameter", false},
    {"notch_depth", NUMBER, "mm", false},
    {"notch_angle", NUMBER, "degrees, between the notch's flanks", false},
    {"notch_bottom", NUMBER, "mm, of the radius of its bottom", false},
    {"notch_corner", NUMBER, "mm, of the radii of its corners", false},
    {"flat", NUMBER, "mm, of the primary flat's length", false},
    {"second_flat", NUMBER, "mm, of the secondary flat's length", false},
    {"chip_depth", NUMBER, "mm, of a chip more, somewhere", false},
    {"chip_width", NUMBER, "mm, of that chip along the rim", false},
    {"bow", NUMBER, "mm", false},
    {"saddle", NUMBER, "mm, high in some direction", false},
    {"glass", NUMBER, "part of the light that comes through", false},
    {"shape", SHAPE, "how they are spread", false},
    END};

const wh_reader_field_t wh_layout_beam_width_fields[] = {
    {"dx", NUMBER, "mm by which it stands farther in", false},
    {"dy", NUMBER, "mm by which it stands to the left", false},
    {"late", NUMBER, "s by which its latches are late", false},
    {"shape", SHAPE, "how they are spread", false},
    END};

/* --------------------------------------------------------------------------------------------- the list */

const wh_layout_class_t wh_layout_classes[] = {
    {"layout", "A cell, which a layout's file returns.", wh_layout_top_fields},
    {"wafer_size", "The size of all wafers.", wh_layout_wafer_size_fields},
    {"notch", "A wafer's notch.", wh_layout_notch_fields},
    {"tolerance", "When a gripper may take a wafer.", wh_layout_tolerance_fields},
    {"near", "How near a miss must be to be reported.", wh_layout_near_fields},
    {"placing", "Limits above which the place of a wafer that was set down is reported.",
     wh_layout_placing_fields},
    {"corrections", "How far a command may go beside what was taught.", wh_layout_corrections_fields},
    {"mapping", "Where the beams of MAP stand and how they judge.", wh_layout_mapping_fields},
    {"vacuum", "The vacuum of all grippers.", wh_layout_vacuum_fields},
    {"pads", "The grip of a wafer on its pads.", wh_layout_pads_fields},
    {"robot", "The robot's axes.", wh_layout_robot_fields},
    {"joint", "The axis that a joint of a URDF follows.", wh_layout_joint_fields},
    {"turning_axis", "An axis that turns.", wh_layout_turning_axis_fields},
    {"robot_arm", "An arm of a robot.", wh_layout_robot_arm_fields},
    {"robot_wrist", "A wrist of a SCARA.", wh_layout_robot_wrist_fields},
    {"flip_axis", "The axis that turns the blade over.", wh_layout_flip_axis_fields},
    {"straight_axis", "An axis that goes straight.", wh_layout_straight_axis_fields},
    {"chuck", "The limits of the prealigners' chucks.", wh_layout_chuck_fields},
    {"gripper", "A blade on the robot, a prealigner's chuck or pins, or a flipper's clamp.",
     wh_layout_gripper_fields},
    {"loaded", "Limits of a carried wafer's centre.", wh_layout_loaded_fields},
    {"edge_grip", "An edge grip.", wh_layout_edge_grip_fields},
    {"stage", "The stage that moves a chuck aside.", wh_layout_stage_fields},
    {"pins", "The pins that lift wafers off a chuck.", wh_layout_pins_fields},
    {"flipper", "The clamp that turns wafers over.", wh_layout_flipper_fields},
    {"door", "A wall that moves: one shape about a place.", wh_layout_door_fields},
    {"station", "A place with slots, a prealigner, a FOUP or a flipper.", wh_layout_station_fields},
    {"approach", "How one of several robots comes to a station.", wh_layout_approach_fields},
    {"axes", "The axes with which a station was taught; all that the arm has.", wh_layout_axes_fields},
    {"wafer", "A wafer, where it lies when a run begins.", wh_layout_wafer_fields},
    {"sensor", "A line sensor beside a prealigner's chuck.", wh_layout_sensor_fields},
    {"believed", "A sensor's errors as a calibration found them.", wh_layout_believed_fields},
    {"arc", "A part of a turn.", wh_layout_arc_fields},
    {"beam", "A beam of light at a station's door.", wh_layout_beam_fields},
    {"via", "A point that the arm passes on its way to a station.", wh_layout_via_fields},
    {"block", "The block that a probe touches.", wh_layout_block_fields},
    {"probe", "A pin with a ball and a switch.", wh_layout_probe_fields},
    {"rim", "A wafer's true rim.", wh_layout_rim_fields},
    {"rim_notch", "A notch with its roundings.", wh_layout_rim_notch_fields},
    {"flat", "A flat.", wh_layout_flat_fields},
    {"chip", "A piece that is broken off a rim.", wh_layout_chip_fields},
    {"shapes", "Sizes of what collisions look at.", wh_layout_shapes_fields},
    {"blade", "A gripper on the robot.", wh_layout_blade_fields},
    {"arm", "The links of the arm.", wh_layout_arm_fields},
    {"ledge", "The supports of a wafer in a slot.", wh_layout_ledge_fields},
    {"foup", "A FOUP's walls.", wh_layout_foup_fields},
    {"spindle", "A prealigner's chuck.", wh_layout_spindle_fields},
    {"obstacle", "Something in the way: one shape about a place.", wh_layout_obstacle_fields},
    {"round", "A cylinder or a capsule.", wh_layout_round_fields},
    {"clearance", "Gaps that must be kept.", wh_layout_clearance_fields},
    {"fault.gripper", "A fault of a gripper.", of_gripper},
    {"fault.slow_vacuum", "A fault of a gripper's vacuum.", slow_vacuum},
    {"fault.leak", "A fault of a gripper's vacuum.", leak},
    {"fault.slow_plunger", "A fault of an edge grip.", slow_plunger},
    {"fault.command", "A fault of all that is commanded.", of_command},
    {"fault.missing", "A fault of a wafer.", missing},
    {"fault.doubled", "A fault of a wafer.", doubled},
    {"fault.crossed", "A fault of a wafer.", crossed},
    {"fault.shifted", "A fault of a wafer.", shifted},
    {"fault.tilted", "A fault of a wafer.", tilted},
    {"fault.door_stuck", "A fault of a door.", door_stuck},
    {"fault.door_slow", "A fault of a door.", door_slow},
    {"fault.beam", "A fault of a beam.", of_beam},
    {"fault.late_beam", "A fault of a beam.", late_beam},
    {"fault.probe", "A fault of the probe.", of_probe},
    {"fault.edge_sensor", "A fault of an edge sensor.", of_edge_sensor},
    {"study", "The errors that the trials of a study draw.", wh_layout_study_fields},
    {"placement", "Widths of errors of a wafer's place.", wh_layout_placement_fields},
    {"teaching", "Widths of errors of a station's place.", wh_layout_teaching_fields},
    {"timing", "Widths of errors of times.", wh_layout_timing_fields},
    {"valve", "The width of a valve's delay.", wh_layout_valve_fields},
    {"rim_width", "Widths of errors of a wafer's rim.", wh_layout_rim_width_fields},
    {"beam_width", "Widths of errors of a beam.", wh_layout_beam_width_fields},
    {NULL, NULL, NULL}};
