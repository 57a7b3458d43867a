/* Finds the contacts in a layout before anything moves: at the start, and with a wafer in every slot. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../layout/arms.h"
#include "../layout/doors.h"
#include "../text/array.h"
#include "feasibility_internal.h"

/* How many contacts are named; the others are counted. */
#define NAMED_CONTACTS 100
/* The most contacts of a full cell that are told apart. */
#define FULL_CONTACTS 100000

/* The contacts of a cell with these wafers, the robot at home: their number, and the first `capacity`. */
static size_t find_contacts(const wh_feasibility_t *check, const wh_world_config_t *world,
                            const wh_wafer_t wafers[], int32_t pairs[][2], size_t capacity) {
    const size_t bytes = wh_world_bytes(world);
    void *memory = wh_array_new(1, bytes);
    wh_gripper_t grippers[WH_GRIPPERS];
    memset(grippers, 0, sizeof grippers);
    for (size_t g = 0; g < world->gripper_count; ++g) {
        grippers[g].base_from_gripper = check->base_from_grippers[g];
        grippers[g].wafer = WH_NONE;
        grippers[g].valve = WH_VALVE_CLOSED;
    }
    wh_pose_t base_from_door[WH_DOORS];
    wh_layout_place_doors(check->layout, NULL, NULL, base_from_door);
    const wh_world_input_t input = {0, wafers, grippers, check->links.bodies, base_from_door};
    const size_t count =
        wh_world_check_rest(wh_world_init(world, &input, memory, bytes), &input, pairs, capacity);
    free(memory);
    return count;
}

/* ------------------------------------------------------------------------------------------- at the start */

/* The arm whose link this part is; WH_NONE: it is none. */
static int32_t arm_of(const wh_layout_t *layout, int32_t part) {
    const bool is_link =
        (size_t)part < layout->world.part_count && layout->world.parts[part].kind == WH_PART_ARM;
    return is_link ? layout->world.parts[part].owner / WH_ARM_BODIES : WH_NONE;
}

/* True of links of both arms of one robot, as no file gives them. */
static bool is_of_two_arms(const wh_layout_t *layout, const int32_t pair[2]) {
    const int32_t one = arm_of(layout, pair[0]);
    const int32_t other = arm_of(layout, pair[1]);
    return one != WH_NONE && other != WH_NONE && one != other && wh_layout_arms(layout) > 1 &&
           layout->arms[one].robot == layout->arms[other].robot &&
           !layout->robots[layout->arms[one].robot].urdf;
}

void wh_feasibility_contacts(wh_feasibility_t *check) {
    const wh_layout_t *layout = check->layout;
    wh_wafer_t *wafers = wh_array_new(layout->wafer_count, sizeof *wafers);
    int32_t pairs[NAMED_CONTACTS][2];
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        wafers[w].base_from_wafer = layout->start[w].base_from_wafer;
        wafers[w].holder = WH_NONE;
    }
    const size_t count = find_contacts(check, &layout->world, wafers, pairs, NAMED_CONTACTS);
    for (size_t i = 0; i < count && i < NAMED_CONTACTS; ++i) {
        wh_finding_t *finding = wh_feasibility_add(
            check, WH_FINDING_CONTACT, WH_NONE, "%s and %s touch before anything moves%s",
            wh_layout_part_name(layout, pairs[i][0]), wh_layout_part_name(layout, pairs[i][1]),
            is_of_two_arms(layout, pairs[i]) ? ": `height` lifts a hand, the links of both arms are at one "
                                               "height, unless a `urdf` has them"
                                             : "");
        memcpy(finding->parts, pairs[i], sizeof finding->parts);
    }
    if (count > NAMED_CONTACTS) {
        (void)wh_feasibility_add(check, WH_FINDING_CONTACT, WH_NONE,
                                 "%zu more pairs touch before anything moves", count - NAMED_CONTACTS);
    }
    free(wafers);
}

/* ---------------------------------------------------------------------------------- a wafer in every slot */

/* A wafer of a full cell, or a thing that it touches: a slot of a station, or a part. */
typedef struct {
    int32_t station, slot; /* slot 0: a part of the station; station WH_NONE: a part of none */
    int32_t part;          /* WH_NONE: a wafer */
} thing_t;

/* All contacts of one station with another one, or with a part that belongs to none. */
typedef struct {
    thing_t wafer, other; /* of the first contact */
    size_t count;
} meeting_t;

typedef struct {
    wh_world_config_t world;
    wh_wafer_t *wafers;
    thing_t *slots; /* by wafer */
    size_t count;
    meeting_t *meetings;
    size_t meeting_count, capacity;
} full_t;

/* A wafer in the middle of each taught slot. */
static void fill(full_t *full, const wh_layout_t *layout) {
    size_t count = 0;
    for (size_t s = 0; s < layout->station_count; ++s) {
        count += layout->stations[s].taught ? (size_t)layout->places[s].slots : 0;
    }
    full->world = layout->world;
    full->wafers = wh_array_new(count, sizeof *full->wafers);
    full->slots = wh_array_new(count, sizeof *full->slots);
    for (size_t s = 0; s < layout->station_count; ++s) {
        for (int32_t slot = 1; layout->stations[s].taught && slot <= layout->places[s].slots; ++slot) {
            full->wafers[full->count].base_from_wafer = wh_station_slot(&layout->places[s], slot);
            full->wafers[full->count].holder = WH_NONE;
            full->slots[full->count++] = (thing_t){(int32_t)s, slot, WH_NONE};
        }
    }
    full->world.wafer_count = full->count;
}

