/* The fields of stations and wafers, and of the sensors there. */
#include "layout_fields_internal.h"

/* ---------------------------------------------------------------------------------- stations and wafers */

const wh_reader_field_t wh_layout_station_fields[] = {
    {"kind", WORD, "what stands there", false, APART_WORD(0, wh_layout_station_words)},
    {"at", TRIPLE, "x, y, z in mm, in base: the centre of a wafer's back face in slot 1; or `axes` says it",
     false},
    {"rpy", TRIPLE, "roll, pitch, yaw in degrees: x is the way in, z goes up through the slots", false,
     .otherwise = "0, 0, 0"},
    {"axes", "waferhand.axes", "in place of `at` and `rpy`: where the axes stand with the gripper in slot 1",
     false},
    {"taught", SWITCH, "false: every command at the station is refused", false,
     AS_SWITCH(wh_layout_station_t, taught, true)},
    {"slots", "integer", "how many", false, APART(1, WH_LAYOUT_SLOTS, FOLLOWS),
     .otherwise = "1, of a FOUP 25"},
    {"pitch", NUMBER, "mm from slot to slot", false, APART(0.1, 1000, FOLLOWS), .otherwise = "by diameter"},
    {"effector", "string", "the gripper that serves it, unless a command names another", false,
     .otherwise = "the first on the robot"},
    {"stroke", NUMBER, "mm: the height of the stroke", false,
     AS_NUMBER(wh_layout_station_t, stroke, 0.01, 1000, FOLLOWS),
     .otherwise = "6 above 200 mm, 4 above 150, else 3"},
    {"offset", NUMBER, "mm above the slot at which a GET leaves", false,
     AS_NUMBER(wh_layout_station_t, offset, 0, 1000, FOLLOWS), .otherwise = "half of the stroke"},
    {"retract", NUMBER, "mm before the slot, where the straight way in begins", false,
     AS_NUMBER(wh_layout_station_t, retract, 1, 10000, 300)},
    {"pickup_speed", NUMBER, "mm/s: of the strokes", false,
     AS_NUMBER(wh_layout_station_t, pickup_speed, 0.001, 10000, 20)},
    {"pickup_acceleration", NUMBER, "mm/s^2: of the strokes; 0: what the axes allow", false,
     AS_NUMBER(wh_layout_station_t, pickup_acceleration, 0, 1e8, 0)},
    {"release", NUMBER, "mm above the slot at which a PUT switches the valves", false,
     AS_NUMBER(wh_layout_station_t, release, -1000, 1000, FOLLOWS),
     .otherwise = "-projz/2; 0 with seat and of an edge grip"},
    {"vacuum_delay", NUMBER, "s from the end of the stroke until the sensor is asked", false,
     AS_NUMBER(wh_layout_station_t, vacuum_delay, 0, 3600, 0)},
    {"vacuum_check", WORD, "the commands that the sensor decides", false,
     AS_WORD(wh_layout_station_t, check, WH_VACUUM_CHECK_BOTH, wh_layout_vacuum_check_words)},
    {"timeout", NUMBER, "s: how long a command waits for the sensor", false,
     AS_NUMBER(wh_layout_station_t, timeout, 0, 3600, FOLLOWS), .otherwise = "0.25, more with a slow vacuum"},
    {"retries", "integer", "how often a GET that took nothing tries again", false,
     AS_WHOLE(wh_layout_station_t, retries, 0, 100, 0)},
    {"wait", NUMBER, "s: how long the arm stands in the station before the stroke", false,
     AS_NUMBER(wh_layout_station_t, wait, 0, 3600, 0)},
    {"map_speed", NUMBER, "mm/s: of the sweep over the slots", false,
     AS_NUMBER(wh_layout_station_t, map_speed, 0.001, 10000, 100)},
    {"check_map", SWITCH, "true: GET and PUT want a MAP before them", false,
     AS_SWITCH(wh_layout_station_t, check_map, false)},
    {"handover", WORD, "at a chuck: the order of the two valves", false,
     AS_WORD(wh_layout_station_t, handover, WH_HANDOVER_NEW_FIRST, wh_layout_handover_words)},
    {"face", WORD, "how wafers must lie there; without it either way", false,
     APART_WORD(FOLLOWS, wh_layout_face_words), .otherwise = "either"},
    {"counts", SWITCH, "true: a wafer that is put here is done, for wafers per hour", false,
     APART_SWITCH(FOLLOWS), .otherwise = "true where wafers end up"},
    {"sensor", "waferhand.sensor", "at a prealigner: what sees the wafer's edge", false},
    {"beams", "waferhand.beam[]", "light at the door, which wafers break on their way", false},
    {"centre", SWITCH, "true: a PUT corrects by what the beams say of the wafer", false, APART_SWITCH(false)},
    {"block", "waferhand.block", "what a probe touches to teach the station", false},
    {"rail", NUMBER, "mm: where the robot's rail stands for it", false, .otherwise = "the rail's home"},
    {"elbow", WORD, "the side of a SCARA's elbow there", false, APART_WORD(FOLLOWS, wh_layout_side_words),
     .otherwise = "the robot's"},
    {"door", "string", "the door through which wafers come, by name", false},
    {"pins", "string", "the pins that lift wafers off its chuck, by name", false,
     .otherwise = "those that are on it"},
    {"via", "waferhand.via[]", "where the arm passes on its way there, and back on its way away", false},
    {"by", "table<string, waferhand.approach|waferhand.timed_way>",
     "with several robots: those that serve it, by name", false, .otherwise = "those that come there"},
    STATION_TIMES(", the blade is out and its doors are shut", "waferhand.lock"),
    {"port", "waferhand.port", "of a load port: its steps and their times", false},
    {"side", WORD, "of a load lock: where the one robot comes", false, APART_WORD(ASKED, wh_flow_side_words)},
    END};

