/* What of two states differs first, field by field. */
#include <stdio.h>
#include <string.h>

#include "../sim/event_text.h"
#include "replay_internal.h"

typedef enum { REAL, VECTOR, MATRIX, INT8, INT32, INT64 } kind_t;

typedef struct {
    const char *name; /* null ends a table */
    size_t offset;
    kind_t kind;
} field_t;

#define AT(type, member) offsetof(waferhand_##type, member)

static const field_t measured_fields[] = {{"dr", AT(measurement, dr), VECTOR},
                                          {"n1_proj_n2", AT(measurement, n1_proj_n2), REAL},
                                          {"dr_proj_z", AT(measurement, dr_proj_z), REAL},
                                          {"dr_proj_xy", AT(measurement, dr_proj_xy), VECTOR},
                                          {"dr_proj_xy_norm", AT(measurement, dr_proj_xy_norm), REAL},
                                          {0}};

static const field_t encounter_fields[] = {{"wafer", AT(encounter, wafer), INT32},
                                           {"holder", AT(encounter, holder), INT32},
                                           {"slice", AT(encounter, slice), INT64},
                                           {0}};

static const field_t head_fields[] = {{"utime", AT(state, utime), INT64},
                                      {"slice", AT(state, seq), INT64},
                                      {"run", AT(state, run), INT64},
                                      {"layout_hash", AT(state, layout_hash), INT64},
                                      {"status", AT(state, status), INT32},
                                      {"wafers", AT(state, wafer_count), INT32},
                                      {"grippers", AT(state, gripper_count), INT32},
                                      {"faults", AT(state, fault_count), INT32},
                                      {"missed slices", AT(state, missed), INT64},
                                      {0}};

static const field_t tail_fields[] = {
    {"sensors", AT(state, sensors), INT32}, {"hash", AT(state, hash), INT64}, {0}};

static const field_t wafer_fields[] = {{"rotation", AT(wafer_state, rotation), MATRIX},
                                       {"position", AT(wafer_state, position), VECTOR},
                                       {"index of the holder", AT(wafer_state, holder), INT32},
                                       {0}};

static const field_t gripper_fields[] = {
    {"rotation", AT(gripper_state, rotation), MATRIX},
    {"position", AT(gripper_state, position), VECTOR},
    {"valve", AT(gripper_state, valve), INT32},
    {"index of the held wafer", AT(gripper_state, wafer), INT32},
    {"the held wafer in its frame, rotation", AT(gripper_state, wafer_rotation), MATRIX},
    {"the held wafer in its frame, position", AT(gripper_state, wafer_position), VECTOR},
    {"vacuum level", AT(gripper_state, vacuum_level), REAL},
    {"valve's command", AT(gripper_state, valve_command), INT32},
    {"valve that was told", AT(gripper_state, valve_told), INT32},
    {"vacuum sensor", AT(gripper_state, vacuum_on), INT8},
    {"slips", AT(gripper_state, slips), INT8},
    {"positions known", AT(gripper_state, positions_known), INT32},
    {"the held wafer a slice before", AT(gripper_state, wafer_before[0]), VECTOR},
    {"the held wafer two slices before", AT(gripper_state, wafer_before[1]), VECTOR},
    {0}};

static const field_t event_fields[] = {{"kind", AT(event, kind), INT32},
                                       {"wafer", AT(event, wafer), INT32},
                                       {"gripper", AT(event, gripper), INT32},
                                       {"other", AT(event, other), INT32},
                                       {"status", AT(event, status), INT32},
                                       {"measured slice", AT(event, measured_slice), INT64},
                                       {"height", AT(event, height), REAL},
                                       {"value", AT(event, value), REAL},
                                       {"limit", AT(event, limit), REAL},
                                       {"first part", AT(event, parts[0]), INT32},
                                       {"second part", AT(event, parts[1]), INT32},
                                       {"place", AT(event, at), VECTOR},
                                       {0}};

static const field_t fault_fields[] = {{"phase", AT(fault_slot, phase), INT32},
                                       {"kind", AT(fault_slot, it.kind), INT32},
                                       {"target", AT(fault_slot, it.target), INT32},
                                       {"other", AT(fault_slot, it.other), INT32},
                                       {"value", AT(fault_slot, it.value), REAL},
                                       {"position", AT(fault_slot, it.position), VECTOR},
                                       {"rotation", AT(fault_slot, it.rotation), MATRIX},
                                       {"first slice", AT(fault_slot, it.from_seq), INT64},
                                       {"end", AT(fault_slot, it.until_seq), INT64},
                                       {"wafer before, position", AT(fault_slot, before_position), VECTOR},
                                       {"wafer before, rotation", AT(fault_slot, before_rotation), MATRIX},
                                       {"wafer placed, position", AT(fault_slot, placed_position), VECTOR},
                                       {"wafer placed, rotation", AT(fault_slot, placed_rotation), MATRIX},
                                       {0}};

/* ------------------------------------------------------------------------------------------------- fields */

static const size_t counts[] = {[REAL] = 1, [VECTOR] = 3, [MATRIX] = 9, [INT8] = 1, [INT32] = 1, [INT64] = 1};
static const size_t sizes[] = {[REAL] = 8, [VECTOR] = 8, [MATRIX] = 8, [INT8] = 1, [INT32] = 4, [INT64] = 8};

static double value_of(kind_t kind, const char *at) {
    union {
        double real;
        int8_t small;
        int32_t integer;
        int64_t wide;
    } value;
    memcpy(&value, at, sizes[kind]);
    if (kind == INT8) {
        return value.small;
    }
    if (kind == INT32) {
        return value.integer;
    }
    return kind == INT64 ? (double)value.wide : value.real;
}

