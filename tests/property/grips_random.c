/* A table of mixed grips beside a slow, obvious model of the rules of grips.h: random steps,
 * compared after each. No wafer is held twice, none vanishes, and none is supported and carried at
 * once. With only vacuum and only backs it has the bits of wh_grasp_step. WH_GRIPS_STEPS is the
 * number of steps with mixed grips; 200,000 without it. */
#include "grasp/grips.h"
#include "grasp/passive.h"
#include "support/pose.h"

enum { WAFERS = 3, GRIPPERS = 3, SUPPORTS = 2, STEPS = 100 };

#define THICKNESS WH_REAL(0.775)

/* The values that do not change in a run. */
typedef struct {
    wh_grasp_config_t config;
    wh_grip_t grips[GRIPPERS];
    wh_edge_wafer_t shapes[WAFERS];
    wh_pose_t supports[SUPPORTS];
    double dt;
} world_t;

/* The rules, one by one as the header states them. */
typedef struct {
    wh_pose_t wafer[WAFERS], gripper[GRIPPERS], grasp[GRIPPERS];
    int holder[WAFERS], let_go_by[WAFERS], began_with[GRIPPERS], meets[GRIPPERS];
    wh_grip_phase_t phase[GRIPPERS];
    double s[GRIPPERS];
    wh_edge_wafer_t lying[GRIPPERS];
    wh_pose_t lay[GRIPPERS]; /* the grasp when the plunger began to move */
    int steps, picked, handed_over, released;
} model_t;

static int holds(const model_t *m, int g) {
    for (int w = 0; w < WAFERS; ++w) {
        if (m->holder[w] == g) {
            return w;
        }
    }
    return -1;
}

static void give(model_t *m, int g, int w) {
    *(m->let_go_by[w] >= 0 ? &m->handed_over : &m->picked) += 1;
    m->holder[w] = g;
}

static void let_go(model_t *m, int g, int w) {
    m->holder[w] = -1;
    m->let_go_by[w] = g;
}

static wh_pose_t carried(const model_t *m, const wh_gripper_input_t *input, int g) {
    wh_pose_t pose = wh_pose_compose(&input[g].base_from_gripper, &m->grasp[g]);
    if (!wh_mat3_is_orthonormal(&pose.R)) {
        wh_mat3_orthonormalise(&pose.R);
    }
    return pose;
}

static wh_pose_t seen_by(const wh_pose_t *wafer, const wh_pose_t *gripper) {
    wh_pose_t face;
    wh_face_frame(wafer, THICKNESS, wh_face_towards(wafer, gripper), &face);
    const wh_vec3_t centre = wh_face_centre(wafer, THICKNESS, gripper);
    assert_memory_equal(&centre, &face.r, sizeof centre);
    return face;
}

static void plunger_back(const world_t *world, model_t *m, int g) {
    m->s[g] = fmax(m->s[g] - world->grips[g].edge.speed * world->dt, world->grips[g].edge.retracted);
    m->phase[g] = m->s[g] > world->grips[g].edge.retracted ? WH_GRIP_OPENING : WH_GRIP_OPEN;
    m->meets[g] = -1;
}

static void plunger_on(const world_t *world, model_t *m, int g) {
    const wh_edge_t *edge = &world->grips[g].edge;
    wh_edge_place_t place;
    assert_int_equal(
        wh_edge_at(edge, m->meets[g] < 0 ? NULL : &m->lying[g], m->s[g] + edge->speed * world->dt, &place),
        WH_OK);
    m->s[g] = place.s;
    if (place.held) {
        m->phase[g] = WH_GRIP_CLOSED;
    } else if (place.phase == WH_EDGE_SEATED || place.phase == WH_EDGE_JAMMED || place.s >= edge->end) {
        m->phase[g] = place.s > edge->gripped_to ? WH_GRIP_MISSED : WH_GRIP_JAMMED;
    }
    if (holds(m, g) >= 0) {
        m->grasp[g].r.x = m->lay[g].r.x + (wh_real_t)(place.x - m->lying[g].x);
        m->grasp[g].r.y = m->lay[g].r.y + (wh_real_t)(place.y - m->lying[g].y);
    }
}

static wh_passive_wafer_t ask_passive(const world_t *world, const model_t *m, const wh_gripper_input_t *input,
                                      int g, int w, int support, wh_passive_change_t *change) {
    const wh_passive_t rules = {world->config.tolerance, world->config.check, THICKNESS};
    wh_passive_wafer_t wafer = {m->wafer[w], wh_pose_identity(), m->holder[w] == g};
    if (wafer.carried) {
        wafer.gripper_from_wafer = m->grasp[g];
    }
    assert_int_equal(wh_passive_step(&rules, m->steps == 1 ? &input[g].base_from_gripper : &m->gripper[g],
                                     &input[g].base_from_gripper,
                                     support < 0 ? NULL : &world->supports[support], &wafer, change),
                     WH_OK);
    return wafer;
}

static void model_plunger(const world_t *world, model_t *m, int g, bool closed) {
    if (closed || m->phase[g] == WH_GRIP_OPENING) {
        plunger_back(world, m, g);
    } else if (m->phase[g] == WH_GRIP_CLOSING) {
        plunger_on(world, m, g);
    }
}

