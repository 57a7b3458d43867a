#include "grasp_internal.h"
#include "horizon_internal.h"
#include "proximity_internal.h"

wh_real_t wh_grasp_distance(const wh_wafer_t *wafer, const wh_pose_t *base_from_gripper) {
    const wh_vec3_t dr = wh_vec3_subtract(&wafer->base_from_wafer.r, &base_from_gripper->r);
    const wh_vec3_t n1 = wh_mat3_column(&wafer->base_from_wafer.R, 2);
    return wh_real_abs(wh_vec3_dot(&dr, &n1));
}

/* The best wafer so far. */
typedef struct {
    int32_t wafer; /* WH_NONE: none */
    wh_real_t distance;
} nearest_t;

/*@ requires \valid(best) && \valid_read(wafer) && \valid_read(base_from_gripper) && w <= INT32_MAX;
    requires \separated(best, wafer) && \separated(best, base_from_gripper);
    assigns *best;
    ensures best->wafer == \old(best->wafer) || best->wafer == w;
    ensures \old(best->wafer) == WH_NONE ==> best->wafer == w; */
static void keep_better(nearest_t *best, size_t w, const wh_wafer_t *wafer,
                        const wh_pose_t *base_from_gripper) {
    const nearest_t here = {(int32_t)w, wh_grasp_distance(wafer, base_from_gripper)};
    if (best->wafer == WH_NONE || here.distance < best->distance ||
        (here.distance == best->distance && here.wafer < best->wafer)) {
        *best = here;
    }
}

int32_t wh_grasp_find_ready(wh_grasp_t *table, size_t g, const wh_pose_t *base_from_gripper) {
    const wh_real_t margin = wh_horizon_margin(table, g, &base_from_gripper->r);
    const wh_vec3_t *place = &base_from_gripper->r;
    const wh_found_t near = wh_grasp_is_swept(table, g) ? wh_index_again(table, g, place, place)
                                                        : wh_index_near(table, g, place, place, margin);
    wh_horizon_t horizon = wh_horizon_begin(table, g, &near, margin);
    nearest_t best = {.wafer = WH_NONE};
    /*@ loop invariant 0 <= i <= near.count;
        loop invariant best.wafer == WH_NONE ||
                       wh_is_wafer(table, best.wafer) && wh_holder(table, best.wafer) == WH_NONE;
        loop assigns i, best, horizon.gap;
        loop variant near.count - i; */
    for (size_t i = 0; i < near.count; ++i) {
        const size_t w = wh_index_wafer(table, &near, i);
        const wh_wafer_t *wafer = &table->storage.wafers[w];
        if (wafer->holder == WH_NONE &&
            !wh_horizon_passes(&horizon, &wafer->base_from_wafer, &base_from_gripper->r) &&
            wh_proximity_ready(&wafer->base_from_wafer, base_from_gripper, &table->config.tolerance)) {
            keep_better(&best, w, wafer, base_from_gripper);
        }
    }
    wh_horizon_keep(table, g, &base_from_gripper->r, &horizon);
    return best.wafer;
}

/* The smallest turn of the wafer, in the gripper's frame, that takes n1 to n2 = e3. c > 0 at every pick. */
/*@ requires \valid(R); assigns *R; */
static void turn_onto_pads(wh_mat3_t *R) {
    const wh_vec3_t n1 = wh_mat3_column(R, 2);
    const wh_real_t a = n1.x;
    const wh_real_t b = n1.y;
    const wh_real_t c = n1.z;
    const wh_real_t f = 1 / (1 + c);
    const wh_mat3_t turn = {{{1 - f * a * a, -f * a * b, -a}, {-f * a * b, 1 - f * b * b, -b}, {a, b, c}}};
    /*@ loop assigns column, *R; loop variant 3 - column; */
    for (size_t column = 0; column < 3; ++column) {
        const wh_vec3_t axis = wh_mat3_column(R, column);
        const wh_vec3_t turned = wh_mat3_transform(&turn, &axis);
        R->m[0][column] = turned.x;
        R->m[1][column] = turned.y;
        R->m[2][column] = turned.z;
    }
}

/*@ requires wh_table_memory(table) && list != \null && wh_list_ready(list, 1) && wh_list_apart(list, table);
    requires wh_is_gripper(table, g) && wh_is_wafer(table, w) && \valid_read(then);
    assigns list->count, list->events[0 .. list->capacity - 1];
    ensures wh_list_grown{Pre, Post}(list, 1); */
static void append(const wh_grasp_t *table, wh_event_list_t *list, size_t g, int32_t w,
                   const wh_pose_t *then) {
    const wh_wafer_t *wafer = &table->storage.wafers[w];
    const bool handed_over = wafer->released_by != WH_NONE;
    wh_event_t *event = wh_event_append(table, list, handed_over ? WH_EVENT_HANDED_OVER : WH_EVENT_PICKED);
    event->wafer = w;
    event->gripper = (int32_t)g;
    event->other = wafer->released_by;
    wh_proximity_values(&wafer->base_from_wafer, then, &table->config.tolerance, &event->measured);
}

