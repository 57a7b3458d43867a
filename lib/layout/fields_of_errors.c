/* The fields of faults, and of the errors that a study draws. */
#include "layout_fields_internal.h"

/* ----------------------------------------------------------------------------------------------- faults */

#define OF_EVERY_FAULT                                                                                       \
    {"after", NUMBER, "s until it begins", false, APART(0, 1e6, 0)}, {                                       \
        "lasting", NUMBER, "s; without it until it is cleared", false, APART(0, 1e6, FOLLOWS),               \
            .otherwise = "until it is cleared"                                                               \
    }
#define GRIPPER                                                                                              \
    { "gripper", "string", "whose; without it the first on the robot", false }
#define DOOR                                                                                                 \
    { "door", "string", "which", true }
#define WAFER                                                                                                \
    { "wafer", "string", "which", true }

const wh_reader_field_t wh_layout_fault_of_gripper[] = {
    {"kind", "\"no_vacuum\"|\"sensor_on\"|\"sensor_off\"|\"valve_stuck\"|\"axis_stopped\"|\"plunger_stuck\"",
     "what happens: no vacuum; a sensor, a valve, the axes or the plunger of an edge grip are stuck", true},
    OF_EVERY_FAULT,
    GRIPPER,
    END};
const wh_reader_field_t wh_layout_fault_slow_plunger[] = {
    {"kind", "\"plunger_slow\"", "the plunger of an edge grip is slow", true},
    OF_EVERY_FAULT,
    GRIPPER,
    {"value", NUMBER, "mm/s: it goes no faster", true},
    END};
const wh_reader_field_t wh_layout_fault_slow_vacuum[] = {
    {"kind", "\"slow_vacuum\"", "the vacuum is slow", true},
    OF_EVERY_FAULT,
    GRIPPER,
    {"value", NUMBER, "s: the time constant upwards", true},
    END};
const wh_reader_field_t wh_layout_fault_leak[] = {{"kind", "\"leak\"", "the vacuum leaks", true},
                                                  OF_EVERY_FAULT,
                                                  GRIPPER,
                                                  {"value", NUMBER, "0 to 1: the highest level", true},
                                                  END};
const wh_reader_field_t wh_layout_fault_of_command[] = {
    {"kind", "\"command_lost\"", "all grippers and valves stay as they were", true}, OF_EVERY_FAULT, END};
const wh_reader_field_t wh_layout_fault_door_stuck[] = {
    {"kind", "\"door_stuck\"", "a door stays where it is", true}, OF_EVERY_FAULT, DOOR, END};