/* True if a support takes over the wafer. */
static bool model_leave(const world_t *world, model_t *m, const wh_gripper_input_t *input, int g, int w) {
    for (int s = 0; s < SUPPORTS; ++s) {
        wh_passive_change_t change;
        const wh_passive_wafer_t after = ask_passive(world, m, input, g, w, s, &change);
        if (change == WH_PASSIVE_LEFT) {
            m->wafer[w] = after.base_from_wafer;
            let_go(m, g, w);
            return true;
        }
    }
    return false;
}

static void model_move(const world_t *world, model_t *m, const wh_gripper_input_t *input, int g) {
    const wh_grip_kind_t kind = world->grips[g].kind;
    const int w = holds(m, g);
    const bool closed = input[g].valve == WH_VALVE_CLOSED;
    if (kind == WH_GRIP_EDGE) {
        model_plunger(world, m, g, closed);
    }
    if (w >= 0 && !(kind == WH_GRIP_PASSIVE && model_leave(world, m, input, g, w))) {
        m->wafer[w] = carried(m, input, g);
        if (kind == WH_GRIP_EDGE ? m->phase[g] != WH_GRIP_CLOSING && m->phase[g] != WH_GRIP_CLOSED
                                 : kind == WH_GRIP_VACUUM && closed) {
            let_go(m, g, w);
        }
    }
}

/* The pose of a wafer on the gripper. */
static wh_edge_wafer_t lying_on(const world_t *world, const model_t *m, const wh_pose_t *gripper, int w) {
    wh_edge_wafer_t lying = world->shapes[w];
    const wh_pose_t seen = seen_by(&m->wafer[w], gripper);
    const wh_pose_t on_blade = wh_pose_relative(gripper, &seen);
    const wh_pose_t own = wh_pose_relative(gripper, &m->wafer[w]);
    const double x = (double)own.R.m[0][0] * lying.notch_x + (double)own.R.m[0][1] * lying.notch_y;
    const double y = (double)own.R.m[1][0] * lying.notch_x + (double)own.R.m[1][1] * lying.notch_y;
    lying.notch_x = x / sqrt(x * x + y * y);
    lying.notch_y = y / sqrt(x * x + y * y);
    lying.x = (double)on_blade.r.x;
    lying.y = (double)on_blade.r.y;
    return lying;
}

static bool edge_finds(const wh_proximity_t *p, const wh_edge_wafer_t *lying) {
    return p->margin_projz > 0 && p->margin_planar > 0 && fabs(lying->x) <= 50 && fabs(lying->y) <= 50;
}

/* The wafer that vacuum, or an edge grip, finds: the nearest free one. For an edge grip, the pose
 * in which it finds the wafer is kept. */
static int find(const world_t *world, model_t *m, const wh_pose_t *gripper, int g) {
    int best = -1;
    double least = 0;
    for (int w = 0; w < WAFERS; ++w) {
        wh_face_t face;
        wh_proximity_t p;
        assert_int_equal(
            wh_face_measure(&m->wafer[w], THICKNESS, gripper, &world->config.tolerance, &face, &p), WH_OK);
        const bool is_edge = world->grips[g].kind == WH_GRIP_EDGE;
        const wh_edge_wafer_t lying = is_edge ? lying_on(world, m, gripper, w) : world->shapes[w];
        const bool found = m->holder[w] < 0 && (is_edge ? edge_finds(&p, &lying) : p.ready);
        const double distance = fabs((double)p.dr_proj_z);
        if (found && (best < 0 || distance < least)) {
            best = w;
            least = distance;
            m->lying[g] = lying;
        }
    }
    return best;
}

static void pick_vacuum(const world_t *world, model_t *m, const wh_pose_t *gripper, int g) {
    const int w = find(world, m, gripper, g);
    if (w >= 0) {
        const wh_face_t face = wh_face_towards(&m->wafer[w], gripper);
        const wh_pose_t seen = seen_by(&m->wafer[w], gripper);
        wh_pose_t by_face = wh_pose_relative(gripper, &seen);
        wh_mat3_orthonormalise(&by_face.R);
        wh_face_frame(&by_face, THICKNESS, face, &m->grasp[g]);
        give(m, g, w);
    }
}

static void pick_edge(const world_t *world, model_t *m, const wh_pose_t *gripper, int g) {
    const int w = m->meets[g] = find(world, m, gripper, g);
    m->phase[g] = WH_GRIP_CLOSING;
    if (w >= 0 && sqrt(m->lying[g].x * m->lying[g].x + m->lying[g].y * m->lying[g].y) <=
                      world->grips[g].edge.clearance) {
        m->grasp[g] = wh_pose_relative(gripper, &m->wafer[w]);
        wh_mat3_orthonormalise(&m->grasp[g].R);
        m->lay[g] = m->grasp[g];
        give(m, g, w);
    }
}

/* The height above a plane of the face that looks at it. */
static wh_real_t above(const wh_pose_t *wafer, const wh_pose_t *plane) {
    const wh_pose_t face = seen_by(wafer, plane);
    const wh_vec3_t dr = wh_vec3_subtract(&face.r, &plane->r);
    const wh_vec3_t n = wh_mat3_column(&plane->R, 2);
    return wh_vec3_dot(&dr, &n);
}

