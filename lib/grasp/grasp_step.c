/* A step, part by part, in one file for all its length, of which two thirds are contracts: as files of their own the parts cost a
 * slice 50 instructions more, and a sampled step 32 bytes of stack more than its limit. */
#include "encounter_internal.h"
#include "grasp_internal.h"
#include "horizon_internal.h"
#include "proximity_internal.h"

/* wh_remembers: gripper g no longer names a wafer that it has let go. */
/*@
  lemma wh_poses_through{K, M, L}: \forall wh_grasp_t *t, integer w;
    wh_same_size{K, M}(t) && wh_same_poses{K, M}(t) && wh_other_poses{M, L}(t, w) ==> wh_other_poses{K, L}(t, w);
  lemma wh_grips_through{K, M, L}: \forall wh_grasp_t *t, integer g;
    wh_same_size{K, M}(t) && wh_same_grips{K, M}(t) && wh_other_grips{M, L}(t, g) ==> wh_other_grips{K, L}(t, g);
  lemma wh_same_grips_through{K, M, L}: \forall wh_grasp_t *t;
    wh_same_size{K, M}(t) && wh_same_grips{K, M}(t) && wh_same_grips{M, L}(t) ==> wh_same_grips{K, L}(t);
  lemma wh_hold_through{K, M, L}: \forall wh_grasp_t *t;
    wh_same_size{K, M}(t) && wh_hold_kept{K, M}(t) && wh_hold_kept{M, L}(t) ==> wh_hold_kept{K, L}(t);
  lemma wh_rest_through{K, M, L}: \forall wh_grasp_t *t;
    wh_same_size{K, M}(t) && wh_free_at_rest{K, M}(t) && wh_holders_kept{M, L}(t) && wh_free_at_rest{M, L}(t) ==>
    wh_free_at_rest{K, L}(t);
  lemma wh_free_stay_through{K, M, L}: \forall wh_grasp_t *t;
    wh_same_size{K, M}(t) && wh_free_stay{K, M}(t) && wh_free_stay{M, L}(t) ==> wh_free_stay{K, L}(t);
  lemma wh_rest_from{K, M, L}: \forall wh_grasp_t *t;
    wh_same_size{K, M}(t) && wh_free_stay{K, M}(t) && wh_free_at_rest{M, L}(t) ==> wh_free_at_rest{K, L}(t);
  lemma wh_rest_until{K, M, L}: \forall wh_grasp_t *t;
    wh_same_size{K, M}(t) && wh_free_at_rest{K, M}(t) && wh_same_holders{M, L}(t) && wh_same_poses{M, L}(t) ==>
    wh_free_at_rest{K, L}(t);
  lemma wh_hold_until{K, M, L}: \forall wh_grasp_t *t;
    wh_same_size{K, M}(t) && wh_hold_kept{K, M}(t) && wh_same_held{M, L}(t) && wh_same_grips{M, L}(t) ==>
    wh_hold_kept{K, L}(t);
  lemma wh_grips_until{K, M, L}: \forall wh_grasp_t *t;
    wh_same_size{K, M}(t) && wh_hold_kept{K, M}(t) && wh_same_grips{M, L}(t) ==> wh_grips_kept{K, L}(t);
  lemma wh_watched_through{K, M, L}: \forall wh_grasp_t *t;
    wh_same_size{K, M}(t) && wh_same_watched{K, M}(t) && wh_same_watched{M, L}(t) ==> wh_same_watched{K, L}(t);
  lemma wh_same_held_through{K, M, L}: \forall wh_grasp_t *t;
    wh_same_size{K, M}(t) && wh_same_held{K, M}(t) && wh_same_held{M, L}(t) ==> wh_same_held{K, L}(t);
  lemma wh_same_holders_through{K, M, L}: \forall wh_grasp_t *t;
    wh_same_size{K, M}(t) && wh_same_holders{K, M}(t) && wh_same_holders{M, L}(t) ==> wh_same_holders{K, L}(t);
  lemma wh_same_poses_through{K, M, L}: \forall wh_grasp_t *t;
    wh_same_size{K, M}(t) && wh_same_poses{K, M}(t) && wh_same_poses{M, L}(t) ==> wh_same_poses{K, L}(t);
  lemma wh_encounters_same{K, L}: \forall wh_grasp_t *t;
    wh_same_size{K, L}(t) && wh_same_watched{K, L}(t) && wh_encounters{K}(t) ==> wh_encounters{L}(t);
  lemma wh_paired_same{K, L}: \forall wh_grasp_t *t;
    wh_same_size{K, L}(t) && wh_same_holders{K, L}(t) && wh_same_held{K, L}(t) && wh_paired{K}(t) ==> wh_paired{L}(t);
  lemma wh_none_released_same{K, L}: \forall wh_grasp_t *t;
    wh_same_size{K, L}(t) && wh_same_releases{K, L}(t) && wh_none_released{K}(t) ==> wh_none_released{L}(t);
  lemma wh_encounters_as_before{K, L}: \forall wh_grasp_t *t;
    wh_same_size{K, L}(t) && wh_same_encounters{K, L}(t) && wh_encounters{K}(t) ==> wh_encounters{L}(t);
  lemma wh_rest_after{K, M, L}: \forall wh_grasp_t *t;
    wh_same_size{K, M}(t) && wh_same_holders{K, M}(t) && wh_same_poses{K, M}(t) && wh_free_at_rest{M, L}(t) ==>
    wh_free_at_rest{K, L}(t);
  lemma wh_grips_after{K, M, L}: \forall wh_grasp_t *t;
    wh_same_size{K, M}(t) && wh_same_held{K, M}(t) && wh_same_grips{K, M}(t) && wh_grips_kept{M, L}(t) ==>
    wh_grips_kept{K, L}(t);
  lemma wh_same_releases_through{K, M, L}: \forall wh_grasp_t *t;
    wh_same_size{K, M}(t) && wh_same_releases{K, M}(t) && wh_same_releases{M, L}(t) ==> wh_same_releases{K, L}(t);
  lemma wh_same_inputs_through{K, M, L}: \forall wh_gripper_input_t *in, integer count;
    wh_same_inputs{K, M}(in, count) && wh_same_inputs{M, L}(in, count) ==> wh_same_inputs{K, L}(in, count);
  lemma wh_same_stands_through{K, M, L}: \forall wh_grasp_t *t;
    wh_same_size{K, M}(t) && wh_same_stands{K, M}(t) && wh_same_stands{M, L}(t) ==> wh_same_stands{K, L}(t);
  lemma wh_same_valves_through{K, M, L}: \forall wh_grasp_t *t;
    wh_same_size{K, M}(t) && wh_same_valves{K, M}(t) && wh_same_valves{M, L}(t) ==> wh_same_valves{K, L}(t);
  lemma wh_same_encounters_through{K, M, L}: \forall wh_grasp_t *t;
    wh_same_size{K, M}(t) && wh_same_encounters{K, M}(t) && wh_same_encounters{M, L}(t) ==> wh_same_encounters{K, L}(t);
  lemma wh_same_measured_through{K, M, L}: \forall wh_grasp_t *t;
    wh_same_size{K, M}(t) && wh_same_measured{K, M}(t) && wh_same_measured{M, L}(t) ==> wh_same_measured{K, L}(t);
  lemma wh_same_arrays_through{K, M, L}: \forall wh_grasp_t *t;
    wh_same_size{K, M}(t) && wh_same_arrays{K, M}(t) && wh_same_arrays{M, L}(t) ==> wh_same_arrays{K, L}(t);
  lemma wh_consistent_same{K, L}: \forall wh_grasp_t *t;
    wh_same_size{K, L}(t) && wh_same_arrays{K, L}(t) && wh_consistent{K}(t) ==> wh_consistent{L}(t);
  lemma wh_stepping_same{K, L}: \forall wh_grasp_t *t, wh_gripper_input_t *in, integer from, integer to;
    wh_same_size{K, L}(t) && wh_same_inputs{K, L}(in, \at(t->storage.gripper_count, K)) && wh_same_holders{K, L}(t) &&
    wh_same_releases{K, L}(t) && wh_same_held{K, L}(t) && wh_stepping{K}(t, in, from, to) ==> wh_stepping{L}(t, in, from, to);
  lemma wh_stepping_took{K, L}: \forall wh_grasp_t *t, wh_gripper_input_t *in, integer g, integer from, integer to;
    wh_is_gripper{K}(t, g) && !wh_lets_go{K}(in, g, from, to) &&
    wh_same_size{K, L}(t) && wh_same_inputs{K, L}(in, \at(t->storage.gripper_count, K)) && wh_took{K, L}(t, g, wh_held{L}(t, g)) &&
    wh_other_holders{K, L}(t, wh_held{L}(t, g)) && wh_same_releases{K, L}(t) && wh_other_held{K, L}(t, g) &&
    wh_stepping{K}(t, in, from, to) ==> wh_stepping{L}(t, in, from, to);

  predicate wh_remembers{K, L}(wh_grasp_t *t, integer g, integer valve) =
    wh_held{L}(t, g) == (valve == WH_VALVE_CLOSED ? WH_NONE : wh_held{K}(t, g)) &&
    \forall integer w; wh_is_wafer{K}(t, w) ==> wh_released_by{L}(t, w) ==
      (valve == WH_VALVE_CLOSED && w == wh_held{K}(t, g) ? WH_NONE : wh_released_by{K}(t, w));

  lemma wh_holders_remembered{K, L}: \forall wh_grasp_t *t, wh_gripper_input_t *in, integer g, integer to;
    wh_is_gripper{K}(t, g) && to == \at(t->storage.gripper_count, K) && wh_same_size{K, L}(t) &&
    wh_same_inputs{K, L}(in, to) && wh_same_holders{K, L}(t) && wh_other_held{K, L}(t, g) &&
    wh_remembers{K, L}(t, g, \at(in[g].valve, K)) && wh_stepping_holders{K}(t, in, g, to) ==>
    wh_stepping_holders{L}(t, in, g + 1, to);
  lemma wh_releases_remembered{K, L}: \forall wh_grasp_t *t, wh_gripper_input_t *in, integer g, integer to;
    wh_is_gripper{K}(t, g) && to == \at(t->storage.gripper_count, K) && wh_same_size{K, L}(t) &&
    wh_same_inputs{K, L}(in, to) && wh_same_holders{K, L}(t) && wh_other_held{K, L}(t, g) &&
    wh_remembers{K, L}(t, g, \at(in[g].valve, K)) && wh_stepping_releases{K}(t, in, g, to) ==>
    wh_stepping_releases{L}(t, in, g + 1, to);
  lemma wh_held_remembered{K, L}: \forall wh_grasp_t *t, wh_gripper_input_t *in, integer g, integer to;
    wh_is_gripper{K}(t, g) && to == \at(t->storage.gripper_count, K) && wh_same_size{K, L}(t) &&
    wh_same_inputs{K, L}(in, to) && wh_same_holders{K, L}(t) && wh_other_held{K, L}(t, g) &&
    wh_remembers{K, L}(t, g, \at(in[g].valve, K)) && wh_stepping{K}(t, in, g, to) ==>
    wh_stepping_held{L}(t, in, g + 1, to);
*/

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

