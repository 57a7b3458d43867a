#include "restore.h"

#include "index_internal.h"

/*@
  predicate good_encounter{L}(wh_encounter_t *e, integer wafer_count) = WH_NONE <= e->wafer < wafer_count;

  predicate good_gripper{L}(wh_wafer_t *ws, integer wafer_count, wh_gripper_t *gs, integer g) =
    (gs[g].wafer != WH_NONE ==> 0 <= gs[g].wafer < wafer_count && ws[gs[g].wafer].holder == g) &&
    good_encounter(&gs[g].approach, wafer_count) && good_encounter(&gs[g].contest, wafer_count);

  predicate good_wafer{L}(wh_wafer_t *ws, wh_gripper_t *gs, integer gripper_count, integer w) =
    ws[w].holder != WH_NONE ==> 0 <= ws[w].holder < gripper_count && gs[ws[w].holder].wafer == w;

  predicate good_grippers{L}(wh_wafer_t *ws, integer wafer_count, wh_gripper_t *gs, integer gripper_count) =
    \forall integer g; 0 <= g < gripper_count ==> good_gripper(ws, wafer_count, gs, g);

  predicate good_wafers{L}(wh_wafer_t *ws, integer wafer_count, wh_gripper_t *gs, integer gripper_count) =
    \forall integer w; 0 <= w < wafer_count ==> good_wafer(ws, gs, gripper_count, w);
*/

/*@ assigns \nothing; ensures \result <==> index == WH_NONE || 0 <= index < count; */
static bool is_index_or_none(int32_t index, size_t count) {
    return index == WH_NONE || wh_is_index(index, count);
}

/* Every number finite: a sum of differences that are each zero, or NaN. */
/*@ requires \valid_read(p); assigns \nothing; */
static bool measured_is_finite(const wh_proximity_t *p) {
    const wh_real_t values[] = {p->dr.x,         p->dr.y,         p->dr.z,
                                p->n1_proj_n2,   p->dr_proj_z,    p->dr_proj_xy.x,
                                p->dr_proj_xy.y, p->dr_proj_xy.z, p->dr_proj_xy_norm};
    bool finite = true;
    /*@ loop assigns i, finite; */
    for (size_t i = 0; i < sizeof values / sizeof values[0]; ++i) {
        finite = finite && wh_real_is_finite(values[i]);
    }
    return finite;
}

/* A wafer that is contested has a holder, one that is approached has none. */
/*@ requires wh_table_memory(table) && \valid_read(encounter);
    assigns \nothing;
    ensures \result == WH_OK ==> good_encounter(encounter, table->storage.wafer_count); */
static wh_status_t check_encounter(const wh_grasp_t *table, const wh_encounter_t *encounter, bool contested,
                                   uint64_t slice) {
    if (encounter->wafer == WH_NONE) {
        return WH_OK;
    }
    const bool holder_fits = contested ? wh_is_index(encounter->holder, table->storage.gripper_count)
                                       : encounter->holder == WH_NONE;
    if (!wh_is_index(encounter->wafer, table->storage.wafer_count) || !holder_fits ||
        encounter->slice > slice) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    return measured_is_finite(&encounter->measured) ? WH_OK : WH_STATUS_NOT_FINITE;
}

/*@ requires wh_table_memory(table) && \valid_read(wafers + (0 .. table->storage.wafer_count - 1)) &&
             \valid_read(grippers + (0 .. table->storage.gripper_count - 1));
    requires w < table->storage.wafer_count;
    assigns \nothing;
    ensures \result == WH_OK ==> good_wafer(wafers, grippers, table->storage.gripper_count, w); */
static wh_status_t check_wafer(const wh_grasp_t *table, size_t w, const wh_wafer_t wafers[],
                               const wh_gripper_t grippers[]) {
    const int32_t holder = wafers[w].holder;
    if (!is_index_or_none(holder, table->storage.gripper_count) ||
        (holder != WH_NONE && grippers[holder].wafer != (int32_t)w)) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    return wh_pose_validate(&wafers[w].base_from_wafer);
}

