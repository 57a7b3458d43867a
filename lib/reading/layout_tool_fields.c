/* The fields of a cell whose robots are times alone. */
#include "layout_tool.h"

#define END                                                                                                  \
    { NULL, NULL, NULL, false }
#define TIMES "number|table<string, number>"

const wh_reader_field_t wh_layout_timed_fields[] = {
    {"robot", "waferhand.timed_robot", "the one robot, of kind \"timed\"", false},
    {"robots", "table<string, waferhand.timed_robot>", "several of them by name", false},
    {"stations", "table<string, waferhand.timed_station>", "the stations by name", true},
    {"routes", "table<string, waferhand.route>",
     "by which wafers go, by name: a schedule is held against them; flows have their own", false},
    END};

const wh_reader_field_t wh_layout_timed_robot_fields[] = {
    {"kind", "\"timed\"", "a robot that is times alone", true},
    {"arms", "integer", "1 or 2; 1", false},
    {"at", "string", "the station in front of which it begins; the first one that it serves", false},
    {"pick", TIMES, "s, or by station, with `default`", true},
    {"place", TIMES, "s, or by station, with `default`", true},
    {"move", TIMES, "s, or by pair as in [\"A>B\"], with `default`; of a pair that is there once, both ways",
     false},
    {"swap", TIMES, "s, or by station; pick, move and place together", false},
    {"speed", "number", "mm/s, in place of move: along the straight way between the stations' places", false},
    END};

const wh_reader_field_t wh_layout_timed_station_fields[] = {
    {"kind", "\"slots\"|\"load_port\"", "slots; a load port's carriers come and go", false},
    {"slots", "integer", "1, of a load port 25", false},
    {"at", "number[]", "mm, for robots with a speed", false},
    {"by", "string|string[]|table<string, waferhand.timed_by>", "the robots that serve it; all", false},
    {"process", "number", "s, from when the wafer lies there and the door is shut; 0", false},
    {"window", "number", "s: the longest stay after the process", false},
    {"clean", "waferhand.clean", "a clean that comes after some wafers, or without them", false},
    {"pump", "waferhand.pump", "makes it a load lock", false},
    {"state", "\"vacuum\"|\"atmosphere\"", "of a load lock at the beginning; atmosphere", false},
    {"into", "integer[]", "slots of a load lock that only atmosphere's robots fill", false},
    {"out", "integer[]", "slots of a load lock that only vacuum's robots fill", false},
    {"door", "number|waferhand.timed_door", "s to open and to shut", false},
    END};

const wh_reader_field_t wh_layout_timed_by_fields[] = {
    {"side", "\"vacuum\"|\"atmosphere\"", "of a load lock", false},
    {"door", "number|waferhand.timed_door", "s, on this robot's side", false},
    END};

const wh_reader_field_t wh_layout_timed_door_fields[] = {
    {"open", "number", "s", true}, {"close", "number", "s", true}, END};