/* False where a number is not finite. */
/*@ requires \valid_read(a) && \valid_read(b); assigns \nothing; */
static bool is_same(const wh_mat3_t *a, const wh_mat3_t *b) {
    return a->m[0][0] == b->m[0][0] && a->m[0][1] == b->m[0][1] && a->m[0][2] == b->m[0][2] &&
           a->m[1][0] == b->m[1][0] && a->m[1][1] == b->m[1][1] && a->m[1][2] == b->m[1][2] &&
           a->m[2][0] == b->m[2][0] && a->m[2][1] == b->m[2][1] && a->m[2][2] == b->m[2][2];
}

/* A gripper that has not turned since the last slice needs no second look at its rotation. */
/*@ requires \valid_read(gripper) && \valid_read(base_from_gripper); assigns \nothing; */
static wh_status_t validate_pose(const wh_gripper_t *gripper, const wh_pose_t *base_from_gripper) {
    if (is_same(&gripper->base_from_gripper.R, &base_from_gripper->R) &&
        wh_vec3_is_finite(&base_from_gripper->r)) {
        return WH_OK;
    }
    return wh_pose_validate(base_from_gripper);
}

/*@ requires \valid_read(gripper) && \valid_read(input);
    assigns \nothing;
    ensures \result == WH_OK ==> input->valve == WH_VALVE_OPEN || input->valve == WH_VALVE_CLOSED; */
static wh_status_t validate_input(const wh_gripper_t *gripper, const wh_gripper_input_t *input) {
    const wh_status_t status = validate_pose(gripper, &input->base_from_gripper);
    if (status != WH_OK) {
        return status;
    }
    const bool good = input->valve == WH_VALVE_OPEN || input->valve == WH_VALVE_CLOSED;
    return good ? WH_OK : WH_STATUS_BAD_VALVE;
}

/*@ requires \valid(table);
    assigns table->counters.refused; */
static void count_refusal(wh_grasp_t *table) {
    ++table->counters.refused;
}

/*@ requires \valid_read(table) && list != \null && wh_list_ready(list, 1) && wh_list_apart(list, table);
    requires gripper < table->storage.gripper_count <= INT32_MAX;
    assigns list->count, list->events[0 .. list->capacity - 1]; */
static void report_refusal(const wh_grasp_t *table, wh_event_list_t *list, size_t gripper,
                           wh_status_t status) {
    wh_event_t *event = wh_event_append(table, list, WH_EVENT_BAD_INPUT);
    event->slice = table->slice + 1;
    event->measured_slice = table->slice + 1;
    event->gripper = (int32_t)gripper;
    event->status = status;
}

/*@ requires wh_table_memory(table) && wh_list_ready(list, 1) && wh_list_apart(list, table);
    requires gripper < table->storage.gripper_count;
    assigns table->counters.refused, list->count, list->events[0 .. wh_room(list) - 1];
    ensures wh_same_size{Pre, Post}(table);
    ensures wh_same_poses{Pre, Post}(table);
    ensures wh_same_holders{Pre, Post}(table);
    ensures wh_same_releases{Pre, Post}(table);
    ensures wh_same_held{Pre, Post}(table);
    ensures wh_same_grips{Pre, Post}(table);
    ensures wh_same_stands{Pre, Post}(table);
    ensures wh_same_valves{Pre, Post}(table);
    ensures wh_same_encounters{Pre, Post}(table);
    ensures wh_same_measured{Pre, Post}(table); */
static void refuse(wh_grasp_t *table, wh_event_list_t *list, size_t gripper, wh_status_t status) {
    if (list) {
        /*@ assert \forall integer g; wh_is_gripper(table, g) ==>
              \separated(&table->storage.grippers[g], list->events + (0 .. list->capacity - 1)); */
        /*@ assert \forall integer w; wh_is_wafer(table, w) ==>
              \separated(&table->storage.wafers[w], list->events + (0 .. list->capacity - 1)); */
        report_refusal(table, list, gripper, status);
    }
    count_refusal(table);
}

/*@ requires wh_table_memory(table) && wh_list_apart(list, table);
    requires table->storage.gripper_count > 0 ==> wh_list_ready(list, 1);
    requires \valid_read(inputs + (0 .. table->storage.gripper_count - 1)) && wh_inputs_apart(inputs, table) &&
             wh_inputs_apart_list(inputs, table, list);
    assigns table->counters.refused, list->count, list->events[0 .. wh_room(list) - 1];
    ensures \result == WH_OK ==> list == \null || list->count == \old(list->count);
    ensures \result == WH_OK ==> wh_valves_good(inputs, table->storage.gripper_count);
    ensures wh_same_size{Pre, Post}(table);
    ensures wh_same_arrays{Pre, Post}(table); */
