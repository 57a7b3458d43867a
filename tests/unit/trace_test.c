/* What a report shows of a run against the run itself, slice by slice; and its scene against glTF's rules. */
#include "support.h"

#include <jansson.h>

#include "report/document.h"
#include "report/quaternion.h"
#include "report/scene.h"
#include "script/run.h"

/* A slice as it was. */
typedef struct {
    wh_pose_t grippers[WH_GRIPPERS];
    wh_pose_t wafers[4];
    double axes[WH_AXES], levels[WH_GRIPPERS];
    int32_t valves[WH_GRIPPERS], holders[4];
    uint32_t sensors;
    bool is_exact;
} slice_t;

static wh_run_t run;
static wh_trace_t trace;
static slice_t *slices; /* by number, 0 not used */
static size_t slice_count, slice_capacity;

static void on_slice(void *user, const wh_mcs_t *mcs) {
    (void)user;
    const wh_state_t *state = &mcs->state;
    if (!trace.layout) {
        wh_trace_begin(&trace, mcs->layout, true);
    }
    wh_trace_slice(&trace, mcs->command.axes, mcs->command.axis_count, state);
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
        kept->valves[g] = state->condition->told[g];
        kept->levels[g] = state->condition->vacuum[g].level;
    }
    for (size_t w = 0; w < state->wafer_count && w < 4; ++w) {
        kept->wafers[w] = state->wafers[w].base_from_wafer;
        kept->holders[w] = state->wafers[w].holder;
    }
    memcpy(kept->axes, mcs->command.axes, sizeof kept->axes);
    kept->sensors = state->sensors;
    kept->is_exact = state->event_count > 0;
}

static void on_boundary(void *user, const wh_mcs_t *mcs) {
    (void)user;
    (void)mcs;
    wh_trace_mark(&trace);
    if (slice_count > 0) {
        slices[slice_count - 1].is_exact = true;
    }
}

static void play(const char *script) {
    const wh_run_options_t options = {
        .script = script, .limits = {.print_to = stderr}, .listener = {on_slice, on_boundary, NULL}};
    slice_count = 0;
    assert_int_not_equal(wh_run_script(&run, &options), WH_RUN_BAD_INPUT);
    wh_trace_finish(&trace);
    assert_true(slice_count > 1000);
    assert_int_equal(trace.last, slice_count - 1);
}

static int close_run(void **state) {
    (void)state;
    wh_trace_close(&trace);
    wh_run_close(&run);
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

static wh_pose_t read_pose(const wh_thin_t *thin, int64_t slice) {
    double values[7];
    wh_pose_t pose;
    wh_thin_read(thin, slice, values);
    pose.r = wh_vec3(values[0], values[1], values[2]);
    wh_quaternion_to_matrix(values + 3, &pose.R);
    return pose;
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
    for (size_t i = 0; i < trace.stay_count && trace.stays[i].slice <= slice; ++i) {
        found = trace.stays[i].wafer == wafer ? &trace.stays[i] : found;
    }
    return found;
}

static void check_gripper(size_t g, int64_t n) {
    const slice_t *was = &slices[n];
    const double factor = was->is_exact ? 0 : 1;
    const wh_thin_t *thin = &trace.grippers[g];
    const wh_pose_t shown = read_pose(thin, n);
    double level;
    assert_pose(&shown, &was->grippers[g], factor * thin->tolerance + 1e-12, factor * thin->turn);
    wh_thin_read(&trace.vacuum[g], n, &level);
    assert_near(level, was->levels[g], factor * WH_TRACE_VACUUM);
    assert_int_equal(step_at(&trace.valves[g], n), was->valves[g]);
    assert_int_equal(step_at(&trace.sensors[g], n), was->sensors >> g & 1U);
}

/* Held, a wafer is where its gripper shows it: a way out from the gripper's origin its turn counts, too. */
static void check_wafer(int32_t w, int64_t n) {
    const slice_t *was = &slices[n];
    const wh_stay_t *stay = stay_at(w, n);
    assert_int_equal(stay->holder, was->holders[w]);
    if (stay->holder == WH_NONE) {
        assert_memory_equal(&stay->pose, &was->wafers[w], sizeof stay->pose);
        return;
    }
    const wh_thin_t *thin = &trace.grippers[stay->holder];
    const wh_pose_t gripper = read_pose(thin, n);
    const wh_pose_t shown = wh_pose_compose(&gripper, &stay->pose);
    const double mm = thin->tolerance + thin->turn * wh_vec3_norm(&stay->pose.r);
    assert_pose(&shown, &was->wafers[w], was->is_exact ? 1e-9 : mm, was->is_exact ? 0 : thin->turn);
}

static void check_axes(int64_t n) {
    for (size_t axis = 0; axis < trace.axis_count; ++axis) {
        const double factor = slices[n].is_exact ? 0 : 1;
        const double seconds = (double)trace.layout->slice_us / 1e6;
        double value, speed;
        wh_thin_read(&trace.axes[axis], n, &value);
        wh_thin_read(&trace.speeds[axis], n, &speed);
        assert_near(value, slices[n].axes[axis], factor * trace.axes[axis].tolerance);
        if (n > 1) {
            assert_near(speed, (slices[n].axes[axis] - slices[n - 1].axes[axis]) / seconds,
                        factor * trace.speeds[axis].tolerance + 1e-9);
        }
    }
}

static void check_all(void) {
    const wh_layout_t *layout = trace.layout;
    for (int64_t n = 1; n < (int64_t)slice_count; ++n) {
        for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
            check_gripper(g, n);
        }
        for (size_t w = 0; w < layout->wafer_count && w < 4; ++w) {
            check_wafer((int32_t)w, n);
        }
        check_axes(n);
    }
}

