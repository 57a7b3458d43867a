/* Where the bodies are, in a DRAW message. */
#include <stdlib.h>
#include <string.h>

#include "../layout/collision.h"
#include "../text/array.h"
#include "cell_internal.h"

void wh_view_place(wh_view_cell_t *cell, size_t body, const wh_pose_t *base_from_body) {
    wh_view_put_pose(base_from_body, cell->draw.position[body], cell->draw.quaternion[body]);
}

void wh_view_draw_open(wh_view_cell_t *cell) {
    const size_t count = (size_t)cell->load.num_links;
    const wh_pose_t here = wh_pose_identity();
    waferhand_viewer_draw *draw = &cell->draw;
    draw->num_links = cell->load.num_links;
    draw->link_name = wh_array_new(count, sizeof *draw->link_name);
    draw->robot_num = wh_array_new(count, sizeof *draw->robot_num);
    draw->position = wh_array_new(count, sizeof *draw->position);
    draw->quaternion = wh_array_new(count, sizeof *draw->quaternion);
    cell->places = wh_array_new(count, sizeof *cell->places);
    for (size_t i = 0; i < count; ++i) {
        draw->link_name[i] = cell->load.link[i].name;
        draw->position[i] = cell->places[i];
        draw->quaternion[i] = cell->places[i] + 3;
        wh_view_place(cell, i, &here);
    }
}

/* The arm is where a gripper on it says; without one it stays at home. */
static void place_robot(wh_view_cell_t *cell, const wh_pose_t base_from_grippers[]) {
    const wh_layout_t *layout = cell->layout;
    wh_pose_t bodies[WH_ARM_BODIES];
    (void)wh_collision_effector(&layout->machine, base_from_grippers, &cell->base_from_effector);
    wh_arm_place(&layout->shapes.arm, &cell->base_from_effector, bodies);
    for (size_t i = 0; i < WH_ARM_BODIES; ++i) {
        wh_view_place(cell, cell->links + i, &bodies[i]);
    }
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        wh_view_place(cell, cell->grippers + g, &base_from_grippers[g]);
    }
}

static void place_wafers(wh_view_cell_t *cell, const wh_wafer_t wafers[]) {
    for (size_t w = 0; w < cell->layout->wafer_count; ++w) {
        wh_view_place(cell, cell->wafers + w, &wafers[w].base_from_wafer);
    }
}

static void take_covers_away(wh_view_cell_t *cell) {
    wh_pose_t away = wh_pose_identity();
    away.r.z = -WH_VIEW_AWAY;
    for (size_t g = 0; g < cell->layout->machine.gripper_count; ++g) {
        wh_view_place(cell, cell->covers + g, &away);
    }
}

static void cover_held(wh_view_cell_t *cell, const wh_wafer_t wafers[]) {
    for (size_t w = 0; w < cell->layout->wafer_count; ++w) {
        if (wafers[w].holder != WH_NONE) {
            wh_view_place(cell, cell->covers + (size_t)wafers[w].holder, &wafers[w].base_from_wafer);
        }
    }
}

void wh_view_cell_move(wh_view_cell_t *cell, const wh_view_look_t *look) {
    cell->draw.timestamp = look->utime / 1000;
    place_robot(cell, look->base_from_grippers);
    place_wafers(cell, look->wafers);
    take_covers_away(cell);
    cover_held(cell, look->wafers);
}

/* A layout's wafers have no holders yet. */
void wh_view_cell_rest(wh_view_cell_t *cell) {
    const wh_layout_t *layout = cell->layout;
    wh_real_t axes[WH_AXES] = {0};
    wh_pose_t base_from_grippers[WH_GRIPPERS];
    memcpy(axes, layout->machine.robot.home, sizeof layout->machine.robot.home);
    wh_robot_forward(axes, &cell->base_from_effector);
    wh_machine_grippers(&layout->machine, axes, base_from_grippers);
    cell->draw.timestamp = 0;
    place_robot(cell, base_from_grippers);
    place_wafers(cell, layout->start);
    take_covers_away(cell);
}