static wh_status_t validate_inputs(wh_grasp_t *table, const wh_gripper_input_t *inputs,
                                   wh_event_list_t *list) {
    /*@ loop invariant 0 <= g <= table->storage.gripper_count && wh_valves_good(inputs, g);
        loop assigns g;
        loop variant table->storage.gripper_count - g; */
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        const wh_status_t status = validate_input(&table->storage.grippers[g], &inputs[g]);
        if (status != WH_OK) {
            refuse(table, list, g, status);
            /*@ assert wh_same_arrays{Pre, Here}(table); */
            return status;
        }
    }
    /*@ assert wh_same_arrays{Pre, Here}(table); */
    return WH_OK;
}

/* A gripper's pose that just passes wh_pose_validate can turn the wafer's into one that does not, and that the table's
 * owner could not hand back to any call: such a one is mended. Mirrored it cannot be, since neither of the two is. */
void wh_grasp_carry(wh_wafer_t *wafer, const wh_pose_t *base_from_gripper,
                    const wh_pose_t *gripper_from_wafer) {
    wh_pose_compose_to(base_from_gripper, gripper_from_wafer, &wafer->base_from_wafer);
    if (!wh_mat3_is_orthonormal(&wafer->base_from_wafer.R)) {
        wh_mat3_orthonormalise(&wafer->base_from_wafer.R);
    }
}

/* Parts 2 and 3: held wafers go where their grippers carry them; a closed valve lets go of them there. */
/*@ requires wh_table_memory(table) && wh_consistent(table);
    requires \valid_read(inputs + (0 .. table->storage.gripper_count - 1)) && wh_inputs_apart(inputs, table);
    assigns table->storage.wafers[0 .. table->storage.wafer_count - 1],
            table->storage.buckets[0 .. table->storage.bucket_count - 1];
    ensures wh_stepping(table, inputs, 0, table->storage.gripper_count);
    ensures wh_same_size{Pre, Post}(table);
    ensures wh_same_held{Pre, Post}(table);
    ensures wh_same_watched{Pre, Post}(table);
    ensures wh_same_grips{Pre, Post}(table);
    ensures wh_free_stay{Pre, Post}(table); */
static void carry_and_release(wh_grasp_t *table, const wh_gripper_input_t *inputs) {
    /*@ loop invariant 0 <= g <= table->storage.gripper_count;
        loop invariant wh_same_held{Pre, Here}(table);
        loop invariant wh_stepping_holders(table, inputs, 0, g);
        loop invariant wh_stepping_releases(table, inputs, 0, g);
        loop invariant wh_stepping_held(table, inputs, 0, g);
        loop invariant wh_free_stay{Pre, Here}(table);
        loop assigns g, table->storage.wafers[0 .. table->storage.wafer_count - 1],
                     table->storage.buckets[0 .. table->storage.bucket_count - 1];
        loop variant table->storage.gripper_count - g; */
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        wh_gripper_t *gripper = &table->storage.grippers[g];
        if (gripper->wafer == WH_NONE) {
            /*@ assert wh_stepping(table, inputs, 0, g + 1); */
            continue;
        }
        wh_wafer_t *wafer = &table->storage.wafers[gripper->wafer];
        /*@ assert wh_is_wafer(table, gripper->wafer) && wh_holder(table, gripper->wafer) == g; */
        /*@ assert \forall integer i; wh_is_gripper(table, i) && wh_held(table, i) == gripper->wafer ==> i == g; */
        wh_grasp_carry(wafer, &inputs[g].base_from_gripper, &gripper->gripper_from_wafer);
        /*@ assert inputs[g].valve != WH_VALVE_CLOSED ==> wh_stepping(table, inputs, 0, g + 1); */
        if (inputs[g].valve == WH_VALVE_CLOSED) {
            /*@ assert \separated(wafer, table->storage.grippers + (0 .. table->storage.gripper_count - 1)); */
            wafer->holder = WH_NONE;
            wafer->released_by = (int32_t)g;
            wh_index_move(table, (size_t)gripper->wafer);
            /*@ assert wh_same_held{Pre, Here}(table); */
            /*@ assert wh_other_holders{LoopCurrent, Here}(table, gripper->wafer); */
            /*@ assert wh_other_releases{LoopCurrent, Here}(table, gripper->wafer); */
            /*@ assert wh_stepping_holders(table, inputs, 0, g + 1); */
            /*@ assert wh_stepping_releases(table, inputs, 0, g + 1); */
            /*@ assert wh_stepping_held(table, inputs, 0, g + 1); */
        }
    }
}

/*@ requires wh_table_memory(table) && wh_is_gripper(table, g) && \valid_read(base_from_gripper);
    assigns table->storage.buckets[0 .. table->storage.bucket_count - 1];
    ensures \result == WH_NONE || wh_is_wafer(table, \result) && wh_holder(table, \result) == WH_NONE; */
static int32_t find_sampled(wh_grasp_t *table, size_t g, const wh_pose_t *base_from_gripper) {
    if (wh_horizon_covers(table, g, &base_from_gripper->r)) {
        wh_horizon_note(table, g);
        return WH_NONE;
    }
    return wh_grasp_find_ready(table, g, base_from_gripper);
}

/*@ requires wh_table_memory(table) && wh_list_ready(list, 1) && wh_list_apart(list, table);
    requires wh_is_gripper(table, g) && wh_held(table, g) == WH_NONE;
    requires \valid_read(input) && wh_apart_from_arrays(input, table);
    assigns table->counters, table->storage.wafers[0 .. table->storage.wafer_count - 1],
            table->storage.grippers[g].wafer, table->storage.grippers[g].gripper_from_wafer,
            table->storage.buckets[0 .. table->storage.bucket_count - 1],
            list->count, list->events[0 .. wh_room(list) - 1];
    ensures wh_list_grown{Pre, Post}(list, 1);
    ensures wh_same_size{Pre, Post}(table);
    ensures wh_held(table, g) != wh_held{Pre}(table, g) ==> wh_took{Pre, Post}(table, g, wh_held(table, g));
    ensures wh_held(table, g) == wh_held{Pre}(table, g) ==> wh_same_holders{Pre, Post}(table);
    ensures wh_other_holders{Pre, Post}(table, wh_held(table, g));
    ensures wh_other_held{Pre, Post}(table, g);
    ensures wh_same_releases{Pre, Post}(table);
    ensures wh_same_watched{Pre, Post}(table);
    ensures wh_other_poses{Pre, Post}(table, wh_held(table, g));
    ensures wh_other_grips{Pre, Post}(table, g); */
static void pick_sampled(wh_grasp_t *table, size_t g, const wh_gripper_input_t *input,
                         wh_event_list_t *list) {
    const int32_t w = find_sampled(table, g, &input->base_from_gripper);
    if (w == WH_NONE) {
        /*@ assert wh_other_poses{Pre, Here}(table, wh_held(table, g)); */
        return;
    }
    wh_grasp_take(table, g, w, &input->base_from_gripper, list);
    if (table->config.seat) {
        wh_grasp_carry(&table->storage.wafers[w], &input->base_from_gripper,
                       &table->storage.grippers[g].gripper_from_wafer);
        /*@ assert wh_other_poses{Pre, Here}(table, w); */
        /*@ assert wh_other_grips{Pre, Here}(table, g); */
    }
    /*@ assert wh_other_poses{Pre, Here}(table, w); */
    /*@ assert wh_other_grips{Pre, Here}(table, g); */
    /*@ assert wh_other_poses{Pre, Here}(table, wh_held(table, g)); */
}

