/* Checks how large meshes are: only their size shows a mistake in their unit or scale. */
#include "../layout/axes.h"
#include "feasibility_internal.h"

/* A mesh whose longest edge is shorter than this is a mistake, mm. */
#define SMALL 1.0

wh_vec3_t wh_feasibility_extent(const wh_convex_t *mesh) {
    const wh_pose_t here = wh_pose_identity();
    wh_vec3_t low;
    wh_vec3_t high;
    wh_convex_bounds(mesh, &here, &low, &high);
    return wh_vec3_subtract(&high, &low);
}

typedef struct {
    wh_vec3_t low, high;
    bool is_any;
} room_t;

static wh_real_t lesser(wh_real_t a, wh_real_t b) {
    return a < b ? a : b;
}

static void grow(room_t *room, const wh_vec3_t *at, wh_real_t reach) {
    const wh_vec3_t out = wh_vec3(reach, reach, 0);
    const wh_vec3_t low = wh_vec3_subtract(at, &out);
    const wh_vec3_t high = wh_vec3_add(at, &out);
    if (!room->is_any) {
        *room = (room_t){low, high, true};
    }
    room->low = wh_vec3(lesser(room->low.x, low.x), lesser(room->low.y, low.y), lesser(room->low.z, low.z));
    room->high = wh_vec3(wh_real_max(room->high.x, high.x), wh_real_max(room->high.y, high.y),
                         wh_real_max(room->high.z, high.z));
}

/* The diagonal of the box around all stations and all that the robots reach. */
static wh_real_t size_of_cell(const wh_layout_t *layout) {
    room_t room = {.is_any = false};
    for (size_t s = 0; s < layout->station_count; ++s) {
        if (layout->stations[s].taught) {
            grow(&room, &layout->places[s].base_from_station.r, layout->wafer_diameter / 2);
        }
    }
    const wh_carrier_t *carrier = layout->machine.carrier;
    for (size_t robot = 0; robot < wh_machine_robots(&layout->machine); ++robot) {
        const wh_vec3_t origin = wh_vec3(0, 0, 0);
        const bool is_placed = carrier && carrier->chain.is_placed;
        grow(&room, is_placed ? &carrier->chain.base_from_robot.r : &origin,
             wh_axis_reach(&layout->machine, robot).max);
        carrier = carrier ? carrier->next : NULL;
    }
    const wh_vec3_t edges = wh_vec3_subtract(&room.high, &room.low);
    return wh_vec3_norm(&edges);
}

void wh_feasibility_sizes(wh_feasibility_t *check) {
    const wh_layout_t *layout = check->layout;
    const wh_real_t most = size_of_cell(layout);
    for (size_t i = 0; i < layout->world.part_count; ++i) {
        const wh_convex_t *mesh = &layout->world.parts[i].convex;
        if (mesh->kind != WH_CONVEX_MESH) {
            continue;
        }
        const wh_vec3_t edges = wh_feasibility_extent(mesh);
        const wh_real_t longest = wh_real_max(edges.x, wh_real_max(edges.y, edges.z));
        if (longest < SMALL || longest > most) {
            (void)wh_feasibility_add(
                check, WH_FINDING_SIZE, WH_NONE,
                "%s: a mesh of %g by %g by %g mm is %s (its `unit`, or a URDF's `scale`, may be another)",
                layout->part_names[i], edges.x, edges.y, edges.z,
                longest < SMALL ? "smaller than 1 mm" : "larger than the cell");
            wh_feasibility_warn(check);
        }
    }
}