/* Before the wafer is taken: a seated wafer would no longer show what made it ready. */
/*@ requires wh_table_memory(table) && wh_list_ready(list, 1) && wh_list_apart(list, table);
    requires wh_is_gripper(table, g) && wh_is_wafer(table, w) && \valid_read(then);
    assigns table->counters, list[0 .. wh_given(list) - 1].count, list->events[0 .. wh_room(list) - 1];
    ensures wh_list_grown{Pre, Post}(list, 1);
    ensures wh_same_size{Pre, Post}(table);
    ensures wh_same_holders{Pre, Post}(table);
    ensures wh_same_releases{Pre, Post}(table);
    ensures wh_same_held{Pre, Post}(table);
    ensures wh_same_watched{Pre, Post}(table);
    ensures wh_same_poses{Pre, Post}(table);
    ensures wh_same_grips{Pre, Post}(table); */
static void report(wh_grasp_t *table, wh_event_list_t *list, size_t g, int32_t w, const wh_pose_t *then) {
    const bool handed_over = table->storage.wafers[w].released_by != WH_NONE;
    *(handed_over ? &table->counters.handed_over : &table->counters.picked) += 1;
    if (list) {
        /*@ assert \forall integer i; wh_is_gripper(table, i) ==>
              \separated(&table->storage.grippers[i], list->events + (0 .. list->capacity - 1)); */
        /*@ assert \forall integer i; wh_is_wafer(table, i) ==>
              \separated(&table->storage.wafers[i], list->events + (0 .. list->capacity - 1)); */
        append(table, list, g, w, then);
    }
}

/*@ requires wh_table_memory(table) && wh_is_gripper(table, g) && wh_is_wafer(table, w);
    requires wh_holder(table, w) == WH_NONE && wh_held(table, g) == WH_NONE;
    assigns table->storage.wafers[w].holder, table->storage.grippers[g].wafer;
    ensures wh_took{Pre, Post}(table, g, w);
    ensures wh_other_holders{Pre, Post}(table, w);
    ensures wh_other_held{Pre, Post}(table, g);
    ensures wh_same_releases{Pre, Post}(table);
    ensures wh_same_watched{Pre, Post}(table); */
static void pair(wh_grasp_t *table, size_t g, int32_t w) {
    table->storage.wafers[w].holder = (int32_t)g;
    table->storage.grippers[g].wafer = w;
}

/* The rotation is brought back to orthonormal, so that poses which are so only to WH_ROTATION_TOLERANCE do not add up over
 * many picks. */
/*@ requires \valid(gripper_from_wafer) && \valid_read(then) && \valid_read(base_from_wafer);
    requires \separated(gripper_from_wafer, then) && \separated(gripper_from_wafer, base_from_wafer);
    assigns *gripper_from_wafer; */
static void measure_grip(wh_pose_t *gripper_from_wafer, const wh_pose_t *then,
                         const wh_pose_t *base_from_wafer, bool seat) {
    wh_pose_relative_to(then, base_from_wafer, gripper_from_wafer);
    wh_mat3_orthonormalise(&gripper_from_wafer->R);
    if (seat) {
        turn_onto_pads(&gripper_from_wafer->R);
        wh_mat3_orthonormalise(&gripper_from_wafer->R);
        gripper_from_wafer->r.z = 0;
    }
}

/*@ requires wh_table_memory(table) && wh_is_gripper(table, g) && wh_is_wafer(table, w);
    requires \valid_read(then) && \separated(then, table->storage.grippers + (0 .. table->storage.gripper_count - 1));
    assigns table->storage.grippers[g].gripper_from_wafer;
    ensures wh_same_poses{Pre, Post}(table);
    ensures wh_other_grips{Pre, Post}(table, g); */
static void grip(wh_grasp_t *table, size_t g, int32_t w, const wh_pose_t *then) {
    /*@ assert \forall integer i; wh_is_wafer(table, i) ==>
          \separated(&table->storage.wafers[i], &table->storage.grippers[g]); */
    /*@ assert \forall integer i; wh_is_gripper(table, i) && i != g ==>
          \separated(&table->storage.grippers[i], &table->storage.grippers[g]); */
    measure_grip(&table->storage.grippers[g].gripper_from_wafer, then,
                 &table->storage.wafers[w].base_from_wafer, table->config.seat);
}

void wh_grasp_take(wh_grasp_t *table, size_t g, int32_t w, const wh_pose_t *then, wh_event_list_t *list) {
    report(table, list, g, w, then);
    /*@ assert wh_same_size{Pre, Here}(table); */
    pair(table, g, w);
    /*@ assert wh_other_holders{Pre, Here}(table, w); */
    /*@ assert wh_other_held{Pre, Here}(table, g); */
    /*@ assert wh_same_releases{Pre, Here}(table); */
    /*@ assert wh_same_watched{Pre, Here}(table); */
    /*@ assert wh_same_poses{Pre, Here}(table); */
    /*@ assert wh_same_grips{Pre, Here}(table); */
    grip(table, g, w, then);
}