/* Part 4 for one gripper. */
/*@ requires wh_table_memory(table) && wh_list_ready(list, 1) && wh_list_apart(list, table);
    requires wh_is_gripper(table, g);
    requires \valid_read(input) && wh_apart_from_arrays(input, table);
    assigns table->counters, table->storage.wafers[0 .. table->storage.wafer_count - 1],
            table->storage.grippers[g].wafer, table->storage.grippers[g].gripper_from_wafer,
            table->storage.buckets[0 .. table->storage.bucket_count - 1],
            list->count, list->events[0 .. wh_room(list) - 1];
    ensures wh_list_grown{Pre, Post}(list, 1);
    ensures wh_same_size{Pre, Post}(table);
    ensures wh_held(table, g) != wh_held{Pre}(table, g) ==> wh_took{Pre, Post}(table, g, wh_held(table, g));
    ensures wh_held(table, g) == wh_held{Pre}(table, g) ==> wh_same_holders{Pre, Post}(table);
    ensures \old(input->valve) == WH_VALVE_CLOSED ==> wh_held(table, g) == wh_held{Pre}(table, g);
    ensures wh_other_holders{Pre, Post}(table, wh_held(table, g));
    ensures wh_other_held{Pre, Post}(table, g);
    ensures wh_same_releases{Pre, Post}(table);
    ensures wh_same_watched{Pre, Post}(table);
    ensures wh_holders_kept{Pre, Post}(table);
    ensures wh_other_poses{Pre, Post}(table, wh_held(table, g));
    ensures wh_other_grips{Pre, Post}(table, g);
    ensures wh_free_at_rest{Pre, Post}(table);
    ensures wh_hold_kept{Pre, Post}(table); */
static void pick(wh_grasp_t *table, size_t g, const wh_gripper_input_t *input, wh_event_list_t *list) {
    const wh_gripper_t *gripper = &table->storage.grippers[g];
    if (input->valve == WH_VALVE_CLOSED || gripper->wafer != WH_NONE) {
        /*@ assert wh_other_poses{Pre, Here}(table, wh_held(table, g)); */
        /*@ assert wh_other_grips{Pre, Here}(table, g); */
        /*@ assert wh_free_at_rest{Pre, Here}(table); */
        /*@ assert wh_hold_kept{Pre, Here}(table); */
        /*@ assert wh_holders_kept{Pre, Here}(table); */
        return;
    }
    if (!wh_grasp_is_swept(table, g) || !wh_grasp_pick_swept(table, g, input, list)) {
        /*@ assert wh_same_holders{Pre, Here}(table) && wh_same_held{Pre, Here}(table); */
        /*@ assert wh_same_poses{Pre, Here}(table); */
        /*@ assert wh_same_grips{Pre, Here}(table); */
        pick_sampled(table, g, input, list);
        /*@ assert wh_other_poses{Pre, Here}(table, wh_held(table, g)); */
        /*@ assert wh_other_grips{Pre, Here}(table, g); */
    }
    /*@ assert wh_held(table, g) != wh_held{Pre}(table, g) ==> wh_took{Pre, Here}(table, g, wh_held(table, g)); */
    /*@ assert wh_held(table, g) == wh_held{Pre}(table, g) ==> wh_same_holders{Pre, Here}(table); */
    /*@ assert wh_other_holders{Pre, Here}(table, wh_held(table, g)); */
    /*@ assert wh_other_held{Pre, Here}(table, g); */
    /*@ assert wh_same_releases{Pre, Here}(table); */
    /*@ assert wh_same_watched{Pre, Here}(table); */
    /*@ assert wh_other_poses{Pre, Here}(table, wh_held(table, g)); */
    /*@ assert wh_other_grips{Pre, Here}(table, g); */
    /*@ assert wh_free_at_rest{Pre, Here}(table); */
    /*@ assert wh_hold_kept{Pre, Here}(table); */
    /*@ assert wh_holders_kept{Pre, Here}(table); */
}

/* A wafer that was let go and that nobody took. */
/*@ requires wh_table_memory(table) && wh_list_ready(list, 1) && wh_list_apart(list, table);
    requires wh_is_gripper(table, g) && \valid_read(input);
    requires wh_held(table, g) == WH_NONE || wh_is_wafer(table, wh_held(table, g));
    assigns table->counters.released, list->count, list->events[0 .. wh_room(list) - 1];
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
/*@ requires wh_table_memory(table) && wh_is_gripper(table, g);
    requires wh_held(table, g) == WH_NONE || wh_is_wafer(table, wh_held(table, g));
    requires \valid_read(inputs + (0 .. table->storage.gripper_count - 1)) && wh_inputs_apart(inputs, table);
    assigns table->storage.wafers[0 .. table->storage.wafer_count - 1],
            table->storage.grippers[g].wafer, table->storage.grippers[g].valve;
    ensures wh_same_inputs{Pre, Post}(inputs, table->storage.gripper_count);
    ensures wh_remembers{Pre, Post}(table, g, \old(inputs[g].valve));
    ensures wh_other_held{Pre, Post}(table, g);
    ensures wh_same_watched{Pre, Post}(table);
    ensures wh_same_holders{Pre, Post}(table);
    ensures wh_same_poses{Pre, Post}(table);
    ensures wh_same_grips{Pre, Post}(table); */
static void remember_valve(wh_grasp_t *table, size_t g, const wh_gripper_input_t *inputs) {
    wh_gripper_t *gripper = &table->storage.grippers[g];
    /*@ assert \forall integer i; wh_is_gripper(table, i) ==> \separated(inputs + i, gripper); */
    /*@ assert \forall integer i; wh_is_gripper(table, i) ==>
          \separated(inputs + i, table->storage.wafers + (0 .. table->storage.wafer_count - 1)); */
    if (inputs[g].valve == WH_VALVE_CLOSED && gripper->wafer != WH_NONE) {
        table->storage.wafers[gripper->wafer].released_by = WH_NONE;
        gripper->wafer = WH_NONE;
    }
    gripper->valve = inputs[g].valve;
}

/*@ requires wh_table_memory(table) && wh_is_gripper(table, g);
    requires wh_held(table, g) == WH_NONE || wh_is_wafer(table, wh_held(table, g));
    requires \valid_read(inputs + (0 .. table->storage.gripper_count - 1)) && wh_inputs_apart(inputs, table);
    assigns table->storage.wafers[0 .. table->storage.wafer_count - 1],
            table->storage.grippers[0 .. table->storage.gripper_count - 1];
    ensures wh_same_size{Pre, Post}(table);
    ensures wh_same_inputs{Pre, Post}(inputs, table->storage.gripper_count);
    ensures wh_remembers{Pre, Post}(table, g, \old(inputs[g].valve));
    ensures wh_other_held{Pre, Post}(table, g);
    ensures wh_same_watched{Pre, Post}(table);
    ensures wh_same_holders{Pre, Post}(table);
    ensures wh_same_poses{Pre, Post}(table);
    ensures wh_same_grips{Pre, Post}(table); */