const wh_reader_field_t wh_layout_fault_door_slow[] = {{"kind", "\"door_slow\"", "a door is slow", true},
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
const wh_reader_field_t wh_layout_fault_of_beam[] = {
    {"kind", "\"beam_dark\"|\"beam_lit\"", "a beam at a door is broken down", true},
    OF_EVERY_FAULT,
    BEAM,
    END};
const wh_reader_field_t wh_layout_fault_late_beam[] = {
    {"kind", "\"beam_late\"", "the latches of a beam are late", true},
    OF_EVERY_FAULT,
    BEAM,
    {"value", NUMBER, "s by which they are", true},
    END};
const wh_reader_field_t wh_layout_fault_of_probe[] = {
    {"kind", "\"probe_closed\"|\"probe_open\"", "the switch of the cell's probe is stuck", true},
    OF_EVERY_FAULT,
    END};
const wh_reader_field_t wh_layout_fault_of_edge_sensor[] = {
    {"kind", "\"edge_sensor_stuck\"|\"edge_sensor_late\"",
     "the samples of an edge sensor are all the same, or late", true},
    OF_EVERY_FAULT,
    STATION,
    {"value", NUMBER,
     "stuck: the part of its line that seems to be covered, 0 to 1; late: s by which they are", true},
    END};
const wh_reader_field_t wh_layout_fault_station_stuck[] = {
    {"kind", "\"station_stuck\"", "a process, clean, pump or load port does not go on", true},
    OF_EVERY_FAULT,
    STATION,
    END};
const wh_reader_field_t wh_layout_fault_station_slow[] = {
    {"kind", "\"station_slow\"", "a process, clean, pump or load port takes longer", true},
    OF_EVERY_FAULT,
    STATION,
    {"value", NUMBER, "how many times as long, 1 to 1000", true},
    END};
#define E84_STEP                                                                                             \
    { "step", "\"tp1\"|\"tp2\"|\"tp3\"|\"tp4\"|\"tp5\"", "which one, by its timer", true }
const wh_reader_field_t wh_layout_fault_e84_stuck[] = {
    {"kind", "\"e84_stuck\"", "a step of a load port's handshake does not end", true},
    OF_EVERY_FAULT,
    STATION,
    E84_STEP,
    END};
const wh_reader_field_t wh_layout_fault_e84_late[] = {
    {"kind", "\"e84_late\"", "a step of a load port's handshake takes longer", true},
    OF_EVERY_FAULT,
    STATION,
    E84_STEP,
    {"value", NUMBER, "s by which it does", true},
    END};
#define ROBOT                                                                                                \
    { "robot", "string", "its name, one of several robots'", false, .otherwise = "the only one" }
const wh_reader_field_t wh_layout_fault_power_lost[] = {
    {"kind", "\"power_lost\"", "the power of a robot's controller goes off, and stays off", true},
    OF_EVERY_FAULT,
    ROBOT,
    END};
const wh_reader_field_t wh_layout_fault_emergency_stop[] = {
    {"kind", "\"emergency_stop\"", "somebody presses a robot's emergency stop, and lets go of it", true},
    OF_EVERY_FAULT,
    ROBOT,
    END};
const wh_reader_field_t wh_layout_fault_servo_error[] = {
    {"kind", "\"servo_error\"", "a servo of a robot fails", true}, OF_EVERY_FAULT, ROBOT, END};
const wh_reader_field_t wh_layout_fault_missing[] = {
    {"kind", "\"wafer_missing\"", "the wafer is taken out of the cell", true}, OF_EVERY_FAULT, WAFER, END};
const wh_reader_field_t wh_layout_fault_doubled[] = {
    {"kind", "\"wafer_doubled\"", "the wafer lies on another one, in the same slot", true},
    OF_EVERY_FAULT,
    WAFER,
    {"onto", "string", "the other wafer", true},
    END};
const wh_reader_field_t wh_layout_fault_crossed[] = {
    {"kind", "\"wafer_crossed\"", "one edge lies higher than the other", true},
    OF_EVERY_FAULT,
    WAFER,
    {"value", NUMBER, "mm by which it does", false, .otherwise = "the pitch, at most half the diameter"},
    END};
const wh_reader_field_t wh_layout_fault_shifted[] = {
    {"kind", "\"wafer_shifted\"", "the wafer is moved, in its own frame", true},
    OF_EVERY_FAULT,
    WAFER,
    {"dx", NUMBER, "mm", false, APART(-1000, 1000, 0)},
    {"dy", NUMBER, "mm", false, APART(-1000, 1000, 0)},
    {"dz", NUMBER, "mm", false, APART(-1000, 1000, 0)},
    END};
const wh_reader_field_t wh_layout_fault_tilted[] = {
    {"kind", "\"wafer_tilted\"", "the wafer is turned, in its own frame", true},
    OF_EVERY_FAULT,
    WAFER,
    {"rpy", TRIPLE, "roll, pitch, yaw in degrees", true},
    END};

const wh_reader_field_t *const wh_layout_fault_fields[WH_FAULT_KINDS] = {
    [WH_FAULT_NO_VACUUM] = wh_layout_fault_of_gripper,
    [WH_FAULT_SLOW_VACUUM] = wh_layout_fault_slow_vacuum,
    [WH_FAULT_SENSOR_ON] = wh_layout_fault_of_gripper,
    [WH_FAULT_SENSOR_OFF] = wh_layout_fault_of_gripper,
    [WH_FAULT_LEAK] = wh_layout_fault_leak,
    [WH_FAULT_VALVE_STUCK] = wh_layout_fault_of_gripper,
    [WH_FAULT_AXIS_STOPPED] = wh_layout_fault_of_gripper,
    [WH_FAULT_COMMAND_LOST] = wh_layout_fault_of_command,
    [WH_FAULT_WAFER_MISSING] = wh_layout_fault_missing,
    [WH_FAULT_WAFER_DOUBLED] = wh_layout_fault_doubled,
    [WH_FAULT_WAFER_CROSSED] = wh_layout_fault_crossed,
    [WH_FAULT_WAFER_SHIFTED] = wh_layout_fault_shifted,
    [WH_FAULT_WAFER_TILTED] = wh_layout_fault_tilted,
    [WH_FAULT_PLUNGER_STUCK] = wh_layout_fault_of_gripper,
    [WH_FAULT_PLUNGER_SLOW] = wh_layout_fault_slow_plunger,
    [WH_FAULT_DOOR_STUCK] = wh_layout_fault_door_stuck,
    [WH_FAULT_DOOR_SLOW] = wh_layout_fault_door_slow,
    [WH_FAULT_BEAM_DARK] = wh_layout_fault_of_beam,
    [WH_FAULT_BEAM_LIT] = wh_layout_fault_of_beam,
    [WH_FAULT_BEAM_LATE] = wh_layout_fault_late_beam,
    [WH_FAULT_PROBE_CLOSED] = wh_layout_fault_of_probe,
    [WH_FAULT_PROBE_OPEN] = wh_layout_fault_of_probe,
    [WH_FAULT_EDGE_SENSOR_STUCK] = wh_layout_fault_of_edge_sensor,
    [WH_FAULT_EDGE_SENSOR_LATE] = wh_layout_fault_of_edge_sensor,
    [WH_FAULT_STATION_STUCK] = wh_layout_fault_station_stuck,
    [WH_FAULT_STATION_SLOW] = wh_layout_fault_station_slow,
    [WH_FAULT_E84_STUCK] = wh_layout_fault_e84_stuck,
    [WH_FAULT_E84_LATE] = wh_layout_fault_e84_late,
    [WH_FAULT_POWER_LOST] = wh_layout_fault_power_lost,
    [WH_FAULT_EMERGENCY_STOP] = wh_layout_fault_emergency_stop,
    [WH_FAULT_SERVO_ERROR] = wh_layout_fault_servo_error,
};

/* ---------------------------------------------------------------------------------------------- studies */

/* The width of an error; of one wafer, station or gripper by default that of all. */
#define WIDTH(most) APART(0, most, 0)
#define PLACEMENT_FIELDS                                                                                     \
    {"dx", NUMBER, "mm, in the slot's frame", false, WIDTH(WH_ERRORS_MOST_MM)},                              \
        {"dy", NUMBER, "mm", false, WIDTH(WH_ERRORS_MOST_MM)},                                               \
        {"dz", NUMBER, "mm", false, WIDTH(WH_ERRORS_MOST_MM)},                                               \
        {"tilt", NUMBER, "degrees, about the slot's x and about its y", false, WIDTH(WH_ERRORS_MOST_DEG)},   \
        {"turn", NUMBER, "degrees, about z", false, WIDTH(WH_ERRORS_MOST_TURN_DEG)}, {                       \
        "shape", WORD, "how they are spread", false, SHAPE                                                   \
    }

#define TEACHING_FIELDS                                                                                      \
    {"x", NUMBER, "mm, along base's x", false, WIDTH(WH_ERRORS_MOST_MM)},                                    \
        {"y", NUMBER, "mm, along base's y", false, WIDTH(WH_ERRORS_MOST_MM)},                                \
        {"z", NUMBER, "mm, along base's z", false, WIDTH(WH_ERRORS_MOST_MM)},                                \
        {"roll", NUMBER, "degrees, about base's x", false, WIDTH(WH_ERRORS_MOST_DEG)},                       \
        {"pitch", NUMBER, "degrees, about base's y", false, WIDTH(WH_ERRORS_MOST_DEG)},                      \
        {"yaw", NUMBER, "degrees, about base's z", false, WIDTH(WH_ERRORS_MOST_DEG)}, {                      \
        "shape", WORD, "how they are spread", false, SHAPE                                                   \
    }

const wh_reader_field_t wh_layout_study_fields[] = {
    {"shape", WORD, "how all errors are spread", false, APART_WORD(WH_SHAPE_NORMAL, wh_layout_shape_words)},
    {"placement", "waferhand.placement", "of every wafer in its slot", false},
    {"teaching", "waferhand.teaching", "of every station, beside where it was taught", false},
    {"timing", "waferhand.timing", "of valves, vacuum, its sensors and processes", false},
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
    {"valve", NUMBER, "s by which a valve acts late", false, WIDTH(WH_ERRORS_MOST_S)},
    {"vacuum", NUMBER, "s by which the vacuum builds up more slowly", false, WIDTH(WH_ERRORS_MOST_S)},
    {"debounce", NUMBER, "s by which vacuum sensors tell a turn later", false, WIDTH(WH_ERRORS_MOST_S)},
    {"process", NUMBER, "s by which a station's process is longer or shorter", false,
     WIDTH(WH_ERRORS_MOST_PROCESS_S)},
    {"port", NUMBER, "s by which each step of a load port is longer or shorter", false,
     WIDTH(WH_ERRORS_MOST_PROCESS_S)},
    {"shape", WORD, "how they are spread", false, SHAPE},
    END};
const wh_reader_field_t wh_layout_valve_fields[] = {
    {"valve", NUMBER, "s by which it acts late", false, WIDTH(WH_ERRORS_MOST_S)},
    {"shape", WORD, "how that is spread", false, SHAPE},
    END};
const wh_reader_field_t wh_layout_rim_width_fields[] = {
    {"diameter", NUMBER, "mm, of the true diameter", false, WIDTH(2)},
    {"notch_depth", NUMBER, "mm", false, WIDTH(1)},
    {"notch_angle", NUMBER, "degrees, between the notch's flanks", false, WIDTH(15)},
    {"notch_bottom", NUMBER, "mm, of the radius of its bottom", false, WIDTH(1)},
    {"notch_corner", NUMBER, "mm, of the radii of its corners", false, WIDTH(1)},
    {"flat", NUMBER, "mm, of the primary flat's length", false, WIDTH(5)},
    {"second_flat", NUMBER, "mm, of the secondary flat's length", false, WIDTH(5)},
    {"chip_depth", NUMBER, "mm, of a chip more, somewhere", false, WIDTH(5)},
    {"chip_width", NUMBER, "mm, of that chip along the rim", false, WIDTH(30)},
    {"bow", NUMBER, "mm", false, WIDTH(2)},
    {"saddle", NUMBER, "mm, high in some direction", false, WIDTH(2)},
    {"glass", NUMBER, "part of the light that comes through", false, WIDTH(0.9)},
    {"shape", WORD, "how they are spread", false, SHAPE},
    END};

const wh_reader_field_t wh_layout_beam_width_fields[] = {
    {"dx", NUMBER, "mm by which it stands farther in", false, WIDTH(5)},
    {"dy", NUMBER, "mm by which it stands to the left", false, WIDTH(5)},
    {"late", NUMBER, "s by which its latches are late", false, WIDTH(0.001)},
    {"shape", WORD, "how they are spread", false, SHAPE},
    END};