static bool is_over(const world_t *world, const wh_pose_t *wafer, const wh_pose_t *plane) {
    wh_face_t face;
    wh_proximity_t p;
    assert_int_equal(wh_face_measure(wafer, THICKNESS, plane, &world->config.tolerance, &face, &p), WH_OK);
    return p.margin_projxy > 0 && p.margin_planar > 0;
}

static int lies_on(const world_t *world, const wh_pose_t *wafer) {
    int best = -1;
    for (int s = 0; s < SUPPORTS; ++s) {
        const wh_real_t height = above(wafer, &world->supports[s]);
        if (height >= -WH_GRIPS_FLAT && height < world->config.tolerance.projz &&
            is_over(world, wafer, &world->supports[s]) &&
            (best < 0 || height < above(wafer, &world->supports[best]))) {
            best = s;
        }
    }
    return best;
}

static void pick_passive(const world_t *world, model_t *m, const wh_gripper_input_t *input, int g) {
    const wh_pose_t begin = m->steps == 1 ? input[g].base_from_gripper : m->gripper[g];
    int best = -1;
    wh_passive_wafer_t taken = {m->gripper[g], m->gripper[g], false};
    for (int w = 0; w < WAFERS; ++w) {
        wh_passive_change_t change = WH_PASSIVE_STAYS;
        if (m->holder[w] < 0 && m->let_go_by[w] < 0) {
            const wh_passive_wafer_t after =
                ask_passive(world, m, input, g, w, lies_on(world, &m->wafer[w]), &change);
            if (change == WH_PASSIVE_TAKEN &&
                (best < 0 || above(&m->wafer[w], &begin) < above(&m->wafer[best], &begin))) {
                best = w;
                taken = after;
            }
        }
    }
    if (best >= 0) {
        m->grasp[g] = taken.gripper_from_wafer;
        m->wafer[best] = taken.base_from_wafer;
        give(m, g, best);
    }
}

static void model_pick(const world_t *world, model_t *m, const wh_gripper_input_t *input, int g) {
    const bool open = input[g].valve == WH_VALVE_OPEN;
    const wh_grip_kind_t kind = world->grips[g].kind;
    if (m->began_with[g] >= 0) {
        return;
    }
    if (kind == WH_GRIP_PASSIVE) {
        pick_passive(world, m, input, g);
    } else if (kind == WH_GRIP_VACUUM && open) {
        pick_vacuum(world, m, &input[g].base_from_gripper, g);
    } else if (open && m->phase[g] == WH_GRIP_OPEN) {
        pick_edge(world, m, &input[g].base_from_gripper, g);
    }
}

static void model_step(const world_t *world, model_t *m, const wh_gripper_input_t *input) {
    ++m->steps;
    for (int w = 0; w < WAFERS; ++w) {
        m->let_go_by[w] = -1;
    }
    for (int g = 0; g < GRIPPERS; ++g) {
        m->began_with[g] = holds(m, g);
    }
    for (int g = 0; g < GRIPPERS; ++g) {
        model_move(world, m, input, g);
    }
    for (int g = 0; g < GRIPPERS; ++g) {
        model_pick(world, m, input, g);
    }
    for (int w = 0; w < WAFERS; ++w) {
        m->released += m->let_go_by[w] >= 0 && m->holder[w] < 0;
    }
    for (int g = 0; g < GRIPPERS; ++g) {
        m->gripper[g] = input[g].base_from_gripper;
    }
}

/* The table and its grips. */
typedef struct {
    wh_grips_t grips;
    wh_grasp_t table;
    wh_wafer_t wafer[WAFERS], seen[WAFERS];
    wh_gripper_t gripper[GRIPPERS];
    wh_grip_state_t state[GRIPPERS];
    wh_event_t event[WH_EVENTS_PER_GRIPPER * GRIPPERS];
    wh_event_list_t list;
} subject_t;

static void begin_table(subject_t *subject, const wh_grasp_config_t *config, const wh_pose_t start[WAFERS]) {
    memset(subject, 0, sizeof *subject);
    for (int w = 0; w < WAFERS; ++w) {
        subject->wafer[w].base_from_wafer = start[w];
    }
    const wh_grasp_storage_t storage = {subject->wafer, WAFERS, subject->gripper, GRIPPERS, NULL, 0};
    assert_int_equal(wh_grasp_init(&subject->table, config, &storage), WH_OK);
    subject->list.events = subject->event;
    subject->list.capacity = WH_EVENTS_PER_GRIPPER * GRIPPERS;
}

static wh_grips_parts_t parts_of(subject_t *subject, const world_t *world) {
    const wh_grips_parts_t parts = {THICKNESS, world->dt,      world->grips,  world->shapes, world->supports,
                                    SUPPORTS,  subject->state, subject->seen, NULL};
    return parts;
}

static void begin(subject_t *subject, const world_t *world, const wh_pose_t start[WAFERS]) {
    begin_table(subject, &world->config, start);
    const wh_grips_parts_t parts = parts_of(subject, world);
    assert_int_equal(wh_grips_init(&subject->grips, &parts, &subject->table), WH_OK);
}

/* A height on a grid that includes the thickness, so that planes meet exactly. */
static double draw_height(void) {
    return ((int)wh_test_below(17) - 8) * 0.125 + (wh_test_below(4) == 0 ? (double)THICKNESS : 0);
}

