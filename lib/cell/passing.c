/* Held wafers that go through the ledges of a slot, through a chuck, or through other wafers (meeting.c). */
#include "station.h"

/* How far up through the station's slots a place is above slot 1. */
static wh_real_t height_of(const wh_station_t *station, const wh_vec3_t *place) {
    const wh_vec3_t up = wh_mat3_column(&station->base_from_station.R, 2);
    const wh_vec3_t from = wh_vec3_subtract(place, &station->base_from_station.r);
    return wh_vec3_dot(&up, &from);
}

/* How far up the centre of the face is that looks at the slots. */
static wh_real_t height_over(const wh_cell_t *cell, const wh_station_t *station,
                             const wh_pose_t *base_from_wafer) {
    const wh_vec3_t centre = wh_face_centre(base_from_wafer, cell->thickness, &station->base_from_station);
    return height_of(station, &centre);
}

/* How far below a slot's plane a wafer is when it has passed the slot. On the way up it is farther: a wafer
 * that the vacuum draws down onto its pads is not to pass its own slot as it is lifted. With a wide tolerance
 * a quarter of the pitch is enough: a stroke that ends below the slot above has not passed it. */
static wh_real_t depth_of(const wh_cell_t *cell, const wh_station_t *station, bool goes_up) {
    const wh_real_t projz = cell->tolerance.projz, quarter = station->pitch / 4;
    const wh_real_t most = quarter > projz ? quarter : projz;
    return !goes_up ? projz : 2 * projz < most ? 2 * projz : most;
}

/* How many of the station's slots are not above a wafer of this height: it is at most `depth` below their
 * planes. It never falls while the height grows, so no crossing falls between two slices. */
static int32_t count_below(const wh_station_t *station, wh_real_t height, wh_real_t depth) {
    const wh_real_t position = (height + depth) / station->pitch + 1;
    if (position == position && position >= 0 && position < (wh_real_t)station->slots) {
        return (int32_t)position;
    }
    return position > 0 ? station->slots : 0;
}

/* True if a wafer is over the slot, or below it. */
static bool is_over(const wh_cell_t *cell, const wh_station_t *station, const wh_place_t *place,
                    const wh_pose_t *base_from_wafer) {
    const wh_vec3_t up = wh_mat3_column(&station->base_from_station.R, 2);
    const wh_vec3_t n = wh_mat3_column(&base_from_wafer->R, 2);
    const wh_real_t cosine = wh_vec3_dot(&n, &up);
    const wh_real_t aside = wh_real_sqrt(place->dx * place->dx + place->dy * place->dy);
    return aside < cell->tolerance.projxy &&
           (place->face == WH_FACE_FRONT ? -cosine : cosine) > cell->tolerance.planar;
}

/* The number of slots below it, before and after a way. Both are equal if it passes none. */
typedef struct {
    int32_t before, after;
} counts_t;

static counts_t count_on_way(const wh_cell_t *cell, const wh_station_t *station, wh_real_t from,
                             wh_real_t to) {
    counts_t counts = {0, 0};
    if (to < from || to > from) {
        const wh_real_t depth = depth_of(cell, station, to > from);
        counts.before = count_below(station, from, depth);
        counts.after = count_below(station, to, depth);
    }
    return counts;
}

/* The wafer as it passes a slot's height, between two poses at these heights: its tilt is that of the end. */
static wh_pose_t pose_at(const wh_cell_t *cell, const wh_station_t *station, int32_t slot,
                         const wh_pose_t *base_from_wafer, const wh_pose_t *next,
                         const wh_real_t heights[2]) {
    const wh_real_t depth = depth_of(cell, station, heights[1] > heights[0]);
    const wh_real_t plane = (wh_real_t)(slot - 1) * station->pitch - depth;
    const wh_vec3_t way = wh_vec3_subtract(&next->r, &base_from_wafer->r);
    const wh_vec3_t part = wh_vec3_scale((plane - heights[0]) / (heights[1] - heights[0]), &way);
    const wh_pose_t pose = {next->R, wh_vec3_add(&base_from_wafer->r, &part)};
    return pose;
}

