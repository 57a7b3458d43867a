#include "core/encounter_internal.h"
#include "core/grasp_internal.h"
#include "core/proximity_internal.h"

wh_event_t *wh_event_append(const wh_grasp_t *table, wh_event_list_t *list, wh_event_kind_t kind) {
    static const wh_event_t blank = {
        .wafer = WH_NONE, .gripper = WH_NONE, .other = WH_NONE, .parts = {WH_NONE, WH_NONE}};
    WH_ASSERT(list->count < list->capacity);
    wh_event_t *event = &list->events[list->count++];
    *event = blank;
    event->kind = kind;
    event->slice = table->slice;
    event->measured_slice = table->slice;
    return event;
}

/*@ requires \valid_read(input);
    assigns \nothing;
    ensures \result == WH_OK ==> input->valve == WH_VALVE_OPEN || input->valve == WH_VALVE_CLOSED; */
static wh_status_t validate_input(const wh_gripper_input_t *input) {
    const wh_status_t status = wh_pose_validate(&input->base_from_gripper);
    if (status != WH_OK) {
        return status;
    }
    const bool good = input->valve == WH_VALVE_OPEN || input->valve == WH_VALVE_CLOSED;
    return good ? WH_OK : WH_STATUS_BAD_VALVE;
}

/*@ requires wh_table_memory(table) && wh_list_ready(list, 1) && wh_list_apart(list, table);
    requires status != WH_OK && gripper < table->storage.gripper_count;
    assigns table->counters.refused, list[0 .. wh_given(list) - 1].count, list->events[0 .. wh_room(list) - 1];
    ensures \result == status;
    ensures wh_same_size{Pre, Post}(table) && wh_same_arrays{Pre, Post}(table); */
static wh_status_t refuse(wh_grasp_t *table, wh_event_list_t *list, size_t gripper, wh_status_t status) {
    ++table->counters.refused;
    if (list) {
        wh_event_t *event = wh_event_append(table, list, WH_EVENT_BAD_INPUT);
        event->slice = table->slice + 1;
        event->measured_slice = table->slice + 1;
        event->gripper = (int32_t)gripper;
        event->status = status;
    }
    /*@ assert wh_same_size{Pre, Here}(table) && wh_same_arrays{Pre, Here}(table); */
    return status;
}

/*@ requires wh_table_memory(table) && wh_list_apart(list, table);
    requires table->storage.gripper_count > 0 ==> wh_list_ready(list, 1);
    requires \valid_read(inputs + (0 .. table->storage.gripper_count - 1)) && wh_inputs_apart(inputs, table) &&
             wh_inputs_apart_list(inputs, table, list);
    assigns table->counters.refused, list[0 .. wh_given(list) - 1].count, list->events[0 .. wh_room(list) - 1];
    ensures \result == WH_OK ==> list == \null || list->count == \old(list->count);
    ensures \result == WH_OK ==> wh_valves_good(inputs, table->storage.gripper_count);
    ensures wh_same_size{Pre, Post}(table) && wh_same_arrays{Pre, Post}(table); */
static wh_status_t validate_inputs(wh_grasp_t *table, const wh_gripper_input_t *inputs,
                                   wh_event_list_t *list) {
    /*@ loop invariant 0 <= g <= table->storage.gripper_count && wh_valves_good(inputs, g);
        loop assigns g;
        loop variant table->storage.gripper_count - g; */
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        const wh_status_t status = validate_input(&inputs[g]);
        if (status != WH_OK) {
            return refuse(table, list, g, status);
        }
    }
    return WH_OK;
}

/* A gripper's pose that just passes wh_pose_validate can turn the wafer's into one that does not, and that the table's
 * owner could not hand back to any call: such a one is mended. */
void wh_grasp_carry(wh_wafer_t *wafer, const wh_pose_t *base_from_gripper,
                    const wh_pose_t *gripper_from_wafer) {
    wh_pose_compose_to(base_from_gripper, gripper_from_wafer, &wafer->base_from_wafer);
    if (wh_pose_validate(&wafer->base_from_wafer) != WH_OK) {
        wh_mat3_orthonormalise(&wafer->base_from_wafer.R);
    }
}

/* Parts 2 and 3: held wafers go where their grippers carry them; a closed valve lets go of them there. */
/*@ requires wh_table_memory(table) && wh_consistent(table);
    requires \valid_read(inputs + (0 .. table->storage.gripper_count - 1)) && wh_inputs_apart(inputs, table);
    assigns table->storage.wafers[0 .. table->storage.wafer_count - 1];
    ensures wh_stepping(table, inputs, 0, table->storage.gripper_count);
    ensures wh_free_at_rest{Pre, Post}(table); */
