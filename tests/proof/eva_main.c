/* The program that Eva analyses: it calls every public function of the core, in every order, with
 * every bit pattern.
 *
 * Assumed, as the headers ask: pointers are null only if a function refuses null; arrays have as
 * many elements as their counts say, GRIPPERS and WAFERS; a bool is 0 or 1; a table is only passed
 * on once wh_grasp_init accepted it. Apart from that, the library alone decides what the arrays
 * hold, before and between the calls. The slice, the counters and the buckets hold anything.
 */
#include "eva_any.h"
#include "grasp/edge.h"
#include "grasp/face.h"
#include "grasp/grips.h"
#include "grasp/hold.h"
#include "grasp/passive.h"
#include "grasp/restore.h"

/* EVA_GRIPS: the table with grips of any kind takes long, so it is apart from all others. */
#if !defined(GRIPPERS)
#define GRIPPERS 2
#define WAFERS 3
#endif
#define EVENTS (GRIPPERS * WH_EVENTS_PER_GRIPPER)
#define BUCKETS WH_GRASP_BUCKETS(WAFERS, GRIPPERS)

static volatile uint32_t bits;

static wh_tolerance_t any_tolerance(void) {
    const wh_tolerance_t tolerance = {real, real, real};
    return tolerance;
}

static wh_proximity_t any_proximity(void) {
    wh_proximity_t p;
    p.dr = wh_vec3(real, real, real);
    p.n1_proj_n2 = real;
    p.dr_proj_z = real;
    p.dr_proj_xy = wh_vec3(real, real, real);
    p.dr_proj_xy_norm = real;
    p.margin_projz = real;
    p.margin_projxy = real;
    p.margin_planar = real;
    p.failed = (unsigned)integer;
    p.ready = any_bool();
    return p;
}

static wh_encounter_t any_encounter(void) {
    wh_encounter_t encounter = {.wafer = integer, .holder = integer, .slice = word};
    encounter.measured = any_proximity();
    return encounter;
}

static wh_wafer_t any_wafer(void) {
    wh_wafer_t wafer = {.holder = integer, .released_by = integer};
    wafer.base_from_wafer = any_pose();
    return wafer;
}

static wh_gripper_t any_gripper(void) {
    wh_gripper_t gripper = {.wafer = integer, .valve = integer};
    gripper.base_from_gripper = any_pose();
    gripper.gripper_from_wafer = any_pose();
    gripper.approach = any_encounter();
    gripper.contest = any_encounter();
    return gripper;
}

static wh_grasp_config_t any_config(void) {
    wh_grasp_config_t config;
    config.tolerance = any_tolerance();
    config.check = (wh_check_t)integer;
    config.seat = any_bool();
    config.near_projz = real;
    config.near_projxy = real;
    return config;
}

static wh_grasp_counters_t any_counters(void) {
    const wh_grasp_counters_t counters = {word, word, word, word, word, word};
    return counters;
}

static wh_event_t any_event(void) {
    wh_event_t event = {.kind = (wh_event_kind_t)integer, .slice = word, .measured_slice = word};
    event.wafer = integer;
    event.gripper = integer;
    event.other = integer;
    event.status = (wh_status_t)integer;
    event.height = real;
    event.measured = any_proximity();
    return event;
}

static void call_grips(void) {
    const wh_pose_t axis = any_pose();
    const wh_pose_t gripper = any_pose();
    const wh_tolerance_t tolerance = any_tolerance();
    wh_pose_t wafer = any_pose();
    wh_face_t face;
    wh_proximity_t measured;
    (void)wh_face_measure(any_bool() ? &wafer : NULL, real, &gripper, &tolerance, any_bool() ? &face : NULL,
                          &measured);
    (void)wh_face_centre(&wafer, real, &gripper);
    wh_face_turn_over(&axis, &wafer);
    (void)wh_face_swept_radius(real, real, real);
    const wh_passive_t passive = {tolerance, (wh_check_t)integer, real};
    const wh_pads_t pads = {real, real, real, real};
    wh_passive_wafer_t lying = {any_pose(), any_pose(), any_bool()};
    wh_passive_change_t change;
    (void)wh_passive_step(&passive, &axis, &gripper, any_bool() ? &axis : NULL, any_bool() ? &lying : NULL,
                          any_bool() ? &change : NULL);
    (void)wh_passive_limit(&pads, &axis.R);
}

