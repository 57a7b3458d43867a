/* A report's view of a run compared with the run itself, slice by slice: curves, rows of plots, its
 * document and its scene. The scene's buffer is read back and checked by glTF's rules. */
#include "support/support.h"

#include <jansson.h>

#include "layout/arms.h"
#include "math/trig.h"
#include "mcs/script_run.h"
#include "record/quaternion.h"
#include "report/document.h"
#include "report/gnuplot.h"
#include "scene/gltf.h"
#include "scene/scene.h"

/* A slice as it was. */
typedef struct {
    wh_pose_t grippers[WH_GRIPPERS];
    wh_pose_t wafers[4];
    double axes[WH_AXES], levels[WH_GRIPPERS];
    int32_t valves[WH_GRIPPERS], holders[4];
    uint32_t sensors;
    bool is_exact;
} slice_t;

static wh_script_run_t run;
static wh_signals_t signals;
static slice_t *slices; /* the slices by number; 0 is not used */
static size_t slice_count, slice_capacity;

static void on_slice(void *user, const wh_command_t *command, const wh_state_t *state) {
    (void)user;
    if (state->status != WH_OK) {
        return;
    }
    wh_signals_slice(&signals, command->axes, command->axis_count, state);
    slice_count = (size_t)state->seq + 1;
    if (slice_count > slice_capacity) {
        slice_capacity = 2 * slice_count + 8192;
        slices = realloc(slices, slice_capacity * sizeof *slices);
        assert_non_null(slices);
    }
    slice_t *kept = &slices[state->seq];
    memset(kept, 0, sizeof *kept);
    for (size_t g = 0; g < state->gripper_count; ++g) {
        kept->grippers[g] = state->grippers[g].base_from_gripper;
        kept->valves[g] = state->physics->told[g];
        kept->levels[g] = state->physics->vacuum[g].level;
    }
    for (size_t w = 0; w < state->wafer_count && w < 4; ++w) {
        kept->wafers[w] = state->wafers[w].base_from_wafer;
        kept->holders[w] = state->wafers[w].holder;
    }
    memcpy(kept->axes, command->axes, sizeof kept->axes);
    kept->sensors = state->sensors;
    kept->is_exact = state->event_count > 0;
}

static void on_boundary(void *user, const wh_layout_t *layout) {
    (void)user;
    if (!signals.layout) {
        wh_signals_begin(&signals, layout, true);
    } else if (signals.last > 0) {
        wh_signals_mark(&signals);
    }
    if (slice_count > 0) {
        slices[slice_count - 1].is_exact = true;
    }
}

static void play(const char *script) {
    const wh_script_run_options_t options = {.script = script,
                                             .limits = {.print_to = stderr},
                                             .listener = {.slice = on_slice, .boundary = on_boundary}};
    slice_count = 0;
    assert_int_not_equal(wh_script_run(&run, &options), WH_RUN_BAD_INPUT);
    wh_signals_finish(&signals);
    assert_true(slice_count > 1000);
    assert_int_equal(signals.last, slice_count - 1);
}

static int close_run(void **state) {
    (void)state;
    wh_signals_close(&signals);
    wh_script_run_close(&run);
    free(slices);
    slices = NULL;
    slice_capacity = 0;
    return 0;
}

/* ------------------------------------------------------------------------------------------------ comparing */

static double angle_between(const wh_mat3_t *a, const wh_mat3_t *b) {
    double p[4], q[4], turn[3];
    wh_quaternion_from_matrix(a, NULL, p);
    wh_quaternion_from_matrix(b, NULL, q);
    wh_quaternion_turn(p, q, turn);
    return sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2]);
}

static void assert_pose(const wh_pose_t *shown, const wh_pose_t *was, double mm, double rad) {
    assert_near(shown->r.x, was->r.x, mm);
    assert_near(shown->r.y, was->r.y, mm);
    assert_near(shown->r.z, was->r.z, mm);
    assert_near(angle_between(&shown->R, &was->R), 0, rad + 1e-7);
}

static int32_t step_at(const wh_steps_t *steps, int64_t slice) {
    int32_t value = 0;
    for (size_t i = 0; i < steps->count && steps->steps[i].slice <= slice; ++i) {
        value = steps->steps[i].value;
    }
    return value;
}

static const wh_stay_t *stay_at(int32_t wafer, int64_t slice) {
    const wh_stay_t *found = NULL;
    for (size_t i = 0; i < signals.stay_count && signals.stays[i].slice <= slice; ++i) {
        found = signals.stays[i].wafer == wafer ? &signals.stays[i] : found;
    }
    return found;
}

/* The tolerance of a pose: that of its axes, with angles at the robot's reach. */
static double room_mm(const slice_t *was) {
    return was->is_exact
               ? 1e-9
               : 2 * WH_SIGNALS_MM + WH_SIGNALS_RAD * signals.layout->machine.robot.travel[WH_AXIS_R].max;
}

static double room_rad(const slice_t *was) {
    return was->is_exact ? 0 : 2 * WH_SIGNALS_RAD;
}

static void check_gripper(size_t g, int64_t n) {
    const slice_t *was = &slices[n];
    wh_pose_t shown;
    wh_signals_gripper(&signals, g, n, &shown);
    assert_pose(&shown, &was->grippers[g], room_mm(was), room_rad(was));
    assert_near(wh_path_read(&signals.vacuum[g], n, NULL), was->levels[g],
                was->is_exact ? 0 : WH_SIGNALS_VACUUM);
    assert_int_equal(step_at(&signals.valves[g], n), was->valves[g]);
    assert_int_equal(step_at(&signals.sensors[g], n), was->sensors >> g & 1U);
}

/* The arm as it was placed for the collision check. */
static void check_links(int64_t n) {
    const slice_t *was = &slices[n];
    wh_pose_t links[WH_SIGNALS_LINKS], bodies[WH_ARM_BODIES];
    assert_true(wh_signals_links(&signals, n, links));
    wh_arm_place(&signals.layout->shapes.arm, &was->grippers[0], bodies);
    int32_t numbers[WH_SIGNALS_LINKS];
    for (size_t i = 0; i < wh_signals_link_bodies(signals.layout, numbers); ++i) {
        /* The elbow moves further than the wrist if the arm is folded or stretched. */
        assert_pose(&links[i], &bodies[WH_ARM_LIFT + i], 20 * room_mm(was), 40 * room_rad(was));
    }
}