static thing_t thing_of(const full_t *full, int32_t part) {
    if ((size_t)part >= full->world.part_count) {
        return full->slots[(size_t)part - full->world.part_count];
    }
    const wh_part_t *from = &full->world.parts[part];
    const bool of_station = from->kind == WH_PART_FIXED || from->kind == WH_PART_LEDGE;
    const thing_t thing = {of_station ? from->owner : WH_NONE, 0, part};
    return thing;
}

/* Two stations meet once, in whatever order. */
static bool is_met(const meeting_t *meeting, const thing_t *wafer, const thing_t *other) {
    const bool same = meeting->wafer.station == wafer->station && meeting->other.station == other->station;
    const bool swapped = meeting->wafer.station == other->station && meeting->other.station == wafer->station;
    return other->station == WH_NONE ? same && meeting->other.part == other->part : same || swapped;
}

static void add_meeting(full_t *full, const int32_t pair[2]) {
    thing_t wafer = thing_of(full, pair[0]);
    thing_t other = thing_of(full, pair[1]);
    if (wafer.part != WH_NONE) {
        const thing_t part = wafer;
        wafer = other;
        other = part;
    }
    if (wafer.part != WH_NONE) {
        return; /* two parts: they touch at the start as well */
    }
    for (size_t i = 0; i < full->meeting_count; ++i) {
        if (is_met(&full->meetings[i], &wafer, &other)) {
            ++full->meetings[i].count;
            return;
        }
    }
    full->meetings =
        wh_array_grow(full->meetings, full->meeting_count, &full->capacity, sizeof *full->meetings);
    full->meetings[full->meeting_count++] = (meeting_t){wafer, other, 1};
}

/* True if it was found already that a wafer of this station touches the part at the start. */
static bool is_known(const wh_feasibility_t *check, const meeting_t *meeting) {
    const wh_layout_t *layout = check->layout;
    for (size_t i = 0; meeting->other.part != WH_NONE && i < check->count; ++i) {
        const wh_finding_t *finding = &check->findings[i];
        const size_t wafer = (size_t)finding->parts[0] - layout->world.part_count;
        if (finding->kind == WH_FINDING_CONTACT && wafer < layout->wafer_count &&
            finding->parts[1] == meeting->other.part &&
            layout->wafers[wafer].station == meeting->wafer.station) {
            return true;
        }
    }
    return false;
}

static void describe(const wh_layout_t *layout, const thing_t *thing, char *text, size_t size) {
    if (thing->part == WH_NONE) {
        snprintf(text, size, "one in %s slot %d", layout->stations[thing->station].name, (int)thing->slot);
    } else {
        const wh_part_kind_t kind = layout->world.parts[thing->part].kind;
        const bool moves = kind == WH_PART_ARM || kind == WH_PART_BLADE;
        snprintf(text, size, "%s%s", layout->part_names[thing->part],
                 moves ? ", with the robot at home" : "");
    }
}

static void say_meeting(wh_feasibility_t *check, const meeting_t *meeting) {
    const wh_layout_t *layout = check->layout;
    const char *name = layout->stations[meeting->wafer.station].name;
    const bool is_other =
        meeting->other.station != WH_NONE && meeting->other.station != meeting->wafer.station;
    char other[WH_PART_NAME_SIZE + 40];
    char begin[2 * WH_NAME_SIZE + 40] = "";
    char rest[40] = "";
    describe(layout, &meeting->other, other, sizeof other);
    if (is_other) {
        snprintf(begin, sizeof begin, "%s and %s overlap: ", name,
                 layout->stations[meeting->other.station].name);
    }
    if (meeting->count > 1) {
        snprintf(rest, sizeof rest, "; so do %zu more pairs", meeting->count - 1);
    }
    wh_finding_t *finding = wh_feasibility_add(check, WH_FINDING_SPACE, meeting->wafer.station,
                                               "%sa wafer in %s slot %d touches %s%s", begin, name,
                                               (int)meeting->wafer.slot, other, rest);
    finding->slot = meeting->wafer.slot;
    finding->other = is_other ? meeting->other.station : WH_NONE;
}

void wh_feasibility_full(wh_feasibility_t *check) {
    full_t full = {.count = 0};
    int32_t(*pairs)[2] = wh_array_new(FULL_CONTACTS, sizeof *pairs);
    fill(&full, check->layout);
    const size_t count = find_contacts(check, &full.world, full.wafers, pairs, FULL_CONTACTS);
    for (size_t i = 0; i < count && i < FULL_CONTACTS; ++i) {
        add_meeting(&full, pairs[i]);
    }
    for (size_t i = 0; i < full.meeting_count; ++i) {
        if (!is_known(check, &full.meetings[i])) {
            say_meeting(check, &full.meetings[i]);
        }
    }
    free(full.wafers);
    free(full.slots);
    free(full.meetings);
    free(pairs);
}
