/* How much room a wafer has that a GET lifts. */
#include "../collision/gap.h"
#include "feasibility_internal.h"

/* Gaps above this are all the same, mm. */
#define FAR WH_REAL(1e4)

/* A wafer at the end of a GET, and the nearest thing so far. */
typedef struct {
    const wh_convex_t *wafer;
    wh_pose_t base_from_shape;
    wh_real_t least; /* FAR: nothing yet */
    bool hits;
} lifted_t;

static void measure(lifted_t *lifted, const wh_convex_t *other, const wh_pose_t *base_from_other) {
    wh_gap_t gap;
    wh_gap_measure(lifted->wafer, &lifted->base_from_shape, other, base_from_other, FAR, wh_vec3(0, 0, -1),
                   &gap);
    const wh_real_t found = gap.state == WH_GAP_CLEAR ? gap.gap : 0;
    lifted->least = found < lifted->least ? found : lifted->least;
    lifted->hits |= gap.state == WH_GAP_HIT || gap.state == WH_GAP_UNDECIDED;
}

/* The least height above the pads of a wafer that was taken. The check runs at slices, so it may lie a step
 * lower than where it is taken first. */
static wh_real_t find_height(const wh_layout_t *layout, const wh_layout_station_t *station) {
    const wh_grasp_config_t *grasp = &layout->grasp;
    const wh_real_t step =
        grasp->check == WH_CHECK_SAMPLED ? station->pickup_speed * (wh_real_t)layout->slice_us / 1000000 : 0;
    return grasp->seat ? 0 : wh_real_max(WH_SWEEP_INSIDE * grasp->tolerance.projz - step, 0);
}

/* The wafer of slot 1: tilted as it lay there, or level on the blade. */
static lifted_t lift(const wh_layout_t *layout, size_t station) {
    const wh_layout_station_t *s = &layout->stations[station];
    const wh_station_t *place = &layout->places[station];
    const wh_convex_t *wafer = &layout->world.wafer;
    wh_pose_t pose = layout->grasp.seat ? wh_layout_come_level(layout, place, 1) : wh_station_slot(place, 1);
    pose.r.z += s->offset + find_height(layout, s) * pose.R.m[2][2];
    const lifted_t lifted = {wafer, wh_pose_compose(&pose, &wafer->body_from_shape), FAR, false};
    return lifted;
}

static void say_lifted(wh_feasibility_t *check, size_t station) {
    const wh_layout_t *layout = check->layout;
    const wh_layout_station_t *s = &layout->stations[station];
    const wh_station_t *place = &layout->places[station];
    (void)wh_feasibility_add(check, WH_FINDING_ENTRY, (int32_t)station,
                             "%s: a GET lifts its wafer against the ledges or the wafer above: `offset` "
                             "%.6g mm, pitch %.4g mm, ledges %.4g mm, wafer %.4g mm, tilt %.4g deg",
                             s->name, (double)s->offset, (double)place->pitch,
                             (double)layout->shapes.ledge.thickness, layout->wafer_thickness,
                             wh_feasibility_tilt(place));
}

void wh_feasibility_lifted(wh_feasibility_t *check, size_t station) {
    const wh_layout_t *layout = check->layout;
    const wh_station_t *place = &layout->places[station];
    wh_entry_t *entry = &check->entries[station];
    if (place->slots < 2) {
        return;
    }
    lifted_t lifted = lift(layout, station);
    const wh_pose_t base_from_slot = wh_station_slot(place, 2);
    const wh_pose_t above = wh_pose_compose(&base_from_slot, &lifted.wafer->body_from_shape);
    measure(&lifted, lifted.wafer, &above);
    for (size_t i = 0; i < layout->world.part_count; ++i) {
        const wh_part_t *part = &layout->world.parts[i];
        if (part->kind == WH_PART_LEDGE && part->owner == (int32_t)station && part->slot == 2) {
            measure(&lifted, &part->convex, &part->convex.body_from_shape);
        }
    }
    entry->has_lifted = true;
    entry->lifted = lifted.least;
    if (lifted.hits) {
        say_lifted(check, station);
    }
}