/* A held wafer is at the place that its gripper shows: away from the gripper's origin its turn
 * counts, too. */
static void check_wafer(int32_t w, int64_t n) {
    const slice_t *was = &slices[n];
    const wh_stay_t *stay = stay_at(w, n);
    assert_int_equal(stay->holder, was->holders[w]);
    if (stay->holder == WH_NONE) {
        assert_memory_equal(&stay->pose, &was->wafers[w], sizeof stay->pose);
        return;
    }
    wh_pose_t gripper;
    wh_signals_gripper(&signals, (size_t)stay->holder, n, &gripper);
    const wh_pose_t shown = wh_pose_compose(&gripper, &stay->pose);
    assert_pose(&shown, &was->wafers[w], room_mm(was) + room_rad(was) * wh_vec3_norm(&stay->pose.r),
                room_rad(was));
}

/* Between points a slope is judged by a hundredth of the axis's value, not by a tolerance. */
static void check_axes(int64_t n) {
    const double seconds = (double)signals.layout->slice_us / 1e6;
    for (size_t axis = 0; axis < signals.axis_count; ++axis) {
        const wh_path_t *curve = &signals.axes[axis];
        const double limit = (double)wh_machine_limits(&signals.layout->machine, axis)->speed;
        double slope;
        const double value = wh_path_read(curve, n, &slope);
        assert_near(value, slices[n].axes[axis], slices[n].is_exact ? 0 : curve->list.tolerance);
        if (n > 1) {
            assert_near(slope / seconds, (slices[n].axes[axis] - slices[n - 1].axes[axis]) / seconds,
                        0.02 * limit);
        }
    }
}

static void check_all(void) {
    const wh_layout_t *layout = signals.layout;
    for (size_t i = 0; i < signals.stay_count; ++i) {
        assert_in_range(signals.stays[i].wafer, 0, layout->wafer_count - 1);
    }
    for (int64_t n = 1; n < (int64_t)slice_count; ++n) {
        for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
            check_gripper(g, n);
        }
        for (size_t w = 0; w < layout->wafer_count && w < 4; ++w) {
            check_wafer((int32_t)w, n);
        }
        check_axes(n);
        check_links(n);
    }
}

/* The plots of (3) to (5) agree with an event at its time. */
static void check_events(size_t expected) {
    size_t measured = 0;
    for (size_t i = 0; i < run.record.event_count; ++i) {
        const wh_event_t *event = &run.record.events[i].event;
        const bool taken = event->kind == WH_EVENT_PICKED || event->kind == WH_EVENT_NEAR_MISS ||
                           event->kind == WH_EVENT_HANDED_OVER;
        if (taken) {
            const wh_path_t *curves = signals.proximity[event->gripper];
            const int64_t slice = (int64_t)event->measured_slice;
            const wh_proximity_t *p = &event->measured;
            assert_near(wh_path_read(&curves[WH_MEASURE_PROJZ], slice, NULL), fabs(p->dr_proj_z), 0);
            assert_near(wh_path_read(&curves[WH_MEASURE_PROJXY], slice, NULL), p->dr_proj_xy_norm, 0);
            assert_near(wh_path_read(&curves[WH_MEASURE_PLANAR], slice, NULL), p->n1_proj_n2, 0);
            assert_int_equal(step_at(&signals.nearest[event->gripper], slice), event->wafer);
            ++measured;
        }
    }
    assert_int_equal(measured, expected);
}

static void transfer(void **state) {
    (void)state;
    play("lua/examples/01_transfer.lua");
    check_all();
    check_events(2);
    assert_int_equal(signals.mark_count, 0);
}

static void prealigner(void **state) {
    (void)state;
    play("lua/examples/02_prealigner.lua");
    check_all();
    check_events(5);
}

static void missed_pick(void **state) {
    (void)state;
    play("lua/examples/03_missed_pick.lua");
    check_all();
    check_events(2);
    assert_int_equal(signals.mark_count, 1);
    assert_int_equal(signals.marks[0].event.kind, WH_EVENT_NEAR_MISS);
    assert_true(signals.marks[0].has_place);
}

static size_t count_faults(void) {
    size_t count = 0;
    for (size_t i = 0; i < signals.mark_count; ++i) {
        count += signals.marks[i].event.kind == WH_EVENT_FAULT_ARMED ? 1 : 0;
    }
    return count;
}

/* A fault on purpose is marked in the picture; a carrier that comes and goes with its wafers is none. */
static void carriers_are_no_faults(void **state) {
    (void)state;
    play("lua/examples/37_late_carrier.lua");
    size_t carried = 0;
    for (size_t i = 0; i < run.record.event_count; ++i) {
        carried += wh_record_is_carried(&run.record.events[i].event) ? 1 : 0;
    }
    assert_int_equal(carried, 5);
    assert_int_equal(count_faults(), 0);
}

static void a_fault_is_marked(void **state) {
    (void)state;
    play("lua/examples/25_jam.lua");
    assert_true(count_faults() > 0);
}

static void vacuum_that_leaks(void **state) {
    (void)state;
    play("lua/examples/05_leak.lua");
    check_all();
}

/* ------------------------------------------------------------------------------------------------ own poses */

/* From the place at which a gripper leaves the pose of the axes, it is shown at its real place. */
static void a_gripper_that_is_elsewhere(void **state) {
    (void)state;
    play("lua/examples/01_transfer.lua");
    const wh_layout_t *layout = signals.layout;
    wh_signals_t other = {0};
    wh_gripper_t grippers[2];
    wh_physics_state_t condition;
    memset(grippers, 0, sizeof grippers);
    wh_physics_state_start(&condition, &layout->physics);
    wh_signals_begin(&other, layout, false);
    for (int64_t n = 1; n <= 2000; ++n) {
        for (size_t g = 0; g < 2; ++g) {
            grippers[g].base_from_gripper = slices[n].grippers[g];
            grippers[g].wafer = WH_NONE;
        }
        grippers[0].base_from_gripper.r.z += n > 900 ? 0.25 : 0;
        const wh_state_t at = {.seq = n,
                               .grippers = grippers,
                               .gripper_count = 2,
                               .physics = &condition,
                               .wafers = layout->start,
                               .wafer_count = layout->wafer_count};
        wh_signals_slice(&other, n == 1500 ? NULL : slices[n].axes, layout->machine.axis_count, &at);
    }
    wh_signals_finish(&other);
    assert_int_equal(other.own[0].list.points[0].slice, 901);
    assert_int_equal(other.own[1].list.points[0].slice, 1500);
    for (int64_t n = 1; n <= 2000; ++n) {
        wh_pose_t shown, was = slices[n].grippers[0];
        was.r.z += n > 900 ? 0.25 : 0;
        wh_signals_gripper(&other, 0, n, &shown);
        assert_pose(&shown, &was, 0.08, 1e-3);
    }
    wh_signals_close(&other);
}