static void remember(wh_grasp_t *table, size_t g, const wh_gripper_input_t *inputs) {
    /*@ assert \forall integer w; wh_is_wafer(table, w) ==>
          \separated(table->storage.wafers + w, table->storage.grippers + g); */
    table->storage.grippers[g].base_from_gripper = inputs[g].base_from_gripper;
    /*@ assert wh_same_poses{Pre, Here}(table); */
    /*@ assert wh_same_grips{Pre, Here}(table); */
    remember_valve(table, g, inputs);
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

/*@ requires wh_table_memory(table) && wh_list_ready(list, 1) && wh_list_apart(list, table);
    requires wh_is_gripper(table, g);
    requires \valid_read(inputs + (0 .. table->storage.gripper_count - 1)) && wh_inputs_apart(inputs, table) &&
             wh_inputs_apart_list(inputs, table, list);
    requires wh_stepping(table, inputs, 0, table->storage.gripper_count);
    assigns table->counters, table->storage.wafers[0 .. table->storage.wafer_count - 1],
            table->storage.grippers[0 .. table->storage.gripper_count - 1],
            table->storage.buckets[0 .. table->storage.bucket_count - 1],
            list->count, list->events[0 .. wh_room(list) - 1];
    ensures wh_same_size{Pre, Post}(table);
    ensures wh_list_grown{Pre, Post}(list, 1);
    ensures wh_same_inputs{Pre, Post}(inputs, table->storage.gripper_count);
    ensures wh_stepping(table, inputs, 0, table->storage.gripper_count);
    ensures wh_same_watched{Pre, Post}(table);
    ensures wh_holders_kept{Pre, Post}(table);
    ensures wh_free_at_rest{Pre, Post}(table);
    ensures wh_hold_kept{Pre, Post}(table); */
static void pick_next(wh_grasp_t *table, size_t g, const wh_gripper_input_t *inputs, wh_event_list_t *list) {
    /*@ assert \forall integer i; wh_is_gripper(table, i) ==>
          \separated(inputs + i, table->storage.wafers + (0 .. table->storage.wafer_count - 1)); */
    /*@ assert \forall integer i; wh_is_gripper(table, i) ==> \separated(inputs + i, table->storage.grippers + g); */
    /*@ assert \forall integer i; wh_is_gripper(table, i) ==>
          \separated(inputs + i, list->events + (0 .. wh_room(list) - 1)); */
    pick(table, g, &inputs[g], list);
    /*@ assert wh_same_inputs{Pre, Here}(inputs, \at(table->storage.gripper_count, Pre)); */
    /*@ assert wh_held(table, g) == wh_held{Pre}(table, g) ==> wh_same_held{Pre, Here}(table); */
    /*@ assert wh_held(table, g) == wh_held{Pre}(table, g) ==>
          wh_stepping(table, inputs, 0, \at(table->storage.gripper_count, Pre)); */
    /*@ assert wh_held(table, g) != wh_held{Pre}(table, g) ==>
          !wh_lets_go{Pre}(inputs, g, 0, \at(table->storage.gripper_count, Pre)); */
    /*@ assert wh_held(table, g) != wh_held{Pre}(table, g) ==>
          wh_stepping(table, inputs, 0, \at(table->storage.gripper_count, Pre)); */
}

/*@ requires wh_table_memory(table) && wh_list_apart(list, table) && wh_list_ready(list, table->storage.gripper_count);
    requires \valid_read(inputs + (0 .. table->storage.gripper_count - 1)) && wh_inputs_apart(inputs, table) &&
             wh_inputs_apart_list(inputs, table, list);
    requires wh_stepping(table, inputs, 0, table->storage.gripper_count);
    assigns table->counters, table->storage.wafers[0 .. table->storage.wafer_count - 1],
            table->storage.grippers[0 .. table->storage.gripper_count - 1],
            table->storage.buckets[0 .. table->storage.bucket_count - 1],
            list->count, list->events[0 .. wh_room(list) - 1];
    ensures wh_stepping(table, inputs, 0, table->storage.gripper_count);
    ensures wh_list_grown{Pre, Post}(list, table->storage.gripper_count);
    ensures wh_same_size{Pre, Post}(table);
    ensures wh_same_watched{Pre, Post}(table);
    ensures wh_free_at_rest{Pre, Post}(table);
    ensures wh_hold_kept{Pre, Post}(table); */
static void pick_all(wh_grasp_t *table, const wh_gripper_input_t *inputs, wh_event_list_t *list) {
    /*@ loop invariant 0 <= g <= table->storage.gripper_count;
        loop invariant table->storage.wafer_count == \at(table->storage.wafer_count, Pre);
        loop invariant table->storage.gripper_count == \at(table->storage.gripper_count, Pre);
        loop invariant table->storage.bucket_count == \at(table->storage.bucket_count, Pre);
        loop invariant wh_room(list) == wh_room{Pre}(list);
        loop invariant wh_same_size{Pre, Here}(table);
        loop invariant wh_stepping(table, inputs, 0, table->storage.gripper_count);
        loop invariant wh_list_grown{Pre, Here}(list, g);
        loop invariant wh_same_watched{Pre, Here}(table);
        loop invariant wh_free_at_rest{Pre, Here}(table);
        loop invariant wh_hold_kept{Pre, Here}(table);
        loop assigns g, table->counters, table->storage.wafers[0 .. \at(table->storage.wafer_count, Pre) - 1],
            table->storage.grippers[0 .. \at(table->storage.gripper_count, Pre) - 1],
            table->storage.buckets[0 .. \at(table->storage.bucket_count, Pre) - 1],
            list->count, list->events[0 .. wh_room{Pre}(list) - 1];
        loop variant table->storage.gripper_count - g; */
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        /*@ assert wh_table_memory(table) && wh_list_apart(list, table) && wh_list_ready(list, 1); */
        /*@ assert wh_inputs_apart(inputs, table); */
        /*@ assert wh_inputs_apart_list(inputs, table, list); */
        pick_next(table, g, inputs, list);
    }
}

/*@ requires wh_table_memory(table) && wh_list_apart(list, table) && wh_list_ready(list, table->storage.gripper_count);
    requires \valid_read(inputs + (0 .. table->storage.gripper_count - 1)) && wh_inputs_apart(inputs, table) &&
             wh_inputs_apart_list(inputs, table, list);
    requires wh_stepping(table, inputs, 0, table->storage.gripper_count);
    assigns table->counters.released,
            list->count, list->events[0 .. wh_room(list) - 1];
    ensures wh_list_grown{Pre, Post}(list, table->storage.gripper_count);
    ensures wh_same_size{Pre, Post}(table);
    ensures wh_same_inputs{Pre, Post}(inputs, table->storage.gripper_count);
    ensures wh_same_holders{Pre, Post}(table);
    ensures wh_same_releases{Pre, Post}(table);
    ensures wh_same_held{Pre, Post}(table);
    ensures wh_same_watched{Pre, Post}(table);
    ensures wh_same_poses{Pre, Post}(table);
    ensures wh_same_grips{Pre, Post}(table); */
static void report_releases(wh_grasp_t *table, const wh_gripper_input_t *inputs, wh_event_list_t *list) {
    /*@ loop invariant 0 <= g <= table->storage.gripper_count;
        loop invariant wh_list_grown{Pre, Here}(list, g);
        loop assigns g, table->counters.released,
            list->count, list->events[0 .. wh_room{Pre}(list) - 1];
        loop variant table->storage.gripper_count - g; */
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        report_release(table, g, &inputs[g], list);
    }
}

/*@ requires wh_table_memory(table) && wh_list_ready(list, 2) && wh_list_apart(list, table);
    requires wh_is_gripper(table, g);
    requires \valid_read(inputs + (0 .. table->storage.gripper_count - 1)) && wh_inputs_apart(inputs, table) &&
             wh_inputs_apart_list(inputs, table, list);
    requires wh_encounters(table);
    assigns table->counters, table->storage.grippers[0 .. table->storage.gripper_count - 1],
            table->storage.buckets[0 .. table->storage.bucket_count - 1],
            list->count, list->events[0 .. wh_room(list) - 1];
    ensures wh_same_size{Pre, Post}(table);
    ensures wh_list_grown{Pre, Post}(list, 2);
    ensures wh_encounters(table);
    ensures wh_same_inputs{Pre, Post}(inputs, table->storage.gripper_count);
    ensures wh_same_held{Pre, Post}(table);
    ensures wh_same_holders{Pre, Post}(table);
    ensures wh_same_releases{Pre, Post}(table);
    ensures wh_same_poses{Pre, Post}(table);
    ensures wh_same_grips{Pre, Post}(table); */
