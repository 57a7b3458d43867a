#include "collision.h"

bool wh_collision_effector(const wh_machine_t *machine, const wh_pose_t base_from_grippers[],
                           wh_pose_t *base_from_effector) {
    for (size_t g = 0; g < machine->gripper_count; ++g) {
        const wh_mount_t *mount = &machine->mounts[g];
        if (mount->axis != WH_NONE) {
            continue;
        }
        *base_from_effector = base_from_grippers[g];
        if (mount->is_shifted) {
            const wh_pose_t identity = wh_pose_identity();
            const wh_pose_t gripper_from_effector =
                wh_pose_relative(&mount->effector_from_gripper, &identity);
            *base_from_effector = wh_pose_compose(&base_from_grippers[g], &gripper_from_effector);
        }
        return true;
    }
    return false;
}

/* After a step that left wafers and grippers so. */
static void look_at(wh_collision_t *collision, uint64_t slice, const wh_wafer_t wafers[],
                    const wh_gripper_t grippers[], wh_event_list_t *list) {
    const wh_layout_t *layout = collision->layout;
    wh_pose_t poses[WH_GRIPPERS];
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        poses[g] = grippers[g].base_from_gripper;
    }
    (void)wh_collision_effector(&layout->machine, poses, &collision->base_from_effector);
    const wh_world_input_t input = {slice, wafers, grippers, collision->base_from_effector};
    if (collision->world) {
        wh_world_step(collision->world, &input, list);
    } else {
        collision->world =
            wh_world_init(&layout->world, &input, collision->memory, wh_collision_bytes(layout));
    }
}

static void place(wh_collision_t *collision, const wh_wafer_t wafers[], int32_t wafer) {
    if (collision->world) {
        wh_world_place(collision->world, wafer, &wafers[wafer].base_from_wafer);
    }
}

static void on_step(void *user, const wh_gripper_input_t inputs[], const wh_grasp_t *table,
                    wh_event_list_t *list) {
    (void)inputs; /* the table's grippers are there by now */
    look_at(user, table->slice, table->storage.wafers, table->storage.grippers, list);
}

static void on_placed(void *user, const wh_grasp_t *table, int32_t wafer) {
    place(user, table->storage.wafers, wafer);
}

void wh_collision_observe(wh_collision_t *collision, const wh_state_t *state) {
    for (size_t i = 0; i < state->event_count; ++i) {
        const wh_event_t *event = &state->events[i];
        const bool by_fault = event->kind == WH_EVENT_FAULT_ARMED || event->kind == WH_EVENT_FAULT_CLEARED;
        if (by_fault && event->wafer != WH_NONE) {
            place(collision, state->wafers, event->wafer);
        }
    }
    look_at(collision, (uint64_t)state->seq, state->wafers, state->grippers, NULL);
}

size_t wh_collision_bytes(const wh_layout_t *layout) {
    return wh_world_bytes(&layout->world);
}

void wh_collision_attach(wh_collision_t *collision, const wh_layout_t *layout, wh_simulator_t *simulator,
                         void *memory) {
    collision->layout = layout;
    collision->memory = memory;
    collision->world = NULL;
    wh_robot_forward(layout->machine.robot.home, &collision->base_from_effector);
    simulator->observer = (wh_observer_t){on_step, on_placed, collision};
}