/* Upright or upside down, turned about its axis, now and then tilted a little; mostly near the others. */
static wh_pose_t draw_pose(bool level) {
    static const double aside[] = {0, 0, 0, 0.75, -1.5, 2.5, 3, 20, -55};
    const double reach = level ? 1 : 0.97;
    const wh_mat3_t yaw = wh_test_rotation(0, 0, 1, wh_test_below(3) == 0 ? 0 : wh_test_uniform(-3, 3));
    const wh_mat3_t over = wh_test_rotation(1, 0, 0, wh_test_below(3) == 0 ? WH_TEST_PI : 0);
    const double x = reach * aside[wh_test_below(9)];
    wh_pose_t pose = wh_test_pose(wh_mat3_multiply(&yaw, &over), x, aside[wh_test_below(9)], draw_height());
    if (!level) {
        const wh_mat3_t tilt = wh_test_random_turn(0.15);
        pose.R = wh_mat3_multiply(&pose.R, &tilt);
        pose.r.z += WH_REAL(wh_test_uniform(-0.2, 0.2));
    }
    wh_mat3_orthonormalise(&pose.R);
    return pose;
}

static void draw_world(world_t *world, bool vacuum_alone) {
    memset(world, 0, sizeof *world);
    world->config = wh_grasp_config_default();
    world->dt = wh_test_below(4) == 0 ? 1 : wh_test_uniform(0.01, 0.1);
    for (int g = 0; g < GRIPPERS; ++g) {
        world->grips[g].kind = vacuum_alone ? WH_GRIP_VACUUM : (wh_grip_kind_t)wh_test_below(3);
        world->grips[g].edge = wh_edge_default(150);
    }
    for (int w = 0; w < WAFERS; ++w) {
        world->shapes[w] = wh_edge_wafer_nominal(150 + (wh_test_below(4) == 0 ? wh_test_uniform(-1, 1) : 0));
    }
    for (int s = 0; s < SUPPORTS; ++s) {
        world->supports[s] = wh_test_at(0, 0, draw_height());
    }
}

/* Now and then elsewhere; otherwise a little up or down, or at rest. */
static void draw_input(bool level, bool first, wh_gripper_input_t *input) {
    if (first || wh_test_below(12) == 0) {
        input->base_from_gripper = draw_pose(level);
        input->valve = (int32_t)wh_test_below(2);
    }
    if (wh_test_below(3) == 0) {
        input->base_from_gripper.r.z += WH_REAL(0.125) * (wh_real_t)((int)wh_test_below(9) - 4);
    }
    if (input->base_from_gripper.r.z < -3 || input->base_from_gripper.r.z > 3) {
        input->base_from_gripper.r.z = 0;
    }
    input->valve = wh_test_below(9) == 0 ? 1 - input->valve : input->valve;
}

static void begin_model(model_t *m, const world_t *world, const wh_pose_t start[WAFERS]) {
    memset(m, 0, sizeof *m);
    for (int w = 0; w < WAFERS; ++w) {
        m->wafer[w] = start[w];
        m->holder[w] = -1;
    }
    for (int g = 0; g < GRIPPERS; ++g) {
        m->meets[g] = -1;
        m->s[g] = world->grips[g].kind == WH_GRIP_EDGE ? world->grips[g].edge.retracted : 0;
    }
}

static void compare(const subject_t *subject, const model_t *m, const world_t *world) {
    const wh_grasp_counters_t *counters = &subject->table.counters;
    for (int w = 0; w < WAFERS; ++w) {
        assert_int_equal(subject->wafer[w].holder, m->holder[w]);
        assert_memory_equal(&subject->wafer[w].base_from_wafer, &m->wafer[w], sizeof m->wafer[w]);
        assert_int_equal(wh_grips_support(&subject->grips, (size_t)w),
                         m->holder[w] < 0 ? lies_on(world, &m->wafer[w]) : -1);
    }
    for (int g = 0; g < GRIPPERS; ++g) {
        assert_int_equal(subject->state[g].phase, m->phase[g]);
        assert_true(subject->state[g].s == m->s[g] &&
                    (subject->state[g].excess > 0) <= (m->phase[g] == WH_GRIP_JAMMED));
        assert_int_equal(subject->state[g].wafer, m->meets[g]);
    }
    assert_true(counters->picked == (uint64_t)m->picked && counters->released == (uint64_t)m->released);
    assert_int_equal(counters->handed_over, m->handed_over);
}

#if defined(WH_FLOAT)
#define CLOSE 1e-3
#else
#define CLOSE 1e-9
#endif

/* The faces that looked at each gripper at the ends of the last slices, by slice. */
#define HISTORY 4096
static wh_face_t history[HISTORY][GRIPPERS][WAFERS];

static void note_faces(const subject_t *subject) {
    for (int g = 0; g < GRIPPERS; ++g) {
        for (int w = 0; w < WAFERS; ++w) {
            history[subject->table.slice % HISTORY][g][w] =
                wh_face_towards(&subject->wafer[w].base_from_wafer, &subject->gripper[g].base_from_gripper);
        }
    }
}

/* A held wafer is where its gripper carries it; an event names the face that looked at its gripper when it was
 * measured. */