static void carry_and_release(wh_grasp_t *table, const wh_gripper_input_t *inputs) {
    /*@ loop invariant 0 <= g <= table->storage.gripper_count && wh_stepping(table, inputs, 0, g);
        loop invariant \forall integer w; wh_is_wafer(table, w) && wh_holder{Pre}(table, w) == WH_NONE ==>
                         wh_holder(table, w) == WH_NONE && wh_same_pose{Pre, Here}(table, w);
        loop assigns g, table->storage.wafers[0 .. table->storage.wafer_count - 1];
        loop variant table->storage.gripper_count - g; */
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        wh_gripper_t *gripper = &table->storage.grippers[g];
        if (gripper->wafer == WH_NONE) {
            continue;
        }
        wh_wafer_t *wafer = &table->storage.wafers[gripper->wafer];
        wh_grasp_carry(wafer, &inputs[g].base_from_gripper, &gripper->gripper_from_wafer);
        if (inputs[g].valve == WH_VALVE_CLOSED) {
            wafer->holder = WH_NONE;
            wafer->released_by = (int32_t)g;
        }
    }
}

/*@ requires wh_table_memory(table) && wh_list_ready(list, 1) && wh_list_apart(list, table);
    requires wh_is_gripper(table, g) && wh_held(table, g) == WH_NONE;
    requires \valid_read(input) && wh_apart_from_arrays(input, table);
    assigns table->counters, table->storage.wafers[0 .. table->storage.wafer_count - 1],
            table->storage.grippers[g].wafer, table->storage.grippers[g].gripper_from_wafer,
            list[0 .. wh_given(list) - 1].count, list->events[0 .. wh_room(list) - 1];
    ensures wh_list_grown{Pre, Post}(list, 1);
    ensures wh_same_size{Pre, Post}(table);
    ensures wh_held(table, g) != wh_held{Pre}(table, g) ==> wh_took{Pre, Post}(table, g, wh_held(table, g));
    ensures wh_held(table, g) == wh_held{Pre}(table, g) ==> wh_same_holders{Pre, Post}(table);
    ensures wh_other_holders{Pre, Post}(table, wh_held(table, g));
    ensures wh_other_held{Pre, Post}(table, g);
    ensures wh_same_releases{Pre, Post}(table);
    ensures wh_same_watched{Pre, Post}(table);
    ensures wh_free_at_rest{Pre, Post}(table);
    ensures wh_grips_kept{Pre, Post}(table); */
static void pick_sampled(wh_grasp_t *table, size_t g, const wh_gripper_input_t *input,
                         wh_event_list_t *list) {
    const int32_t w = wh_grasp_find_ready(table, &input->base_from_gripper, false);
    if (w == WH_NONE) {
        return;
    }
    wh_grasp_take(table, g, w, &input->base_from_gripper, list);
    if (table->config.seat) {
        wh_grasp_carry(&table->storage.wafers[w], &input->base_from_gripper,
                       &table->storage.grippers[g].gripper_from_wafer);
    }
}

/* Part 4 for one gripper. */
/*@ requires wh_table_memory(table) && wh_list_ready(list, 1) && wh_list_apart(list, table);
    requires wh_is_gripper(table, g);
    requires \valid_read(input) && wh_apart_from_arrays(input, table);
    assigns table->counters, table->storage.wafers[0 .. table->storage.wafer_count - 1],
            table->storage.grippers[g].wafer, table->storage.grippers[g].gripper_from_wafer,
            list[0 .. wh_given(list) - 1].count, list->events[0 .. wh_room(list) - 1];
    ensures wh_list_grown{Pre, Post}(list, 1);
    ensures wh_same_size{Pre, Post}(table);
    ensures wh_held(table, g) != wh_held{Pre}(table, g) ==> wh_took{Pre, Post}(table, g, wh_held(table, g));
    ensures wh_held(table, g) == wh_held{Pre}(table, g) ==> wh_same_holders{Pre, Post}(table);
    ensures wh_other_holders{Pre, Post}(table, wh_held(table, g));
    ensures wh_other_held{Pre, Post}(table, g);
    ensures wh_same_releases{Pre, Post}(table);
    ensures wh_same_watched{Pre, Post}(table);
    ensures wh_free_at_rest{Pre, Post}(table);
    ensures wh_grips_kept{Pre, Post}(table); */