static void call_edges(void) {
    const double x = real;
    const wh_edge_t edge = {x, x, x, x, x, x, x, x, x, x};
    const wh_edge_wafer_t lies = {x, x, x, x, x, x, x, x};
    wh_edge_t some = wh_edge_default(x);
    wh_edge_wafer_t other = wh_edge_wafer_nominal(x);
    wh_edge_place_t place;
    some.clearance = any_bool() ? x : some.clearance;
    other.x = x;
    other.y = x;
    other.notch_x = x;
    (void)wh_edge_validate(any_bool() ? &edge : NULL);
    (void)wh_edge_wafer_validate(any_bool() ? &edge : NULL, any_bool() ? &lies : NULL);
    (void)wh_edge_at(any_bool() ? &edge : NULL, any_bool() ? &lies : NULL, x, &place);
    (void)wh_edge_at(&some, &other, x, &place);
    (void)wh_edge_meets_notch(&other, x, x);
}

static void call_names(void) {
    (void)wh_status_text((wh_status_t)integer);
    (void)wh_status_name((wh_status_t)integer);
    (void)wh_event_name((wh_event_kind_t)integer);
    (void)wh_grasp_buckets(size, size);
}

static void call_values(void) {
    const wh_pose_t a = any_pose();
    const wh_pose_t b = any_pose();
    (void)wh_pose_validate(&a);
    wh_mat3_t almost = a.R;
    wh_mat3_orthonormalise(&almost);
    const wh_pose_t c = wh_pose_compose(&a, &b);
    (void)wh_pose_relative(&a, &c);
}

static void call_proximity(void) {
    const wh_pose_t wafer = any_pose();
    const wh_pose_t gripper = any_pose();
    wh_tolerance_t tolerance = any_tolerance();
    wh_proximity_t measured = any_proximity();
    (void)wh_proximity_ready(&wafer, &gripper, &tolerance);
    (void)wh_proximity_rim_gap(&wafer, &gripper, real);
    wh_proximity_judge(&tolerance, &measured);
    (void)wh_proximity_measure(any_bool() ? &wafer : NULL, any_bool() ? &gripper : NULL,
                               any_bool() ? &tolerance : NULL, any_bool() ? &measured : NULL);
    (void)wh_tolerance_validate(&tolerance);
    (void)wh_tolerance_preset(size, &tolerance);
    (void)wh_tolerance_paper();
    (void)wh_tolerance_strict();
}

static void call_vacuum(void) {
    wh_vacuum_config_t config = any_bool() ? wh_vacuum_ideal() : wh_vacuum_delayed();
    config.build = real;
    config.vent = real;
    config.idle = real;
    config.on = real;
    config.off = real;
    config.release = real;
    config.debounce = integer;
    (void)wh_vacuum_validate(any_bool() ? &config : NULL);
    wh_vacuum_fault_t upset = wh_vacuum_sound();
    upset.full = real;
    upset.build = real;
    wh_vacuum_t vacuum = wh_vacuum_start();
    vacuum.level = real;
    vacuum.on = any_bool();
    vacuum.waits = (uint16_t)integer;
    (void)wh_vacuum_before(&config, &upset, integer, any_bool(), real, &vacuum);
    (void)wh_vacuum_after(&config, &upset, any_bool(), real, &vacuum);
}

static void call_holding(void) {
    wh_pads_t pads = wh_pads_none();
    pads.friction = real;
    pads.force = real;
    pads.mass = any_bool() ? real : wh_wafer_mass(real, real);
    pads.gravity = real;
    (void)wh_pads_validate(any_bool() ? &pads : NULL);
    const wh_pads_t passive = wh_passive_pads(&pads);
    (void)wh_pads_validate(&passive);
    const wh_pose_t gripper = any_pose();
    const wh_vec3_t place = wh_vec3(real, real, real);
    (void)wh_hold_judge(&pads, real, &gripper.R, &place);
    wh_carry_t carry = {{place, place}, 0, any_bool()};
    wh_hold_t hold;
    while (any_bool()) {
        (void)wh_carry_update(&carry, &pads, real, &gripper.R, any_bool() ? &place : NULL, real, &hold);
    }
}