static void check_places(const subject_t *subject) {
    note_faces(subject);
    for (int g = 0; g < GRIPPERS; ++g) {
        const wh_gripper_t *gripper = &subject->gripper[g];
        if (gripper->wafer >= 0) {
            const wh_pose_t *pose = &subject->wafer[gripper->wafer].base_from_wafer;
            const wh_pose_t there =
                wh_pose_compose(&gripper->base_from_gripper, &gripper->gripper_from_wafer);
            assert_near(wh_test_difference_r(pose, &there), 0, CLOSE);
            assert_near(wh_test_difference_R(pose, &there), 0, CLOSE);
        }
    }
    for (size_t i = 0; i < subject->list.count; ++i) {
        const wh_event_t *event = &subject->event[i];
        assert_true(subject->table.slice - event->measured_slice < HISTORY);
        assert_int_equal(event->face, history[event->measured_slice % HISTORY][event->gripper][event->wafer]);
    }
}

static int holders_of(const subject_t *subject, int w) {
    int holders = 0;
    for (int g = 0; g < GRIPPERS; ++g) {
        holders += subject->gripper[g].wafer == w;
    }
    return holders;
}

/* A wafer on passive pads that moved from above a support to below it. */
static void check_not_through(const world_t *world, const wh_pose_t *then, const wh_pose_t *now) {
    for (int s = 0; s < SUPPORTS && world->config.check == WH_CHECK_SAMPLED; ++s) {
        const wh_pose_t *plane = &world->supports[s];
        assert_false(above(then, plane) > WH_GRIPS_FLAT && above(now, plane) < -WH_GRIPS_FLAT &&
                     is_over(world, now, plane));
    }
}

/* Rules for any model state: no wafer is held twice, each has a place, none moves that nothing
 * touched, and none went down through a support on passive pads. */
static void check_sound(const subject_t *subject, const subject_t *before, const world_t *world) {
    for (int w = 0; w < WAFERS; ++w) {
        const wh_wafer_t *now = &subject->wafer[w];
        const wh_wafer_t *then = &before->wafer[w];
        assert_int_equal(holders_of(subject, w), now->holder >= 0);
        assert_int_equal(wh_pose_validate(&now->base_from_wafer), WH_OK);
        assert_true(now->holder < 0 || subject->gripper[now->holder].wafer == w);
        if (now->holder < 0 && then->holder < 0) {
            assert_memory_equal(&now->base_from_wafer, &then->base_from_wafer, sizeof(wh_pose_t));
        }
        if (now->holder >= 0 && then->holder == now->holder &&
            world->grips[now->holder].kind == WH_GRIP_PASSIVE) {
            check_not_through(world, &then->base_from_wafer, &now->base_from_wafer);
        }
    }
    assert_true(wh_grasp_is_consistent(&subject->table));
}

/* The state alone is enough: arrays that are copied out and back continue with the same bits. */
static void check_restored(const subject_t *subject, const world_t *world, const wh_gripper_input_t *input,
                           uint64_t hash) {
    static subject_t other;
    const wh_pose_t anywhere[WAFERS] = {wh_pose_identity(), wh_pose_identity(), wh_pose_identity()};
    begin(&other, world, anywhere);
    memcpy(other.wafer, subject->wafer, sizeof other.wafer);
    memcpy(other.gripper, subject->gripper, sizeof other.gripper);
    memcpy(other.state, subject->state, sizeof other.state);
    other.table.slice = subject->table.slice;
    assert_int_equal(wh_grips_step(&other.grips, input, NULL), WH_OK);
    assert_true(wh_grips_hash(&other.grips) == hash);
}

/* In full, with STEPS steps each. */
enum { PLAYS = 10000 };

/* The events of a run; a test without one of the kinds shows nothing about it. */
typedef struct {
    int64_t steps, picked, handed_over, released, jammed, missed, closed, fronts, on_passive;
} sum_t;

static void add_up(sum_t *sum, const subject_t *subject, const subject_t *before, const world_t *world) {
    ++sum->steps;
    for (int g = 0; g < GRIPPERS; ++g) {
        const bool changed = subject->state[g].phase != before->state[g].phase;
        sum->jammed += changed && subject->state[g].phase == WH_GRIP_JAMMED;
        sum->missed += changed && subject->state[g].phase == WH_GRIP_MISSED;
        sum->closed += changed && subject->state[g].phase == WH_GRIP_CLOSED;
        sum->on_passive += world->grips[g].kind == WH_GRIP_PASSIVE && subject->gripper[g].wafer >= 0;
    }
    for (size_t i = 0; i < subject->list.count; ++i) {
        sum->picked += subject->event[i].kind == WH_EVENT_PICKED;
        sum->handed_over += subject->event[i].kind == WH_EVENT_HANDED_OVER;
        sum->released += subject->event[i].kind == WH_EVENT_RELEASED;
        sum->fronts += subject->event[i].kind == WH_EVENT_PICKED && subject->event[i].face == WH_FACE_FRONT;
    }
}

