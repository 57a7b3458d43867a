#include "collision.h"

#include "doors.h"

/* The places of everything; wafers and grippers are as the state has them. `told` is that of
 * wh_links_follow. */
static wh_world_input_t input_of(wh_collision_t *collision, uint64_t slice, const wh_real_t axes[],
                                 const wh_gripper_input_t told[], const wh_state_t *state,
                                 wh_pose_t base_from_door[WH_DOORS]) {
    const wh_layout_t *layout = collision->layout;
    wh_pose_t poses[WH_GRIPPERS];
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        poses[g] = state->grippers[g].base_from_gripper;
    }
    wh_links_follow(&collision->links, layout, poses, axes, told, WH_LINKS_SAME);
    wh_layout_place_doors(layout, state->physics ? &state->physics->doors : NULL, axes, base_from_door);
    return (wh_world_input_t){slice, state->wafers, state->grippers, collision->links.bodies, base_from_door};
}

/* Called after a step. */
static void look_at(wh_collision_t *collision, uint64_t slice, const wh_real_t axes[],
                    const wh_gripper_input_t told[], const wh_state_t *state, wh_event_list_t *list) {
    const wh_layout_t *layout = collision->layout;
    wh_pose_t base_from_door[WH_DOORS];
    const wh_world_input_t input = input_of(collision, slice, axes, told, state, base_from_door);
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

/* Null if the command does not have all axes of the machine. */
static const wh_real_t *axes_of(const wh_collision_t *collision, const wh_command_t *command) {
    return command->axis_count == collision->layout->machine.axis_count ? command->axes : NULL;
}

static void on_step(void *user, const wh_command_t *command, const wh_gripper_input_t inputs[],
                    const wh_grasp_t *table, wh_event_list_t *list) {
    (void)inputs; /* the table's grippers are there by now */
    const wh_collision_t *collision = user;
    const wh_state_t state = {
        .wafers = table->storage.wafers, .grippers = table->storage.grippers, .physics = collision->physics};
    look_at(user, table->slice, axes_of(user, command), collision->is_told ? command->grippers : NULL, &state,
            list);
}

static void on_placed(void *user, const wh_grasp_t *table, int32_t wafer) {
    place(user, table->storage.wafers, wafer);
}

void wh_collision_observe(wh_collision_t *collision, const wh_real_t axes[], const wh_state_t *state) {
    for (size_t i = 0; i < state->event_count; ++i) {
        const wh_event_t *event = &state->events[i];
        const bool by_fault = event->kind == WH_EVENT_FAULT_ARMED || event->kind == WH_EVENT_FAULT_CLEARED;
        if (by_fault && event->wafer != WH_NONE) {
            place(collision, state->wafers, event->wafer);
        }
    }
    look_at(collision, (uint64_t)state->seq, axes, NULL, state, NULL);
}

void wh_collision_jump(wh_collision_t *collision, uint64_t slice, const wh_real_t axes[],
                       const wh_state_t *state) {
    wh_pose_t base_from_door[WH_DOORS];
    const wh_world_input_t input = input_of(collision, slice, axes, NULL, state, base_from_door);
    if (collision->world) {
        wh_world_jump(collision->world, &input);
    }
}

size_t wh_collision_bytes(const wh_layout_t *layout) {
    return wh_world_bytes(&layout->world);
}

void wh_collision_attach(wh_collision_t *collision, const wh_layout_t *layout, wh_simulator_t *simulator,
                         void *memory) {
    collision->layout = layout;
    collision->memory = memory;
    collision->world = NULL;
    collision->physics = &simulator->physics;
    collision->is_told = false;
    wh_links_home(&collision->links, layout);
    simulator->observer = (wh_observer_t){on_step, on_placed, collision};
}