static void watch_next(wh_grasp_t *table, size_t g, const wh_gripper_input_t *inputs, wh_event_list_t *list) {
    /*@ assert \forall integer i; wh_is_gripper(table, i) ==> \separated(inputs + i, table->storage.grippers + g); */
    /*@ assert \forall integer i; wh_is_gripper(table, i) ==>
          \separated(&inputs[i].valve, &table->storage.grippers[g].approach, list->events + (0 .. wh_room(list) - 1)) &&
          \separated(&inputs[i].valve, &table->storage.grippers[g].contest); */
    /*@ assert \forall integer w; wh_is_wafer(table, w) ==>
          \separated(table->storage.wafers + w, table->storage.grippers + g); */
    /*@ assert \forall integer w; wh_is_wafer(table, w) ==>
          \separated(table->storage.wafers + w, list->events + (0 .. wh_room(list) - 1)); */
    /*@ assert \forall integer w; wh_is_wafer(table, w) ==>
          \separated(&table->storage.wafers[w].holder, &table->storage.grippers[g].approach,
                     list->events + (0 .. wh_room(list) - 1)) &&
          \separated(&table->storage.wafers[w].holder, &table->storage.grippers[g].contest); */
    /*@ assert \forall integer w; wh_is_wafer(table, w) ==>
          \separated(&table->storage.wafers[w].released_by, &table->storage.grippers[g].approach,
                     list->events + (0 .. wh_room(list) - 1)) &&
          \separated(&table->storage.wafers[w].released_by, &table->storage.grippers[g].contest); */
    /*@ assert \forall integer w; wh_is_wafer(table, w) ==>
          \separated(&table->storage.wafers[w].base_from_wafer, &table->storage.grippers[g].approach,
                     list->events + (0 .. wh_room(list) - 1)) &&
          \separated(&table->storage.wafers[w].base_from_wafer, &table->storage.grippers[g].contest); */
    wh_encounter_update(table, g, &inputs[g], list);
    /*@ assert wh_same_size{Pre, Here}(table); */
    /*@ assert \forall integer i; wh_is_gripper{Pre}(table, i) ==> inputs[i].valve == \at(inputs[i].valve, Pre); */
    /*@ assert wh_same_inputs{Pre, Here}(inputs, \at(table->storage.gripper_count, Pre)); */
    /*@ assert \forall integer w; wh_is_wafer{Pre}(table, w) ==>
          table->storage.wafers[w].holder == \at(table->storage.wafers[w].holder, Pre); */
    /*@ assert \forall integer w; wh_is_wafer{Pre}(table, w) ==>
          table->storage.wafers[w].released_by == \at(table->storage.wafers[w].released_by, Pre); */
    /*@ assert \forall integer w; wh_is_wafer{Pre}(table, w) ==> wh_same_pose{Pre, Here}(table, w); */
}

/*@ requires wh_table_memory(table) && wh_list_apart(list, table) && wh_list_ready(list, 2 * table->storage.gripper_count);
    requires \valid_read(inputs + (0 .. table->storage.gripper_count - 1)) && wh_inputs_apart(inputs, table) &&
             wh_inputs_apart_list(inputs, table, list);
    requires wh_encounters(table);
    assigns table->counters, table->storage.grippers[0 .. table->storage.gripper_count - 1],
            table->storage.buckets[0 .. table->storage.bucket_count - 1],
            list->count, list->events[0 .. wh_room(list) - 1];
    ensures wh_same_size{Pre, Post}(table);
    ensures wh_same_held{Pre, Post}(table);
    ensures wh_list_grown{Pre, Post}(list, 2 * table->storage.gripper_count);
    ensures wh_encounters(table);
    ensures wh_same_inputs{Pre, Post}(inputs, table->storage.gripper_count);
    ensures wh_same_holders{Pre, Post}(table);
    ensures wh_same_releases{Pre, Post}(table);
    ensures wh_same_poses{Pre, Post}(table);
    ensures wh_same_grips{Pre, Post}(table); */
static void watch_all(wh_grasp_t *table, const wh_gripper_input_t *inputs, wh_event_list_t *list) {
    /*@ loop invariant 0 <= g <= table->storage.gripper_count;
        loop invariant table->storage.wafer_count == \at(table->storage.wafer_count, Pre);
        loop invariant table->storage.gripper_count == \at(table->storage.gripper_count, Pre);
        loop invariant table->storage.bucket_count == \at(table->storage.bucket_count, Pre);
        loop invariant wh_room(list) == wh_room{Pre}(list);
        loop invariant wh_same_size{Pre, Here}(table);
        loop invariant wh_list_grown{Pre, Here}(list, 2 * g);
        loop invariant wh_encounters(table);
        loop invariant wh_same_inputs{Pre, Here}(inputs, table->storage.gripper_count);
        loop invariant wh_same_held{Pre, Here}(table);
        loop invariant wh_same_holders{Pre, Here}(table);
        loop invariant wh_same_releases{Pre, Here}(table);
        loop invariant wh_same_poses{Pre, Here}(table);
        loop invariant wh_same_grips{Pre, Here}(table);
        loop assigns g, table->counters, table->storage.grippers[0 .. \at(table->storage.gripper_count, Pre) - 1],
            table->storage.buckets[0 .. \at(table->storage.bucket_count, Pre) - 1],
            list->count, list->events[0 .. wh_room{Pre}(list) - 1];
        loop variant table->storage.gripper_count - g; */
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        /*@ assert wh_table_memory(table) && wh_list_apart(list, table) && wh_list_ready(list, 2); */
        /*@ assert wh_inputs_apart(inputs, table); */
        /*@ assert wh_inputs_apart_list(inputs, table, list); */
        watch_next(table, g, inputs, list);
    }
}

/*@ requires wh_table_memory(table);
    requires \valid_read(inputs + (0 .. table->storage.gripper_count - 1)) && wh_inputs_apart(inputs, table);
    requires wh_stepping(table, inputs, 0, table->storage.gripper_count);
    requires wh_encounters(table);
    assigns table->storage.wafers[0 .. table->storage.wafer_count - 1],
            table->storage.grippers[0 .. table->storage.gripper_count - 1];
    ensures wh_same_size{Pre, Post}(table);
    ensures wh_consistent(table);
    ensures wh_same_holders{Pre, Post}(table);
    ensures wh_same_poses{Pre, Post}(table);
    ensures wh_same_grips{Pre, Post}(table); */
static void remember_all(wh_grasp_t *table, const wh_gripper_input_t *inputs) {
    /*@ loop invariant 0 <= g <= table->storage.gripper_count;
        loop invariant table->storage.wafer_count == \at(table->storage.wafer_count, Pre);
        loop invariant table->storage.gripper_count == \at(table->storage.gripper_count, Pre);
        loop invariant wh_same_size{Pre, Here}(table);
        loop invariant wh_encounters(table);
        loop invariant wh_stepping(table, inputs, g, table->storage.gripper_count);
        loop invariant wh_same_holders{Pre, Here}(table);
        loop invariant wh_same_poses{Pre, Here}(table);
        loop invariant wh_same_grips{Pre, Here}(table);
        loop assigns g, table->storage.wafers[0 .. \at(table->storage.wafer_count, Pre) - 1],
                     table->storage.grippers[0 .. \at(table->storage.gripper_count, Pre) - 1];
        loop variant table->storage.gripper_count - g; */
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        /*@ assert wh_inputs_apart(inputs, table); */
        remember(table, g, inputs);
        /*@ assert wh_encounters(table); */
        /*@ assert wh_stepping_holders(table, inputs, g + 1, table->storage.gripper_count); */
        /*@ assert wh_stepping_releases(table, inputs, g + 1, table->storage.gripper_count); */
        /*@ assert wh_stepping_held(table, inputs, g + 1, table->storage.gripper_count); */
        /*@ assert wh_stepping(table, inputs, g + 1, table->storage.gripper_count); */
    }
}

/* What else there is to tell after the picks. */
/*@ requires wh_table_memory(table) && wh_list_apart(list, table) && wh_list_ready(list, 3 * table->storage.gripper_count);
    requires \valid_read(inputs + (0 .. table->storage.gripper_count - 1)) && wh_inputs_apart(inputs, table) &&
             wh_inputs_apart_list(inputs, table, list);
    requires wh_stepping(table, inputs, 0, table->storage.gripper_count);
    requires wh_encounters(table);
    assigns table->counters, table->storage.grippers[0 .. table->storage.gripper_count - 1],
            table->storage.buckets[0 .. table->storage.bucket_count - 1],
            list->count, list->events[0 .. wh_room(list) - 1];
    ensures wh_same_size{Pre, Post}(table);
    ensures wh_stepping(table, inputs, 0, table->storage.gripper_count);
    ensures wh_encounters(table);
    ensures wh_same_held{Pre, Post}(table);
    ensures wh_same_holders{Pre, Post}(table);
    ensures wh_same_poses{Pre, Post}(table);
    ensures wh_same_grips{Pre, Post}(table); */