/* What the plots of (3) to (5) say at an event is what the event says. */
static void check_events(size_t expected) {
    size_t measured = 0;
    for (size_t i = 0; i < run.record.event_count; ++i) {
        const wh_event_t *event = &run.record.events[i].event;
        const bool taken = event->kind == WH_EVENT_PICKED || event->kind == WH_EVENT_NEAR_MISS ||
                           event->kind == WH_EVENT_HANDED_OVER;
        if (taken) {
            double values[3];
            wh_thin_read(&trace.proximity[event->gripper], (int64_t)event->measured_slice, values);
            assert_near(values[0], fabs(event->measured.dr_proj_z), 0);
            assert_near(values[1], WH_TRACE_PROJXY_SCALE * event->measured.dr_proj_xy_norm, 0);
            assert_near(values[2], WH_TRACE_PLANAR_SCALE * event->measured.n1_proj_n2, 0);
            ++measured;
        }
    }
    assert_int_equal(measured, expected);
}

static void test_transfer(void **state) {
    (void)state;
    play("lua/examples/01_transfer.lua");
    check_all();
    check_events(2);
    assert_int_equal(trace.mark_count, 0);
}

static void test_prealigner(void **state) {
    (void)state;
    play("lua/examples/02_prealigner.lua");
    check_all();
    check_events(5);
}

static void test_missed_pick(void **state) {
    (void)state;
    play("lua/examples/03_missed_pick.lua");
    check_all();
    check_events(2);
    assert_int_equal(trace.mark_count, 1);
    assert_int_equal(trace.marks[0].event.kind, WH_EVENT_NEAR_MISS);
    assert_true(trace.marks[0].has_place);
}

static void test_vacuum_that_leaks(void **state) {
    (void)state;
    play("lua/examples/05_leak.lua");
    check_all();
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

static const json_t *node(const json_t *scene, const char *name) {
    size_t i;
    json_t *found;
    json_array_foreach(json_object_get(scene, "nodes"), i, found) {
        if (strcmp(json_string_value(json_object_get(found, "name")), name) == 0) {
            return found;
        }
    }
    return NULL;
}

static void test_scene(void **state) {
    (void)state;
    static const char *const names[] = {"base", "station A", "station B", "station P",
                                        "lift", "upper arm", "forearm",   "hand",
                                        "EE",   "PA",        "Wafer 1",   "Wafer 2"};
    play("lua/examples/01_transfer.lua");
    json_t *still = wh_scene_make(&trace, "a run", false);
    json_t *moving = wh_scene_make(&trace, "a run", true);
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
    const json_t *place = json_object_get(node(still, "Wafer 1"), "translation");
    assert_near(json_number_value(json_array_get(place, 0)), 0.7, 1e-12);
    json_decref(still);
    json_decref(moving);
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

static void test_document(void **state) {
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
                                    .trace = &trace};
    json_t *read = document_of(&document);
    assert_int_equal(integer(read, "format"), 1);
    assert_string_equal(json_string_value(json_object_get(read, "title")), "a </title>");
    assert_string_equal(json_string_value(json_object_get(json_object_get(read, "parameters"), "b")),
                        "x=</script>");
    assert_true(json_equal(json_object_get(read, "run"), object));
    assert_int_equal(json_array_size(json_object_get(read, "slots")), 51);
    const json_t *tracks = json_object_get(read, "tracks");
    const json_t *gripper = json_array_get(json_object_get(tracks, "grippers"), 0);
    const size_t points = json_array_size(json_object_get(gripper, "t"));
    assert_int_equal(points, trace.grippers[0].count);
    assert_int_equal(json_array_size(json_object_get(gripper, "r")), 3 * points);
    assert_int_equal(json_array_size(json_object_get(gripper, "q")), 4 * points);
    for (size_t i = 0; i < points; ++i) {
        const wh_thin_point_t *point = &trace.grippers[0].points[i];
        const double x = json_number_value(json_array_get(json_object_get(gripper, "r"), 3 * i));
        assert_near(x, point->values[0], point->exact ? 0 : 1e-4);
    }
    json_decref(read);
    json_decref(object);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(test_transfer, close_run),
        cmocka_unit_test_teardown(test_prealigner, close_run),
        cmocka_unit_test_teardown(test_missed_pick, close_run),
        cmocka_unit_test_teardown(test_vacuum_that_leaks, close_run),
        cmocka_unit_test_teardown(test_scene, close_run),
        cmocka_unit_test_teardown(test_document, close_run),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