static void name_entry(const field_t *field, size_t i, char name[80]) {
    if (field->kind == VECTOR) {
        (void)snprintf(name, 80, "%s %c", field->name, (char)('x' + (int)i));
    } else if (field->kind == MATRIX) {
        (void)snprintf(name, 80, "%s %zu,%zu", field->name, i / 3 + 1, i % 3 + 1);
    } else {
        (void)snprintf(name, 80, "%s", field->name);
    }
}

/* By their bits: -0 is not 0. */
static bool differ(const field_t fields[], const char *of, const void *recorded, const void *replayed,
                   wh_replay_difference_t *difference) {
    for (const field_t *field = fields; field->name; ++field) {
        const char *a = (const char *)recorded + field->offset;
        const char *b = (const char *)replayed + field->offset;
        for (size_t i = 0; i < counts[field->kind]; ++i, a += sizes[field->kind], b += sizes[field->kind]) {
            if (memcmp(a, b, sizes[field->kind]) != 0) {
                char name[80];
                name_entry(field, i, name);
                (void)snprintf(difference->what, sizeof difference->what, "%.70s%s%s", of, of[0] ? ", " : "",
                               name);
                difference->recorded = value_of(field->kind, a);
                difference->replayed = value_of(field->kind, b);
                return true;
            }
        }
    }
    return false;
}

/* ------------------------------------------------------------------------------------------------- states */

bool wh_replay_is_collision(int32_t kind) {
    return kind == WH_EVENT_HIT || kind == WH_EVENT_UNDECIDED || kind == WH_EVENT_TOO_CLOSE;
}

/* The next event from `from` on that is not of the collision check, or the count. */
static int32_t next_event(const waferhand_state *message, int32_t from) {
    while (from < message->event_count && wh_replay_is_collision(message->events[from].kind)) {
        ++from;
    }
    return from;
}

static bool encounter_differs(const char *of, const char *which, const waferhand_encounter *recorded,
                              const waferhand_encounter *replayed, wh_replay_difference_t *difference) {
    char name[80];
    (void)snprintf(name, sizeof name, "%.40s, %s", of, which);
    return differ(encounter_fields, name, recorded, replayed, difference) ||
           differ(measured_fields, name, &recorded->measured, &replayed->measured, difference);
}

static bool gripper_differs(const char *of, const waferhand_gripper_state *recorded,
                            const waferhand_gripper_state *replayed, wh_replay_difference_t *difference) {
    return differ(gripper_fields, of, recorded, replayed, difference) ||
           encounter_differs(of, "closest approach", &recorded->approach, &replayed->approach, difference) ||
           encounter_differs(of, "contest", &recorded->contest, &replayed->contest, difference);
}

static bool event_differs(int number, const waferhand_event *recorded, const waferhand_event *replayed,
                          wh_replay_difference_t *difference) {
    char of[20];
    (void)snprintf(of, sizeof of, "event %d", number);
    return differ(event_fields, of, recorded, replayed, difference) ||
           differ(measured_fields, of, &recorded->measured, &replayed->measured, difference);
}

static bool events_differ(const waferhand_state *recorded, const waferhand_state *replayed,
                          wh_replay_difference_t *difference) {
    int32_t a = next_event(recorded, 0);
    int32_t b = next_event(replayed, 0);
    for (int number = 1; a < recorded->event_count && b < replayed->event_count; ++number) {
        if (event_differs(number, &recorded->events[a], &replayed->events[b], difference)) {
            return true;
        }
        a = next_event(recorded, a + 1);
        b = next_event(replayed, b + 1);
    }
    if (a == recorded->event_count && b == replayed->event_count) {
        return false;
    }
    const bool lacks = a == recorded->event_count;
    const waferhand_event *event = lacks ? &replayed->events[b] : &recorded->events[a];
    (void)snprintf(difference->what, sizeof difference->what, "event: %s",
                   wh_event_name((wh_event_kind_t)event->kind));
    difference->recorded = lacks ? 0 : 1;
    difference->replayed = lacks ? 1 : 0;
    return true;
}

static bool faults_differ(const waferhand_state *recorded, const waferhand_state *replayed,
                          wh_replay_difference_t *difference) {
    for (int32_t i = 0; i < recorded->fault_count; ++i) {
        char of[20];
        (void)snprintf(of, sizeof of, "fault %d", (int)i + 1);
        if (differ(fault_fields, of, &recorded->faults[i], &replayed->faults[i], difference)) {
            return true;
        }
    }
    return false;
}

bool wh_replay_differs(const wh_layout_t *layout, const waferhand_state *recorded,
                       const waferhand_state *replayed, wh_replay_difference_t *difference) {
    /* The counts first: behind them they are the same. */
    if (differ(head_fields, "", recorded, replayed, difference)) {
        return true;
    }
    for (int32_t w = 0; w < recorded->wafer_count; ++w) {
        if (differ(wafer_fields, layout->wafers[w].name, &recorded->wafers[w], &replayed->wafers[w],
                   difference)) {
            return true;
        }
    }
    for (int32_t g = 0; g < recorded->gripper_count; ++g) {
        if (gripper_differs(layout->grippers[g].name, &recorded->grippers[g], &replayed->grippers[g],
                            difference)) {
            return true;
        }
    }
    return events_differ(recorded, replayed, difference) || faults_differ(recorded, replayed, difference) ||
           differ(tail_fields, "", recorded, replayed, difference);
}