static void report_all(wh_grasp_t *table, const wh_gripper_input_t *inputs, wh_event_list_t *list) {
    report_releases(table, inputs, list);
    /*@ assert wh_same_size{Pre, Here}(table); */
    /*@ assert table->storage.wafer_count == \at(table->storage.wafer_count, Pre) &&
               table->storage.gripper_count == \at(table->storage.gripper_count, Pre) &&
               table->storage.bucket_count == \at(table->storage.bucket_count, Pre); */
    /*@ assert wh_room(list) == wh_room{Pre}(list); */
    /*@ assert wh_stepping(table, inputs, 0, table->storage.gripper_count); */
    /*@ assert wh_encounters(table); */
    /*@ assert wh_table_memory(table); */
    /*@ assert wh_list_ready(list, 2 * table->storage.gripper_count); */
    /*@ assert wh_list_apart(list, table); */
    /*@ assert wh_inputs_apart(inputs, table); */
    /*@ assert wh_inputs_apart_list(inputs, table, list); */
    watch_all(table, inputs, list);
    /*@ assert table->storage.wafer_count == \at(table->storage.wafer_count, Pre) &&
               table->storage.gripper_count == \at(table->storage.gripper_count, Pre) &&
               table->storage.bucket_count == \at(table->storage.bucket_count, Pre); */
    /*@ assert wh_same_size{Pre, Here}(table); */
}

/* That looking for wafers would find none: none of those at rest matters to gripper g, on its way or at its end. */
/*@ requires wh_table_memory(table) && wh_is_gripper(table, g) && \valid_read(place);
    assigns \nothing; */
static bool is_far_from_all(const wh_grasp_t *table, size_t g, const wh_vec3_t *place) {
    const wh_vec3_t *begin = &table->storage.grippers[g].base_from_gripper.r;
    if (!wh_horizon_covers(table, g, place)) {
        return false;
    }
    return !wh_grasp_is_swept(table, g) || wh_horizon_covers(table, g, begin);
}

/* What gripper g does in this slice may be more than going on with what it holds, or without: it is watching a wafer, lets
 * go, or is open and not far from all that rest. */
/*@ requires wh_table_memory(table) && wh_is_gripper(table, g) && \valid_read(input);
    assigns \nothing;
    ensures !\result ==> input->valve == WH_VALVE_OPEN || wh_held(table, g) == WH_NONE; */
static bool may_act(const wh_grasp_t *table, size_t g, const wh_gripper_input_t *input) {
    const wh_gripper_t *gripper = &table->storage.grippers[g];
    const bool open = input->valve == WH_VALVE_OPEN;
    if (gripper->approach.wafer != WH_NONE || gripper->contest.wafer != WH_NONE) {
        return true;
    }
    if (gripper->wafer != WH_NONE) {
        return !open;
    }
    return open && !is_far_from_all(table, g, &input->base_from_gripper.r);
}

/* Whether this slice has no pick, no release and nothing to tell: what most slices are. Where a gripper holds a wafer and
 * another one looks for some, they may contest it. */
/*@ requires wh_table_memory(table);
    requires \valid_read(inputs + (0 .. table->storage.gripper_count - 1));
    assigns \nothing;
    ensures \result ==> \forall integer g; wh_is_gripper(table, g) ==>
              inputs[g].valve == WH_VALVE_OPEN || wh_held(table, g) == WH_NONE; */
static bool is_uneventful(const wh_grasp_t *table, const wh_gripper_input_t *inputs) {
    bool holding = false;
    bool looking = false;
    /*@ loop invariant 0 <= g <= table->storage.gripper_count;
        loop invariant \forall integer i; 0 <= i < g ==>
                         inputs[i].valve == WH_VALVE_OPEN || wh_held(table, i) == WH_NONE;
        loop assigns g, holding, looking;
        loop variant table->storage.gripper_count - g; */
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        const bool holds = table->storage.grippers[g].wafer != WH_NONE;
        if (may_act(table, g, &inputs[g])) {
            return false;
        }
        holding = holding || holds;
        looking = looking || (!holds && inputs[g].valve == WH_VALVE_OPEN);
    }
    return !(holding && looking);
}

/*@ requires wh_table_memory(table) && wh_consistent(table) && wh_is_gripper(table, g);
    requires \valid_read(input) && wh_apart_from_arrays(input, table);
    assigns table->storage.wafers[0 .. table->storage.wafer_count - 1],
            table->storage.grippers[0 .. table->storage.gripper_count - 1];
    ensures wh_same_size{Pre, Post}(table);
    ensures wh_same_holders{Pre, Post}(table);
    ensures wh_same_releases{Pre, Post}(table);
    ensures wh_same_held{Pre, Post}(table);
    ensures wh_same_watched{Pre, Post}(table);
    ensures wh_same_grips{Pre, Post}(table);
    ensures wh_free_stay{Pre, Post}(table); */
static void move(wh_grasp_t *table, size_t g, const wh_gripper_input_t *input) {
    wh_gripper_t *gripper = &table->storage.grippers[g];
    if (gripper->wafer != WH_NONE) {
        wh_grasp_carry(&table->storage.wafers[gripper->wafer], &input->base_from_gripper,
                       &gripper->gripper_from_wafer);
    }
    gripper->base_from_gripper = input->base_from_gripper;
    gripper->valve = input->valve;
}

/* An uneventful slice: the grippers go where they go, and what they hold goes with them. */
/*@ requires wh_table_memory(table) && wh_consistent(table);
    requires \valid_read(inputs + (0 .. table->storage.gripper_count - 1)) && wh_inputs_apart(inputs, table);
    assigns table->storage.wafers[0 .. table->storage.wafer_count - 1],
            table->storage.grippers[0 .. table->storage.gripper_count - 1];
    ensures wh_same_size{Pre, Post}(table);
    ensures wh_consistent(table);
    ensures wh_same_holders{Pre, Post}(table);
    ensures wh_same_grips{Pre, Post}(table);
    ensures wh_free_stay{Pre, Post}(table); */
static void move_all(wh_grasp_t *table, const wh_gripper_input_t *inputs) {
    /*@ loop invariant 0 <= g <= table->storage.gripper_count;
        loop invariant table->storage.wafer_count == \at(table->storage.wafer_count, Pre);
        loop invariant table->storage.gripper_count == \at(table->storage.gripper_count, Pre);
        loop invariant wh_same_size{Pre, Here}(table);
        loop invariant wh_same_holders{Pre, Here}(table);
        loop invariant wh_same_releases{Pre, Here}(table);
        loop invariant wh_same_held{Pre, Here}(table);
        loop invariant wh_same_watched{Pre, Here}(table);
        loop invariant wh_same_grips{Pre, Here}(table);
        loop invariant wh_free_stay{Pre, Here}(table);
        loop assigns g, table->storage.wafers[0 .. \at(table->storage.wafer_count, Pre) - 1],
                     table->storage.grippers[0 .. \at(table->storage.gripper_count, Pre) - 1];
        loop variant table->storage.gripper_count - g; */
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        move(table, g, &inputs[g]);
    }
}

/* Parts 4 to 6, for slices in which they may find something. */
/*@ requires wh_table_memory(table) && wh_list_apart(list, table);
    requires wh_list_ready(list, 4 * table->storage.gripper_count);
    requires \valid_read(inputs + (0 .. table->storage.gripper_count - 1)) && wh_inputs_apart(inputs, table) &&
             wh_inputs_apart_list(inputs, table, list);
    requires wh_stepping(table, inputs, 0, table->storage.gripper_count);
    requires wh_encounters(table);
    assigns table->counters, table->storage.wafers[0 .. table->storage.wafer_count - 1],
            table->storage.grippers[0 .. table->storage.gripper_count - 1],
            table->storage.buckets[0 .. table->storage.bucket_count - 1],
            list->count, list->events[0 .. wh_room(list) - 1];
    ensures wh_same_size{Pre, Post}(table);
    ensures wh_stepping(table, inputs, 0, table->storage.gripper_count);
    ensures wh_encounters(table);
    ensures wh_free_at_rest{Pre, Post}(table);
    ensures wh_hold_kept{Pre, Post}(table); */