const wh_reader_field_t wh_layout_clean_fields[] = {
    {"after", "integer|table<string, integer>", "wafers, also by recipe of the one that was there last",
     false, APART(1, 1000000, ASKED)},
    {"idle", BY_RECIPE, "s without a wafer, also by recipe of the one that was there last", false,
     SECONDS_ABOVE_0(ASKED)},
    {"seconds", NUMBER, "s: how long it takes", true, SECONDS_ABOVE_0(ASKED)},
    {"empty", SWITCH, "false: after the last wafer's process, with the wafer inside", false,
     APART_SWITCH(true)},
    END};

/* The longest time of a load port's step, s. */
#define LONGEST 86400

const wh_reader_field_t wh_layout_port_fields[] = {
    {"state", "\"absent\"|\"placed\"|\"clamped\"|\"docked\"|\"open\"|\"mapped\"", "when a run begins", false,
     .otherwise = "open with a carrier, else absent"},
    {"place", NUMBER, "s by hand until a carrier that comes is placed", false, APART(0, LONGEST, 0)},
    {"remove", NUMBER, "s by hand until a carrier that goes is gone", false, APART(0, LONGEST, 0)},
    {"clamp", NUMBER, "s to clamp the carrier", false, APART(0, LONGEST, 1)},
    {"dock", NUMBER, "s to dock it", false, APART(0, LONGEST, 3)},
    {"open", NUMBER, "s to open its door", false, APART(0, LONGEST, 5)},
    {"map", NUMBER, "s to map its slots", false, APART(0, LONGEST, 4)},
    {"close", NUMBER, "s to shut its door", false, APART(0, LONGEST, FOLLOWS), .otherwise = "as open"},
    {"undock", NUMBER, "s to move it out again", false, APART(0, LONGEST, FOLLOWS), .otherwise = "as dock"},
    {"unclamp", NUMBER, "s to let go of it", false, APART(0, LONGEST, FOLLOWS), .otherwise = "as clamp"},
    {"goes", "\"placed\"|\"clamped\"|\"docked\"|\"open\"|\"mapped\"",
     "where a carrier that has come goes by itself", false, .otherwise = "mapped"},
    {"e84", "waferhand.e84", "a vehicle brings and takes carriers, by this handshake", false,
     .otherwise = "by hand"},
    {"mapper", "waferhand.mapper", "how its mapper judges", false, .otherwise = "as MAP"},
    END};