/* True if the wafer is over the slot as it passes its height. */
static bool is_over_on_way(const wh_cell_t *cell, const wh_station_t *station, int32_t slot,
                           const wh_pose_t *base_from_wafer, const wh_pose_t *next,
                           const wh_real_t heights[2]) {
    const wh_pose_t pose = pose_at(cell, station, slot, base_from_wafer, next, heights);
    const wh_place_t place = wh_cell_measure(cell, station, slot, &pose);
    return is_over(cell, station, &place, &pose);
}

static bool passes(const wh_cell_t *cell, int32_t s, const wh_pose_t *base_from_wafer, const wh_pose_t *next,
                   wh_passing_t *passing) {
    const wh_station_t *station = &cell->stations[s];
    const wh_real_t heights[2] = {height_over(cell, station, base_from_wafer),
                                  height_over(cell, station, next)};
    const counts_t counts = count_on_way(cell, station, heights[0], heights[1]);
    int32_t found = 0;
    for (int32_t below = counts.before; found == 0 && below < counts.after; ++below) {
        found = is_over_on_way(cell, station, below + 1, base_from_wafer, next, heights) ? below + 1 : 0;
    }
    for (int32_t slot = counts.before; found == 0 && slot > counts.after; --slot) {
        found = is_over_on_way(cell, station, slot, base_from_wafer, next, heights) ? slot : 0;
    }
    if (found != 0) {
        passing->station = s;
        passing->slot = found;
        passing->goes_up = counts.after > counts.before;
    }
    return found != 0;
}

bool wh_cell_passes(const wh_cell_t *cell, int32_t gripper, const wh_pose_t *base_from_wafer,
                    const wh_pose_t *next, wh_passing_t *passing) {
    for (size_t s = 0; s < cell->count; ++s) {
        if (cell->stations[s].chuck != gripper && passes(cell, (int32_t)s, base_from_wafer, next, passing)) {
            return true;
        }
    }
    return false;
}

static WH_OUT_OF_LINE bool goes_through(const wh_cell_t *cell, const wh_grasp_t *table,
                                        const wh_gripper_input_t *input, int32_t gripper,
                                        const wh_pose_t *base_from_wafer, wh_passing_t *passing) {
    const wh_gripper_t *holder = &table->storage.grippers[gripper];
    wh_pose_t next;
    wh_pose_compose_to(&input->base_from_gripper, &holder->gripper_from_wafer, &next);
    return wh_cell_passes(cell, gripper, base_from_wafer, &next, passing);
}

/* False if no back face passes a slot, wherever it is beside it: what most slices are. */
static bool may_pass(const wh_cell_t *cell, const wh_vec3_t *from, const wh_vec3_t *to) {
    bool may = cell->thickness > 0;
    for (size_t s = 0; s < cell->count && !may; ++s) {
        const wh_station_t *station = &cell->stations[s];
        const counts_t counts = count_on_way(cell, station, height_of(station, from), height_of(station, to));
        may = counts.before != counts.after;
    }
    return may;
}

/* A wafer goes with its gripper, and is let go at the slice's end. */
static bool is_pushed(const wh_cell_t *cell, const wh_grasp_t *table, const wh_gripper_input_t *input,
                      int32_t gripper, const wh_pose_t *base_from_wafer, wh_passing_t *passing) {
    const wh_gripper_t *holder = &table->storage.grippers[gripper];
    const wh_pose_t *base_from_gripper = &input->base_from_gripper;
    const wh_vec3_t aside = wh_mat3_transform(&base_from_gripper->R, &holder->gripper_from_wafer.r);
    const wh_vec3_t to = wh_vec3_add(&aside, &base_from_gripper->r);
    return may_pass(cell, &base_from_wafer->r, &to) &&
           goes_through(cell, table, input, gripper, base_from_wafer, passing);
}

