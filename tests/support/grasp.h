/* A small cell for tests of the grasp table: wafers and grippers far from each other, ready to be moved. */
#ifndef WH_TESTS_SUPPORT_GRASP_H
#define WH_TESTS_SUPPORT_GRASP_H

#include "grasp/grasp.h"
#include "support/pose.h"

/* Swept checking, if the library has it. */
#define SWEPT_IF_BUILT (WH_SWEEP_BUILT ? WH_CHECK_SWEPT : WH_CHECK_SAMPLED)

enum { CELL_WAFERS = 4, CELL_GRIPPERS = 3, OPEN = WH_VALVE_OPEN, CLOSED = WH_VALVE_CLOSED };

typedef struct {
    wh_grasp_t table;
    wh_wafer_t wafer[CELL_WAFERS];
    wh_gripper_t gripper[CELL_GRIPPERS];
    wh_gripper_input_t input[CELL_GRIPPERS];
    wh_event_t event[CELL_GRIPPERS * WH_EVENTS_PER_GRIPPER];
    wh_event_list_t list;
} cell_t;

/* Wafer w lies level at (1000 w, 0, 0), gripper g waits closed at (1000 g, 0, -500). */
static inline void cell_begin(cell_t *cell, const wh_grasp_config_t *config) {
    memset(cell, 0, sizeof *cell);
    for (int w = 0; w < CELL_WAFERS; ++w) {
        cell->wafer[w].base_from_wafer = wh_test_at(1000 * w, 0, 0);
    }
    for (int g = 0; g < CELL_GRIPPERS; ++g) {
        cell->input[g].base_from_gripper = wh_test_at(1000 * g, 0, -500);
        cell->input[g].valve = CLOSED;
    }
    const wh_grasp_storage_t storage = {cell->wafer, CELL_WAFERS, cell->gripper, CELL_GRIPPERS, NULL, 0};
    assert_int_equal(wh_grasp_init(&cell->table, config, &storage), WH_OK);
    cell->list.events = cell->event;
    cell->list.capacity = CELL_GRIPPERS * WH_EVENTS_PER_GRIPPER;
}

static inline void cell_begin_default(cell_t *cell) {
    const wh_grasp_config_t config = wh_grasp_config_default();
    cell_begin(cell, &config);
}

static inline void cell_step(cell_t *cell) {
    assert_int_equal(wh_grasp_step(&cell->table, cell->input, &cell->list), WH_OK);
}

/* Gripper g, level, moves to (x, y, z) in the next slice, with this valve. */
static inline void cell_set(cell_t *cell, int g, double x, double y, double z, int valve) {
    cell->input[g].base_from_gripper = wh_test_at(x, y, z);
    cell->input[g].valve = valve;
}

/* A level pose within `reach` of wafer 0 along x and `height` along z; the valve is open or closed. */
static inline void cell_set_randomly(cell_t *cell, int g, double reach, double height) {
    const double x = wh_test_uniform(-reach, reach);
    const double z = wh_test_uniform(-height, height);
    cell_set(cell, g, x, 0, z, (int)wh_test_below(2));
}

static inline void cell_move(cell_t *cell, int g, double x, double y, double z, int valve) {
    cell_set(cell, g, x, y, z, valve);
    cell_step(cell);
}

/* Puts a free wafer, level, at (x, y, z). */
static inline void cell_place(cell_t *cell, size_t w, double x, double y, double z) {
    const wh_pose_t pose = wh_test_at(x, y, z);
    assert_int_equal(wh_grasp_place(&cell->table, w, &pose), WH_OK);
}

/* The last step's only event of this kind; none: null, several: a failure. */
static inline const wh_event_t *cell_event(const cell_t *cell, wh_event_kind_t kind) {
    const wh_event_t *found = NULL;
    for (size_t i = 0; i < cell->list.count; ++i) {
        if (cell->event[i].kind == kind) {
            assert_null(found);
            found = &cell->event[i];
        }
    }
    return found;
}

/* Asserts that the last step's only event was this one. */
static inline const wh_event_t *cell_expect(const cell_t *cell, wh_event_kind_t kind, int wafer, int gripper,
                                            int other) {
    assert_int_equal(cell->list.count, 1);
    const wh_event_t *e = &cell->event[0];
    assert_string_equal(wh_event_name(e->kind), wh_event_name(kind));
    assert_int_equal(e->wafer, wafer);
    assert_int_equal(e->gripper, gripper);
    assert_int_equal(e->other, other);
    assert_int_equal(e->slice, cell->table.slice);
    assert_int_equal(e->status, WH_OK);
    return e;
}

static inline void cell_expect_nothing(const cell_t *cell) {
    assert_int_equal(cell->list.count, 0);
}

/* Asserts that wafer and gripper agree that one holds the other; WH_NONE on either side: neither does. */
static inline void cell_expect_held(const cell_t *cell, int wafer, int gripper) {
    int32_t holder = -2;
    int32_t held = -2;
    if (wafer != WH_NONE) {
        assert_int_equal(wh_grasp_wafer(&cell->table, (size_t)wafer, NULL, &holder), WH_OK);
        assert_int_equal(holder, gripper);
    }
    if (gripper != WH_NONE) {
        assert_int_equal(wh_grasp_held(&cell->table, (size_t)gripper, &held), WH_OK);
        assert_int_equal(held, wafer);
    }
}

#endif