/* A wafer is taken within the tolerances. From much farther off it could be carried to where no number is. */
/*@ requires \valid_read(tolerance) && \valid_read(r); assigns \nothing; */
static bool is_within_reach(const wh_tolerance_t *tolerance, const wh_vec3_t *r) {
    const wh_real_t reach = 2 * (tolerance->projz + tolerance->projxy);
    return wh_real_abs(r->x) <= reach && wh_real_abs(r->y) <= reach && wh_real_abs(r->z) <= reach;
}

/*@ requires wh_table_memory(table) && \valid_read(wafers + (0 .. table->storage.wafer_count - 1)) && \valid_read(gripper);
    requires g < table->storage.gripper_count;
    assigns \nothing;
    ensures \result == WH_OK && gripper->wafer != WH_NONE ==>
              0 <= gripper->wafer < table->storage.wafer_count && wafers[gripper->wafer].holder == g; */
static wh_status_t check_held(const wh_grasp_t *table, size_t g, const wh_wafer_t wafers[],
                              const wh_gripper_t *gripper) {
    if (gripper->wafer == WH_NONE) {
        return WH_OK;
    }
    if (!wh_is_index(gripper->wafer, table->storage.wafer_count) || gripper->valve != WH_VALVE_OPEN ||
        wafers[gripper->wafer].holder != (int32_t)g) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    const wh_status_t status = wh_pose_validate(&gripper->gripper_from_wafer);
    const bool reached =
        status != WH_OK || is_within_reach(&table->config.tolerance, &gripper->gripper_from_wafer.r);
    return reached ? status : WH_STATUS_OUT_OF_RANGE;
}

/*@ requires wh_table_memory(table) && \valid_read(wafers + (0 .. table->storage.wafer_count - 1)) && \valid_read(gripper);
    requires g < table->storage.gripper_count;
    assigns \nothing;
    ensures \result == WH_OK ==> good_gripper(wafers, table->storage.wafer_count, gripper - g, g); */
static wh_status_t check_gripper(const wh_grasp_t *table, size_t g, const wh_wafer_t wafers[],
                                 const wh_gripper_t *gripper, uint64_t slice) {
    if (gripper->valve != WH_VALVE_OPEN && gripper->valve != WH_VALVE_CLOSED) {
        return WH_STATUS_BAD_VALVE;
    }
    wh_status_t status = wh_pose_validate(&gripper->base_from_gripper);
    if (status == WH_OK) {
        status = check_held(table, g, wafers, gripper);
    }
    if (status == WH_OK) {
        status = check_encounter(table, &gripper->approach, false, slice);
    }
    if (status == WH_OK) {
        status = check_encounter(table, &gripper->contest, true, slice);
    }
    return status;
}

/*@ requires wh_table_memory(table) && \valid_read(wafers + (0 .. table->storage.wafer_count - 1)) &&
             \valid_read(grippers + (0 .. table->storage.gripper_count - 1));
    assigns \nothing;
    ensures \result == WH_OK ==> good_grippers(wafers, table->storage.wafer_count, grippers, table->storage.gripper_count); */
static wh_status_t check_grippers(const wh_grasp_t *table, uint64_t slice, const wh_wafer_t wafers[],
                                  const wh_gripper_t grippers[]) {
    /*@ loop invariant good_grippers(wafers, table->storage.wafer_count, grippers, g);
        loop assigns g;
        loop variant table->storage.gripper_count - g; */
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        const wh_status_t status = check_gripper(table, g, wafers, &grippers[g], slice);
        if (status != WH_OK) {
            return status;
        }
    }
    return WH_OK;
}

/*@ requires wh_table_memory(table) && \valid_read(wafers + (0 .. table->storage.wafer_count - 1)) &&
             \valid_read(grippers + (0 .. table->storage.gripper_count - 1));
    assigns \nothing;
    ensures \result == WH_OK ==> good_wafers(wafers, table->storage.wafer_count, grippers, table->storage.gripper_count); */
static wh_status_t check_wafers(const wh_grasp_t *table, const wh_wafer_t wafers[],
                                const wh_gripper_t grippers[]) {
    /*@ loop invariant good_wafers(wafers, w, grippers, table->storage.gripper_count);
        loop assigns w;
        loop variant table->storage.wafer_count - w; */
    for (size_t w = 0; w < table->storage.wafer_count; ++w) {
        const wh_status_t status = check_wafer(table, w, wafers, grippers);
        if (status != WH_OK) {
            return status;
        }
    }
    return WH_OK;
}