/* True if the gripper's wafer is pushed through a slot or a wafer, or if its blade goes through one. */
static bool begins_passing(const wh_cell_t *cell, const wh_grasp_t *table, const wh_gripper_input_t inputs[],
                           uint32_t shut, size_t g, wh_passing_t *passing) {
    const int32_t wafer = table->storage.grippers[g].wafer;
    if (!wh_is_index(wafer, table->storage.wafer_count)) {
        return wafer == WH_NONE && (shut >> g & 1U) != 0 &&
               wh_cell_meets(cell, table, inputs, shut, g, passing);
    }
    if (!is_pushed(cell, table, &inputs[g], (int32_t)g, &table->storage.wafers[wafer].base_from_wafer,
                   passing) &&
        !wh_cell_meets(cell, table, inputs, shut, g, passing)) {
        return false;
    }
    passing->wafer = wafer;
    return true;
}

bool wh_cell_begin_passing(const wh_cell_t *cell, const wh_grasp_t *table, const wh_gripper_input_t inputs[],
                           uint32_t shut, wh_passing_t passing[]) {
    bool found = false;
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        passing[g].wafer = WH_NONE;
        passing[g].station = 0;
        passing[g].slot = 0;
        passing[g].goes_up = false;
        passing[g].other = WH_NONE;
        found = begins_passing(cell, table, inputs, shut, g, &passing[g]) || found;
    }
    return found;
}

static wh_event_t *say_pushed(const wh_grasp_t *table, size_t g, const wh_passing_t *passing,
                              wh_event_list_t *list) {
    static const wh_event_t blank = {.other = WH_NONE, .parts = {WH_NONE, WH_NONE}};
    wh_event_t *said = &list->events[list->count++];
    *said = blank;
    said->kind = WH_EVENT_PUSHED_THROUGH;
    said->slice = table->slice;
    said->measured_slice = table->slice;
    said->wafer = passing->wafer;
    said->gripper = (int32_t)g;
    said->other = passing->other;
    return said;
}

/* Passive pads leave a wafer at the plane, whatever they go on to do. Near the end of the range of numbers
 * there is no height, here and below. */
static void judge_in_slot(const wh_cell_t *cell, const wh_grasp_t *table, size_t g,
                          const wh_passing_t *passing, wh_event_list_t *list) {
    const wh_pose_t *pose = &table->storage.wafers[passing->wafer].base_from_wafer;
    const wh_station_t *station = &cell->stations[passing->station];
    const wh_place_t place = wh_cell_measure(cell, station, passing->slot, pose);
    const wh_real_t depth = depth_of(cell, station, passing->goes_up);
    const bool is_above = count_below(station, height_over(cell, station, pose), depth) >= passing->slot;
    if (is_above == passing->goes_up && wh_real_is_finite(place.dz)) {
        wh_event_t *said = say_pushed(table, g, passing, list);
        said->face = place.face;
        said->value = -place.dz;
        said->limit = depth;
        said->at = pose->r;
    }
}

/* How high the wafer, or the blade, now is over the wafer that it went through, along that one's normal; as
 * far as supports have let it go there. */
static void judge_in_wafer(const wh_cell_t *cell, const wh_grasp_t *table, size_t g,
                           const wh_passing_t *passing, wh_event_list_t *list) {
    const wh_grasp_storage_t *storage = &table->storage;
    const wh_pose_t *other = &storage->wafers[passing->other].base_from_wafer;
    const wh_vec3_t *own = passing->wafer == WH_NONE ? &storage->grippers[g].base_from_gripper.r
                                                     : &storage->wafers[passing->wafer].base_from_wafer.r;
    const wh_vec3_t up = wh_mat3_column(&other->R, 2);
    const wh_vec3_t from = wh_vec3_subtract(own, &other->r);
    const wh_real_t height = wh_vec3_dot(&up, &from);
    if (wh_real_is_finite(height) &&
        (passing->wafer == WH_NONE || passing->goes_up || height < -cell->tolerance.projz / 2)) {
        wh_event_t *said = say_pushed(table, g, passing, list);
        said->value = height;
        said->at = *own;
    }
}

void wh_cell_end_passing(const wh_cell_t *cell, const wh_grasp_t *table, const wh_passing_t passing[],
                         wh_event_list_t *list) {
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        if (list->count < list->capacity && passing[g].other != WH_NONE) {
            judge_in_wafer(cell, table, g, &passing[g], list);
        } else if (list->count < list->capacity && passing[g].wafer != WH_NONE) {
            judge_in_slot(cell, table, g, &passing[g], list);
        }
    }
}
