/* A played run as data: rows out of what was kept, and a first play that gives the hash of what goes in. */
#include <stdlib.h>
#include <string.h>

#include "../layout/grips.h"
#include "../math/hash.h"
#include "../text/array.h"
#include "segments.h"

/* -------------------------------------------------------------------------------------------------- rows */

static wh_played_row_t *add_row(wh_segments_t *segments, wh_played_kind_t kind, int32_t command) {
    segments->rows =
        wh_array_grow(segments->rows, segments->row_count, &segments->row_capacity, sizeof *segments->rows);
    segments->origins = wh_array_grow(segments->origins, segments->row_count, &segments->origin_capacity,
                                      sizeof *segments->origins);
    wh_played_row_t *row = &segments->rows[segments->row_count];
    segments->origins[segments->row_count++] = (wh_segments_origin_t){command, 0};
    memset(row, 0, sizeof *row);
    row->kind = kind;
    row->gripper = WH_NONE;
    return row;
}

/* Adds a value to the last row; a full one goes on in another. */
static void add_value(wh_segments_t *segments, wh_real_t value) {
    if (segments->origins[segments->row_count - 1].values == WH_PLAYED_VALUES) {
        (void)add_row(segments, WH_PLAYED_MORE, segments->origins[segments->row_count - 1].command);
    }
    const size_t last = segments->row_count - 1;
    segments->rows[last].values[segments->origins[last].values++] = value;
}

static void add_places(wh_segments_t *segments, uint32_t axes, const wh_real_t places[], bool by_axis) {
    size_t own = 0;
    for (size_t axis = 0; axis < WH_AXES; ++axis) {
        if ((axes >> axis & 1U) != 0) {
            add_value(segments, places[by_axis ? axis : own++]);
        }
    }
}

static void add_line(wh_segments_t *segments, const wh_segment_t *segment) {
    const wh_vec3_t *travel = &segment->travel;
    const wh_real_t values[] = {travel->x, travel->y, travel->z, segment->speed, segment->acceleration};
    for (size_t i = 0; i < sizeof values / sizeof values[0]; ++i) {
        add_value(segments, values[i]);
    }
}

static void add_points(wh_segments_t *segments, const wh_kept_motion_t *motion) {
    for (size_t i = 0; i < motion->segment.point_count; ++i) {
        const wh_via_point_t *point = &motion->points[i];
        (void)add_row(segments, WH_PLAYED_POINT, motion->command);
        add_value(segments, point->blend);
        add_value(segments, point->reach[0]);
        add_value(segments, point->reach[1]);
        add_places(segments, motion->axes, point->q, false);
    }
}

static void add_slowness(wh_segments_t *segments, const wh_kept_motion_t *motion) {
    const wh_slowness_t *slowness = &motion->slowness;
    if (slowness->pace == 1 && slowness->share.speed == 1 && slowness->share.acceleration == 1) {
        return;
    }
    (void)add_row(segments, WH_PLAYED_SLOW, motion->command);
    add_value(segments, slowness->share.speed);
    add_value(segments, slowness->share.acceleration);
    add_value(segments, slowness->pace);
}

/* Waiting and valves are no motions. */
static wh_played_kind_t kind_of(const wh_segment_t *segment) {
    static const wh_played_kind_t kinds[] = {[WH_SEGMENT_AXES] = WH_PLAYED_AXES,
                                             [WH_SEGMENT_LINE] = WH_PLAYED_LINE,
                                             [WH_SEGMENT_WAY] = WH_PLAYED_WAY,
                                             [WH_SEGMENT_VIA] = WH_PLAYED_VIA};
    return kinds[segment->kind];
}

static void add_motion(wh_segments_t *segments, const wh_kept_motion_t *motion) {
    const wh_segment_t *segment = &motion->segment;
    wh_played_row_t *row = add_row(segments, kind_of(segment), motion->command);
    row->after = motion->after;
    row->slices = motion->slices;
    row->is_cut = motion->slices < motion->planned;
    row->gripper = row->kind == WH_PLAYED_AXES ? WH_NONE : segment->gripper;
    row->bits = motion->axes;
    if (segment->kind == WH_SEGMENT_LINE) {
        add_line(segments, segment);
    } else {
        if (segment->kind == WH_SEGMENT_WAY) {
            add_value(segments, segment->reach);
            add_value(segments, segment->reach2);
        }
        add_places(segments, motion->axes, segment->target, true);
    }
    add_slowness(segments, motion);
    add_points(segments, motion);
}

static void add_valves(wh_segments_t *segments, const wh_kept_valves_t *valves) {
    wh_played_row_t *row = add_row(segments, WH_PLAYED_VALVES, valves->command);
    row->after = valves->seq - 1;
    row->bits = valves->open;
}