static void play(sum_t *sum, bool with_model) {
    static subject_t subject;
    static subject_t before;
    static model_t model;
    world_t world;
    wh_pose_t start[WAFERS];
    wh_gripper_input_t input[GRIPPERS];
    const bool level = wh_test_below(2) == 0;
    draw_world(&world, false);
    world.config.check =
        with_model || wh_test_below(2) == 0 || !WH_SWEEP_BUILT ? WH_CHECK_SAMPLED : WH_CHECK_SWEPT;
    world.config.seat = !with_model && wh_test_below(2) == 0;
    for (int w = 0; w < WAFERS; ++w) {
        start[w] = draw_pose(level);
    }
    begin(&subject, &world, start);
    begin_model(&model, &world, start);
    for (int step = 0; step < STEPS; ++step) {
        for (int g = 0; g < GRIPPERS; ++g) {
            draw_input(level, step == 0, &input[g]);
        }
        memcpy(&before, &subject, sizeof before);
        assert_int_equal(wh_grips_step(&subject.grips, input, &subject.list), WH_OK);
        check_sound(&subject, &before, &world);
        check_places(&subject);
        add_up(sum, &subject, &before, &world);
        if (with_model) {
            model_step(&world, &model, input);
            compare(&subject, &model, &world);
        }
        if (wh_test_below(STEPS) == 0) {
            check_restored(&before, &world, input, wh_grips_hash(&subject.grips));
        }
    }
}

static void grips_and_model_agree(void **state) {
    (void)state;
    sum_t sum = {0};
    wh_rounds_t rounds = WH_ROUNDS(400, PLAYS, 0.5);
    while (wh_round(&rounds)) {
        play(&sum, true);
    }
    const int64_t steps = sum.steps;
    printf("%lld steps: %lld picked (%lld by the front), %lld handed over, %lld released; %lld closed, %lld "
           "jammed, %lld missed; "
           "%lld slices on passive pads\n",
           (long long)sum.steps, (long long)sum.picked, (long long)sum.fronts, (long long)sum.handed_over,
           (long long)sum.released, (long long)sum.closed, (long long)sum.jammed, (long long)sum.missed,
           (long long)sum.on_passive);
    assert_true(sum.picked > steps / 200 && sum.fronts > steps / 1000 && sum.released > steps / 200);
    assert_true(sum.closed > steps / 2000 && sum.jammed > steps / 5000 && sum.missed > steps / 2000);
    assert_true(sum.on_passive > steps / 200 && sum.handed_over > steps / 5000);
}

static void swept_and_seated_steps_are_sound(void **state) {
    (void)state;
    sum_t sum = {0};
    wh_rounds_t rounds = WH_ROUNDS(50, PLAYS / 4, 0.25);
    while (wh_round(&rounds)) {
        play(&sum, false);
    }
    assert_true(sum.fronts > 0 && sum.on_passive > 0 && sum.closed > 0);
}

static void check_same(const subject_t *subject, const subject_t *plain) {
    assert_true(wh_grips_hash(&subject->grips) == wh_grasp_hash(&plain->table));
    assert_memory_equal(&subject->table.counters, &plain->table.counters, sizeof plain->table.counters);
    assert_int_equal(subject->list.count, plain->list.count);
    for (size_t i = 0; i < plain->list.count; ++i) {
        const wh_event_t *a = &subject->event[i];
        const wh_event_t *b = &plain->event[i];
        assert_true(a->kind == b->kind && a->wafer == b->wafer && a->gripper == b->gripper &&
                    a->other == b->other);
        assert_true(a->face == b->face && a->measured_slice == b->measured_slice);
        assert_true(a->measured.dr_proj_z == b->measured.dr_proj_z);
    }
}

/* Only vacuum and only backs: both steps agree to the bit and to the event. */
static void vacuum_alone_is_the_table(void **state) {
    (void)state;
    static subject_t subject;
    static subject_t plain;
    world_t world;
    wh_rounds_t rounds = WH_ROUNDS(16, 1000, 0.25);
    while (wh_round(&rounds)) {
        const int run = rounds.number;
        wh_pose_t start[WAFERS];
        wh_gripper_input_t input[GRIPPERS];
        draw_world(&world, true);
        world.config.check = run % 2 == 0 && WH_SWEEP_BUILT ? WH_CHECK_SWEPT : WH_CHECK_SAMPLED;
        world.config.seat = run % 4 < 2;
        for (int w = 0; w < WAFERS; ++w) {
            start[w] = wh_test_pose(wh_test_random_turn(0.1), wh_test_uniform(-30, 30), 0, draw_height());
        }
        begin(&subject, &world, start);
        begin_table(&plain, &world.config, start);
        for (int step = 0; step < STEPS; ++step) {
            for (int g = 0; g < GRIPPERS; ++g) {
                input[g].base_from_gripper =
                    wh_test_pose(wh_test_random_turn(0.1), wh_test_uniform(-30, 30), 0, draw_height());
                input[g].valve = (int32_t)wh_test_below(2);
            }
            assert_int_equal(wh_grips_step(&subject.grips, input, &subject.list), WH_OK);
            assert_int_equal(wh_grasp_step(&plain.table, input, &plain.list), WH_OK);
            check_same(&subject, &plain);
        }
    }
}