static void pick_and_report(wh_grasp_t *table, const wh_gripper_input_t *inputs, wh_event_list_t *list) {
    pick_all(table, inputs, list);
    /*@ assert wh_same_size{Pre, Here}(table); */
    /*@ assert table->storage.wafer_count == \at(table->storage.wafer_count, Pre) &&
               table->storage.gripper_count == \at(table->storage.gripper_count, Pre) &&
               table->storage.bucket_count == \at(table->storage.bucket_count, Pre); */
    /*@ assert wh_room(list) == wh_room{Pre}(list); */
    /*@ assert wh_encounters(table); */
    /*@ assert wh_free_at_rest{Pre, Here}(table); */
    /*@ assert wh_hold_kept{Pre, Here}(table); */
    /*@ assert wh_table_memory(table); */
    /*@ assert wh_list_ready(list, 3 * table->storage.gripper_count); */
    /*@ assert wh_list_apart(list, table); */
    /*@ assert wh_inputs_apart(inputs, table); */
    /*@ assert wh_inputs_apart_list(inputs, table, list); */
    report_all(table, inputs, list);
    /*@ assert wh_same_size{Pre, Here}(table); */
    /*@ assert wh_free_at_rest{Pre, Here}(table); */
    /*@ assert wh_hold_kept{Pre, Here}(table); */
}

/* Parts 2 to 7. */
/*@ requires wh_table_memory(table) && wh_consistent(table) && wh_list_apart(list, table);
    requires wh_list_ready(list, 4 * table->storage.gripper_count);
    requires \valid_read(inputs + (0 .. table->storage.gripper_count - 1)) && wh_inputs_apart(inputs, table) &&
             wh_inputs_apart_list(inputs, table, list);
    assigns table->slice, table->counters, table->storage.wafers[0 .. table->storage.wafer_count - 1],
            table->storage.grippers[0 .. table->storage.gripper_count - 1],
            table->storage.buckets[0 .. table->storage.bucket_count - 1],
            list->count, list->events[0 .. wh_room(list) - 1];
    ensures wh_consistent(table);
    ensures wh_free_at_rest{Pre, Post}(table);
    ensures wh_grips_kept{Pre, Post}(table); */
static void advance_with_events(wh_grasp_t *table, const wh_gripper_input_t *inputs, wh_event_list_t *list) {
    ++table->slice;
    /*@ assert wh_same_size{Pre, Here}(table) && wh_table_memory(table); */
    /*@ assert wh_paired(table); */
    /*@ assert wh_none_released(table); */
    /*@ assert wh_encounters(table); */
    carry_and_release(table, inputs);
    /*@ assert wh_same_size{Pre, Here}(table); */
    /*@ assert wh_encounters(table); */
    /*@ assert wh_free_stay{Pre, Here}(table); */
    /*@ assert wh_hold_kept{Pre, Here}(table); */
    pick_and_report(table, inputs, list);
    /*@ assert wh_same_size{Pre, Here}(table); */
    /*@ assert table->storage.wafer_count == \at(table->storage.wafer_count, Pre) &&
               table->storage.gripper_count == \at(table->storage.gripper_count, Pre); */
    /*@ assert wh_free_at_rest{Pre, Here}(table); */
    /*@ assert wh_hold_kept{Pre, Here}(table); */
    /*@ assert wh_table_memory(table); */
    /*@ assert wh_inputs_apart(inputs, table); */
    remember_all(table, inputs);
    /*@ assert wh_free_at_rest{Pre, Here}(table); */
    /*@ assert wh_grips_kept{Pre, Here}(table); */
}

/*@ requires wh_table_memory(table) && wh_consistent(table) && wh_list_apart(list, table);
    requires wh_list_ready(list, 4 * table->storage.gripper_count);
    requires \valid_read(inputs + (0 .. table->storage.gripper_count - 1)) && wh_inputs_apart(inputs, table) &&
             wh_inputs_apart_list(inputs, table, list);
    assigns table->slice, table->counters, table->storage.wafers[0 .. table->storage.wafer_count - 1],
            table->storage.grippers[0 .. table->storage.gripper_count - 1],
            table->storage.buckets[0 .. table->storage.bucket_count - 1],
            list->count, list->events[0 .. wh_room(list) - 1];
    ensures wh_consistent(table);
    ensures wh_free_at_rest{Pre, Post}(table);
    ensures wh_grips_kept{Pre, Post}(table); */
static void advance(wh_grasp_t *table, const wh_gripper_input_t *inputs, wh_event_list_t *list) {
    if (is_uneventful(table, inputs)) {
        ++table->slice;
        move_all(table, inputs);
    } else {
        advance_with_events(table, inputs, list);
    }
}

/* Part 1. A refused call changes nothing but counters and the list. */
/*@ requires wh_table_memory(table) && wh_list_memory(list) && wh_list_apart(list, table);
    requires inputs != \null ==> \valid_read(inputs + (0 .. table->storage.gripper_count - 1)) &&
             wh_inputs_apart(inputs, table) && wh_inputs_apart_list(inputs, table, list);
    requires list != \null ==> list->count == 0;
    assigns table->counters.refused, list->count, list->events[0 .. wh_room(list) - 1];
    ensures wh_same_size{Pre, Post}(table);
    ensures wh_same_arrays{Pre, Post}(table);
    ensures \result == WH_OK ==> wh_list_ready(list, 4 * table->storage.gripper_count);
    ensures \result == WH_OK ==> \valid_read(inputs + (0 .. table->storage.gripper_count - 1)) &&
             wh_inputs_apart(inputs, table) && wh_inputs_apart_list(inputs, table, list); */
static wh_status_t validate(wh_grasp_t *table, const wh_gripper_input_t *inputs, wh_event_list_t *list) {
    const wh_status_t status = validate_call(table, inputs, list);
    if (status != WH_OK) {
        count_refusal(table);
        return status;
    }
    return validate_inputs(table, inputs, list);
}

/* The step of a table that there is, with an empty list. */
/*@ requires wh_table_memory(table) && wh_consistent(table);
    requires wh_list_memory(list) && wh_list_apart(list, table);
    requires inputs != \null ==> \valid_read(inputs + (0 .. table->storage.gripper_count - 1)) &&
             wh_inputs_apart(inputs, table) && wh_inputs_apart_list(inputs, table, list);
    requires list != \null ==> list->count == 0;
    assigns table->slice, table->counters, table->storage.wafers[0 .. table->storage.wafer_count - 1],
            table->storage.grippers[0 .. table->storage.gripper_count - 1],
            table->storage.buckets[0 .. table->storage.bucket_count - 1],
            list->count, list->events[0 .. wh_room(list) - 1];
    ensures wh_consistent(table);
    ensures wh_free_at_rest{Pre, Post}(table);
    ensures wh_grips_kept{Pre, Post}(table);
    ensures \result != WH_OK ==> \at(table->slice, Pre) == table->slice;
    ensures \result != WH_OK ==> wh_same_arrays{Pre, Post}(table); */
static wh_status_t step(wh_grasp_t *table, const wh_gripper_input_t *inputs, wh_event_list_t *list) {
    const wh_status_t status = validate(table, inputs, list);
    /*@ assert wh_table_memory(table); */
    /*@ assert wh_same_size{Pre, Here}(table) && wh_room(list) == wh_room{Pre}(list); */
    /*@ assert wh_consistent(table); */
    if (status == WH_OK) {
        advance(table, inputs, list);
    }
    return status;
}

wh_status_t wh_grasp_step(wh_grasp_t *table, const wh_gripper_input_t *inputs, wh_event_list_t *list) {
    if (list) {
        list->count = 0;
    }
    if (!table) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    /*@ assert wh_same_size{Pre, Here}(table); */
    /*@ assert wh_same_encounters{Pre, Here}(table); */
    /*@ assert wh_same_arrays{Pre, Here}(table); */
    /*@ assert wh_table_memory(table); */
    /*@ assert wh_consistent(table); */
    return step(table, inputs, list);
}
