/* The probe of a gripper, and the blocks of a layout's stations that it touches. */
#include "../layout/axes.h"
#include "layout_internal.h"

/* The usual block stands before the slot by this and the wafer's radius, and below it, mm. */
#define BEFORE 30
#define BELOW 40

static void take_vector(const wh_vec3_t *from, double to[3]) {
    to[0] = (double)from->x;
    to[1] = (double)from->y;
    to[2] = (double)from->z;
}

/* ---------------------------------------------------------------------------------------------- the probe */

static void read_probe(wh_reader_t *reader, wh_layout_t *layout, size_t g) {
    static const wh_vec3_t below = {0, 0, -12};
    wh_layout_probe_t *probe = &layout->probe;
    if (!wh_reader_open(reader, "probe", wh_layout_probe_fields)) {
        return;
    }
    if (layout->grippers[g].station != WH_NONE) {
        wh_reader_fail(reader, NULL, "nothing: a probe is of a gripper on the robot");
    }
    if (probe->is_there) {
        wh_reader_fail(reader, NULL, "nothing: %s has the cell's probe",
                       layout->grippers[probe->gripper].name);
    }
    probe->is_there = true;
    probe->gripper = (int32_t)g;
    const wh_vec3_t at = wh_reader_vector(reader, "at", &below);
    take_vector(&at, probe->at);
    for (size_t i = 0; i < 3; ++i) {
        if (!(probe->at[i] >= -500 && probe->at[i] <= 500)) {
            (void)wh_reader_push(reader, "at");
            wh_reader_fail(reader, "at", "numbers from -500 to 500 mm");
        }
    }
    wh_reader_scalars(reader, probe);
    wh_reader_leave(reader);
}

static void find_probe(wh_reader_t *reader, wh_layout_t *layout) {
    if (!wh_reader_enter(reader, "grippers")) {
        return;
    }
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        wh_reader_enter_item(reader, (lua_Integer)g + 1);
        read_probe(reader, layout, g);
        wh_reader_leave(reader);
    }
    wh_reader_leave(reader);
}

/* --------------------------------------------------------------------------------------------- the blocks */

static void read_place(wh_reader_t *reader, const wh_layout_t *layout, wh_layout_block_t *block) {
    const wh_real_t before = -(wh_real_t)layout->wafer_diameter / 2 - BEFORE;
    const wh_vec3_t usual_at = {before, 0, -BELOW};
    const wh_vec3_t usual_size = {40, 200, 20};
    const wh_vec3_t at = wh_reader_vector(reader, "at", &usual_at);
    const wh_vec3_t size = wh_reader_vector(reader, "size", &usual_size);
    take_vector(&at, block->at);
    take_vector(&size, block->size);
    for (size_t i = 0; i < 3; ++i) {
        if (!(block->size[i] >= 10 && block->size[i] <= 1000)) {
            (void)wh_reader_push(reader, "size");
            wh_reader_fail(reader, "size", "numbers from 10 to 1000 mm");
        }
        if (!(block->at[i] >= -1000 && block->at[i] <= 1000)) {
            (void)wh_reader_push(reader, "at");
            wh_reader_fail(reader, "at", "numbers from -1000 to 1000 mm");
        }
    }
}

static void add_faces(wh_layout_t *layout, size_t s) {
    const wh_layout_probe_t *probe = &layout->probe;
    const size_t first = layout->beam_count;
    for (size_t face = 0; face < WH_BLOCK_FACES; ++face) {
        layout->beams[first + face] = (wh_layout_beam_t){.station = (int32_t)s};
        layout->doors[first + face] = (wh_door_beam_t){
            .seed = probe->seed,
            .stuck = probe->stuck,
            .kind = WH_DOOR_TOUCH,
            .touch = {.ball = {probe->at[0], probe->at[1], probe->at[2]}, .radius = probe->radius},
            .gripper = probe->gripper,
            .noise = probe->noise};
    }
    layout->beam_count += WH_BLOCK_FACES;
    for (size_t face = 0; face < WH_BLOCK_FACES; ++face) {
        wh_layout_place_beam(layout, first + face);
    }
}

/* The least cosine of the angle to the block's own way in at which a face still looks at the robot. */
#define LEAST_ALONG WH_REAL(0.98)

/* With several robots one of them has the probe, and comes to the block. */
static void check_toucher(wh_reader_t *reader, const wh_layout_t *layout, size_t s) {
    const size_t robot = layout->machine.mounts[layout->probe.gripper].robot;
    const char *name = layout->robots[robot].name;
    const wh_layout_approach_t *by = &layout->stations[s].by[robot];
    if (!wh_layout_is_usual(layout, robot)) {
        wh_reader_fail(reader, NULL,
                       "nothing: blocks are for " WH_AXES_USUAL_OF_SEVERAL ", and %s has the probe", name);
    }
    if (!by->serves) {
        wh_reader_fail(reader, NULL, "nothing: %s, which has the probe, does not serve the station", name);
    }
    const wh_vec3_t own = wh_mat3_column(&layout->places[s].base_from_station.R, 0);
    const wh_vec3_t in = wh_mat3_column(&by->R, 0);
    if (by->is_turned && wh_vec3_dot(&own, &in) < LEAST_ALONG) {
        wh_reader_fail(reader, NULL,
                       "nothing: %s, which has the probe, comes from another side than the "
                       "station's `rpy` says",
                       name);
    }
}

static void read_block(wh_reader_t *reader, wh_layout_t *layout, size_t s) {
    wh_layout_block_t *block = &layout->stations[s].block;
    if (!wh_reader_open(reader, "block", wh_layout_block_fields)) {
        return;
    }
    if (!wh_layout_is_shared(layout) && !wh_layout_is_usual(layout, 0)) {
        wh_reader_fail(reader, NULL, "nothing: blocks are for " WH_AXES_USUAL);
    }
    if (!layout->probe.is_there) {
        wh_reader_fail(reader, NULL, "nothing: no gripper has a `probe`");
    }
    if (layout->stations[s].by) {
        check_toucher(reader, layout, s);
    }
    if (layout->beam_count + WH_BLOCK_FACES > WH_BEAMS) {
        wh_reader_fail(reader, NULL, "at most %d beams and faces in all of the cell: a block has %d",
                       WH_BEAMS, WH_BLOCK_FACES);
    }
    if (layout->wafer_diameter < WH_SENSED_LEAST || layout->wafer_diameter > WH_SENSED_MOST) {
        wh_reader_fail(reader, NULL, "nothing: blocks are for wafers from %d to %d mm, these have %.12g",
                       WH_SENSED_LEAST, WH_SENSED_MOST, layout->wafer_diameter);
    }
    block->is_there = true;
    read_place(reader, layout, block);
    add_faces(layout, s);
    wh_reader_leave(reader);
}

void wh_layout_read_blocks(wh_reader_t *reader, wh_layout_t *layout) {
    find_probe(reader, layout);
    (void)wh_reader_enter(reader, "stations");
    for (size_t s = 0; s < layout->station_count; ++s) {
        wh_reader_enter(reader, layout->stations[s].name);
        read_block(reader, layout, s);
        wh_reader_leave(reader);
    }
    wh_reader_leave(reader);
}