/* ---------------------------------------------------------------------------------------------------- past */

static void assert_told_late(const wh_signals_t *other) {
    assert_int_equal(other->nearest[0].count, 3);
    assert_int_equal(other->nearest[1].count, 1);
    const wh_path_t *curve = &other->proximity[0][WH_MEASURE_PROJZ];
    for (int64_t n = 1; n <= 300; ++n) {
        const double told = n == 50 ? 4.25 : n == 150 ? 4.5 : 5;
        const double shown = wh_path_read(curve, n, NULL);
        assert_int_equal(step_at(&other->nearest[0], n), n <= 100 ? 0 : n <= 200 ? 1 : WH_NONE);
        if (n % 50 == 0 && n <= 200) {
            assert_near(shown, told, n % 100 == 50 ? 1e-12 : 0.01);
        }
        assert_int_equal(isnan(shown), n > 200);
    }
    assert_near(wh_path_read(curve, 60, NULL), 5, 0.75);
}

/* The gripper is near wafer 0 up to slice 100, near wafer 1 up to 200, then near none. A near miss
 * reported at 120 refers to slice 50, one at 250 to 150: the curves agree. One at 260 refers to a
 * wafer that was not the nearest then: the curves do not agree. */
static void a_near_miss_is_told_late(void **state) {
    (void)state;
    play("lua/examples/01_transfer.lua");
    const wh_layout_t *layout = signals.layout;
    static const struct {
        int64_t at, of;
        int32_t wafer;
        double projz;
    } misses[] = {{120, 50, 0, 4.25}, {250, 150, 1, 4.5}, {260, 60, 1, 4.75}};
    wh_signals_t other = {0};
    wh_gripper_t grippers[2];
    wh_physics_state_t condition;
    wh_wafer_t *wafers = malloc(layout->wafer_count * sizeof *wafers);
    assert_non_null(wafers);
    memcpy(wafers, layout->start, layout->wafer_count * sizeof *wafers);
    memset(grippers, 0, sizeof grippers);
    wh_physics_state_start(&condition, &layout->physics);
    wh_signals_begin(&other, layout, false);
    size_t next = 0;
    for (int64_t n = 1; n <= 300; ++n) {
        wh_event_t event = {.kind = WH_EVENT_NEAR_MISS};
        const bool tells = next < 3 && misses[next].at == n;
        if (tells) {
            event.wafer = misses[next].wafer;
            event.measured_slice = (uint64_t)misses[next].of;
            event.measured.dr_proj_z = -misses[next].projz;
            event.measured.dr_proj_xy_norm = 0.5;
            event.measured.n1_proj_n2 = 1;
            ++next;
        }
        grippers[0].base_from_gripper = wafers[n <= 100 ? 0 : 1].base_from_wafer;
        grippers[0].base_from_gripper.r.z -= n <= 200 ? 5 : 500;
        grippers[1].base_from_gripper = grippers[0].base_from_gripper;
        grippers[1].base_from_gripper.r.z -= 1000;
        grippers[0].wafer = grippers[1].wafer = WH_NONE;
        const wh_state_t at = {.seq = n,
                               .grippers = grippers,
                               .gripper_count = 2,
                               .physics = &condition,
                               .events = &event,
                               .event_count = tells ? 1 : 0,
                               .wafers = wafers,
                               .wafer_count = layout->wafer_count};
        wh_signals_slice(&other, NULL, layout->machine.axis_count, &at);
    }
    wh_signals_finish(&other);
    assert_int_equal(other.stay_count, layout->wafer_count);
    assert_told_late(&other);
    wh_signals_close(&other);
    free(wafers);
}

/* --------------------------------------------------------------------------------------------------- scene */

static json_int_t integer(const json_t *object, const char *key) {
    return json_integer_value(json_object_get(object, key));
}

static void check_accessors(const json_t *scene) {
    static const struct {
        const char *type;
        json_int_t width;
    } types[] = {{"SCALAR", 1}, {"VEC3", 3}, {"VEC4", 4}};
    const json_t *views = json_object_get(scene, "bufferViews");
    size_t i;
    json_t *accessor;
    json_array_foreach(json_object_get(scene, "accessors"), i, accessor) {
        const json_t *view = json_array_get(views, (size_t)integer(accessor, "bufferView"));
        const char *type = json_string_value(json_object_get(accessor, "type"));
        const json_int_t bytes = integer(accessor, "componentType") == 5123 ? 2 : 4;
        json_int_t width = 0;
        for (size_t k = 0; k < 3; ++k) {
            width = strcmp(types[k].type, type) == 0 ? types[k].width : width;
        }
        assert_int_equal(integer(view, "byteLength"), bytes * width * integer(accessor, "count"));
        assert_int_equal(integer(view, "byteOffset") % 4, 0);
        const json_t *buffer = json_array_get(json_object_get(scene, "buffers"), 0);
        assert_true(integer(view, "byteOffset") + integer(view, "byteLength") <=
                    integer(buffer, "byteLength"));
    }
}

static size_t node_index(const json_t *scene, const char *name) {
    size_t i;
    json_t *found;
    json_array_foreach(json_object_get(scene, "nodes"), i, found) {
        if (strcmp(json_string_value(json_object_get(found, "name")), name) == 0) {
            return i;
        }
    }
    return SIZE_MAX;
}

static const json_t *node(const json_t *scene, const char *name) {
    return json_array_get(json_object_get(scene, "nodes"), node_index(scene, name));
}

/* The numbers of a list, all of them. */
static size_t read_list(const json_t *list, double values[4]) {
    for (size_t i = 0; i < json_array_size(list); ++i) {
        values[i] = json_number_value(json_array_get(list, i));
    }
    return json_array_size(list);
}

