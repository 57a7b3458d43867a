/* What the contracts of the grasp table speak of, in ACSL (read by Frama-C; a compiler sees a comment).
 *
 * Memory is the caller's promise: arrays are as long as their counts say and do not overlap. Consistency is the
 * library's: who holds a wafer is told twice, by the wafer and by the gripper, and both always agree.
 */
#ifndef WH_CORE_CONTRACTS_H
#define WH_CORE_CONTRACTS_H

/*@
  predicate wh_table_memory{L}(wh_grasp_t *t) =
    \valid(t) && t->storage.wafer_count <= INT32_MAX && t->storage.gripper_count <= INT32_MAX &&
    \valid(t->storage.wafers + (0 .. t->storage.wafer_count - 1)) &&
    \valid(t->storage.grippers + (0 .. t->storage.gripper_count - 1)) &&
    \separated(t, t->storage.wafers + (0 .. t->storage.wafer_count - 1),
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

  predicate wh_inputs_apart{L}(wh_gripper_input_t *in, wh_grasp_t *t, wh_event_list_t *l) =
    \separated(in + (0 .. t->storage.gripper_count - 1), t, l,
               t->storage.wafers + (0 .. t->storage.wafer_count - 1),
               t->storage.grippers + (0 .. t->storage.gripper_count - 1)) &&
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

  predicate wh_encounters{L}(wh_grasp_t *t) =
    \forall integer g; wh_is_gripper(t, g) ==>
      WH_NONE <= t->storage.grippers[g].approach.wafer < t->storage.wafer_count &&
      WH_NONE <= t->storage.grippers[g].contest.wafer < t->storage.wafer_count;

  // What holds between two calls, for every table that wh_grasp_init accepted.
  predicate wh_consistent{L}(wh_grasp_t *t) =
    wh_paired(t) && wh_encounters(t) &&
    \forall integer w; wh_is_wafer(t, w) ==> wh_released_by(t, w) == WH_NONE;

  // Within a step: gripper g's valve is closed in this slice and it has let go, but still names its wafer.
  predicate wh_lets_go{L}(wh_gripper_input_t *in, integer g, integer from, integer to) =
    from <= g < to && in[g].valve == WH_VALVE_CLOSED;

  predicate wh_stepping{L}(wh_grasp_t *t, wh_gripper_input_t *in, integer from, integer to) =
    (\forall integer w; wh_is_wafer(t, w) && wh_holder(t, w) != WH_NONE ==>
       wh_is_gripper(t, wh_holder(t, w)) && wh_held(t, wh_holder(t, w)) == w &&
       !wh_lets_go(in, wh_holder(t, w), from, to)) &&
    (\forall integer w; wh_is_wafer(t, w) && wh_released_by(t, w) != WH_NONE ==>
       wh_is_gripper(t, wh_released_by(t, w)) && wh_held(t, wh_released_by(t, w)) == w &&
       wh_lets_go(in, wh_released_by(t, w), from, to)) &&
    (\forall integer g; wh_is_gripper(t, g) && wh_held(t, g) != WH_NONE ==>
       wh_is_wafer(t, wh_held(t, g)) &&
       (wh_lets_go(in, g, from, to) ? wh_released_by(t, wh_held(t, g)) == g
                                    : wh_holder(t, wh_held(t, g)) == g));

  predicate wh_same_pose{K, L}(wh_grasp_t *t, integer w) =
    \at(t->storage.wafers[w].base_from_wafer, K) == \at(t->storage.wafers[w].base_from_wafer, L);

  predicate wh_same_grip{K, L}(wh_grasp_t *t, integer g) =
    \at(t->storage.grippers[g].gripper_from_wafer, K) == \at(t->storage.grippers[g].gripper_from_wafer, L);

  // A wafer that nobody held, and that nobody took since, has not moved.
  predicate wh_free_at_rest{K, L}(wh_grasp_t *t) =
    \forall integer w; wh_is_wafer{K}(t, w) && wh_holder{K}(t, w) == WH_NONE &&
      wh_holder{L}(t, w) == WH_NONE ==> wh_same_pose{K, L}(t, w);

  // How a gripper held its wafer has not changed.
  predicate wh_grips_kept{K, L}(wh_grasp_t *t) =
    \forall integer g; wh_is_gripper{K}(t, g) && wh_held{K}(t, g) != WH_NONE ==> wh_same_grip{K, L}(t, g);

  // Nothing but counters has changed.
  predicate wh_unchanged{K, L}(wh_grasp_t *t) =
    \at(t->config, K) == \at(t->config, L) && \at(t->storage, K) == \at(t->storage, L) &&
    \at(t->slice, K) == \at(t->slice, L) &&
    (\forall integer w; wh_is_wafer{K}(t, w) ==>
       \at(t->storage.wafers[w], K) == \at(t->storage.wafers[w], L)) &&
    (\forall integer g; wh_is_gripper{K}(t, g) ==>
       \at(t->storage.grippers[g], K) == \at(t->storage.grippers[g], L));
*/

#endif