const wh_reader_field_t wh_layout_mapper_fields[] = {
    {"crossed", NUMBER, "0.01 to 0.5: a wafer farther from its slot's plane is crossed, a share of the pitch",
     false, APART(0.01, 0.5, FOLLOWS), .otherwise = "that of `mapping`"},
    {"level", NUMBER, "mm: a wafer that its beams see so far apart in height is crossed; 0: half the pitch",
     false, APART(0, 1000, FOLLOWS), .otherwise = "that of `mapping`"},
    {"protruded", NUMBER, "mm: a wafer farther out towards the arm is protruded", false,
     APART(0, 1000, FOLLOWS), .otherwise = "that of `mapping`"},
    {"thinnest", NUMBER, "mm: a wafer below it is thin", false, APART(0, 100, FOLLOWS),
     .otherwise = "that of `mapping`"},
    {"thickest", NUMBER, "mm: a wafer above it is thick", false, APART(0.01, 1000, FOLLOWS),
     .otherwise = "that of `mapping`"},
    END};

const wh_reader_field_t wh_layout_e84_fields[] = {
    {"tp1", NUMBER, "s: the longest from L_REQ or U_REQ to TR_REQ", false, APART(0.001, LONGEST, 2)},
    {"tp2", NUMBER, "s: the longest from READY to BUSY", false, APART(0.001, LONGEST, 2)},
    {"tp3", NUMBER, "s: the longest from BUSY until the carrier is there, or gone", false,
     APART(0.001, LONGEST, 60)},
    {"tp4", NUMBER, "s: the longest until BUSY is off", false, APART(0.001, LONGEST, 60)},
    {"tp5", NUMBER, "s: the longest from READY off to VALID off", false, APART(0.001, LONGEST, 2)},
    {"t1", NUMBER, "s that the step of TP1 takes", false, APART(0, LONGEST, 0.5)},
    {"t2", NUMBER, "s that the step of TP2 takes", false, APART(0, LONGEST, 0.5)},
    {"t3", NUMBER, "s that the step of TP3 takes", false, APART(0, LONGEST, 10)},
    {"t4", NUMBER, "s that the step of TP4 takes", false, APART(0, LONGEST, 5)},
    {"t5", NUMBER, "s that the step of TP5 takes", false, APART(0, LONGEST, 0.5)},
    END};

const wh_reader_field_t wh_layout_carrier_fields[] = {
    {"wafers", "integer|integer[]", "how many, from slot 1 on, or their slots; each is called CARRIER.SLOT",
     false, .otherwise = "0"},
    {"recipe", "string", "by which stations process its wafers", false, .otherwise = "none"},
    {"at", "string", "the load port where it is when a run begins, by name", false,
     .otherwise = "it is still to come"},
    END};

#define PUMP_TIMES                                                                                           \
    {"down", NUMBER, "s to vacuum", true, SECONDS_ABOVE_0(ASKED)},                                           \
        {"up", NUMBER, "s to atmosphere", true, SECONDS_ABOVE_0(ASKED)},                                     \
        {"empty_down",       NUMBER, "s to vacuum without a wafer", false, SECONDS_ABOVE_0(FOLLOWS),         \
         .otherwise = "down"},                                                                               \
    {                                                                                                        \
        "empty_up", NUMBER, "s to atmosphere without a wafer", false, SECONDS_ABOVE_0(FOLLOWS),              \
            .otherwise = "up"                                                                                \
    }

const wh_reader_field_t wh_layout_pump_fields[] = {PUMP_TIMES, END};

const wh_reader_field_t wh_layout_lock_fields[] = {
    PUMP_TIMES, {"doors", "waferhand.lock_doors", "doors through which no robot of `by` comes", false}, END};