/* The scene's buffer, from base 64. */
static uint8_t *read_buffer(const json_t *scene) {
    static const char head[] = "data:application/octet-stream;base64,";
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const json_t *buffer = json_array_get(json_object_get(scene, "buffers"), 0);
    const char *text = json_string_value(json_object_get(buffer, "uri"));
    assert_int_equal(strncmp(text, head, sizeof head - 1), 0);
    text += sizeof head - 1;
    uint8_t *bytes = malloc(strlen(text) + 1);
    size_t count = 0;
    assert_non_null(bytes);
    uint32_t held = 0;
    unsigned bits = 0;
    for (size_t i = 0; text[i] != '\0' && text[i] != '='; ++i) {
        held = held << 6 | (uint32_t)(strchr(digits, text[i]) - digits);
        bits += 6;
        if (bits >= 8) {
            bits -= 8;
            bytes[count++] = (uint8_t)(held >> bits);
        }
    }
    assert_int_equal(integer(buffer, "byteLength"), count);
    return bytes;
}

/* An accessor's numbers in the buffer, the number of items, and the numbers in an item. */
typedef struct {
    const float *numbers;
    size_t count, width;
} floats_t;

static floats_t floats_at(const json_t *scene, const uint8_t *buffer, json_int_t index) {
    const json_t *accessor = json_array_get(json_object_get(scene, "accessors"), (size_t)index);
    const json_t *view =
        json_array_get(json_object_get(scene, "bufferViews"), (size_t)integer(accessor, "bufferView"));
    const char *type = json_string_value(json_object_get(accessor, "type"));
    assert_int_equal(integer(accessor, "componentType"), 5126);
    return (floats_t){(const float *)(const void *)(buffer + integer(view, "byteOffset")),
                      (size_t)integer(accessor, "count"),
                      strcmp(type, "SCALAR") == 0 ? 1 : (size_t)(type[3] - '0')};
}

/* If there are bounds, they are the least and the greatest number. */
static void check_bounds(const json_t *scene, const uint8_t *buffer) {
    size_t bounded = 0;
    for (size_t a = 0; a < json_array_size(json_object_get(scene, "accessors")); ++a) {
        const json_t *accessor = json_array_get(json_object_get(scene, "accessors"), a);
        double low[4], high[4];
        const size_t width = read_list(json_object_get(accessor, "min"), low);
        assert_int_equal(read_list(json_object_get(accessor, "max"), high), width);
        if (width > 0) {
            const floats_t found = floats_at(scene, buffer, (json_int_t)a);
            bool low_is[4] = {false}, high_is[4] = {false};
            assert_int_equal(found.width, width);
            for (size_t i = 0; i < found.count * width; ++i) {
                const double value = (double)found.numbers[i];
                assert_true(value >= low[i % width] && value <= high[i % width]);
                low_is[i % width] = low_is[i % width] || value <= low[i % width];
                high_is[i % width] = high_is[i % width] || value >= high[i % width];
            }
            for (size_t c = 0; c < width; ++c) {
                assert_true(low_is[c] && high_is[c]);
            }
            ++bounded;
        }
    }
    assert_true(bounded > 10);
}

/* Triangles have valid vertices, and the normals at their corners point outwards. */
static void check_meshes(const json_t *scene, const uint8_t *buffer) {
    const json_t *accessors = json_object_get(scene, "accessors");
    const json_t *meshes = json_object_get(scene, "meshes");
    for (size_t m = 0; m < json_array_size(meshes); ++m) {
        const json_t *part = json_array_get(json_object_get(json_array_get(meshes, m), "primitives"), 0);
        const json_t *attributes = json_object_get(part, "attributes");
        const floats_t places = floats_at(scene, buffer, integer(attributes, "POSITION"));
        const floats_t normals = floats_at(scene, buffer, integer(attributes, "NORMAL"));
        const json_t *of = json_array_get(accessors, (size_t)integer(part, "indices"));
        const json_t *view =
            json_array_get(json_object_get(scene, "bufferViews"), (size_t)integer(of, "bufferView"));
        const uint16_t *indices = (const uint16_t *)(const void *)(buffer + integer(view, "byteOffset"));
        assert_int_equal(integer(of, "componentType"), 5123);
        assert_int_equal(integer(of, "count") % 3, 0);
        assert_int_equal(normals.count, places.count);
        for (size_t i = 0; i < (size_t)integer(of, "count"); i += 3) {
            wh_vec3_t p[3];
            for (size_t k = 0; k < 3; ++k) {
                assert_in_range(indices[i + k], 0, places.count - 1);
                const float *at = &places.numbers[3 * (size_t)indices[i + k]];
                p[k] = wh_vec3((double)at[0], (double)at[1], (double)at[2]);
            }
            const wh_vec3_t ab = wh_vec3_subtract(&p[1], &p[0]);
            const wh_vec3_t ac = wh_vec3_subtract(&p[2], &p[0]);
            const wh_vec3_t out =
                wh_vec3(ab.y * ac.z - ab.z * ac.y, ab.z * ac.x - ab.x * ac.z, ab.x * ac.y - ab.y * ac.x);
            for (size_t k = 0; k < 3; ++k) {
                const float *n = &normals.numbers[3 * (size_t)indices[i + k]];
                const wh_vec3_t normal = wh_vec3((double)n[0], (double)n[1], (double)n[2]);
                assert_near(wh_vec3_norm(&normal), 1, 1e-6);
                assert_true(wh_vec3_dot(&normal, &out) >= 0);
            }
        }
    }
}

/* A node's keyframes: item 0 of its channels is its place, item 1 its turn. */
typedef struct {
    floats_t times, values[2];
} keys_t;

static keys_t keys_of(const json_t *scene, const uint8_t *buffer, const char *name) {
    static const char *const paths[] = {"translation", "rotation"};
    const json_t *animation = json_array_get(json_object_get(scene, "animations"), 0);
    keys_t keys = {{NULL, 0, 0}, {{NULL, 0, 0}, {NULL, 0, 0}}};
    size_t i;
    json_t *channel;
    json_array_foreach(json_object_get(animation, "channels"), i, channel) {
        const json_t *target = json_object_get(channel, "target");
        const char *path = json_string_value(json_object_get(target, "path"));
        if ((size_t)integer(target, "node") == node_index(scene, name)) {
            const json_t *sampler =
                json_array_get(json_object_get(animation, "samplers"), (size_t)integer(channel, "sampler"));
            const size_t k = strcmp(path, paths[1]) == 0 ? 1 : 0;
            assert_string_equal(path, paths[k]);
            assert_string_equal(json_string_value(json_object_get(sampler, "interpolation")), "LINEAR");
            keys.times = floats_at(scene, buffer, integer(sampler, "input"));
            keys.values[k] = floats_at(scene, buffer, integer(sampler, "output"));
            assert_int_equal(keys.values[k].width, 3 + k);
            assert_int_equal(keys.values[k].count, keys.times.count);
        }
    }
    assert_true(keys.values[0].count > 1 && keys.values[1].count == keys.values[0].count);
    return keys;
}

