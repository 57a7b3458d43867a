/* The fields of a cell, and the list of all tables. */
#include "layout_fields_internal.h"

/* --------------------------------------------------------------------------------------------- the cell */

const wh_reader_field_t wh_layout_top_fields[] = {
    {"wafer", "waferhand.wafer_size", "the wafers' size", false},
    {"tolerance", "\"paper\"|\"strict\"|waferhand.tolerance", "when a gripper may take a wafer", false},
    {"near", "waferhand.near", "how near a miss must be to be reported", false},
    {"check", WORD, "if the check runs between slices, too", false,
     AS_WORD(wh_layout_t, grasp.check, WH_CHECK_SAMPLED, wh_layout_check_words)},
    {"slice", NUMBER, "s: the length of a slice, a whole number of microseconds", false},
    {"seat", SWITCH, "true: the pick draws the wafer onto the pads", false,
     AS_SWITCH(wh_layout_t, grasp.seat, false)},
    {"settle", SWITCH, "true: a wafer let go above a slot comes to lie on it", false,
     AS_SWITCH(wh_layout_t, cell.settle, false)},
    {"placing", "waferhand.placing", "the limits above which a wafer's place is reported", false},
    {"collision", SWITCH, "true: look for collisions while stepping", false},
    {"look_ahead", SWITCH, "true: a command that would collide is refused", false},
    {"robot", "waferhand.robot", "the robot's axes", false},
    {"robots", "table<string, waferhand.robot>", "several robots by name, in place of robot", false},
    {"homed", SWITCH, "false: HOME comes first", false, AS_SWITCH(wh_layout_t, homed, true)},
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
    {"patterns", "string", "a file of patterns, relative to the layout's folder", false},
    END};

const wh_reader_field_t wh_layout_wafer_size_fields[] = {
    {"diameter", NUMBER, "mm", false, AS_NUMBER(wh_layout_t, wafer_diameter, 25, 1000, 300)},
    {"thickness", NUMBER, "mm", false},
    {"spread", NUMBER,
     "mm: standard deviation of true diameters, which "
     "centring allows for; 0: none",
     false, AS_NUMBER(wh_layout_t, wafer_spread, 0, 2, 0)},
    {"notch", "waferhand.notch", "the notch", false},
    END};

const wh_reader_field_t wh_layout_notch_fields[] = {
    {"at", NUMBER, "degrees about the wafer's axis, from its x", false}, {"depth", NUMBER, "mm", false}, END};

const wh_reader_field_t wh_layout_tolerance_fields[] = {
    {"projz", NUMBER, "mm: the limit of |dr_proj_z|", false,
     AS_NUMBER(wh_tolerance_t, projz, 1e-9, 1e6, KEPT)},
    {"projxy", NUMBER, "mm: the limit of |dr_proj_xy|", false,
     AS_NUMBER(wh_tolerance_t, projxy, 1e-6, 1e6, KEPT)},
    {"planar", NUMBER, "the limit of n1_proj_n2, a cosine", false,
     AS_NUMBER(wh_tolerance_t, planar, 0, 0.999999999999, KEPT)},
    END};

const wh_reader_field_t wh_layout_near_fields[] = {
    {"projz", NUMBER, "mm", false, AS_NUMBER(wh_grasp_config_t, near_projz, 1e-9, 1e6, KEPT)},
    {"projxy", NUMBER, "mm", false, AS_NUMBER(wh_grasp_config_t, near_projxy, 1e-9, 1e6, KEPT)},
    END};

const wh_reader_field_t wh_layout_placing_fields[] = {
    {"off_centre", NUMBER, "mm beside the slot's centre; 0: never", false,
     AS_NUMBER(wh_cell_t, off_centre, 0, 1000, 0)},
    {"askew", NUMBER, "degrees of tilt; 0: never", false, AS_DEGREES(wh_cell_t, askew, 0, 90, 0)},
    {"drop", NUMBER, "mm above the slot as it is let go, 0.5; 0: any height is good", false,
     AS_NUMBER(wh_cell_t, drop, 0, 1000, WH_USUAL_DROP)},
    END};

const wh_reader_field_t wh_layout_corrections_fields[] = {
    {"x", NUMBER, "mm", false, AS_NUMBER(wh_corrections_t, x, 0, 1000, 5)},
    {"y", NUMBER, "mm", false, AS_NUMBER(wh_corrections_t, y, 0, 1000, 5)},
    {"z", NUMBER, "mm", false, AS_NUMBER(wh_corrections_t, z, 0, 1000, 2.5)},
    {"turn", NUMBER, "degrees", false, AS_NUMBER(wh_corrections_t, turn_deg, 0, 180, 5)},
    END};