static void add_place(wh_segments_t *segments, uint32_t axes, const wh_real_t at[WH_AXES], int64_t seq,
                      int32_t origin) {
    wh_played_row_t *row = add_row(segments, WH_PLAYED_PLACE, origin);
    row->after = seq - 1;
    row->bits = axes;
    add_places(segments, axes, at, true);
}

/* Valves and places that come before this slice. */
static void add_until(wh_segments_t *segments, const wh_mcs_kept_t *kept, size_t *valves, size_t *places,
                      int64_t after) {
    for (;;) {
        const int64_t valve = *valves < kept->valves_count ? kept->valves[*valves].seq - 1 : INT64_MAX;
        const int64_t place = *places < kept->place_count ? kept->places[*places].seq - 1 : INT64_MAX;
        const int64_t next = valve < place ? valve : place;
        if (next == INT64_MAX || next > after) {
            return;
        }
        if (valve <= place) {
            add_valves(segments, &kept->valves[(*valves)++]);
        } else {
            const wh_kept_place_t *at = &kept->places[(*places)++];
            add_place(segments, at->axes, at->at, at->seq, at->command);
        }
    }
}

/* All lists are in order of time. A segment that took no slice moved nothing. */
static void add_rows(wh_segments_t *segments, const wh_mcs_kept_t *kept) {
    size_t valves = 0;
    size_t places = 0;
    for (size_t i = 0; i < kept->motion_count; ++i) {
        add_until(segments, kept, &valves, &places, kept->motions[i].after);
        if (kept->motions[i].slices > 0) {
            add_motion(segments, &kept->motions[i]);
        }
    }
    add_until(segments, kept, &valves, &places, INT64_MAX);
}

/* ------------------------------------------------------------------------------------------------- parts */

/* The most motions that run at once. A motion that begins when another one ends takes its place. */
static size_t count_motions(const wh_segments_t *segments) {
    int64_t ends[WH_AXES] = {0}; /* at most one motion for each axis */
    size_t most = 0;
    for (size_t i = 0; i < segments->row_count; ++i) {
        const wh_played_row_t *row = &segments->rows[i];
        size_t place = 0;
        if (row->kind >= WH_PLAYED_VALVES) {
            continue;
        }
        while (place + 1 < WH_AXES && ends[place] > row->after) {
            ++place;
        }
        ends[place] = row->after + row->slices;
        most = place + 1 > most ? place + 1 : most;
    }
    return most;
}

static bool has_row(const wh_segments_t *segments, wh_played_kind_t kind) {
    bool any = false;
    for (size_t i = 0; i < segments->row_count; ++i) {
        any = any || segments->rows[i].kind == kind;
    }
    return any;
}

/* True for a run that orders something from edge sensors, or from beams. */
static bool scans(const wh_mcs_kept_t *kept) {
    bool any = false;
    for (size_t i = 0; i < kept->order_count; ++i) {
        any = any || kept->orders[i].scan.kind != WH_SCAN_KEEP;
    }
    return any;
}

static bool latches(const wh_mcs_kept_t *kept) {
    bool any = false;
    for (size_t i = 0; i < kept->order_count; ++i) {
        any = any || kept->orders[i].latch.kind != WH_LATCH_KEEP;
    }
    return any;
}

/* Those to which the run gives orders: a log has none. */
static void find_sensors(wh_played_parts_t *parts, const wh_layout_t *layout, const wh_mcs_kept_t *kept) {
    if (scans(kept)) {
        parts->set_scanning = wh_simulator_set_scanning;
        parts->scanning = wh_layout_scanning(layout);
    }
    if (latches(kept)) {
        parts->set_latching = wh_simulator_set_latching;
        parts->latching = wh_layout_latching(layout);
    }
}

static wh_played_parts_t find_parts(const wh_segments_t *segments, const wh_mcs_kept_t *kept) {
    const wh_layout_t *layout = segments->layout;
    wh_played_parts_t parts = {0};
    parts.take_ways = has_row(segments, WH_PLAYED_WAY) ? wh_track_take_ways : NULL;
    parts.take_vias = has_row(segments, WH_PLAYED_VIA) ? wh_track_take_vias : NULL;
    parts.begin_slowly = has_row(segments, WH_PLAYED_SLOW) ? wh_track_begin_slowly : NULL;
    parts.set_doors = layout->machine.door_count > 0 ? wh_simulator_set_doors : NULL;
    if (kept) {
        find_sensors(&parts, layout, kept);
    }
    if (wh_layout_has_grips(layout)) {
        parts.set_grips = wh_simulator_set_grips;
        parts.grips = wh_layout_grips(layout);
    }
    return parts;
}

static wh_pose_t *copy_places(const wh_layout_t *layout) {
    wh_pose_t *wafers = wh_array_new(layout->wafer_count, sizeof *wafers);
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        wafers[w] = layout->start[w].base_from_wafer;
    }
    return wafers;
}

