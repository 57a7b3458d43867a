/* Every field that a layout may have: the readers refuse all others by these lists, and `waferhand
 * definitions` writes them for editors. */
#ifndef WH_LAYOUT_LAYOUT_FIELDS_H
#define WH_LAYOUT_LAYOUT_FIELDS_H

#include "../script/field.h"
#include "../sim/faults.h"

/* The parts of a layout's hash that go by rows: wh_reader_field_t.hashed. */
enum {
    WH_HASHED_CHECKS = 1,
    WH_HASHED_VACUUM,
    WH_HASHED_PADS,
    WH_HASHED_PLACING,
    WH_HASHED_DROP,
    WH_HASHED_ARM
};

/* The tables of one kind. Types of fields name them as waferhand.NAME. */
typedef struct {
    const char *name; /* null ends the list */
    const char *text; /* what such a table is */
    const wh_reader_field_t *fields;
} wh_layout_class_t;

/* All of them, `layout` first. */
extern const wh_layout_class_t wh_layout_classes[];

/* The fields of a fault of each kind. */
extern const wh_reader_field_t *const wh_layout_fault_fields[WH_FAULT_KINDS];

extern const wh_reader_field_t wh_layout_top_fields[];
extern const wh_reader_field_t wh_layout_wafer_size_fields[];
extern const wh_reader_field_t wh_layout_notch_fields[];
extern const wh_reader_field_t wh_layout_tolerance_fields[];
extern const wh_reader_field_t wh_layout_near_fields[];
extern const wh_reader_field_t wh_layout_placing_fields[];
extern const wh_reader_field_t wh_layout_corrections_fields[];
extern const wh_reader_field_t wh_layout_mapping_fields[];
extern const wh_reader_field_t wh_layout_vacuum_fields[];
extern const wh_reader_field_t wh_layout_pads_fields[];
extern const wh_reader_field_t wh_layout_robot_fields[];
extern const wh_reader_field_t wh_layout_joint_fields[];
extern const wh_reader_field_t wh_layout_turning_axis_fields[];
extern const wh_reader_field_t wh_layout_robot_arm_fields[];
extern const wh_reader_field_t wh_layout_robot_wrist_fields[];
extern const wh_reader_field_t wh_layout_flip_axis_fields[];
extern const wh_reader_field_t wh_layout_straight_axis_fields[];
extern const wh_reader_field_t wh_layout_chuck_fields[];
extern const wh_reader_field_t wh_layout_gripper_fields[];
extern const wh_reader_field_t wh_layout_loaded_fields[];
extern const wh_reader_field_t wh_layout_edge_grip_fields[];
extern const wh_reader_field_t wh_layout_stage_fields[];
extern const wh_reader_field_t wh_layout_pins_fields[];
extern const wh_reader_field_t wh_layout_flipper_fields[];
extern const wh_reader_field_t wh_layout_door_fields[];
extern const wh_reader_field_t wh_layout_station_fields[];
extern const wh_reader_field_t wh_layout_approach_fields[];
extern const wh_reader_field_t wh_layout_clean_fields[];
extern const wh_reader_field_t wh_layout_pump_fields[];
extern const wh_reader_field_t wh_layout_lock_fields[];
extern const wh_reader_field_t wh_layout_lock_doors_fields[];
extern const wh_reader_field_t wh_layout_port_fields[];
extern const wh_reader_field_t wh_layout_mapper_fields[];
extern const wh_reader_field_t wh_layout_e84_fields[];
extern const wh_reader_field_t wh_layout_carrier_fields[];
extern const wh_reader_field_t wh_layout_axes_fields[];
extern const wh_reader_field_t wh_layout_wafer_fields[];
extern const wh_reader_field_t wh_layout_sensor_fields[];
extern const wh_reader_field_t wh_layout_believed_fields[];
extern const wh_reader_field_t wh_layout_arc_fields[];
extern const wh_reader_field_t wh_layout_via_fields[];
extern const wh_reader_field_t wh_layout_beam_fields[];
extern const wh_reader_field_t wh_layout_block_fields[];
extern const wh_reader_field_t wh_layout_probe_fields[];
extern const wh_reader_field_t wh_layout_rim_fields[];
extern const wh_reader_field_t wh_layout_rim_notch_fields[];
extern const wh_reader_field_t wh_layout_flat_fields[];
extern const wh_reader_field_t wh_layout_chip_fields[];
extern const wh_reader_field_t wh_layout_shapes_fields[];
extern const wh_reader_field_t wh_layout_blade_fields[];
extern const wh_reader_field_t wh_layout_arm_fields[];
extern const wh_reader_field_t wh_layout_ledge_fields[];
extern const wh_reader_field_t wh_layout_foup_fields[];
extern const wh_reader_field_t wh_layout_spindle_fields[];
extern const wh_reader_field_t wh_layout_obstacle_fields[];
extern const wh_reader_field_t wh_layout_round_fields[];
extern const wh_reader_field_t wh_layout_clearance_fields[];
extern const wh_reader_field_t wh_layout_study_fields[];
extern const wh_reader_field_t wh_layout_placement_fields[];
extern const wh_reader_field_t wh_layout_teaching_fields[];
extern const wh_reader_field_t wh_layout_timing_fields[];
extern const wh_reader_field_t wh_layout_valve_fields[];
extern const wh_reader_field_t wh_layout_rim_width_fields[];
extern const wh_reader_field_t wh_layout_beam_width_fields[];
extern const wh_reader_field_t wh_layout_timed_fields[];
extern const wh_reader_field_t wh_layout_timed_study_fields[];
extern const wh_reader_field_t wh_layout_timed_timing_fields[];
extern const wh_reader_field_t wh_layout_timed_robot_fields[];
extern const wh_reader_field_t wh_layout_timed_station_fields[];
extern const wh_reader_field_t wh_layout_timed_by_fields[];
extern const wh_reader_field_t wh_layout_timed_door_fields[];
extern const wh_reader_field_t wh_layout_timed_way_fields[];

#endif