/* The pose that a viewer shows at a slice. `k` is the last keyframe before it. */
static wh_pose_t shown_at(const keys_t *keys, int64_t n, size_t *k) {
    const float *times = keys->times.numbers;
    const double seconds = (double)n * (double)signals.layout->slice_us / 1e6;
    while (*k + 2 < keys->times.count && (double)times[*k + 1] <= seconds) {
        assert_true(times[*k + 1] > times[*k]);
        ++*k;
    }
    const double share =
        fmin(fmax((seconds - (double)times[*k]) / (double)(times[*k + 1] - times[*k]), 0), 1);
    double from[7], to[7], turn[4];
    for (size_t c = 0; c < 7; ++c) {
        const floats_t *of = &keys->values[c / 3 > 0 ? 1 : 0];
        const float *at = &of->numbers[*k * of->width + (c < 3 ? c : c - 3)];
        from[c] = (double)at[0];
        to[c] = (double)at[of->width];
    }
    wh_pose_t shown;
    shown.r =
        wh_vec3(1000 * (from[0] + share * (to[0] - from[0])), 1000 * (from[1] + share * (to[1] - from[1])),
                1000 * (from[2] + share * (to[2] - from[2])));
    wh_quaternion_slerp(from + 3, to + 3, share, turn);
    wh_quaternion_to_matrix(turn, &shown.R);
    return shown;
}

/* Grippers and wafers move as they did in the run. Places are floats in metres. */
static void check_animation(const json_t *scene, const uint8_t *buffer) {
    const keys_t gripper = keys_of(scene, buffer, "EE");
    const keys_t wafer = keys_of(scene, buffer, "Wafer 1");
    size_t at[2] = {0, 0};
    for (int64_t n = 1; n < (int64_t)slice_count; ++n) {
        const wh_pose_t shown = shown_at(&gripper, n, &at[0]);
        assert_pose(&shown, &slices[n].grippers[0], 0.15, 2e-3);
        const wh_pose_t lies = shown_at(&wafer, n, &at[1]);
        assert_pose(&lies, &slices[n].wafers[0], 0.3, 3e-3);
    }
}

static void check_still(const json_t *scene, const char *name, const wh_pose_t *pose) {
    const json_t *of = node(scene, name);
    double r[4], q[4];
    wh_pose_t shown;
    assert_int_equal(read_list(json_object_get(of, "translation"), r), 3);
    assert_int_equal(read_list(json_object_get(of, "rotation"), q), 4);
    shown.r = wh_vec3(1000 * r[0], 1000 * r[1], 1000 * r[2]);
    wh_quaternion_to_matrix(q, &shown.R);
    assert_pose(&shown, pose, 1e-9, 1e-9);
}

/* Before the first slice everything stands at its place, in a cell whose z is glTF's y. */
static void check_nodes(const json_t *scene) {
    const wh_layout_t *layout = signals.layout;
    wh_pose_t links[WH_SIGNALS_LINKS], cell;
    double q[4];
    for (size_t i = 0; i < layout->station_count; ++i) {
        char name[WH_NAME_SIZE + 16];
        (void)snprintf(name, sizeof name, "station %s", layout->stations[i].name);
        check_still(scene, name, &layout->places[i].base_from_station);
    }
    assert_true(wh_signals_links(&signals, signals.first, links));
    int32_t numbers[WH_SIGNALS_LINKS];
    for (size_t i = 0; i < wh_signals_link_bodies(layout, numbers); ++i) {
        char name[2 * WH_NAME_SIZE];
        wh_layout_name_body(layout, (size_t)numbers[i], "column", name, sizeof name);
        check_still(scene, name, &links[i]);
    }
    check_still(scene, "Wafer 2", &layout->start[1].base_from_wafer);
    assert_int_equal(read_list(json_object_get(node(scene, "cell"), "rotation"), q), 4);
    wh_quaternion_to_matrix(q, &cell.R);
    const wh_vec3_t up = wh_mat3_column(&cell.R, 2);
    assert_near(up.y, 1, 1e-12);
    assert_int_equal(json_array_size(json_object_get(node(scene, "cell"), "children")),
                     json_array_size(json_object_get(scene, "nodes")) - 1);
}

static void a_scene_is_made(void **state) {
    (void)state;
    static const char *const names[] = {"base", "station A", "station B", "station P",
                                        "lift", "upper arm", "forearm",   "hand",
                                        "EE",   "PA",        "Wafer 1",   "Wafer 2"};
    play("lua/examples/01_transfer.lua");
    json_t *still = wh_scene_make(&signals, "a run", false);
    json_t *moving = wh_scene_make(&signals, "a run", true);
    for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i) {
        assert_non_null(node(still, names[i]));
        assert_non_null(json_object_get(node(still, names[i]), "mesh"));
    }
    check_accessors(still);
    check_accessors(moving);
    assert_null(json_object_get(still, "animations"));
    const json_t *animation = json_array_get(json_object_get(moving, "animations"), 0);
    /* Lift, upper arm, forearm, hand, EE and two wafers, each in place and turn. */
    assert_int_equal(json_array_size(json_object_get(animation, "channels")), 14);
    uint8_t *buffer = read_buffer(moving);
    check_bounds(moving, buffer);
    check_meshes(moving, buffer);
    check_animation(moving, buffer);
    check_nodes(still);
    free(buffer);
    const json_t *place = json_object_get(node(still, "Wafer 1"), "translation");
    assert_near(json_number_value(json_array_get(place, 0)), 0.7, 1e-12);
    json_decref(still);
    json_decref(moving);
}

