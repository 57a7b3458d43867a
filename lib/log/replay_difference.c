/* Compares a recorded state with the replayed one, and names the first field that differs. */
#include <stdio.h>
#include <string.h>

#include "../sim/event_text.h"
#include "replay_internal.h"

typedef enum { REAL, PAIR, VECTOR, MATRIX, INT8, INT32, INT64 } kind_t;

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
                                      {"samples of the edge sensor", AT(state, sample_count), INT32},
                                      {"doors", AT(state, door_count), INT32},
                                      {"missed slices", AT(state, missed), INT64},
                                      {0}};

static const field_t scan_fields[] = {
    {"number", AT(state, scan_number), INT32},      {"goes on", AT(state, scan_armed), INT8},
    {"gripper", AT(state, scan_gripper), INT32},    {"count", AT(state, scan_count), INT32},
    {"first sample", AT(state, scan_first), INT64}, {"samples taken", AT(state, scan_taken), INT32},
    {"turn", AT(state, scan_turn), REAL},           {0}};

static const field_t latches_fields[] = {{"latches to come", AT(latching, waiting_count), INT32},
                                         {"latches", AT(latching, latch_count), INT32},
                                         {"number", AT(latching, number), INT32},
                                         {"armed", AT(latching, armed), INT8},
                                         {"first beam", AT(latching, first), INT32},
                                         {"beams", AT(latching, beams), INT32},
                                         {"slices", AT(latching, slice), INT64},
                                         {"crossings", AT(latching, crossings), INT32},
                                         {"lost latches", AT(latching, lost), INT32},
                                         {"broken beams", AT(latching, broken), INT32},
                                         {0}};

static const field_t latch_fields[] = {{"beam", AT(latch, beam), INT32},
                                       {"edge", AT(latch, edge), INT32},
                                       {"slice", AT(latch, slice), INT64},
                                       {"part", AT(latch, part), REAL},
                                       {0}};

static const field_t tail_fields[] = {{"sensors", AT(state, sensors), INT32},
                                      {"events were lost", AT(state, events_lost), INT8},
                                      {"hash", AT(state, hash), INT64},
                                      {0}};

static const field_t wafer_fields[] = {{"rotation", AT(wafer_state, rotation), MATRIX},
                                       {"position", AT(wafer_state, position), VECTOR},
                                       {"index of the holder", AT(wafer_state, holder), INT32},
                                       {"face", AT(wafer_state, face), INT8},
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
    {"plunger's phase", AT(gripper_state, grip_phase), INT8},
    {"index of the plunger's wafer", AT(gripper_state, grip_wafer), INT32},
    {"plunger's way or sensor's debounce", AT(gripper_state, grip_s), REAL},
    {"beyond the clearance", AT(gripper_state, grip_excess), REAL},
    {"where the plunger began", AT(gripper_state, grip_begin), PAIR},
    {"where the face lay then", AT(gripper_state, grip_lying), PAIR},
    {"the notch's axis then", AT(gripper_state, grip_notch), PAIR},
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
                                       {"face", AT(event, face), INT8},
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

static const size_t counts[] = {
    [REAL] = 1, [PAIR] = 2, [VECTOR] = 3, [MATRIX] = 9, [INT8] = 1, [INT32] = 1, [INT64] = 1};
static const size_t sizes[] = {
    [REAL] = 8, [PAIR] = 8, [VECTOR] = 8, [MATRIX] = 8, [INT8] = 1, [INT32] = 4, [INT64] = 8};

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
    if (field->kind == VECTOR || field->kind == PAIR) {
        (void)snprintf(name, 80, "%s %c", field->name, (char)('x' + (int)i));
    } else if (field->kind == MATRIX) {
        (void)snprintf(name, 80, "%s %zu,%zu", field->name, i / 3 + 1, i % 3 + 1);
    } else {
        (void)snprintf(name, 80, "%s", field->name);
    }
}

/* Compares by bits: -0 is not 0. */
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

/* Makes the state without events of the collision check; the other events go into `events`. Returns the
 * number left out. */