static void pick(wh_grasp_t *table, size_t g, const wh_gripper_input_t *input, wh_event_list_t *list) {
    const wh_gripper_t *gripper = &table->storage.grippers[g];
    if (input->valve == WH_VALVE_CLOSED || gripper->wafer != WH_NONE) {
        return;
    }
    const bool swept = table->config.check == WH_CHECK_SWEPT && gripper->valve == WH_VALVE_OPEN;
    if (!swept || !wh_grasp_pick_swept(table, g, input, list)) {
        pick_sampled(table, g, input, list);
    }
}

/* A wafer that was let go and that nobody took. */
/*@ requires wh_table_memory(table) && wh_list_ready(list, 1) && wh_list_apart(list, table);
    requires wh_is_gripper(table, g) && \valid_read(input);
    requires wh_held(table, g) == WH_NONE || wh_is_wafer(table, wh_held(table, g));
    assigns table->counters.released, list[0 .. wh_given(list) - 1].count, list->events[0 .. wh_room(list) - 1];
    ensures wh_list_grown{Pre, Post}(list, 1); */
static void report_release(wh_grasp_t *table, size_t g, const wh_gripper_input_t *input,
                           wh_event_list_t *list) {
    const int32_t w = table->storage.grippers[g].wafer;
    if (input->valve == WH_VALVE_OPEN || w == WH_NONE || table->storage.wafers[w].holder != WH_NONE) {
        return;
    }
    ++table->counters.released;
    if (list) {
        wh_event_t *event = wh_event_append(table, list, WH_EVENT_RELEASED);
        event->wafer = w;
        event->gripper = (int32_t)g;
        wh_proximity_values(&table->storage.wafers[w].base_from_wafer, &input->base_from_gripper,
                            &table->config.tolerance, &event->measured);
    }
}

/* A gripper that let go still names its wafer up to here. */
/*@ requires wh_table_memory(table) && wh_is_gripper(table, g) && \valid_read(input);
    requires wh_held(table, g) == WH_NONE || wh_is_wafer(table, wh_held(table, g));
    requires wh_apart_from_arrays(input, table);
    assigns table->storage.wafers[0 .. table->storage.wafer_count - 1].released_by, table->storage.grippers[g].wafer,
            table->storage.grippers[g].base_from_gripper, table->storage.grippers[g].valve;
    ensures wh_held(table, g) == (input->valve == WH_VALVE_CLOSED ? WH_NONE : wh_held{Pre}(table, g));
    ensures \forall integer w; wh_is_wafer(table, w) ==> wh_released_by(table, w) ==
              (input->valve == WH_VALVE_CLOSED && w == wh_held{Pre}(table, g) ? WH_NONE : wh_released_by{Pre}(table, w));
    ensures wh_other_held{Pre, Post}(table, g);
    ensures wh_same_watched{Pre, Post}(table);
    ensures wh_same_holders{Pre, Post}(table); */
static void remember(wh_grasp_t *table, size_t g, const wh_gripper_input_t *input) {
    wh_gripper_t *gripper = &table->storage.grippers[g];
    if (input->valve == WH_VALVE_CLOSED && gripper->wafer != WH_NONE) {
        table->storage.wafers[gripper->wafer].released_by = WH_NONE;
        gripper->wafer = WH_NONE;
    }
    gripper->base_from_gripper = input->base_from_gripper;
    gripper->valve = input->valve;
}

/*@ requires wh_table_memory(table) && wh_list_memory(list);
    assigns \nothing;
    ensures \result == WH_OK ==> (inputs != \null || table->storage.gripper_count == 0) &&
                                  (list != \null ==> (list->events != \null || list->capacity == 0) &&
                                    WH_EVENTS_PER_GRIPPER * table->storage.gripper_count <= list->capacity); */
static wh_status_t validate_call(const wh_grasp_t *table, const wh_gripper_input_t *inputs,
                                 const wh_event_list_t *list) {
    if (!inputs && table->storage.gripper_count > 0) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (list && !list->events && list->capacity > 0) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    const bool room = !list || list->capacity / WH_EVENTS_PER_GRIPPER >= table->storage.gripper_count;
    return room ? WH_OK : WH_STATUS_BAD_CAPACITY;
}