static void call_step(wh_grasp_t *table, size_t gripper_count) {
    wh_gripper_input_t inputs[GRIPPERS];
    wh_event_t events[EVENTS];
    wh_event_list_t list = {events, any_bool() ? 4 * gripper_count : 4 * gripper_count - 1, size};
    for (size_t i = 0; i < EVENTS; ++i) {
        events[i] = any_event();
    }
    for (size_t g = 0; g < GRIPPERS; ++g) {
        inputs[g].base_from_gripper = any_pose();
        inputs[g].valve = integer;
    }
    if (any_bool()) {
        list.events = NULL;
        list.capacity = 0;
    }
    (void)wh_grasp_step(any_bool() ? table : NULL, any_bool() ? inputs : NULL, any_bool() ? &list : NULL);
}

static void call_place(wh_grasp_t *table) {
    const wh_pose_t pose = any_pose();
    (void)wh_grasp_place(any_bool() ? table : NULL, size, any_bool() ? &pose : NULL);
}

static void call_restore(wh_grasp_t *table) {
    wh_wafer_t wafers[WAFERS];
    wh_gripper_t grippers[GRIPPERS];
    for (size_t w = 0; w < WAFERS; ++w) {
        wafers[w] = any_wafer();
    }
    for (size_t g = 0; g < GRIPPERS; ++g) {
        grippers[g] = any_gripper();
    }
    (void)wh_grasp_restore(any_bool() ? table : NULL, word, any_bool() ? wafers : NULL,
                           any_bool() ? grippers : NULL);
}

static void call_questions(const wh_grasp_t *table) {
    wh_pose_t pose;
    int32_t index;
    (void)wh_grasp_wafer(any_bool() ? table : NULL, size, any_bool() ? &pose : NULL,
                         any_bool() ? &index : NULL);
    (void)wh_grasp_held(any_bool() ? table : NULL, size, any_bool() ? &index : NULL);
    (void)wh_grasp_is_consistent(table);
    (void)wh_grasp_hash(table);
}

/* Before each call the slice, the counters and the buckets get any values. This covers more than
 * earlier calls can have left, and Eva need not follow each count. */
static void spoil(wh_grasp_t *table) {
    table->slice = word;
    table->counters = any_counters();
    if (table->storage.bucket_count > 0) {
        for (size_t i = 0; i < BUCKETS; ++i) {
            table->storage.buckets[i] = bits;
        }
    }
}

/* Makes any calls in any order, without end. */
static void use(wh_grasp_t *table, size_t gripper_count) {
    while (any_bool()) {
        spoil(table);
        switch (integer) {
        case 0:
            call_step(table, gripper_count);
            break;
        case 1:
            call_place(table);
            break;
        case 2:
            call_restore(table);
            break;
        default:
            call_questions(table);
            break;
        }
    }
}

static void call_grips_step(wh_grips_t *grips) {
    wh_gripper_input_t inputs[GRIPPERS];
    wh_event_t events[EVENTS];
    wh_event_list_t list = {events, EVENTS, size};
    for (size_t i = 0; i < EVENTS; ++i) {
        events[i] = any_event();
    }
    for (size_t g = 0; g < GRIPPERS; ++g) {
        inputs[g].base_from_gripper = any_pose();
        inputs[g].valve = integer;
    }
    (void)wh_grips_step(any_bool() ? grips : NULL, any_bool() ? inputs : NULL, any_bool() ? &list : NULL);
}

/* States as a message may contain them. */
static void call_complete(const wh_grips_parts_t *parts, const wh_gripper_t grippers[]) {
    wh_grip_state_t states[GRIPPERS];
    for (size_t g = 0; g < GRIPPERS; ++g) {
        states[g].phase = (wh_grip_phase_t)integer;
        states[g].wafer = integer;
        states[g].s = real;
        states[g].excess = real;
        states[g].x = real;
        states[g].y = real;
        states[g].lying.x = real;
        states[g].lying.y = real;
        states[g].lying.notch_x = real;
        states[g].lying.notch_y = real;
    }
    (void)wh_grips_complete(parts, grippers, GRIPPERS, WAFERS, states);
}

/* A table of its own with grips of any kind: steps in which wafers are picked and released, and
 * questions between them. */