const wh_reader_field_t wh_layout_lock_doors_fields[] = {
    {"atmosphere", "string", "the door on this side, by name", false},
    {"vacuum", "string", "the door on this side, by name", false},
    END};

const wh_reader_field_t wh_layout_approach_fields[] = {
    {"rpy", TRIPLE, "roll, pitch, yaw in degrees, in base: x is this robot's way in", false,
     .otherwise = "the station's"},
    {"at", TRIPLE, "where it was taught slot 1, mm, in base, up to 5 mm beside the station's own `at`", false,
     .otherwise = "the station's"},
    {"axes", "waferhand.axes", "where its axes stand with its gripper in slot 1", false},
    {"rail", NUMBER, "mm: where its rail stands for it", false, .otherwise = "the rail's home"},
    {"elbow", WORD, "the side of a SCARA's elbow there", false, APART_WORD(FOLLOWS, wh_layout_side_words),
     .otherwise = "the robot's"},
    {"door", "string", "the door through which it comes, by name", false, .otherwise = "the station's"},
    {"via", "waferhand.via[]", "where it passes on its way there, and back on its way away", false},
    {"side", WORD, "of a load lock: where it comes", false, APART_WORD(ASKED, wh_flow_side_words)},
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
    {"name", "string", "how commands name it", false, .otherwise = "\"Wafer 1\" and so on"},
    {"station", "string", "the station in which it lies", true},
    {"slot", "integer", "from 1, at the bottom", true},
    {"dx", NUMBER, "mm off the slot's centre, along its x", false, APART(-1000, 1000, 0)},
    {"dy", NUMBER, "mm off the slot's centre, along its y", false, APART(-1000, 1000, 0)},
    {"dz", NUMBER, "mm above the slot", false, APART(-1000, 1000, 0)},
    {"rpy", TRIPLE, "roll, pitch, yaw in degrees, in the slot's frame", false, .otherwise = "0, 0, 0"},
    {"face", WORD, "the way it lies; without it as its station says, else up", false,
     APART_WORD(FOLLOWS, wh_layout_face_words), .otherwise = "the station's, else up"},
    {"thickness", NUMBER, "mm: what MAP measures; all else goes by that of `wafer`", false,
     APART(0.01, 100, FOLLOWS), .otherwise = "that of `wafer`"},
    {"recipe", "string", "by which stations process it", false, .otherwise = "none"},
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
    {"blend", NUMBER, "mm: how near the arm passes; 0: it stops there", false, APART(0, 1000, 50)},
    END};

const wh_reader_field_t wh_layout_beam_fields[] = {
    {"x", NUMBER, "mm along the way in from the slot's centre, below 0 before it", false,
     AS_NUMBER(wh_layout_beam_t, x, -10000, 10000, FOLLOWS), .otherwise = "-retract/2"},
    {"y", NUMBER, "mm across the way, to the left", true,
     AS_NUMBER(wh_layout_beam_t, y, -10000, 10000, FOLLOWS)},
    {"low", NUMBER, "mm above slot 1 where it begins", false,
     AS_NUMBER(wh_layout_beam_t, low, -1000, 1000, -30)},
    {"high", NUMBER, "mm above slot 1 where it ends", false,
     AS_NUMBER(wh_layout_beam_t, high, -1000, 1e4, FOLLOWS), .otherwise = "30 above the top slot"},
    {"sd", NUMBER, "mm: how well x and y are known, standard deviation", false,
     AS_NUMBER(wh_layout_beam_t, sd, 0, 0.5, 0)},
    {"delay_on", NUMBER, "s from being broken to the latch", false,
     AS_NUMBER(wh_layout_beam_t, delay_on, 0, 0.009, 0)},
    {"delay_off", NUMBER, "s from being free to the latch", false,
     AS_NUMBER(wh_layout_beam_t, delay_off, 0, 0.009, 0)},
    {"jitter", NUMBER, "s: standard deviation of both delays", false, APART(0, 0.001, 0)},
    {"seed", "integer", "names the jitter, with the number of the arming", false, APART(0, INT32_MAX, 1)},
    {"dx", NUMBER, "mm by which it truly stands farther in than motion control believes", false,
     AS_NUMBER(wh_layout_beam_t, dx, -5, 5, 0)},
    {"dy", NUMBER, "mm by which it truly stands farther to the left", false,
     AS_NUMBER(wh_layout_beam_t, dy, -5, 5, 0)},
    {"late", NUMBER, "s by which both delays are truly longer", false,
     AS_NUMBER(wh_layout_beam_t, late, 0, 0.001, 0)},
    {"stuck", WORD, "what a beam always says that is broken down", false,
     APART_WORD(0, wh_layout_beam_stuck_words)},
    END};

