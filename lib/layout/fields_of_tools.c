/* The fields of a cell whose robots are times alone. */
#include "layout_fields_internal.h"

#define TIMES "number|table<string, number>"

const wh_reader_field_t wh_layout_timed_fields[] = {
    {"robot", "waferhand.timed_robot", "the one robot, of kind \"timed\"", false},
    {"robots", "table<string, waferhand.timed_robot>", "several of them by name", false},
    {"stations", "table<string, waferhand.timed_station>", "the stations by name", true},
    {"routes", "table<string, waferhand.route>",
     "by which wafers go, by name: a schedule is held against them; flows have their own", false},
    {"study", "waferhand.timed_study", "what trials draw: see waferhand study", false},
    END};

const wh_reader_field_t wh_layout_timed_study_fields[] = {
    {"shape", WORD, "how errors are spread", false, APART_WORD(WH_SHAPE_NORMAL, wh_layout_shape_words)},
    {"timing", "waferhand.timed_timing", "of processes", false},
    END};

const wh_reader_field_t wh_layout_timed_timing_fields[] = {
    {"process", NUMBER, "s by which each process of a station is longer or shorter in a trial", false,
     APART(0, WH_ERRORS_MOST_PROCESS_S, 0)},
    {"shape", WORD, "how that is spread", false, SHAPE},
    END};

const wh_reader_field_t wh_layout_timed_robot_fields[] = {
    {"kind", "\"timed\"", "a robot that is times alone", true},
    {"arms", "integer", "how many", false, APART(1, 2, 1)},
    {"at", "string", "the station in front of which it begins", false,
     .otherwise = "the first one that it serves"},
    {"pick", TIMES, "s, or by station, with `default`", true},
    {"place", TIMES, "s, or by station, with `default`", true},
    {"move", TIMES, "s, or by pair as in [\"A>B\"], with `default`; of a pair that is there once, both ways",
     false},
    {"swap", TIMES, "s, or by station", false, .otherwise = "pick, the default move and place together"},
    {"speed", NUMBER, "mm/s, in place of move: along the straight way between the stations' places", false,
     APART(1e-3, 1e6, ASKED)},
    END};

static const char *const kinds[] = {"slots", "load_port", NULL};

const wh_reader_field_t wh_layout_timed_station_fields[] = {
    {"kind", WORD, "a load port's carriers come and go", false, APART_WORD(0, kinds)},
    {"slots", "integer", "how many", false, APART(1, 100000, FOLLOWS), .otherwise = "1, of a load port 25"},
    {"at", TRIPLE, "mm, for robots with a speed", false},
    {"by", "string|string[]|table<string, waferhand.timed_by>", "the robots that serve it", false,
     .otherwise = "all"},
    STATION_TIMES(" and the door is shut", "waferhand.pump"),
    {"port", "waferhand.port", "of a load port: how long a carrier takes to come and to go", false,
     .otherwise = "no time"},
    {"into", "integer[]", "slots of a load lock that only atmosphere's robots fill", false},
    {"out", "integer[]", "slots of a load lock that only vacuum's robots fill", false},
    {"door", "number|waferhand.timed_door", "s to open and to shut", false},
    END};

const wh_reader_field_t wh_layout_timed_by_fields[] = {
    {"side", WORD, "of a load lock", false, APART_WORD(ASKED, wh_flow_side_words)},
    {"door", "number|waferhand.timed_door", "s, on this robot's side", false},
    END};

/* In a cell with axes. */
const wh_reader_field_t wh_layout_timed_way_fields[] = {
    {"side", WORD, "of a load lock: where it comes", false, APART_WORD(ASKED, wh_flow_side_words)},
    {"door", "string", "the door that opens for it, by name", false, .otherwise = "none"},
    END};

const wh_reader_field_t wh_layout_timed_door_fields[] = {
    {"open", NUMBER, "s", true, SECONDS(ASKED)}, {"close", NUMBER, "s", true, SECONDS(ASKED)}, END};
