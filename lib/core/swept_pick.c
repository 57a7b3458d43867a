#include "core/grasp_internal.h"
#include "core/sweep_internal.h"

/* The best wafer so far. */
typedef struct {
    int32_t wafer; /* WH_NONE: none */
    wh_real_t t;   /* the instant within the slice, 1 being its end */
    wh_real_t distance;
} candidate_t;

/* Earliest instant, then smallest |dr_proj_z|; of equal ones the first, which has the lowest index. */
/*@ requires \valid(best) && \valid_read(other); assigns *best; ensures best->wafer == \old(best->wafer) || best->wafer == \old(other->wafer);
    ensures \old(best->wafer) == WH_NONE ==> best->wafer == \old(other->wafer); */
static void keep_better(candidate_t *best, const candidate_t *other) {
    if (best->wafer == WH_NONE || other->t < best->t ||
        (other->t == best->t && other->distance < best->distance)) {
        *best = *other;
    }
}

/*@ requires wh_table_memory(table) && wh_sweep_memory(sweep);
    assigns \nothing;
    ensures \result.wafer == WH_NONE ||
            wh_is_wafer(table, \result.wafer) && wh_holder(table, \result.wafer) == WH_NONE; */
static candidate_t find_ready(const wh_grasp_t *table, const wh_sweep_t *sweep) {
    candidate_t best = {.wafer = WH_NONE};
    /*@ loop invariant 0 <= w <= table->storage.wafer_count;
        loop invariant best.wafer == WH_NONE || 0 <= best.wafer < w && wh_holder(table, best.wafer) == WH_NONE;
        loop assigns w, best;
        loop variant table->storage.wafer_count - w; */
    for (size_t w = 0; w < table->storage.wafer_count; ++w) {
        const wh_wafer_t *wafer = &table->storage.wafers[w];
        candidate_t here = {.wafer = (int32_t)w};
        if (wafer->holder == WH_NONE && wafer->released_by == WH_NONE &&
            wh_sweep_first_ready(sweep, &wafer->base_from_wafer, &table->config.tolerance, &here.t)) {
            wh_pose_t then;
            wh_sweep_pose_at(sweep, here.t, &then);
            here.distance = wh_grasp_distance(wafer, &then);
            keep_better(&best, &here);
        }
    }
    return best;
}

bool wh_grasp_pick_swept(wh_grasp_t *table, size_t g, const wh_gripper_input_t *input,
                         wh_event_list_t *list) {
    wh_sweep_t sweep;
    wh_sweep_between(&table->storage.grippers[g].base_from_gripper, &input->base_from_gripper, &sweep);
    /*@ assert wh_other_poses{Pre, Here}(table, WH_NONE); */
    /*@ assert wh_other_grips{Pre, Here}(table, WH_NONE); */
    const candidate_t best = find_ready(table, &sweep);
    if (best.wafer == WH_NONE) {
        return false;
    }
    wh_pose_t then;
    wh_sweep_pose_at(&sweep, best.t, &then);
    wh_grasp_take(table, g, best.wafer, &then, list);
    /*@ assert wh_other_poses{Pre, Here}(table, best.wafer); */
    /*@ assert wh_other_grips{Pre, Here}(table, g); */
    if (table->config.seat || best.t < 1) {
        wh_grasp_carry(&table->storage.wafers[best.wafer], &input->base_from_gripper,
                       &table->storage.grippers[g].gripper_from_wafer);
        /*@ assert wh_other_poses{Pre, Here}(table, best.wafer); */
        /*@ assert wh_other_grips{Pre, Here}(table, g); */
    }
    return true;
}