/*@ requires wh_table_memory(table);
    requires wh_state_memory(wafers, table->storage.wafer_count, grippers, table->storage.gripper_count);
    assigns \nothing;
    ensures \result == WH_OK ==> wafers != \null || table->storage.wafer_count == 0;
    ensures \result == WH_OK ==> grippers != \null || table->storage.gripper_count == 0;
    ensures \result == WH_OK ==>
              good_grippers(wafers, table->storage.wafer_count, grippers, table->storage.gripper_count) &&
              good_wafers(wafers, table->storage.wafer_count, grippers, table->storage.gripper_count); */
static wh_status_t check_all(const wh_grasp_t *table, uint64_t slice, const wh_wafer_t wafers[],
                             const wh_gripper_t grippers[]) {
    if ((!wafers && table->storage.wafer_count > 0) || (!grippers && table->storage.gripper_count > 0)) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    const wh_status_t status = check_grippers(table, slice, wafers, grippers);
    return status == WH_OK ? check_wafers(table, wafers, grippers) : status;
}

/*@ requires \valid(to + (0 .. count - 1)) && \valid_read(from + (0 .. count - 1));
    requires \separated(to + (0 .. count - 1), from + (0 .. count - 1));
    assigns to[0 .. count - 1];
    ensures \forall integer w; 0 <= w < count ==>
              to[w].holder == from[w].holder && to[w].released_by == WH_NONE; */
static void copy_wafers(wh_wafer_t to[], const wh_wafer_t from[], size_t count) {
    /*@ loop invariant 0 <= w <= count;
        loop invariant \forall integer i; 0 <= i < w ==>
                         to[i].holder == from[i].holder && to[i].released_by == WH_NONE;
        loop assigns w, to[0 .. count - 1];
        loop variant count - w; */
    for (size_t w = 0; w < count; ++w) {
        to[w].base_from_wafer = from[w].base_from_wafer;
        to[w].holder = from[w].holder;
        to[w].released_by = WH_NONE;
    }
}

/*@ requires \valid(to) && \valid_read(from) && \separated(to, from);
    assigns *to;
    ensures to->wafer == from->wafer; */
static void copy_encounter(wh_encounter_t *to, const wh_encounter_t *from) {
    to->measured = from->measured;
    to->slice = from->slice;
    to->holder = from->holder;
    to->wafer = from->wafer;
}

/*@ requires \valid(to) && \valid_read(from) && \separated(to, from);
    assigns *to;
    ensures to->wafer == from->wafer && to->approach.wafer == from->approach.wafer &&
            to->contest.wafer == from->contest.wafer; */
static void copy_gripper(wh_gripper_t *to, const wh_gripper_t *from) {
    to->base_from_gripper = from->base_from_gripper;
    to->gripper_from_wafer = from->gripper_from_wafer;
    copy_encounter(&to->approach, &from->approach);
    copy_encounter(&to->contest, &from->contest);
    to->valve = from->valve;
    to->wafer = from->wafer;
}

/*@ requires \valid(to + (0 .. count - 1)) && \valid_read(from + (0 .. count - 1));
    requires \separated(to + (0 .. count - 1), from + (0 .. count - 1));
    assigns to[0 .. count - 1];
    ensures \forall integer g; 0 <= g < count ==>
              to[g].wafer == from[g].wafer && to[g].approach.wafer == from[g].approach.wafer &&
              to[g].contest.wafer == from[g].contest.wafer; */
static void copy_grippers(wh_gripper_t to[], const wh_gripper_t from[], size_t count) {
    /*@ loop invariant 0 <= g <= count;
        loop invariant \forall integer i; 0 <= i < g ==>
                         to[i].wafer == from[i].wafer && to[i].approach.wafer == from[i].approach.wafer &&
                         to[i].contest.wafer == from[i].contest.wafer;
        loop assigns g, to[0 .. count - 1];
        loop variant count - g; */
    for (size_t g = 0; g < count; ++g) {
        copy_gripper(&to[g], &from[g]);
    }
}