static void call_table_of_grips(wh_wafer_t wafers[], wh_gripper_t grippers[]) {
    static wh_grip_state_t states[GRIPPERS];
    static wh_wafer_t seen[WAFERS];
    const wh_pose_t support = any_pose();
    const double x = real;
    wh_grasp_t table;
    wh_grips_t grips;
    wh_grip_t kinds[GRIPPERS];
    wh_edge_wafer_t shapes[WAFERS];
    for (size_t g = 0; g < GRIPPERS; ++g) {
        kinds[g].kind = (wh_grip_kind_t)integer;
        kinds[g].edge = (wh_edge_t){x, x, x, x, x, x, x, x, x, x};
    }
    for (size_t w = 0; w < WAFERS; ++w) {
        shapes[w] = (wh_edge_wafer_t){x, x, x, x, x, x, x, x};
    }
    const wh_grasp_config_t config = any_config();
    const wh_grasp_storage_t storage = {wafers, WAFERS, grippers, GRIPPERS, NULL, 0};
    const wh_grips_parts_t parts = {real, real, kinds, shapes, &support, 1, states, seen, NULL};
    if (wh_grasp_init(&table, &config, &storage) != WH_OK || wh_grips_init(&grips, &parts, &table) != WH_OK) {
        return;
    }
    /* The check just above has shown that each value is one of these. */
    for (size_t g = 0; g < GRIPPERS; ++g) {
        kinds[g].kind = any_bool() ? WH_GRIP_VACUUM : WH_GRIP_EDGE;
        kinds[g].kind = any_bool() ? WH_GRIP_PASSIVE : kinds[g].kind;
    }
    while (any_bool()) {
        spoil(&table);
        call_grips_step(&grips);
        for (size_t w = 0; w < WAFERS; ++w) {
            (void)wh_grips_support(&grips, w);
        }
        (void)wh_grips_hash(&grips);
        call_complete(&parts, grippers);
    }
}

static void call_refused_init(wh_wafer_t wafers[], wh_gripper_t grippers[]) {
    wh_grasp_t table;
    const wh_grasp_config_t config = any_config();
    const wh_grasp_storage_t storage = {any_bool() ? wafers : NULL,
                                        any_bool() ? WAFERS : (size_t)INT32_MAX + 1,
                                        any_bool() ? grippers : NULL,
                                        any_bool() ? GRIPPERS : SIZE_MAX,
                                        NULL,
                                        size};
    (void)wh_grasp_init(any_bool() ? &table : NULL, any_bool() ? &config : NULL,
                        any_bool() ? &storage : NULL);
}

static void call_empty(void) {
    wh_grasp_t table;
    const wh_grasp_config_t config = wh_grasp_config_default();
    const wh_grasp_storage_t storage = {NULL, 0, NULL, 0, NULL, 0};
    if (wh_grasp_init(&table, &config, &storage) == WH_OK) {
        use(&table, 0);
    }
}

/* A table of zeroes, with a mark or without. */
static void call_blank(void) {
    wh_grasp_t table = {.slice = 0};
    const wh_pose_t pose = any_pose();
    int32_t index;
    table.mark = bits;
    (void)wh_grasp_step(&table, NULL, NULL);
    (void)wh_grasp_place(&table, size, &pose);
    (void)wh_grasp_restore(&table, word, NULL, NULL);
    (void)wh_grasp_wafer(&table, size, NULL, &index);
    (void)wh_grasp_held(&table, size, &index);
    (void)wh_grasp_is_consistent(&table);
}

int main(void) {
    wh_grasp_t table;
    wh_wafer_t wafers[WAFERS];
    wh_gripper_t grippers[GRIPPERS];
    uint32_t buckets[BUCKETS];
    for (size_t w = 0; w < WAFERS; ++w) {
        wafers[w] = any_wafer();
    }
#if defined(EVA_GRIPS)
    call_table_of_grips(wafers, grippers);
    return 0;
#else
    call_names();
    call_grips();
    call_edges();
    call_values();
    call_proximity();
    call_vacuum();
    call_holding();
    call_refused_init(wafers, grippers);
    call_empty();
    call_blank();

    const wh_grasp_config_t config = any_config();
    const wh_grasp_storage_t storage = {wafers,   WAFERS,  grippers,
                                        GRIPPERS, buckets, any_bool() ? BUCKETS : 0};
    if (wh_grasp_init(&table, &config, &storage) == WH_OK) {
        use(&table, GRIPPERS);
    }
    return 0;
#endif
}
