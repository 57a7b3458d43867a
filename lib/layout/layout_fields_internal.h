/* Shared by the files that have the rows of fields: how a row is written, and the rows of faults. */
#ifndef WH_LAYOUT_LAYOUT_FIELDS_INTERNAL_H
#define WH_LAYOUT_LAYOUT_FIELDS_INTERNAL_H

#include "layout.h"
#include "layout_fields.h"
#include "times.h"
#include "words.h"

#define NUMBER "number"
#define TRIPLE "number[]"
#define BY_RECIPE "number|table<string, number>"
#define SWITCH "boolean"
#define WORD "" /* its type is its words: wh_field_type */
#define END                                                                                                  \
    { NULL, NULL, NULL, false }

/* Where a struct has a member, which is as large as its kind needs. */
#define AT(of, member, kind)                                                                                 \
    (offsetof(of, member) + 0 * sizeof(char[sizeof(((of *)0)->member) == sizeof(kind) ? 1 : -1]))
#define AS_NUMBER(of, member, least, most, usual) WH_SCALAR_NUMBER, AT(of, member, double), least, most, usual
#define AS_DEGREES(of, member, least, most, usual)                                                           \
    WH_SCALAR_DEGREES, AT(of, member, double), least, most, usual
#define AS_WHOLE(of, member, least, most, usual) WH_SCALAR_WHOLE, AT(of, member, int32_t), least, most, usual
#define AS_SEED(of, member) WH_SCALAR_SEED, AT(of, member, uint64_t), 0, INT32_MAX, 1
#define AS_SWITCH(of, member, usual) WH_SCALAR_SWITCH, AT(of, member, bool), 0, 1, usual
#define AS_WORD(of, member, usual, words) WH_SCALAR_WORD, AT(of, member, int32_t), 0, 0, usual, words
#define APART(least, most, usual) WH_SCALAR_APART, 0, least, most, usual
#define APART_SWITCH(usual) WH_SCALAR_APART, 0, 0, 1, usual
#define APART_WORD(usual, words) WH_SCALAR_APART, 0, 0, 0, usual, words
/* A time, in the table's s; and one that is not 0: what repeats in no time would do so for ever. */
#define SECONDS(usual) APART(0, WH_LAYOUT_LONGEST_S, usual)
#define SECONDS_ABOVE_0(usual) APART(1e-6, WH_LAYOUT_LONGEST_S, usual)
/* The fields of a station that takes time, in a cell with axes and in one of times alone. */
#define STATION_TIMES(since, lock)                                                                           \
    {"process", BY_RECIPE, "s, also by recipe, from when the wafer lies there" since, false, SECONDS(0)},    \
        {"window", NUMBER,           "s: the longest stay after the process",                                \
         false,    SECONDS(FOLLOWS), .otherwise = "any"},                                                    \
        {"clean", "waferhand.clean", "a clean that comes after some wafers, or without them", false},        \
        {"pump", lock, "makes it a load lock", false}, {                                                     \
        "state", WORD, "of a load lock when a run begins", false, APART_WORD(0, wh_flow_side_words)          \
    }
/* How errors are spread: as the study says, or the table for all. */
#define SHAPE APART_WORD(FOLLOWS, wh_layout_shape_words), .otherwise = "that of the study"
#define ASKED WH_FIELD_FOLLOWS /* there is no default */
#define FOLLOWS WH_FIELD_FOLLOWS
#define KEPT WH_FIELD_KEPT

extern const wh_reader_field_t wh_layout_fault_of_gripper[];
extern const wh_reader_field_t wh_layout_fault_slow_plunger[];
extern const wh_reader_field_t wh_layout_fault_slow_vacuum[];
extern const wh_reader_field_t wh_layout_fault_leak[];
extern const wh_reader_field_t wh_layout_fault_of_command[];
extern const wh_reader_field_t wh_layout_fault_door_stuck[];
extern const wh_reader_field_t wh_layout_fault_door_slow[];
extern const wh_reader_field_t wh_layout_fault_of_beam[];
extern const wh_reader_field_t wh_layout_fault_late_beam[];
extern const wh_reader_field_t wh_layout_fault_of_probe[];
extern const wh_reader_field_t wh_layout_fault_of_edge_sensor[];
extern const wh_reader_field_t wh_layout_fault_station_stuck[];
extern const wh_reader_field_t wh_layout_fault_station_slow[];
extern const wh_reader_field_t wh_layout_fault_e84_stuck[];
extern const wh_reader_field_t wh_layout_fault_e84_late[];
extern const wh_reader_field_t wh_layout_fault_power_lost[];
extern const wh_reader_field_t wh_layout_fault_emergency_stop[];
extern const wh_reader_field_t wh_layout_fault_servo_error[];
extern const wh_reader_field_t wh_layout_fault_missing[];
extern const wh_reader_field_t wh_layout_fault_doubled[];
extern const wh_reader_field_t wh_layout_fault_crossed[];
extern const wh_reader_field_t wh_layout_fault_shifted[];
extern const wh_reader_field_t wh_layout_fault_tilted[];

#endif