const wh_reader_field_t wh_layout_block_fields[] = {
    {"at", TRIPLE, "x, y, z in mm, in the station's frame: the middle of its upper face", false,
     .otherwise = "30 before a wafer in the slot, 40 below it"},
    {"size", TRIPLE, "mm along the station's x, y and z", false, .otherwise = "40, 200, 20"},
    END};

const wh_reader_field_t wh_layout_probe_fields[] = {
    {"at", TRIPLE, "x, y, z in mm, in the gripper's frame: the middle of its ball", false,
     .otherwise = "0, 0, -12"},
    {"radius", NUMBER, "mm: of the ball", false, AS_NUMBER(wh_layout_probe_t, radius, 0, 50, 1.5)},
    {"noise", NUMBER, "mm: of where a touch closes the switch, standard deviation", false,
     AS_NUMBER(wh_layout_probe_t, noise, 0, 0.1, 0.005)},
    {"seed", "integer", "names the noise, with the number of the arming", false,
     AS_SEED(wh_layout_probe_t, seed)},
    {"stuck", WORD, "what a switch always says that is broken down", false,
     AS_WORD(wh_layout_probe_t, stuck, 0, wh_layout_touch_stuck_words)},
    END};

const wh_reader_field_t wh_layout_sensor_fields[] = {
    {"samples", "integer", "how many in a turn", false,
     AS_WHOLE(wh_sensor_t, samples, 90, WH_SENSOR_SAMPLES, KEPT)},
    {"pixel", NUMBER, "mm: a pixel's length", false, AS_NUMBER(wh_sensor_t, pixel, 0.001, 0.1, KEPT)},
    {"length", NUMBER, "mm: the line's length", false, AS_NUMBER(wh_sensor_t, length, 2, 100, FOLLOWS)},
    {"noise", NUMBER, "mm: standard deviation of one sample", false,
     AS_NUMBER(wh_sensor_t, noise, 0, 0.1, 0)},
    {"seed", "integer", "names the noise, with the number of the scan", false, APART(0, INT32_MAX, 1)},
    {"at", NUMBER, "degrees: where the line points from the chuck's axis, about the station's z", false,
     AS_DEGREES(wh_sensor_t, direction, -360, 360, 0)},
    {"encoder", "integer", "counts in a turn of the chuck; 0: no steps", false,
     AS_WHOLE(wh_sensor_t, encoder, 0, 10000000, 0)},
    {"offset", NUMBER, "mm by which the line passes the axis, to the left", false,
     AS_NUMBER(wh_sensor_t, error.offset, -1, 1, 0)},
    {"zero", NUMBER, "mm by which its inner end is farther out", false,
     AS_NUMBER(wh_sensor_t, error.zero, -1, 1, 0)},
    {"gain", NUMBER, "the part of their length by which pixels are longer", false,
     AS_NUMBER(wh_sensor_t, error.gain, -0.01, 0.01, 0)},
    {"latency", NUMBER, "s by which a sample is taken later than it is due", false,
     AS_NUMBER(wh_sensor_t, error.latency, -0.001, 0.001, 0)},
    {"believed", "waferhand.believed", "what motion control takes these four to be: 0 without it", false},
    {"tilt", NUMBER, "degrees of its light out of the upright, outwards going up", false,
     AS_DEGREES(wh_sensor_t, tilt, -28, 28, 0)},
    {"hidden", "waferhand.arc[]", "arcs of the chuck in which something covers the line", false},
    END};

