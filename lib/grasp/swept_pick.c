#include "grasp_internal.h"
#include "horizon_internal.h"
#include "sweep_internal.h"

/* The best wafer so far. */
typedef struct {
    int32_t wafer; /* WH_NONE: none */
    wh_real_t t;   /* the instant within the slice, 1 being its end */
    wh_real_t distance;
} candidate_t;

/*@ requires \valid_read(best) && \valid_read(other); assigns \nothing; */
static bool is_better(const candidate_t *best, const candidate_t *other) {
    if (other->t != best->t) {
        return other->t < best->t;
    }
    return other->distance < best->distance ||
           (other->distance == best->distance && other->wafer < best->wafer);
}

/* Earliest instant, then smallest |dr_proj_z|, then lowest index. */
/*@ requires \valid(best) && \valid_read(other); assigns *best; ensures best->wafer == \old(best->wafer) || best->wafer == \old(other->wafer);
    ensures \old(best->wafer) == WH_NONE ==> best->wafer == \old(other->wafer); */
static void keep_better(candidate_t *best, const candidate_t *other) {
    if (best->wafer == WH_NONE || is_better(best, other)) {
        *best = *other;
    }
}

/*@ requires wh_table_memory(table) && wh_is_gripper(table, g) && wh_sweep_memory(sweep);
    assigns table->storage.buckets[0 .. table->storage.bucket_count - 1];
    ensures \result.wafer == WH_NONE ||
            wh_is_wafer(table, \result.wafer) && wh_holder(table, \result.wafer) == WH_NONE; */
static candidate_t find_ready(wh_grasp_t *table, size_t g, const wh_sweep_t *sweep) {
    const wh_vec3_t *place = &sweep->end->r;
    const wh_real_t margin = wh_horizon_margin(table, g, place);
    const wh_found_t near = wh_index_near(table, g, &sweep->begin->r, place, margin);
    wh_horizon_t horizon = wh_horizon_begin(table, g, &near, margin);
    candidate_t best = {.wafer = WH_NONE};
    /*@ loop invariant 0 <= i <= near.count;
        loop invariant best.wafer == WH_NONE ||
                       wh_is_wafer(table, best.wafer) && wh_holder(table, best.wafer) == WH_NONE;
        loop assigns i, best, horizon.gap;
        loop variant near.count - i; */
    for (size_t i = 0; i < near.count; ++i) {
        const size_t w = wh_index_wafer(table, &near, i);
        const wh_wafer_t *wafer = &table->storage.wafers[w];
        if (wafer->holder != WH_NONE) {
            continue;
        }
        candidate_t here = {.wafer = (int32_t)w};
        (void)wh_horizon_passes(&horizon, &wafer->base_from_wafer, place);
        if (wafer->released_by == WH_NONE &&
            wh_sweep_first_ready(sweep, &wafer->base_from_wafer, &table->config.tolerance, &here.t)) {
            wh_pose_t then;
            wh_sweep_pose_at(sweep, here.t, &then);
            here.distance = wh_grasp_distance(wafer, &then);
            keep_better(&best, &here);
        }
    }
    wh_horizon_keep(table, g, place, &horizon);
    return best;
}

/*@ requires wh_table_memory(table) && wh_is_gripper(table, g) && wh_is_wafer(table, w);
    requires \valid_read(base_from_gripper) &&
             \separated(base_from_gripper, table->storage.wafers + (0 .. table->storage.wafer_count - 1));
    assigns table->storage.wafers[w].base_from_wafer;
    ensures wh_other_poses{Pre, Post}(table, w);
    ensures wh_same_grips{Pre, Post}(table); */
static void carry_on(wh_grasp_t *table, size_t g, int32_t w, const wh_pose_t *base_from_gripper) {
    /*@ assert \forall integer i; wh_is_wafer(table, i) && i != w ==>
          \separated(&table->storage.wafers[i], &table->storage.wafers[w]); */
    /*@ assert \forall integer i; wh_is_gripper(table, i) ==>
          \separated(&table->storage.grippers[i], &table->storage.wafers[w]); */
    wh_grasp_carry(&table->storage.wafers[w], base_from_gripper,
                   &table->storage.grippers[g].gripper_from_wafer);
}

/* The wafer is taken at t and carried to the slice's end. */
/*@ requires wh_table_memory(table) && wh_list_ready(list, 1) && wh_list_apart(list, table);
    requires wh_is_gripper(table, g) && wh_is_wafer(table, w);
    requires wh_holder(table, w) == WH_NONE && wh_held(table, g) == WH_NONE;
    requires wh_sweep_memory(sweep) &&
             \separated(sweep->end, table->storage.wafers + (0 .. table->storage.wafer_count - 1));
    assigns table->counters, table->storage.wafers[w], table->storage.grippers[g].wafer,
            table->storage.grippers[g].gripper_from_wafer, list->count, list->events[0 .. wh_room(list) - 1];
    ensures wh_list_grown{Pre, Post}(list, 1);
    ensures wh_same_size{Pre, Post}(table);
    ensures wh_took{Pre, Post}(table, g, w);
    ensures wh_other_holders{Pre, Post}(table, w);
    ensures wh_other_held{Pre, Post}(table, g);
    ensures wh_other_poses{Pre, Post}(table, w);
    ensures wh_other_grips{Pre, Post}(table, g);
    ensures wh_same_releases{Pre, Post}(table);
    ensures wh_same_watched{Pre, Post}(table); */
static void take_at(wh_grasp_t *table, size_t g, int32_t w, const wh_sweep_t *sweep, wh_real_t t,
                    wh_event_list_t *list) {
    wh_pose_t then;
    wh_sweep_pose_at(sweep, t, &then);
    /*@ assert wh_same_poses{Pre, Here}(table); */
    /*@ assert wh_same_grips{Pre, Here}(table); */
    wh_grasp_take(table, g, w, &then, list);
    /*@ assert wh_other_poses{Pre, Here}(table, w); */
    /*@ assert wh_other_grips{Pre, Here}(table, g); */
    if (table->config.seat || t < 1) {
        carry_on(table, g, w, sweep->end);
    }
}

bool wh_grasp_pick_swept(wh_grasp_t *table, size_t g, const wh_gripper_input_t *input,
                         wh_event_list_t *list) {
    const wh_pose_t *begin = &table->storage.grippers[g].base_from_gripper;
    if (wh_horizon_covers(table, g, &begin->r) && wh_horizon_covers(table, g, &input->base_from_gripper.r)) {
        return false;
    }
    wh_sweep_t sweep;
    wh_sweep_between(begin, &input->base_from_gripper, &sweep);
    /*@ assert wh_same_poses{Pre, Here}(table); */
    /*@ assert wh_same_grips{Pre, Here}(table); */
    const candidate_t best = find_ready(table, g, &sweep);
    if (best.wafer == WH_NONE) {
        return false;
    }
    take_at(table, g, best.wafer, &sweep, best.t, list);
    /*@ assert wh_other_poses{Pre, Here}(table, best.wafer); */
    /*@ assert wh_other_grips{Pre, Here}(table, g); */
    return true;
}