/* Whatever was in its place before, an asset begins empty; and only lists with entries are written. */
static void an_empty_scene(void **state) {
    (void)state;
    wh_gltf_t gltf;
    memset(&gltf, 0xff, sizeof gltf);
    wh_gltf_open(&gltf);
    assert_null(gltf.bytes);
    assert_int_equal(gltf.size, 0);
    assert_int_equal(gltf.capacity, 0);
    json_t *root = wh_gltf_finish(&gltf, "nothing", "a test");
    assert_int_equal(json_object_size(root), 4);
    assert_int_equal(json_array_size(json_object_get(root, "nodes")), 1);
    assert_int_equal(json_array_size(json_object_get(node(root, "cell"), "children")), 0);
    json_decref(root);
}

/* --------------------------------------------------------------------------------------------------- plots */

/* Rows of a block as they were written; `breaks` of a row that has a gap before it. */
typedef struct {
    int64_t slice;
    double values[WH_MEASURES + 1];
    bool breaks;
} row_t;

static row_t *rows_of(const wh_plot_curves_t *of, size_t columns, size_t *count) {
    const double slice_s = wh_signals_seconds(&signals, 1);
    wh_plot_t plot = {.has_rows = false};
    char *text = NULL;
    size_t size = 0;
    plot.data = open_memstream(&text, &size);
    assert_non_null(plot.data);
    assert_int_equal(wh_plot_curves(&plot, of, slice_s), 0);
    (void)fclose(plot.data);
    assert_string_equal(text + size - 3, "\n\n\n");
    text[size - 2] = '\0';
    row_t *rows = calloc(size, sizeof *rows);
    assert_non_null(rows);
    *count = 0;
    bool breaks = false;
    for (char *line = text; *line != '\0'; line += strcspn(line, "\n") + 1) {
        row_t *row = &rows[*count];
        char *c = line;
        if (*line == '\n') {
            assert_false(breaks || *count == 0);
            breaks = true;
            continue;
        }
        row->breaks = breaks;
        row->slice = (int64_t)llround(strtod(c, &c) / slice_s);
        for (size_t k = 0; k < columns; ++k) {
            row->values[k] = strtod(c, &c);
        }
        assert_int_equal(*c, '\n');
        breaks = false;
        ++*count;
    }
    free(text);
    return rows;
}

/* The distance of a straight line between two rows from the curve. */
static double off_line(const wh_path_t *curve, const row_t *from, const row_t *to) {
    double off = 0;
    for (int64_t n = from->slice; n <= to->slice; ++n) {
        const double share = (double)(n - from->slice) / (double)(to->slice - from->slice);
        const double line = from->values[0] + share * (to->values[0] - from->values[0]);
        off = fmax(off, fabs(line - wh_path_read(curve, n, NULL)));
    }
    return off;
}

/* Lines between rows are within the curve's tolerance, apart from rows at whole slices. If six or
 * more rows are in one cubic, all but its two ends are needed. Returns how many cubics have so
 * many. */
static size_t check_rows(const wh_path_t *curve) {
    const wh_points_t *points = &curve->list;
    const wh_plot_curves_t of = {{curve}, 1, 1, false, NULL};
    size_t count = 0, cut = 0, i = 0;
    row_t *rows = rows_of(&of, 1, &count);
    assert_int_equal(rows[0].slice, points->points[0].slice);
    for (size_t p = 0; p + 1 < points->count; ++p) {
        size_t end = i;
        while (end < count && rows[end].slice < points->points[p + 1].slice) {
            ++end;
        }
        assert_true(end < count && rows[end].slice == points->points[p + 1].slice);
        const double length = (double)(rows[end].slice - rows[i].slice) / (double)(end - i);
        const double most = points->tolerance * (length + 1) * (length + 1) / (length * length);
        if (end - i >= 6 && length > 4) {
            assert_true(off_line(curve, &rows[i], &rows[i + 2]) > points->tolerance ||
                        off_line(curve, &rows[end - 2], &rows[end]) > points->tolerance);
            ++cut;
        }
        for (; i < end; ++i) {
            assert_true(rows[i + 1].slice > rows[i].slice);
            assert_true(off_line(curve, &rows[i], &rows[i + 1]) < most + 1e-6);
        }
    }
    assert_int_equal(i, count - 1);
    free(rows);
    return cut;
}

/* For speeds each row is the slope there. */
static void check_slopes(const wh_path_t *curve) {
    const wh_plot_curves_t of = {{curve}, 1, 0.5, true, NULL};
    size_t count = 0;
    row_t *rows = rows_of(&of, 1, &count);
    for (size_t i = 0; i < count; ++i) {
        double slope;
        (void)wh_path_read(curve, rows[i].slice, &slope);
        const double speed = 2 * slope / wh_signals_seconds(&signals, 1);
        assert_near(rows[i].values[0], speed, 1e-8 * fmax(fabs(speed), 1));
    }
    free(rows);
}

/* Each row contains the curves' values, and the wafer against which they are measured. If that is
 * another wafer, or there was none before, there is a gap. */
static void check_measured_rows(size_t gripper) {
    const wh_path_t *curves = signals.proximity[gripper];
    const wh_steps_t *nearest = &signals.nearest[gripper];
    const wh_plot_curves_t of = {{&curves[0], &curves[1], &curves[2]}, 3, 1, false, nearest};
    size_t count = 0, gaps = 0;
    row_t *rows = rows_of(&of, 4, &count);
    for (size_t i = 0; i < count; ++i) {
        const int64_t slice = rows[i].slice;
        for (size_t m = 0; m < WH_MEASURES; ++m) {
            const double value = wh_path_read(&curves[m], slice, NULL);
            assert_near(rows[i].values[m], value, 1e-8 * fmax(fabs(value), 1e-3));
        }
        assert_int_equal(rows[i].values[3], step_at(nearest, slice));
        if (i > 0) {
            bool breaks = false;
            for (int64_t n = rows[i - 1].slice; n <= slice; ++n) {
                breaks = breaks || step_at(nearest, n) != (int32_t)rows[i].values[3];
            }
            assert_int_equal(rows[i].breaks, breaks);
            gaps += breaks ? 1 : 0;
        }
    }
    assert_true(gaps > 0);
    free(rows);
}

