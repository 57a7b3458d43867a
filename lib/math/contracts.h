/* What the contracts of the grasp table speak of, in ACSL (read by Frama-C; a compiler sees a comment).
 *
 * Memory is the caller's promise: arrays are as long as their counts say and do not overlap. Consistency is the
 * library's: who holds a wafer is told twice, by the wafer and by the gripper, and both always agree.
 */
#ifndef WH_MATH_CONTRACTS_H
#define WH_MATH_CONTRACTS_H

/*@
  predicate wh_storage_memory{L}(wh_grasp_storage_t *s) =
    \valid_read(s) &&
    (s->wafers == \null || \valid(s->wafers + (0 .. s->wafer_count - 1))) &&
    (s->grippers == \null || \valid(s->grippers + (0 .. s->gripper_count - 1))) &&
    (s->buckets == \null || \valid(s->buckets + (0 .. s->bucket_count - 1)));

  predicate wh_storage_apart{L}(wh_grasp_storage_t *s, wh_grasp_t *t) =
    \separated(s, t, s->wafers + (0 .. s->wafer_count - 1), s->grippers + (0 .. s->gripper_count - 1));

  // None, or what wh_grasp_buckets says.
  predicate wh_enough_buckets{L}(wh_grasp_storage_t *s) =
    s->bucket_count == 0 ||
    8 + 4 * s->gripper_count + 5 * s->wafer_count <= s->bucket_count <= INT32_MAX;

  // What wh_grasp_init has looked at.
  predicate wh_storage_good{L}(wh_grasp_storage_t *s) =
    s->wafer_count <= INT32_MAX && s->gripper_count <= INT32_MAX &&
    (s->wafers != \null || s->wafer_count == 0) && (s->grippers != \null || s->gripper_count == 0) &&
    (s->buckets != \null || s->bucket_count == 0) && wh_enough_buckets(s);

  predicate wh_table_memory{L}(wh_grasp_t *t) =
    \valid(t) && t->storage.wafer_count <= INT32_MAX && t->storage.gripper_count <= INT32_MAX &&
    \valid(t->storage.wafers + (0 .. t->storage.wafer_count - 1)) &&
    \valid(t->storage.grippers + (0 .. t->storage.gripper_count - 1)) &&
    wh_enough_buckets(&t->storage) && \valid(t->storage.buckets + (0 .. t->storage.bucket_count - 1)) &&
    \separated(t, t->storage.wafers + (0 .. t->storage.wafer_count - 1),
               t->storage.grippers + (0 .. t->storage.gripper_count - 1));

  // A state to be restored.
  predicate wh_state_memory{L}(wh_wafer_t *ws, integer wafer_count, wh_gripper_t *gs, integer gripper_count) =
    (ws == \null || \valid_read(ws + (0 .. wafer_count - 1))) &&
    (gs == \null || \valid_read(gs + (0 .. gripper_count - 1)));

  predicate wh_checkpoint_apart{L}(wh_wafer_t *ws, wh_gripper_t *gs, wh_grasp_t *t) =
    \separated(ws + (0 .. t->storage.wafer_count - 1), t,
               t->storage.wafers + (0 .. t->storage.wafer_count - 1),
               t->storage.grippers + (0 .. t->storage.gripper_count - 1)) &&
    \separated(gs + (0 .. t->storage.gripper_count - 1), t,
               t->storage.wafers + (0 .. t->storage.wafer_count - 1),
               t->storage.grippers + (0 .. t->storage.gripper_count - 1));

  // A list may be null; then it has no elements and no count.
  logic integer wh_given(wh_event_list_t *l) = l == \null ? 0 : 1;
  logic integer wh_room{L}(wh_event_list_t *l) = l == \null ? 0 : l->capacity;

  predicate wh_list_memory{L}(wh_event_list_t *l) =
    l != \null ==> \valid(l) && \separated(l, l->events + (0 .. l->capacity - 1)) &&
                   (l->events == \null || \valid(l->events + (0 .. l->capacity - 1)));

  predicate wh_list_apart{L}(wh_event_list_t *l, wh_grasp_t *t) =
    \separated(l, t, t->storage.wafers + (0 .. t->storage.wafer_count - 1),
               t->storage.grippers + (0 .. t->storage.gripper_count - 1)) &&
    (l != \null ==> \separated(l->events + (0 .. l->capacity - 1), t,
                               t->storage.wafers + (0 .. t->storage.wafer_count - 1),
                               t->storage.grippers + (0 .. t->storage.gripper_count - 1)));

  // Room for n more events.
  predicate wh_list_ready{L}(wh_event_list_t *l, integer n) =
    l != \null ==> \valid(l) && \valid(l->events + (0 .. l->capacity - 1)) &&
                   \separated(l, l->events + (0 .. l->capacity - 1)) && l->count + n <= l->capacity;

  predicate wh_list_grown{K, L}(wh_event_list_t *l, integer n) =
    l != \null ==> \at(l->count, L) <= \at(l->count, K) + n && \at(l->capacity, K) == \at(l->capacity, L) &&
                   \at(l->events, K) == \at(l->events, L);

  predicate wh_apart_from_arrays{L}(wh_gripper_input_t *in, wh_grasp_t *t) =
    \separated(in, t->storage.wafers + (0 .. t->storage.wafer_count - 1),
               t->storage.grippers + (0 .. t->storage.gripper_count - 1));

  predicate wh_inputs_apart{L}(wh_gripper_input_t *in, wh_grasp_t *t) =
    \separated(in + (0 .. t->storage.gripper_count - 1), t,
               t->storage.wafers + (0 .. t->storage.wafer_count - 1),
               t->storage.grippers + (0 .. t->storage.gripper_count - 1));

  predicate wh_inputs_apart_list{L}(wh_gripper_input_t *in, wh_grasp_t *t, wh_event_list_t *l) =
    \separated(in + (0 .. t->storage.gripper_count - 1), l) &&
    (l != \null ==> \separated(in + (0 .. t->storage.gripper_count - 1), l->events + (0 .. l->capacity - 1)));

  logic integer wh_holder{L}(wh_grasp_t *t, integer w) = t->storage.wafers[w].holder;
  logic integer wh_released_by{L}(wh_grasp_t *t, integer w) = t->storage.wafers[w].released_by;
  logic integer wh_held{L}(wh_grasp_t *t, integer g) = t->storage.grippers[g].wafer;

  predicate wh_is_wafer{L}(wh_grasp_t *t, integer w) = 0 <= w < t->storage.wafer_count;
  predicate wh_is_gripper{L}(wh_grasp_t *t, integer g) = 0 <= g < t->storage.gripper_count;

  // Wafers and grippers are paired: no wafer has two holders, no gripper two wafers.
  predicate wh_paired{L}(wh_grasp_t *t) =
    (\forall integer w; wh_is_wafer(t, w) && wh_holder(t, w) != WH_NONE ==>
       wh_is_gripper(t, wh_holder(t, w)) && wh_held(t, wh_holder(t, w)) == w) &&
    (\forall integer g; wh_is_gripper(t, g) && wh_held(t, g) != WH_NONE ==>
       wh_is_wafer(t, wh_held(t, g)) && wh_holder(t, wh_held(t, g)) == g);

  // Who holds what has not changed.
  predicate wh_same_holders{K, L}(wh_grasp_t *t) =
    \forall integer w; wh_is_wafer{K}(t, w) ==> wh_holder{K}(t, w) == wh_holder{L}(t, w);
  predicate wh_same_releases{K, L}(wh_grasp_t *t) =
    \forall integer w; wh_is_wafer{K}(t, w) ==> wh_released_by{K}(t, w) == wh_released_by{L}(t, w);
  predicate wh_same_held{K, L}(wh_grasp_t *t) =
    \forall integer g; wh_is_gripper{K}(t, g) ==> wh_held{K}(t, g) == wh_held{L}(t, g);

  predicate wh_encounters{L}(wh_grasp_t *t) =
    \forall integer g; wh_is_gripper(t, g) ==>
      WH_NONE <= t->storage.grippers[g].approach.wafer < t->storage.wafer_count &&
      WH_NONE <= t->storage.grippers[g].contest.wafer < t->storage.wafer_count;

  predicate wh_cleared{L}(wh_gripper_t *g) =
    g->wafer == WH_NONE && g->approach.wafer == WH_NONE && g->contest.wafer == WH_NONE;

  predicate wh_none_released{L}(wh_grasp_t *t) =
    \forall integer w; wh_is_wafer(t, w) ==> wh_released_by(t, w) == WH_NONE;

  // What holds between two calls, for every table that wh_grasp_init accepted.
  predicate wh_consistent{L}(wh_grasp_t *t) =
    wh_paired(t) && wh_encounters(t) && wh_none_released(t);

  // Within a step: gripper g's valve is closed in this slice and it has let go, but still names its wafer.
  predicate wh_lets_go{L}(wh_gripper_input_t *in, integer g, integer from, integer to) =
    from <= g < to && in[g].valve == WH_VALVE_CLOSED;

  predicate wh_same_inputs{K, L}(wh_gripper_input_t *in, integer count) =
    \forall integer g; 0 <= g < count ==> \at(in[g].valve, K) == \at(in[g].valve, L);

  predicate wh_valves_good{L}(wh_gripper_input_t *in, integer count) =
    \forall integer g; 0 <= g < count ==> in[g].valve == WH_VALVE_OPEN || in[g].valve == WH_VALVE_CLOSED;

  predicate wh_stepping_holders{L}(wh_grasp_t *t, wh_gripper_input_t *in, integer from, integer to) =
    \forall integer w; wh_is_wafer(t, w) && wh_holder(t, w) != WH_NONE ==>
      wh_is_gripper(t, wh_holder(t, w)) && wh_held(t, wh_holder(t, w)) == w &&
      !wh_lets_go(in, wh_holder(t, w), from, to);
  predicate wh_stepping_releases{L}(wh_grasp_t *t, wh_gripper_input_t *in, integer from, integer to) =
    \forall integer w; wh_is_wafer(t, w) && wh_released_by(t, w) != WH_NONE ==>
      wh_is_gripper(t, wh_released_by(t, w)) && wh_held(t, wh_released_by(t, w)) == w &&
      wh_lets_go(in, wh_released_by(t, w), from, to);
  predicate wh_stepping_held{L}(wh_grasp_t *t, wh_gripper_input_t *in, integer from, integer to) =
    \forall integer g; wh_is_gripper(t, g) && wh_held(t, g) != WH_NONE ==>
      wh_is_wafer(t, wh_held(t, g)) &&
      (wh_lets_go(in, g, from, to) ? wh_released_by(t, wh_held(t, g)) == g
                                   : wh_holder(t, wh_held(t, g)) == g);
  predicate wh_stepping{L}(wh_grasp_t *t, wh_gripper_input_t *in, integer from, integer to) =
    wh_stepping_holders(t, in, from, to) && wh_stepping_releases(t, in, from, to) &&
    wh_stepping_held(t, in, from, to);

  // Number by number: what a struct's equality means, in words that provers need not unfold.
  predicate wh_equal_vec3{K, L}(wh_vec3_t *p, wh_vec3_t *q) =
    \at(p->x, K) == \at(q->x, L) && \at(p->y, K) == \at(q->y, L) && \at(p->z, K) == \at(q->z, L);

  predicate wh_same_pose{K, L}(wh_grasp_t *t, integer w) =
    \at(t->storage.wafers[w].base_from_wafer, K) == \at(t->storage.wafers[w].base_from_wafer, L);

  predicate wh_same_grip{K, L}(wh_grasp_t *t, integer g) =
    \at(t->storage.grippers[g].gripper_from_wafer, K) == \at(t->storage.grippers[g].gripper_from_wafer, L);

  predicate wh_same_watched{K, L}(wh_grasp_t *t) =
    \forall integer g; wh_is_gripper{K}(t, g) ==>
      \at(t->storage.grippers[g].approach.wafer, K) == \at(t->storage.grippers[g].approach.wafer, L) &&
      \at(t->storage.grippers[g].contest.wafer, K) == \at(t->storage.grippers[g].contest.wafer, L);

  predicate wh_other_watched{K, L}(wh_grasp_t *t, integer g) =
    \forall integer i; wh_is_gripper{K}(t, i) && i != g ==>
      \at(t->storage.grippers[i].approach.wafer, K) == \at(t->storage.grippers[i].approach.wafer, L) &&
      \at(t->storage.grippers[i].contest.wafer, K) == \at(t->storage.grippers[i].contest.wafer, L);

  predicate wh_same_size{K, L}(wh_grasp_t *t) =
    \at(t->storage.wafer_count, K) == \at(t->storage.wafer_count, L) &&
    \at(t->storage.gripper_count, K) == \at(t->storage.gripper_count, L) &&
    \at(t->storage.wafers, K) == \at(t->storage.wafers, L) &&
    \at(t->storage.grippers, K) == \at(t->storage.grippers, L) &&
    \at(t->storage.bucket_count, K) == \at(t->storage.bucket_count, L) &&
    \at(t->storage.buckets, K) == \at(t->storage.buckets, L);

  // Gripper g, which was empty, took wafer w, which nobody held; the others are as they were.
  predicate wh_took{K, L}(wh_grasp_t *t, integer g, integer w) =
    wh_is_wafer{K}(t, w) && wh_holder{K}(t, w) == WH_NONE && wh_held{K}(t, g) == WH_NONE &&
    wh_holder{L}(t, w) == g && wh_held{L}(t, g) == w;

  // Nobody lets go.
  predicate wh_holders_kept{K, L}(wh_grasp_t *t) =
    \forall integer w; wh_is_wafer{K}(t, w) && wh_holder{K}(t, w) != WH_NONE ==> wh_holder{K}(t, w) == wh_holder{L}(t, w);

  predicate wh_other_holders{K, L}(wh_grasp_t *t, integer w) =
    \forall integer i; wh_is_wafer{K}(t, i) && i != w ==> wh_holder{K}(t, i) == wh_holder{L}(t, i);
  predicate wh_other_releases{K, L}(wh_grasp_t *t, integer w) =
    \forall integer i; wh_is_wafer{K}(t, i) && i != w ==> wh_released_by{K}(t, i) == wh_released_by{L}(t, i);
  predicate wh_other_held{K, L}(wh_grasp_t *t, integer g) =
    \forall integer i; wh_is_gripper{K}(t, i) && i != g ==> wh_held{K}(t, i) == wh_held{L}(t, i);
  predicate wh_other_poses{K, L}(wh_grasp_t *t, integer w) =
    \forall integer i; wh_is_wafer{K}(t, i) && i != w ==> wh_same_pose{K, L}(t, i);
  predicate wh_other_grips{K, L}(wh_grasp_t *t, integer g) =
    \forall integer i; wh_is_gripper{K}(t, i) && i != g ==> wh_same_grip{K, L}(t, i);

  // A wafer that nobody held, and that nobody took since, has not moved.
  predicate wh_free_at_rest{K, L}(wh_grasp_t *t) =
    \forall integer w; wh_is_wafer{K}(t, w) && wh_holder{K}(t, w) == WH_NONE &&
      wh_holder{L}(t, w) == WH_NONE ==> wh_same_pose{K, L}(t, w);

  // Nobody took one either.
  predicate wh_free_stay{K, L}(wh_grasp_t *t) =
    \forall integer w; wh_is_wafer{K}(t, w) && wh_holder{K}(t, w) == WH_NONE ==>
      wh_holder{L}(t, w) == WH_NONE && wh_same_pose{K, L}(t, w);

  // Nor has a held one.
  predicate wh_held_at_rest{K, L}(wh_grasp_t *t) =
    \forall integer w; wh_is_wafer{K}(t, w) && wh_holder{K}(t, w) != WH_NONE ==> wh_same_pose{K, L}(t, w);

  // Who held a wafer still holds it, in the same way.
  predicate wh_hold_kept{K, L}(wh_grasp_t *t) =
    \forall integer g; wh_is_gripper{K}(t, g) && wh_held{K}(t, g) != WH_NONE ==>
      wh_held{K}(t, g) == wh_held{L}(t, g) && wh_same_grip{K, L}(t, g);

  // How a gripper held its wafer has not changed.
  predicate wh_grips_kept{K, L}(wh_grasp_t *t) =
    \forall integer g; wh_is_gripper{K}(t, g) && wh_held{K}(t, g) != WH_NONE ==> wh_same_grip{K, L}(t, g);

  predicate wh_same_values{K, L}(wh_proximity_t *p) =
    wh_equal_vec3{K, L}(\at(&p->dr, K), \at(&p->dr, L)) && wh_equal_vec3{K, L}(\at(&p->dr_proj_xy, K), \at(&p->dr_proj_xy, L)) &&
    \at(p->n1_proj_n2, K) == \at(p->n1_proj_n2, L) && \at(p->dr_proj_z, K) == \at(p->dr_proj_z, L) &&
    \at(p->dr_proj_xy_norm, K) == \at(p->dr_proj_xy_norm, L) && \at(p->margin_projz, K) == \at(p->margin_projz, L) &&
    \at(p->margin_projxy, K) == \at(p->margin_projxy, L) && \at(p->margin_planar, K) == \at(p->margin_planar, L) &&
    \at(p->failed, K) == \at(p->failed, L) && \at(p->ready, K) == \at(p->ready, L);

  // Which wafer, whose, and since when.
  predicate wh_same_event{K, L}(wh_encounter_t *e) =
    \at(e->wafer, K) == \at(e->wafer, L) && \at(e->holder, K) == \at(e->holder, L) &&
    \at(e->slice, K) == \at(e->slice, L);

  predicate wh_same_poses{K, L}(wh_grasp_t *t) =
    \forall integer w; wh_is_wafer{K}(t, w) ==> wh_same_pose{K, L}(t, w);
  predicate wh_same_grips{K, L}(wh_grasp_t *t) =
    \forall integer g; wh_is_gripper{K}(t, g) ==> wh_same_grip{K, L}(t, g);
  predicate wh_same_stands{K, L}(wh_grasp_t *t) =
    \forall integer g; wh_is_gripper{K}(t, g) ==>
      \at(t->storage.grippers[g].base_from_gripper, K) == \at(t->storage.grippers[g].base_from_gripper, L);
  predicate wh_same_valves{K, L}(wh_grasp_t *t) =
    \forall integer g; wh_is_gripper{K}(t, g) ==>
      \at(t->storage.grippers[g].valve, K) == \at(t->storage.grippers[g].valve, L);
  predicate wh_same_encounters{K, L}(wh_grasp_t *t) =
    \forall integer g; wh_is_gripper{K}(t, g) ==>
      wh_same_event{K, L}(\at(&t->storage.grippers[g].approach, K)) &&
      wh_same_event{K, L}(\at(&t->storage.grippers[g].contest, K));
  predicate wh_same_measured{K, L}(wh_grasp_t *t) =
    \forall integer g; wh_is_gripper{K}(t, g) ==>
      wh_same_values{K, L}(\at(&t->storage.grippers[g].approach.measured, K)) &&
      wh_same_values{K, L}(\at(&t->storage.grippers[g].contest.measured, K));

  // Nothing has changed in the arrays.
  predicate wh_same_arrays{K, L}(wh_grasp_t *t) =
    wh_same_poses{K, L}(t) && wh_same_holders{K, L}(t) && wh_same_releases{K, L}(t) && wh_same_held{K, L}(t) &&
    wh_same_grips{K, L}(t) && wh_same_stands{K, L}(t) && wh_same_valves{K, L}(t) && wh_same_encounters{K, L}(t) &&
    wh_same_measured{K, L}(t);

  // Nothing has changed but counters.
  predicate wh_unchanged{K, L}(wh_grasp_t *t) =
    \at(t->config, K) == \at(t->config, L) && \at(t->storage, K) == \at(t->storage, L) &&
    \at(t->slice, K) == \at(t->slice, L) && wh_same_arrays{K, L}(t);
*/

#endif