static void fill_run(wh_segments_t *segments, const wh_mcs_kept_t *kept, int64_t slices, uint64_t hash) {
    const wh_layout_t *layout = segments->layout;
    segments->wafers = copy_places(layout);
    const wh_played_t run = {.machine = &layout->machine,
                             .rows = segments->rows,
                             .row_count = segments->row_count,
                             .motion_count = count_motions(segments),
                             .faults = kept ? kept->faults : NULL,
                             .fault_count = kept ? kept->fault_count : 0,
                             .orders = kept ? kept->orders : NULL,
                             .order_count = kept ? kept->order_count : 0,
                             .wafers = segments->wafers,
                             .wafer_count = layout->wafer_count,
                             .slice_us = layout->slice_us,
                             .config = layout->grasp,
                             .physics = layout->physics,
                             .cell = layout->cell,
                             .parts = find_parts(segments, kept),
                             .slices = slices,
                             .hash = hash};
    segments->run = run;
}

/* ------------------------------------------------------------------------------------------ a first play */

typedef struct {
    wh_player_t player;
    wh_gripper_t grippers[WH_GRIPPERS];
    wh_played_motion_t motions[WH_AXES];
    wh_slow_t slow;
} memory_t;

/* Plays the run, and takes the hash of what went in from that. True if it came to its own hash. */
static bool play(wh_played_t *run) {
    memory_t *memory = wh_array_new(1, sizeof *memory);
    wh_wafer_t *wafers = wh_array_new(2 * run->wafer_count, sizeof *wafers);
    wh_player_t *player = &memory->player;
    const wh_played_room_t room = {.wafers = wafers,
                                   .wafer_count = run->wafer_count,
                                   .grippers = memory->grippers,
                                   .gripper_count = run->machine->gripper_count,
                                   .motions = memory->motions,
                                   .motion_count = run->motion_count,
                                   .seen = wafers + run->wafer_count,
                                   .slow = &memory->slow};
    (void)wh_player_init(player, run, &room);
    while (wh_player_next(player)) {
    }
    run->inputs = player->inputs;
    const bool good = wh_player_is_as_recorded(player);
    free(wafers);
    free(memory);
    return good;
}

const char *wh_segments_make(wh_segments_t *segments, const wh_mcs_t *mcs, const char *path) {
    const wh_mcs_kept_t *kept = wh_mcs_kept(mcs);
    const wh_record_t *record = wh_mcs_record(mcs);
    *segments = (wh_segments_t){
        .record = record, .source = record->script, .layout = wh_mcs_true_layout(mcs), .path = path};
    if (!segments->layout) {
        return "a script with a cell";
    }
    if (segments->layout->tool) {
        return "robots with axes";
    }
    if (record->missed > 0) {
        return "a simulator that misses no slice";
    }
    add_rows(segments, kept);
    fill_run(segments, kept, record->slices, record->hash);
    return play(&segments->run) ? NULL
                                : "a run from the layout's own start, which comes to its hash again when it "
                                  "is played";
}

/* ---------------------------------------------------------------------------------------------- a log */

void wh_segments_begin(wh_segments_t *segments, const wh_layout_t *layout, const char *source,
                       const char *path) {
    *segments = (wh_segments_t){.source = source, .layout = layout, .path = path};
    wh_machine_home(&layout->machine, segments->q);
}

/* The axes that stand elsewhere than in the slice before, bit for bit. */
static uint32_t find_moved(const wh_segments_t *segments, const wh_command_t *command) {
    uint32_t moved = 0;
    for (size_t axis = 0; axis < command->axis_count; ++axis) {
        if (wh_double_bits(segments->q[axis]) != wh_double_bits(command->axes[axis])) {
            moved |= UINT32_C(1) << axis;
        }
    }
    return moved;
}

static uint32_t find_open(const wh_command_t *command) {
    uint32_t open = 0;
    for (size_t g = 0; g < command->gripper_count; ++g) {
        open |= command->grippers[g].valve == WH_VALVE_OPEN ? UINT32_C(1) << g : 0;
    }
    return open;
}

void wh_segments_keep(wh_segments_t *segments, const wh_command_t *command, size_t line) {
    const uint32_t moved = find_moved(segments, command);
    const uint32_t open = find_open(command);
    if (moved != 0) {
        add_place(segments, moved, command->axes, command->seq, (int32_t)line);
        memcpy(segments->q, command->axes, sizeof segments->q);
    }
    if (open != segments->open) {
        wh_played_row_t *row = add_row(segments, WH_PLAYED_VALVES, (int32_t)line);
        row->after = command->seq - 1;
        row->bits = open;
        segments->open = open;
    }
    segments->slices = command->seq;
}

const char *wh_segments_end(wh_segments_t *segments, uint64_t hash) {
    fill_run(segments, NULL, segments->slices, hash);
    return play(&segments->run) ? NULL : "a log that comes to its hash again when it is played";
}

void wh_segments_free(wh_segments_t *segments) {
    free(segments->rows);
    free(segments->origins);
    free(segments->wafers);
    *segments = (wh_segments_t){0};
}