/*@ requires \valid(table);
    assigns table->counters.refused; */
static void count_refusal(wh_grasp_t *table) {
    ++table->counters.refused;
}

/*@ requires wh_table_memory(table);
    requires \valid_read(wafers + (0 .. table->storage.wafer_count - 1)) &&
             \valid_read(grippers + (0 .. table->storage.gripper_count - 1));
    requires wh_checkpoint_apart(wafers, grippers, table);
    requires good_grippers(wafers, table->storage.wafer_count, grippers, table->storage.gripper_count);
    requires good_wafers(wafers, table->storage.wafer_count, grippers, table->storage.gripper_count);
    assigns table->storage.wafers[0 .. table->storage.wafer_count - 1],
            table->storage.grippers[0 .. table->storage.gripper_count - 1];
    ensures wh_consistent(table); */
static void take_over(wh_grasp_t *table, const wh_wafer_t wafers[], const wh_gripper_t grippers[]) {
    /*@ assert \forall integer w; wh_is_wafer(table, w) && wafers[w].holder != WH_NONE ==>
                 good_wafer(wafers, grippers, table->storage.gripper_count, w) &&
                 wh_is_gripper(table, wafers[w].holder) && grippers[wafers[w].holder].wafer == w; */
    /*@ assert \forall integer g; wh_is_gripper(table, g) && grippers[g].wafer != WH_NONE ==>
                 good_gripper(wafers, table->storage.wafer_count, grippers, g) &&
                 wh_is_wafer(table, grippers[g].wafer) && wafers[grippers[g].wafer].holder == g; */
    /*@ assert \forall integer g; wh_is_gripper(table, g) ==>
                 good_gripper(wafers, table->storage.wafer_count, grippers, g) &&
                 WH_NONE <= grippers[g].approach.wafer < table->storage.wafer_count &&
                 WH_NONE <= grippers[g].contest.wafer < table->storage.wafer_count; */
    copy_wafers(table->storage.wafers, wafers, table->storage.wafer_count);
    /*@ assert \forall integer w; wh_is_wafer(table, w) ==> wh_holder(table, w) == \at(wafers[w].holder, Pre); */
    /*@ assert wh_none_released(table); */
    /*@ assert \forall integer g; wh_is_gripper(table, g) ==> grippers[g].wafer == \at(grippers[g].wafer, Pre) &&
                 grippers[g].approach.wafer == \at(grippers[g].approach.wafer, Pre) &&
                 grippers[g].contest.wafer == \at(grippers[g].contest.wafer, Pre); */
    copy_grippers(table->storage.grippers, grippers, table->storage.gripper_count);
    /*@ assert table->storage.wafer_count == \at(table->storage.wafer_count, Pre) &&
               table->storage.gripper_count == \at(table->storage.gripper_count, Pre); */
    /*@ assert \forall integer w; wh_is_wafer(table, w) ==> wh_holder(table, w) == \at(wafers[w].holder, Pre); */
    /*@ assert \forall integer w; wh_is_wafer(table, w) ==> wh_released_by(table, w) == WH_NONE; */
    /*@ assert \forall integer g; wh_is_gripper(table, g) ==> wh_held(table, g) == \at(grippers[g].wafer, Pre); */
    /*@ assert \forall integer g; wh_is_gripper(table, g) ==>
                 table->storage.grippers[g].approach.wafer == \at(grippers[g].approach.wafer, Pre); */
    /*@ assert \forall integer g; wh_is_gripper(table, g) ==>
                 table->storage.grippers[g].contest.wafer == \at(grippers[g].contest.wafer, Pre); */
    /*@ assert wh_encounters(table); */
    /*@ assert wh_paired(table); */
}

wh_status_t wh_grasp_restore(wh_grasp_t *table, uint64_t slice, const wh_wafer_t wafers[],
                             const wh_gripper_t grippers[]) {
    if (!table) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    const wh_status_t status = check_all(table, slice, wafers, grippers);
    if (status != WH_OK) {
        count_refusal(table);
        return status;
    }
    table->slice = slice;
    take_over(table, wafers, grippers);
    wh_index_build(table);
    return WH_OK;
}