const wh_reader_field_t wh_layout_believed_fields[] = {
    {"offset", NUMBER, "mm", false, AS_NUMBER(wh_sensor_error_t, offset, -1, 1, 0)},
    {"zero", NUMBER, "mm", false, AS_NUMBER(wh_sensor_error_t, zero, -1, 1, 0)},
    {"gain", NUMBER, "a part of the pixels' length", false,
     AS_NUMBER(wh_sensor_error_t, gain, -0.01, 0.01, 0)},
    {"latency", NUMBER, "s", false, AS_NUMBER(wh_sensor_error_t, latency, -0.001, 0.001, 0)},
    END};

const wh_reader_field_t wh_layout_arc_fields[] = {
    {"from", NUMBER, "degrees", true, AS_DEGREES(wh_arc_t, from, -360, 360, KEPT)},
    {"width", NUMBER, "degrees", true, AS_DEGREES(wh_arc_t, width, 0.001, 360, KEPT)},
    END};

const wh_reader_field_t wh_layout_rim_fields[] = {
    {"diameter", NUMBER, "mm", false, APART(WH_SENSED_LEAST, WH_SENSED_MOST, FOLLOWS),
     .otherwise = "that of `wafer`"},
    {"notch", "waferhand.rim_notch", "the notch", false},
    {"flats", "waferhand.flat[]", "the flats", false, .otherwise = "by size, below 200 mm"},
    {"chips", "waferhand.chip[]", "what is broken off", false},
    {"bow", NUMBER, "mm: how far the rim is above the centre, the same all round", false,
     AS_NUMBER(wh_rim_t, bow, -2, 2, 0)},
    {"saddle", NUMBER, "mm: how far the rim is above the centre, twice up and down", false,
     AS_NUMBER(wh_rim_t, saddle, -2, 2, 0)},
    {"saddle_at", NUMBER, "degrees: where the saddle is highest", false,
     AS_DEGREES(wh_rim_t, saddle_direction, -360, 360, 0)},
    {"glass", NUMBER, "0 to 0.9: the part of the light that comes through", false,
     AS_NUMBER(wh_rim_t, transmission, 0, 0.9, 0)},
    END};

const wh_reader_field_t wh_layout_rim_notch_fields[] = {
    {"at", NUMBER, "degrees about the wafer's axis, from its x", false,
     AS_DEGREES(wh_notch_shape_t, direction, -360, 360, KEPT)},
    {"depth", NUMBER, "mm; 0: none", false, AS_NUMBER(wh_notch_shape_t, depth, 0, 3, FOLLOWS),
     .otherwise = "that of `wafer`"},
    {"angle", NUMBER, "degrees between its flanks", false,
     AS_DEGREES(wh_notch_shape_t, opening, 58, 120, 90)},
    {"bottom", NUMBER, "mm: the radius at its bottom", false,
     AS_NUMBER(wh_notch_shape_t, bottom, 0, 2, FOLLOWS)},
    {"corner", NUMBER, "mm: the radius where it meets the rim", false,
     AS_NUMBER(wh_notch_shape_t, corner, 0, 1, FOLLOWS)},
    END};

const wh_reader_field_t wh_layout_flat_fields[] = {
    {"at", NUMBER, "degrees about the wafer's axis, from its x", true, APART(-360, 360, ASKED)},
    {"length", NUMBER, "mm", true},
    END};

const wh_reader_field_t wh_layout_chip_fields[] = {
    {"at", NUMBER, "degrees about the wafer's axis, from its x", true, APART(-360, 360, ASKED)},
    {"width", NUMBER, "mm along the rim", true, APART(0.01, 30, ASKED)},
    {"depth", NUMBER, "mm", true},
    END};