static void plots_have_rows_of_the_curves(void **state) {
    (void)state;
    size_t cut = 0;
    play("lua/examples/02_prealigner.lua");
    for (size_t axis = 0; axis < signals.axis_count; ++axis) {
        cut += check_rows(&signals.axes[axis]);
        check_slopes(&signals.axes[axis]);
    }
    for (size_t g = 0; g < signals.layout->machine.gripper_count; ++g) {
        check_measured_rows(g);
    }
    assert_true(cut > 20);
}

/* ------------------------------------------------------------------------------------------------- document */

static json_t *document_of(const wh_document_t *document) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    assert_int_equal(wh_document_write(document, out), 0);
    (void)fclose(out);
    assert_null(strchr(text, '<'));
    json_error_t error;
    json_t *read = json_loads(text, 0, &error);
    assert_non_null(read);
    free(text);
    return read;
}

static double number_at(const json_t *object, const char *key, size_t i) {
    return json_number_value(json_array_get(json_object_get(object, key), i));
}

static void a_document_is_made(void **state) {
    (void)state;
    static const char *const parameters[] = {"a=1", "b=x=</script>"};
    play("lua/examples/01_transfer.lua");
    json_t *object = json_pack("{s:s}", "script", "</script><!--");
    const wh_document_t document = {.title = "a </title>",
                                    .reproduce = "waferhand run",
                                    .source = "run",
                                    .parameters = parameters,
                                    .parameter_count = 2,
                                    .run = object,
                                    .record = &run.record,
                                    .signals = &signals};
    json_t *read = document_of(&document);
    assert_int_equal(integer(read, "format"), 2);
    assert_string_equal(json_string_value(json_object_get(read, "title")), "a </title>");
    assert_string_equal(json_string_value(json_object_get(json_object_get(read, "parameters"), "b")),
                        "x=</script>");
    assert_true(json_equal(json_object_get(read, "run"), object));
    assert_int_equal(json_array_size(json_object_get(read, "slots")), 51);
    const json_t *tracks = json_object_get(read, "tracks");
    assert_int_equal(
        json_array_size(json_object_get(json_array_get(json_object_get(tracks, "grippers"), 0), "t")), 0);
    const json_t *axis = json_array_get(json_object_get(tracks, "axes"), WH_AXIS_R);
    const wh_path_t *curve = &signals.axes[WH_AXIS_R];
    assert_int_equal(json_array_size(json_object_get(axis, "t")), curve->list.count);
    assert_int_equal(json_array_size(json_object_get(axis, "v")), curve->list.count);
    assert_int_equal(json_array_size(json_object_get(axis, "slope")), curve->list.count);
    for (size_t i = 0; i < curve->list.count; ++i) {
        const wh_point_t *point = &curve->list.points[i];
        assert_near(number_at(axis, "t", i), (double)point->slice / 1e3, 1e-9);
        assert_near(number_at(axis, "v", i), wh_path_value(curve, i), point->exact ? 0 : 1e-4);
        assert_near(number_at(axis, "slope", i), wh_path_slope(curve, i) * 1e3, 1e-3);
    }
    const json_t *machine = json_object_get(read, "machine");
    const json_t *chuck = json_array_get(json_object_get(machine, "grippers"), 1);
    assert_int_equal(integer(chuck, "axis"), 4);
    assert_near(number_at(chuck, "r", 0), -600, 1e-12);
    json_decref(read);
    json_decref(object);
}

/* ---------------------------------------------------------------------------------------------------- scans */

static wh_edge_point_t samples[4000];

/* The estimate's text for the only scan. */
static wh_scan_words_t words_as(const wh_edge_scan_t *scan, const char *command, wh_align_result_t *result) {
    wh_scan_words_t words;
    const wh_edge_wish_t wish = wh_edge_wish_of(command);
    assert_true((size_t)scan->taken <= sizeof samples / sizeof *samples);
    const wh_status_t status = wh_edge_scan_estimate(scan, signals.layout, wish, samples, result);
    wh_edge_scan_words(scan, status, result, &words);
    return words;
}

static wh_scan_words_t words_of(const wh_edge_scan_t *scan, wh_align_result_t *result) {
    return words_as(scan, NULL, result);
}

/* In the layout the wafer is at (1.5, -0.8), turned by 37 degrees, with the radius 150.025. */
static void an_edge_scan(void **state) {
    (void)state;
    play("lua/examples/09_edge_scan.lua");
    assert_int_equal(signals.scans.count, 1);
    assert_int_equal(signals.scans.left_out, 0);
    const wh_edge_scan_t *scan = &signals.scans.list[0];
    assert_int_equal(scan->number, 1);
    assert_int_equal(scan->gripper, 1);
    assert_int_equal(scan->taken, 3600);
    assert_int_equal(scan->missed, 0);
    assert_true(scan->first_slice > 4000 && scan->last_slice > scan->first_slice + 1000);
    wh_align_result_t result;
    const wh_scan_words_t words = words_of(scan, &result);
    assert_true(words.is_sure);
    assert_string_equal(words.lines[0], "sure");
    assert_near(result.circle.x, 1.5, 1e-3);
    assert_near(result.circle.y, -0.8, 1e-3);
    assert_near(result.turn, wh_rad_from_deg(37), 1e-4);
    assert_memory_equal(words.lines[1], "centre: 1.", strlen("centre: 1."));
    assert_memory_equal(words.lines[2], "notch: towards 3", strlen("notch: towards 3"));
    size_t counting = 0;
    for (int32_t i = 0; i < scan->taken; ++i) {
        const wh_edge_point_t *sample = &samples[i];
        const double rho =
            wh_circle_radius(&result.circle, 0, cos(sample->angle), sin(sample->angle)) + sample->residual;
        assert_near(sample->radius, rho, 1e-9);
        counting += sample->counts ? 1 : 0;
    }
    assert_int_equal(counting, result.circle.used);
}

/* A scan uses the wafer's data that its ALIGN had: glass, and a mark that is not looked for. */
static void a_scan_is_told_as_its_command_has_the_wafer(void **state) {
    (void)state;
    play("lua/examples/09_edge_scan.lua");
    wh_align_result_t result;
    const wh_edge_scan_t *scan = &signals.scans.list[0];
    const wh_scan_words_t round = words_as(scan, "ALIGN P mark=none correct=false", &result);
    assert_true(round.is_sure && result.mark == WH_ALIGN_MARK_NONE);
    assert_string_equal(round.lines[2], "notch or flat: not looked for");
    assert_true(words_as(scan, "ALIGN P 90 glass=0.25", &result).is_sure &&
                result.mark == WH_ALIGN_MARK_NOTCH);
    assert_near(wh_edge_wish_of("ALIGN P 90 glass=0.25").glass, 0.25, 0);
    assert_near(wh_edge_wish_of("ALIGN P 90").glass, 0, 0);
    char get[] = "GET A 1", align[] = "ALIGN P 0 mark=none";
    wh_command_record_t commands[] = {{.text = get, .begin_s = 0}, {.text = align, .begin_s = 2}};
    const wh_record_t record = {.commands = commands, .command_count = 2};
    assert_true(!wh_edge_wish_at(&record, 1.9).without_mark && wh_edge_wish_at(&record, 2.5).without_mark);
}