/* One edge grip below one wafer, in slices of a tenth of a second: the plunger moves 4 mm. */
static void begin_edge(subject_t *subject, world_t *world, double x, double y, double radius) {
    const wh_pose_t start[WAFERS] = {wh_test_at(x, y, 0.25), wh_test_at(0, 0, 500), wh_test_at(0, 0, 600)};
    (void)wh_test_seed();
    draw_world(world, true);
    world->grips[0].kind = WH_GRIP_EDGE;
    world->dt = 0.1;
    world->shapes[0] = wh_edge_wafer_nominal(radius);
    begin(subject, world, start);
}

/* Gripper 0 moves to this height; the others stay away. */
static void step_to(subject_t *subject, double z, int32_t valve) {
    const wh_gripper_input_t input[GRIPPERS] = {{wh_test_at(0, 0, z), valve},
                                                {wh_test_at(0, 0, -500), WH_VALVE_CLOSED},
                                                {wh_test_at(0, 0, -500), WH_VALVE_CLOSED}};
    assert_int_equal(wh_grips_step(&subject->grips, input, &subject->list), WH_OK);
}

/* The wafer moves with a blade that rises while it closes, and ends at the place of the closed form. */
static void a_plunger_takes_its_time(void **state) {
    (void)state;
    static subject_t subject;
    world_t world;
    begin_edge(&subject, &world, -1, 0.5, 150.1);
    step_to(&subject, 0, WH_VALVE_OPEN);
    assert_int_equal(subject.state[0].phase, WH_GRIP_CLOSING);
    assert_int_equal(subject.wafer[0].holder, 0);
    assert_near(subject.wafer[0].base_from_wafer.r.x, -1, 1e-9);
    step_to(&subject, 1, WH_VALVE_OPEN);
    assert_near(subject.state[0].s, -4, 1e-9);
    assert_near(subject.wafer[0].base_from_wafer.r.z, 1.25, 1e-6);
    step_to(&subject, 2, WH_VALVE_OPEN);
    step_to(&subject, 2, WH_VALVE_OPEN);
    assert_int_equal(subject.state[0].phase, WH_GRIP_CLOSED);
    assert_near(subject.wafer[0].base_from_wafer.r.x, -0.115457, 1e-5);
    assert_near(subject.wafer[0].base_from_wafer.r.y, 0, 1e-5);
    step_to(&subject, 3, WH_VALVE_CLOSED);
    assert_int_equal(subject.wafer[0].holder, WH_NONE);
    assert_int_equal(subject.state[0].phase, WH_GRIP_OPENING);
    assert_near(subject.wafer[0].base_from_wafer.r.z, 3.25, 1e-6);
    step_to(&subject, 0, WH_VALVE_OPEN); /* it opens before it closes again */
    step_to(&subject, 0, WH_VALVE_OPEN);
    assert_int_equal(subject.state[0].phase, WH_GRIP_CLOSING);
    assert_int_equal(subject.state[0].wafer, WH_NONE);
}

/* 3 mm off: jammed by half a millimetre. No wafer there, and a wafer out of reach: missed. Far too
 * large: jammed without contact. */
static void a_jam_says_by_how_much(void **state) {
    (void)state;
    static subject_t subject;
    world_t world;
    const struct {
        double x, y, radius;
        wh_grip_phase_t phase;
        double excess;
    } cases[] = {{-3, 0, 150, WH_GRIP_JAMMED, 0.5},  {0, 2.5, 150, WH_GRIP_CLOSED, 0},
                 {0, 2.6, 150, WH_GRIP_JAMMED, 0.1}, {20, 0, 150, WH_GRIP_MISSED, 0},
                 {500, 0, 150, WH_GRIP_MISSED, 0},   {0, 0, 150.9, WH_GRIP_JAMMED, 0},
                 {0, 0, 149.2, WH_GRIP_MISSED, 0}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        begin_edge(&subject, &world, cases[i].x, cases[i].y, cases[i].radius);
        for (int step = 0; step < 5; ++step) {
            step_to(&subject, 0, WH_VALVE_OPEN);
        }
        assert_int_equal(subject.state[0].phase, cases[i].phase);
        assert_near(subject.state[0].excess, cases[i].excess, 1e-6);
        assert_int_equal(subject.wafer[0].holder, cases[i].phase == WH_GRIP_CLOSED ? 0 : WH_NONE);
    }
}

/* Faults in the parts of a good set-up, one at a time. */
typedef struct {
    wh_grips_parts_t parts;
    world_t world;
} setting_t;

static wh_status_t try_init(subject_t *subject, const setting_t *setting) {
    static const wh_grips_t blank = {{0}, NULL, 0, 0};
    subject->grips = blank;
    const wh_status_t status = wh_grips_init(&subject->grips, &setting->parts, &subject->table);
    assert_true((status == WH_OK) == (subject->grips.mark == WH_GRIPS_MARK));
    return status;
}