const wh_reader_field_t wh_layout_mapping_fields[] = {
    {"x", NUMBER, "0 to 0.8: the beams before the slot's middle, a share of the wafers' radius", false,
     AS_NUMBER(wh_mapping_t, x, 0, 0.8, 0.6)},
    {"y", NUMBER, "the beams to either side, likewise; both are within the rim", false,
     AS_NUMBER(wh_mapping_t, y, 0.1, 0.98, FOLLOWS)},
    {"crossed", NUMBER, "0.01 to 0.5: a wafer farther from its slot's plane is crossed, a share of the pitch",
     false, AS_NUMBER(wh_mapping_t, crossed, 0.01, 0.5, 0.5)},
    {"level", NUMBER, "mm: a wafer that the beams see so far apart in height is crossed; 0: half the pitch",
     false, AS_NUMBER(wh_mapping_t, level, 0, 1000, FOLLOWS)},
    {"protruded", NUMBER, "mm: a wafer farther out towards the arm is protruded", false,
     AS_NUMBER(wh_mapping_t, protruded, 0, 1000, FOLLOWS)},
    {"thinnest", NUMBER, "mm: a wafer below it is thin", false,
     AS_NUMBER(wh_mapping_t, thinnest, 0, 100, FOLLOWS)},
    {"thickest", NUMBER, "mm: a wafer above it is thick", false,
     AS_NUMBER(wh_mapping_t, thickest, 0.01, 1000, FOLLOWS)},
    END};

const wh_reader_field_t wh_layout_vacuum_fields[] = {
    {"model", "\"ideal\"|\"delayed\"", "whose values the other fields have by default", false},
    {"build", NUMBER, "s: time constant upwards", false, AS_NUMBER(wh_vacuum_config_t, build, 0, 3600, KEPT)},
    {"vent", NUMBER, "s: time constant downwards", false, AS_NUMBER(wh_vacuum_config_t, vent, 0, 3600, KEPT)},
    {"idle", NUMBER, "0 to 1: the level of an open valve without a wafer", false,
     AS_NUMBER(wh_vacuum_config_t, idle, 0, 1, FOLLOWS)},
    {"sensor_on", NUMBER, "0 to 1: the level at which the sensor goes on", false,
     AS_NUMBER(wh_vacuum_config_t, on, 0.01, 1, KEPT)},
    {"sensor_off", NUMBER, "0 to 1: the level below which the sensor goes off", false,
     AS_NUMBER(wh_vacuum_config_t, off, 0.01, 1, FOLLOWS)},
    {"release", NUMBER, "0 to 1: the level below which a closed valve lets go", false,
     AS_NUMBER(wh_vacuum_config_t, release, 0.01, 1, KEPT)},
    {"debounce", NUMBER, "ms for which the sensor's switch must stand until it is told", false},
    END};

const wh_reader_field_t wh_layout_pads_fields[] = {
    {"friction", NUMBER, "the coefficient between pads and wafer", true,
     AS_NUMBER(wh_pads_t, friction, 0, 100, KEPT)},
    {"force", NUMBER, "N: the force of the full vacuum", true, AS_NUMBER(wh_pads_t, force, 0, 1e6, KEPT)},
    {"mass", NUMBER, "kg: of a wafer", false, AS_NUMBER(wh_pads_t, mass, 1e-6, 1000, FOLLOWS)},
    {"gravity", NUMBER, "m/s^2, along -z of base", false, AS_NUMBER(wh_pads_t, gravity, 0, 1000, 9.81)},
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
    {"fault.gripper", "A fault of a gripper.", wh_layout_fault_of_gripper},
    {"fault.slow_vacuum", "A fault of a gripper's vacuum.", wh_layout_fault_slow_vacuum},
    {"fault.leak", "A fault of a gripper's vacuum.", wh_layout_fault_leak},
    {"fault.slow_plunger", "A fault of an edge grip.", wh_layout_fault_slow_plunger},
    {"fault.command", "A fault of all that is commanded.", wh_layout_fault_of_command},
    {"fault.missing", "A fault of a wafer.", wh_layout_fault_missing},
    {"fault.doubled", "A fault of a wafer.", wh_layout_fault_doubled},
    {"fault.crossed", "A fault of a wafer.", wh_layout_fault_crossed},
    {"fault.shifted", "A fault of a wafer.", wh_layout_fault_shifted},
    {"fault.tilted", "A fault of a wafer.", wh_layout_fault_tilted},
    {"fault.door_stuck", "A fault of a door.", wh_layout_fault_door_stuck},
    {"fault.door_slow", "A fault of a door.", wh_layout_fault_door_slow},
    {"fault.beam", "A fault of a beam.", wh_layout_fault_of_beam},
    {"fault.late_beam", "A fault of a beam.", wh_layout_fault_late_beam},
    {"fault.probe", "A fault of the probe.", wh_layout_fault_of_probe},
    {"fault.edge_sensor", "A fault of an edge sensor.", wh_layout_fault_of_edge_sensor},
    {"study", "The errors that the trials of a study draw.", wh_layout_study_fields},
    {"placement", "Widths of errors of a wafer's place.", wh_layout_placement_fields},
    {"teaching", "Widths of errors of a station's place.", wh_layout_teaching_fields},
    {"timing", "Widths of errors of times.", wh_layout_timing_fields},
    {"valve", "The width of a valve's delay.", wh_layout_valve_fields},
    {"rim_width", "Widths of errors of a wafer's rim.", wh_layout_rim_width_fields},
    {"beam_width", "Widths of errors of a beam.", wh_layout_beam_width_fields},
    {NULL, NULL, NULL}};