/* At the notch's angle, samples are deepest below the circle. */
static void the_mark_is_where_the_notch_is_seen(void **state) {
    (void)state;
    play("lua/examples/09_edge_scan.lua");
    wh_align_result_t result;
    (void)words_of(&signals.scans.list[0], &result);
    size_t deepest = 0;
    for (size_t i = 0; i < 3600; ++i) {
        deepest = samples[i].residual < samples[deepest].residual ? i : deepest;
    }
    assert_near(wh_edge_scan_mark_at(&result), samples[deepest].angle, 2 * WH_PI / 3600);
}

/* A scan of `seen` samples of a round wafer without a notch, then `gap` samples that never came,
 * then one more. */
static void hear_scan(uint32_t number, int32_t seen, int32_t gap) {
    const int32_t all = seen + gap + 1;
    wh_scan_t scan = {.number = number, .armed = true, .gripper = 1, .count = 3600};
    for (int64_t slice = 1; scan.taken < all; ++slice) {
        scan.taken += scan.taken == seen ? gap + 1 : 1;
        scan.sample_count = 1;
        scan.samples[0] = 2000;
        wh_edge_scans_hear(&signals.scans, slice, &scan);
        wh_edge_scans_hear(&signals.scans, slice, &scan); /* a repeated one adds nothing */
    }
}

static void samples_that_never_came_are_counted(void **state) {
    (void)state;
    play("lua/examples/09_edge_scan.lua");
    hear_scan(2, 100, 7);
    assert_int_equal(signals.scans.count, 2);
    const wh_edge_scan_t *scan = &signals.scans.list[1];
    assert_int_equal(scan->taken, 108);
    assert_int_equal(scan->missed, 7);
    for (int32_t i = 0; i < scan->taken; ++i) {
        assert_int_equal(scan->samples[i], i >= 100 && i < 107 ? WH_NONE : 2000);
    }
    wh_align_result_t result;
    const wh_scan_words_t words = words_of(scan, &result);
    assert_false(words.is_sure);
    assert_string_equal(words.lines[0],
                        "no estimate: no scan: NaN, angles out of order, or all the same (77 BAD_SCAN)");
    assert_string_equal(words.lines[1], "centre: not told");
    assert_string_equal(words.lines[4], "samples: 108 of 3600 taken, 7 of them missing");
    assert_true(isnan(samples[103].radius) && !isnan(samples[99].radius) && isnan(samples[99].residual));
}

/* Samples of the true scan without those of an arc: the centre may be sure, the notch is not. */
static void what_is_not_sure_says_so(void **state) {
    (void)state;
    play("lua/examples/09_edge_scan.lua");
    wh_edge_scan_t *scan = &signals.scans.list[0];
    const int32_t notch = 3600 - 370; /* 37 degrees: the chuck turns, the sensor stands */
    for (int32_t i = notch - 100; i < notch + 100; ++i) {
        scan->samples[(i - (int32_t)scan->first % 3600 + 3600) % 3600] = WH_NONE;
        ++scan->missed;
    }
    wh_align_result_t result;
    const wh_scan_words_t words = words_of(scan, &result);
    assert_int_equal(result.verdict, WH_STATUS_NOTCH_NOT_SURE);
    assert_false(words.is_sure);
    assert_string_equal(words.lines[0],
                        "not sure: the scan does not tell the notch or flat (76 NOTCH_NOT_SURE)");
    assert_memory_equal(words.lines[1], "centre: 1.", strlen("centre: 1."));
    assert_string_equal(words.lines[2], "notch or flat: not told");
    assert_non_null(strstr(words.lines[4], "200 of them missing"));
}

/* Scans beyond a run's capacity are counted, and none of them is stored in part. */
static void scans_beyond_the_limit_are_counted(void **state) {
    (void)state;
    wh_scan_t scan = {.gripper = 1, .count = -WH_SENSOR_SAMPLES};
    for (scan.number = 1; scan.number <= 20; ++scan.number) {
        wh_edge_scans_hear(&signals.scans, scan.number, &scan);
    }
    assert_int_equal(signals.scans.count, WH_SCANS_SAMPLES / WH_SENSOR_SAMPLES);
    assert_int_equal(signals.scans.left_out, 20 - WH_SCANS_SAMPLES / WH_SENSOR_SAMPLES);
    wh_edge_scans_close(&signals.scans);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(transfer, close_run),
        cmocka_unit_test_teardown(prealigner, close_run),
        cmocka_unit_test_teardown(missed_pick, close_run),
        cmocka_unit_test_teardown(vacuum_that_leaks, close_run),
        cmocka_unit_test_teardown(carriers_are_no_faults, close_run),
        cmocka_unit_test_teardown(a_fault_is_marked, close_run),
        cmocka_unit_test_teardown(a_gripper_that_is_elsewhere, close_run),
        cmocka_unit_test_teardown(a_near_miss_is_told_late, close_run),
        cmocka_unit_test_teardown(a_scene_is_made, close_run),
        cmocka_unit_test(an_empty_scene),
        cmocka_unit_test_teardown(plots_have_rows_of_the_curves, close_run),
        cmocka_unit_test_teardown(a_document_is_made, close_run),
        cmocka_unit_test_teardown(an_edge_scan, close_run),
        cmocka_unit_test_teardown(a_scan_is_told_as_its_command_has_the_wafer, close_run),
        cmocka_unit_test_teardown(the_mark_is_where_the_notch_is_seen, close_run),
        cmocka_unit_test_teardown(samples_that_never_came_are_counted, close_run),
        cmocka_unit_test_teardown(what_is_not_sure_says_so, close_run),
        cmocka_unit_test(scans_beyond_the_limit_are_counted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