static void bad_set_ups_are_refused(void **state) {
    (void)state;
    static subject_t subject;
    static setting_t good;
    static setting_t bad;
    begin_edge(&subject, &good.world, 0, 0, 150);
    good.parts = parts_of(&subject, &good.world);
    assert_int_equal(try_init(&subject, &good), WH_OK);
    assert_int_equal(wh_grips_init(NULL, &good.parts, &subject.table), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_grips_init(&subject.grips, NULL, &subject.table), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_grips_init(&subject.grips, &good.parts, NULL), WH_STATUS_NULL_ARGUMENT);
#define REFUSED(member, value, status)                                                                       \
    bad = good;                                                                                              \
    bad.parts.grips = bad.world.grips;                                                                       \
    bad.parts.shapes = bad.world.shapes;                                                                     \
    bad.parts.supports = bad.world.supports;                                                                 \
    bad.member = value;                                                                                      \
    assert_int_equal(try_init(&subject, &bad), status)
    REFUSED(parts.grips, NULL, WH_STATUS_NULL_ARGUMENT);
    REFUSED(parts.states, NULL, WH_STATUS_NULL_ARGUMENT);
    REFUSED(parts.seen, NULL, WH_STATUS_NULL_ARGUMENT);
    REFUSED(parts.supports, NULL, WH_STATUS_NULL_ARGUMENT);
    REFUSED(parts.shapes, NULL, WH_STATUS_NULL_ARGUMENT);
    REFUSED(parts.thickness, -1, WH_STATUS_OUT_OF_RANGE);
    REFUSED(parts.thickness, 101, WH_STATUS_OUT_OF_RANGE);
    REFUSED(parts.thickness, WH_REAL(NAN), WH_STATUS_NOT_FINITE);
    REFUSED(parts.dt, 0, WH_STATUS_OUT_OF_RANGE);
    REFUSED(parts.dt, 3601, WH_STATUS_OUT_OF_RANGE);
    REFUSED(parts.dt, (double)INFINITY, WH_STATUS_NOT_FINITE);
    REFUSED(world.grips[2].kind, (wh_grip_kind_t)3, WH_STATUS_OUT_OF_RANGE);
    REFUSED(world.grips[0].edge.speed, 0, WH_STATUS_OUT_OF_RANGE);
    REFUSED(world.grips[0].edge.speed, (double)NAN, WH_STATUS_NOT_FINITE);
    REFUSED(world.shapes[2].radius, 152, WH_STATUS_OUT_OF_RANGE);
    REFUSED(world.supports[1].R.m[0][0], 2, WH_STATUS_NOT_A_ROTATION);
#undef REFUSED
    assert_int_equal(try_init(&subject, &good), WH_OK);
    step_to(&subject, 0, WH_VALVE_OPEN);
}

static void bad_tables_and_steps_are_refused(void **state) {
    (void)state;
    static subject_t subject;
    static setting_t setting;
    begin_edge(&subject, &setting.world, 0, 0, 150);
    setting.parts = parts_of(&subject, &setting.world);
    wh_gripper_input_t input[GRIPPERS];
    for (int g = 0; g < GRIPPERS; ++g) {
        input[g].base_from_gripper = wh_test_at(0, 0, g == 0 ? 0 : -500);
        input[g].valve = WH_VALVE_OPEN;
    }
    assert_int_equal(wh_grips_step(NULL, input, NULL), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_grips_step(&subject.grips, NULL, NULL), WH_STATUS_NULL_ARGUMENT);
    wh_event_list_t small = {subject.event, GRIPPERS * WH_EVENTS_PER_GRIPPER - 1, 7};
    assert_int_equal(wh_grips_step(&subject.grips, input, &small), WH_STATUS_BAD_CAPACITY);
    wh_event_list_t none = {NULL, 100, 7};
    assert_int_equal(wh_grips_step(&subject.grips, input, &none), WH_STATUS_NULL_ARGUMENT);
    const uint64_t before = wh_grips_hash(&subject.grips);
    input[1].valve = 2;
    assert_int_equal(wh_grips_step(&subject.grips, input, &subject.list), WH_STATUS_BAD_VALVE);
    assert_int_equal(subject.list.count, 1);
    assert_int_equal(subject.event[0].kind, WH_EVENT_BAD_INPUT);
    assert_int_equal(subject.event[0].gripper, 1);
    input[1].valve = 0;
    input[2].base_from_gripper.r.x = WH_REAL(NAN);
    assert_int_equal(wh_grips_step(&subject.grips, input, &subject.list), WH_STATUS_NOT_FINITE);
    assert_int_equal(subject.event[0].gripper, 2);
    assert_true(wh_grips_hash(&subject.grips) == before);
    assert_int_equal(subject.table.counters.refused, 5);
    input[2].base_from_gripper.r.x = 0;
    assert_int_equal(wh_grips_step(&subject.grips, input, &subject.list), WH_OK);
    assert_int_equal(try_init(&subject, &setting), WH_STATUS_HELD);
    assert_int_equal(wh_grips_step(&subject.grips, input, NULL), WH_STATUS_NOT_INITIALISED);
    uint32_t bucket;
    subject.table.storage.bucket_count = 1;
    subject.table.storage.buckets = &bucket;
    assert_int_equal(try_init(&subject, &setting), WH_STATUS_BAD_CAPACITY);
    subject.table.mark = 0;
    assert_int_equal(try_init(&subject, &setting), WH_STATUS_NOT_INITIALISED);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(grips_and_model_agree),
        cmocka_unit_test(swept_and_seated_steps_are_sound),
        cmocka_unit_test(vacuum_alone_is_the_table),
        cmocka_unit_test(a_plunger_takes_its_time),
        cmocka_unit_test(a_jam_says_by_how_much),
        cmocka_unit_test(bad_set_ups_are_refused),
        cmocka_unit_test(bad_tables_and_steps_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