static int32_t leave_out_collisions(const waferhand_state *message, waferhand_event events[WH_LINK_EVENTS],
                                    waferhand_state *plain) {
    *plain = *message;
    plain->events = events;
    plain->event_count = 0;
    for (int32_t i = 0; i < message->event_count; ++i) {
        if (!wh_replay_is_collision(message->events[i].kind)) {
            events[plain->event_count++] = message->events[i];
        }
    }
    return message->event_count - plain->event_count;
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

/* Compares the events of states without those of the collision check. */
static bool events_differ(const waferhand_state *recorded, const waferhand_state *replayed,
                          wh_replay_difference_t *difference) {
    const int32_t counts_of[2] = {recorded->event_count, replayed->event_count};
    const int32_t both = counts_of[0] < counts_of[1] ? counts_of[0] : counts_of[1];
    for (int32_t i = 0; i < both; ++i) {
        if (event_differs((int)i + 1, &recorded->events[i], &replayed->events[i], difference)) {
            return true;
        }
    }
    if (counts_of[0] == counts_of[1]) {
        return false;
    }
    const bool lacks = counts_of[0] == both;
    const waferhand_event *event = lacks ? &replayed->events[both] : &recorded->events[both];
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

static bool scans_differ(const waferhand_state *recorded, const waferhand_state *replayed,
                         wh_replay_difference_t *difference) {
    static const field_t sample[] = {{"dark pixels", 0, INT32}, {0}};
    if (differ(scan_fields, "edge scan", recorded, replayed, difference)) {
        return true;
    }
    for (int32_t i = 0; i < recorded->sample_count; ++i) {
        char of[40];
        (void)snprintf(of, sizeof of, "edge scan, sample %d", (int)i + 1);
        if (differ(sample, of, &recorded->samples[i], &replayed->samples[i], difference)) {
            return true;
        }
    }
    return false;
}

static bool doors_differ(const wh_layout_t *layout, const waferhand_state *recorded,
                         const waferhand_state *replayed, wh_replay_difference_t *difference) {
    static const field_t place[] = {{"how far it is open", 0, REAL}, {0}};
    bool found = false;
    for (int32_t d = 0; !found && d < recorded->door_count; ++d) {
        found =
            differ(place, layout->door_list[d].name, &recorded->doors[d], &replayed->doors[d], difference);
    }
    return found;
}

static bool latches_differ(const waferhand_latching *recorded, const waferhand_latching *replayed,
                           wh_replay_difference_t *difference) {
    bool found = differ(latches_fields, "beams", recorded, replayed, difference);
    for (int32_t i = 0; !found && i < recorded->waiting_count; ++i) {
        found =
            differ(latch_fields, "a latch to come", &recorded->waiting[i], &replayed->waiting[i], difference);
    }
    for (int32_t i = 0; !found && i < recorded->latch_count; ++i) {
        found = differ(latch_fields, "a latch", &recorded->latches[i], &replayed->latches[i], difference);
    }
    return found;
}

static bool sensing_differs(const wh_layout_t *layout, const waferhand_state *recorded,
                            const waferhand_state *replayed, wh_replay_difference_t *difference) {
    return scans_differ(recorded, replayed, difference) ||
           doors_differ(layout, recorded, replayed, difference) ||
           latches_differ(&recorded->latching, &replayed->latching, difference);
}

/* Names the first field that differs. False if no field of the tables differs. */
static bool name_difference(const wh_layout_t *layout, const waferhand_state *recorded,
                            const waferhand_state *replayed, wh_replay_difference_t *difference) {
    /* Compares the counts first: after that they are equal. */
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
           sensing_differs(layout, recorded, replayed, difference) ||
           differ(tail_fields, "", recorded, replayed, difference);
}

static size_t encode(const waferhand_state *message, uint8_t bytes[WH_LINK_DATAGRAM]) {
    const int size = waferhand_state_encode(bytes, 0, WH_LINK_DATAGRAM, message);
    return size > 0 ? (size_t)size : 0;
}

bool wh_replay_states_differ(const wh_layout_t *layout, const waferhand_state *recorded,
                             const waferhand_state *replayed, wh_replay_difference_t *difference) {
    static waferhand_event events[2][WH_LINK_EVENTS];
    static uint8_t bytes[2][WH_LINK_DATAGRAM];
    waferhand_state plain[2];
    const int32_t collisions = leave_out_collisions(recorded, events[0], &plain[0]);
    (void)leave_out_collisions(replayed, events[1], &plain[1]);
    if (collisions > 0 && recorded->events_lost != 0 && plain[1].event_count > plain[0].event_count) {
        plain[1].event_count = plain[0].event_count; /* the other events had no room beside those of the
                                                      * check */
    }
    plain[1].events_lost = replayed->events_lost;
    if (collisions > 0) {
        plain[1].events_lost = recorded->events_lost;
    }
    const size_t size = encode(&plain[0], bytes[0]);
    if (size > 8 && encode(&plain[1], bytes[1]) == size && memcmp(bytes[0], bytes[1], size - 8) == 0) {
        return false;
    }
    if (!name_difference(layout, &plain[0], &plain[1], difference)) {
        (void)snprintf(difference->what, sizeof difference->what, "another field");
        difference->recorded = difference->replayed = 0;
    }
    return true;
}