/*@ requires wh_table_memory(table) && wh_list_apart(list, table) && wh_list_ready(list, table->storage.gripper_count);
    requires \valid_read(inputs + (0 .. table->storage.gripper_count - 1)) && wh_inputs_apart(inputs, table) &&
             wh_inputs_apart_list(inputs, table, list);
    requires wh_stepping(table, inputs, 0, table->storage.gripper_count);
    assigns table->counters, table->storage.wafers[0 .. table->storage.wafer_count - 1],
            table->storage.grippers[0 .. table->storage.gripper_count - 1],
            list[0 .. wh_given(list) - 1].count, list->events[0 .. wh_room(list) - 1];
    ensures wh_stepping(table, inputs, 0, table->storage.gripper_count);
    ensures wh_list_grown{Pre, Post}(list, table->storage.gripper_count);
    ensures wh_same_size{Pre, Post}(table);
    ensures wh_same_watched{Pre, Post}(table);
    ensures wh_free_at_rest{Pre, Post}(table);
    ensures wh_grips_kept{Pre, Post}(table); */
static void pick_all(wh_grasp_t *table, const wh_gripper_input_t *inputs, wh_event_list_t *list) {
    /*@ loop invariant 0 <= g <= table->storage.gripper_count;
        loop invariant wh_same_size{Pre, Here}(table);
        loop invariant wh_stepping(table, inputs, 0, table->storage.gripper_count);
        loop invariant wh_list_grown{Pre, Here}(list, g);
        loop invariant wh_same_watched{Pre, Here}(table);
        loop invariant wh_free_at_rest{Pre, Here}(table);
        loop invariant \forall integer i; wh_is_gripper(table, i) && wh_held{Pre}(table, i) != WH_NONE ==>
                         wh_held(table, i) == wh_held{Pre}(table, i) && wh_same_grip{Pre, Here}(table, i);
        loop assigns g, table->counters, table->storage.wafers[0 .. table->storage.wafer_count - 1],
            table->storage.grippers[0 .. table->storage.gripper_count - 1],
            list[0 .. wh_given(list) - 1].count, list->events[0 .. wh_room(list) - 1];
        loop variant table->storage.gripper_count - g; */
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        pick(table, g, &inputs[g], list);
    }
}

/*@ requires wh_table_memory(table) && wh_list_apart(list, table) && wh_list_ready(list, table->storage.gripper_count);
    requires \valid_read(inputs + (0 .. table->storage.gripper_count - 1)) && wh_inputs_apart(inputs, table) &&
             wh_inputs_apart_list(inputs, table, list);
    requires wh_stepping(table, inputs, 0, table->storage.gripper_count);
    assigns table->counters.released,
            list[0 .. wh_given(list) - 1].count, list->events[0 .. wh_room(list) - 1];
    ensures wh_list_grown{Pre, Post}(list, table->storage.gripper_count); */
static void report_releases(wh_grasp_t *table, const wh_gripper_input_t *inputs, wh_event_list_t *list) {
    /*@ loop invariant 0 <= g <= table->storage.gripper_count;
        loop invariant wh_list_grown{Pre, Here}(list, g);
        loop assigns g, table->counters.released,
            list[0 .. wh_given(list) - 1].count, list->events[0 .. wh_room(list) - 1];
        loop variant table->storage.gripper_count - g; */
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        report_release(table, g, &inputs[g], list);
    }
}

/*@ requires wh_table_memory(table) && wh_list_apart(list, table) && wh_list_ready(list, 2 * table->storage.gripper_count);
    requires \valid_read(inputs + (0 .. table->storage.gripper_count - 1)) && wh_inputs_apart(inputs, table) &&
             wh_inputs_apart_list(inputs, table, list);
    requires wh_encounters(table);
    assigns table->counters, table->storage.grippers[0 .. table->storage.gripper_count - 1],
            list[0 .. wh_given(list) - 1].count, list->events[0 .. wh_room(list) - 1];
    ensures wh_same_size{Pre, Post}(table);
    ensures wh_same_held{Pre, Post}(table);
    ensures wh_list_grown{Pre, Post}(list, 2 * table->storage.gripper_count);
    ensures wh_encounters(table);
    ensures wh_other_grips{Pre, Post}(table, WH_NONE); */
static void watch_all(wh_grasp_t *table, const wh_gripper_input_t *inputs, wh_event_list_t *list) {
    /*@ loop invariant 0 <= g <= table->storage.gripper_count;
        loop invariant wh_same_size{Pre, Here}(table);
        loop invariant wh_same_held{Pre, Here}(table);
        loop invariant wh_list_grown{Pre, Here}(list, 2 * g);
        loop invariant wh_encounters(table);
        loop invariant wh_other_grips{Pre, Here}(table, WH_NONE);
        loop assigns g, table->counters, table->storage.grippers[0 .. table->storage.gripper_count - 1],
            list[0 .. wh_given(list) - 1].count, list->events[0 .. wh_room(list) - 1];
        loop variant table->storage.gripper_count - g; */
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        wh_encounter_update(table, g, &inputs[g], list);
    }
}

