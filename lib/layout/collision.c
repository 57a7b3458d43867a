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

static void look(void *user, const wh_gripper_input_t inputs[], const wh_grasp_t *table,
                 wh_event_list_t *list) {
    wh_collision_t *collision = user;
    wh_pose_t grippers[WH_GRIPPERS];
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        grippers[g] = inputs[g].base_from_gripper;
    }
    (void)wh_collision_effector(&collision->layout->machine, grippers, &collision->base_from_effector);
    if (collision->world) {
        wh_world_step(collision->world, table, &collision->base_from_effector, grippers, list);
    } else {
        collision->world = wh_world_init(&collision->layout->world, table, &collision->base_from_effector,
                                         grippers, collision->memory, wh_collision_bytes(collision->layout));
    }
}

static void placed(void *user, const wh_grasp_t *table, int32_t wafer) {
    wh_collision_t *collision = user;
    if (collision->world) {
        wh_world_place(collision->world, table, wafer);
    }
}

/* A table that is nothing but a view of a state, which is never written to. */
static wh_grasp_t view_of(const wh_layout_t *layout, const wh_state_t *state) {
    union {
        const wh_wafer_t *constant;
        wh_wafer_t *plain;
    } wafers = {state->wafers};
    union {
        const wh_gripper_t *constant;
        wh_gripper_t *plain;
    } grippers = {state->grippers};
    wh_grasp_t view = {.config = layout->grasp, .slice = (uint64_t)state->seq};
    view.storage.wafers = wafers.plain;
    view.storage.wafer_count = state->wafer_count;
    view.storage.grippers = grippers.plain;
    view.storage.gripper_count = state->gripper_count;
    return view;
}

void wh_collision_observe(wh_collision_t *collision, const wh_state_t *state) {
    const wh_grasp_t view = view_of(collision->layout, state);
    wh_gripper_input_t inputs[WH_GRIPPERS];
    for (size_t g = 0; g < state->gripper_count; ++g) {
        inputs[g].base_from_gripper = state->grippers[g].base_from_gripper;
        inputs[g].valve = state->grippers[g].valve;
    }
    for (size_t i = 0; i < state->event_count; ++i) {
        const wh_event_t *event = &state->events[i];
        const bool by_fault = event->kind == WH_EVENT_FAULT_ARMED || event->kind == WH_EVENT_FAULT_CLEARED;
        if (by_fault && event->wafer != WH_NONE) {
            placed(collision, &view, event->wafer);
        }
    }
    look(collision, inputs, &view, NULL);
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
    simulator->observer = (wh_observer_t){look, placed, collision};
}