/*@ requires wh_table_memory(table);
    requires \valid_read(inputs + (0 .. table->storage.gripper_count - 1)) && wh_inputs_apart(inputs, table);
    requires wh_stepping(table, inputs, 0, table->storage.gripper_count);
    requires wh_encounters(table);
    assigns table->storage.wafers[0 .. table->storage.wafer_count - 1].released_by, table->storage.grippers[0 .. table->storage.gripper_count - 1];
    ensures wh_same_size{Pre, Post}(table);
    ensures wh_consistent(table);
    ensures wh_other_grips{Pre, Post}(table, WH_NONE); */
static void remember_all(wh_grasp_t *table, const wh_gripper_input_t *inputs) {
    /*@ loop invariant 0 <= g <= table->storage.gripper_count;
        loop invariant wh_same_size{Pre, Here}(table);
        loop invariant wh_encounters(table);
        loop invariant wh_stepping(table, inputs, g, table->storage.gripper_count);
        loop invariant wh_other_grips{Pre, Here}(table, WH_NONE);
        loop assigns g, table->storage.wafers[0 .. table->storage.wafer_count - 1].released_by, table->storage.grippers[0 .. table->storage.gripper_count - 1];
        loop variant table->storage.gripper_count - g; */
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        remember(table, g, &inputs[g]);
    }
}

/*@ requires \valid(table);
    assigns table->counters.refused; */
static void count_refusal(wh_grasp_t *table) {
    ++table->counters.refused;
}

/*@ requires wh_table_memory(table) && wh_consistent(table) && wh_list_apart(list, table);
    requires wh_list_ready(list, 4 * table->storage.gripper_count);
    requires \valid_read(inputs + (0 .. table->storage.gripper_count - 1)) && wh_inputs_apart(inputs, table) &&
             wh_inputs_apart_list(inputs, table, list);
    assigns table->slice, table->counters, table->storage.wafers[0 .. table->storage.wafer_count - 1],
            table->storage.grippers[0 .. table->storage.gripper_count - 1],
            list[0 .. wh_given(list) - 1].count, list->events[0 .. wh_room(list) - 1];
    ensures wh_consistent(table);
    ensures wh_free_at_rest{Pre, Post}(table);
    ensures wh_grips_kept{Pre, Post}(table); */
static void advance(wh_grasp_t *table, const wh_gripper_input_t *inputs, wh_event_list_t *list) {
    ++table->slice;
    /*@ assert wh_same_size{Pre, Here}(table) && wh_table_memory(table); */
    /*@ assert wh_paired(table); */
    /*@ assert wh_none_released(table); */
    /*@ assert wh_encounters(table); */
    carry_and_release(table, inputs);
    /*@ assert wh_encounters(table); */
    pick_all(table, inputs, list);
    /*@ assert wh_same_size{Pre, Here}(table); */
    /*@ assert wh_encounters(table); */
    /*@ assert wh_list_grown{Pre, Here}(list, table->storage.gripper_count); */
    report_releases(table, inputs, list);
    /*@ assert wh_same_size{Pre, Here}(table); */
    /*@ assert wh_stepping(table, inputs, 0, table->storage.gripper_count); */
    /*@ assert wh_encounters(table); */
    /*@ assert wh_list_grown{Pre, Here}(list, 2 * table->storage.gripper_count); */
    watch_all(table, inputs, list);
    /*@ assert wh_same_size{Pre, Here}(table); */
    /*@ assert wh_stepping(table, inputs, 0, table->storage.gripper_count); */
    remember_all(table, inputs);
}

wh_status_t wh_grasp_step(wh_grasp_t *table, const wh_gripper_input_t *inputs, wh_event_list_t *list) {
    if (list) {
        list->count = 0;
    }
    if (!table) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    /*@ assert wh_same_size{Pre, Here}(table) && wh_same_arrays{Pre, Here}(table); */
    /*@ assert wh_table_memory(table) && wh_consistent(table); */
    wh_status_t status = validate_call(table, inputs, list);
    if (status != WH_OK) {
        count_refusal(table);
        /*@ assert wh_same_size{Pre, Here}(table) && wh_same_arrays{Pre, Here}(table); */
        return status;
    }
    status = validate_inputs(table, inputs, list);
    /*@ assert wh_same_size{Pre, Here}(table) && wh_same_arrays{Pre, Here}(table); */
    /*@ assert wh_table_memory(table) && wh_consistent(table); */
    if (status != WH_OK) {
        return status;
    }
    advance(table, inputs, list);
    return WH_OK;
}
