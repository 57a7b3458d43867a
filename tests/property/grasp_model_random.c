/* The grasp table beside a slow, obvious model of it: random runs, compared bit for bit after every
 * step. A second test makes a hundred thousand GETs and PUTs of one wafer that lies beside its
 * slot's centre, and measures its drift. */
#include "grasp/grasp.h"
#include "support/grasp.h"
#include "support/grasp_model.h"
#include "support/pose.h"

#ifndef RUNS
#define RUNS 30000
#endif

/* The grasp table and its model side by side: the first difference between them, or a rule that the
 * table breaks, as a phrase; null if all is well. */
typedef struct {
    wh_grasp_t table;
    wh_wafer_t wafer[MODEL_WAFERS];
    wh_gripper_t gripper[MODEL_GRIPPERS];
    wh_event_t event[WH_EVENTS_PER_GRIPPER * MODEL_GRIPPERS];
    wh_event_list_t list;
    model_t model;
} pair_t;

static bool same_values(const wh_proximity_t *a, const wh_proximity_t *b) {
    return memcmp(&a->dr, &b->dr, sizeof a->dr) == 0 && a->n1_proj_n2 == b->n1_proj_n2 &&
           a->dr_proj_z == b->dr_proj_z && memcmp(&a->dr_proj_xy, &b->dr_proj_xy, sizeof a->dr) == 0 &&
           a->dr_proj_xy_norm == b->dr_proj_xy_norm && a->failed == b->failed && a->ready == b->ready;
}

static const wh_event_t *find_event(const model_t *m, const wh_event_t *like) {
    for (int k = 0; k < m->events; ++k) {
        const wh_event_t *e = &m->event[k];
        if (e->kind == like->kind && e->wafer == like->wafer && e->gripper == like->gripper) {
            return e;
        }
    }
    return NULL;
}

static const char *compare_events(const pair_t *p) {
    const model_t *m = &p->model;
    if (p->list.count != (size_t)m->events) {
        return "number of events";
    }
    for (size_t i = 0; i < p->list.count; ++i) {
        const wh_event_t *a = &p->event[i];
        const wh_event_t *b = find_event(m, a);
        if (!b || a->other != b->other || a->slice != b->slice || a->measured_slice != b->measured_slice) {
            return "an event";
        }
        if (!same_values(&a->measured, &b->measured)) {
            return "an event's values";
        }
    }
    return memcmp(&p->table.counters, &m->counters, sizeof m->counters) ? "counters" : NULL;
}

static const char *compare_encounter(const wh_encounter_t *a, const wh_encounter_t *b) {
    if (a->wafer != b->wafer) {
        return "an encounter's wafer";
    }
    const bool same = a->wafer < 0 || (a->slice == b->slice && a->holder == b->holder &&
                                       same_values(&a->measured, &b->measured));
    return same ? NULL : "an encounter";
}

static const char *compare_gripper(const pair_t *p, int g) {
    const model_t *m = &p->model;
    const wh_gripper_t *gripper = &p->gripper[g];
    if (gripper->wafer != m->holds[g]) {
        return "what a gripper holds";
    }
    if (gripper->wafer >= 0 && memcmp(&gripper->gripper_from_wafer, &m->grasp[g], sizeof m->grasp[g]) != 0) {
        return "gripper_from_wafer";
    }
    const char *wrong = compare_encounter(&gripper->approach, &m->approach[g]);
    return wrong ? wrong : compare_encounter(&gripper->contest, &m->contest[g]);
}

static const char *compare_state(const pair_t *p) {
    const model_t *m = &p->model;
    const char *wrong = NULL;
    for (int w = 0; w < m->wafers; ++w) {
        if (p->wafer[w].holder != m->holder[w] || p->wafer[w].released_by != -1) {
            return "a holder";
        }
        if (memcmp(&p->wafer[w].base_from_wafer, &m->wafer[w], sizeof m->wafer[w]) != 0) {
            return "a wafer's pose";
        }
    }
    for (int g = 0; g < m->grippers && !wrong; ++g) {
        wrong = compare_gripper(p, g);
    }
    if (wrong) {
        return wrong;
    }
    return wh_grasp_hash(&p->table) == model_hash(m) ? NULL : "the hash";
}

static const char *check_gripper(const pair_t *p, const pair_t *before, size_t g) {
    const wh_gripper_t *now = &p->gripper[g];
    const wh_gripper_t *then = &before->gripper[g];
    if (now->wafer >= 0 && p->wafer[now->wafer].holder != (int32_t)g) {
        return "one wafer, two holders";
    }
    const bool kept = now->wafer >= 0 && then->wafer == now->wafer;
    return kept && memcmp(&now->gripper_from_wafer, &then->gripper_from_wafer, sizeof(wh_pose_t)) != 0
               ? "a held wafer slipped"
               : NULL;
}

static int count_holders(const pair_t *p, size_t w) {
    int holders = 0;
    for (size_t g = 0; g < p->table.storage.gripper_count; ++g) {
        holders += p->gripper[g].wafer == (int32_t)w;
    }
    return holders;
}

static const char *check_wafer(const pair_t *p, const pair_t *before, size_t w) {
    const wh_pose_t *pose = &p->wafer[w].base_from_wafer;
    if (before->wafer[w].holder < 0 && memcmp(pose, &before->wafer[w].base_from_wafer, sizeof *pose) != 0) {
        return "a resting wafer moved";
    }
    if (wh_pose_validate(pose) != WH_OK) {
        return "a wafer's pose is none";
    }
    return count_holders(p, w) == (p->wafer[w].holder >= 0) ? NULL : "a holder that holds nothing";
}

/* Rules that must hold whatever the model does. */
static const char *check_invariants(const pair_t *p, const pair_t *before) {
    const char *wrong = NULL;
    for (size_t g = 0; g < p->table.storage.gripper_count && !wrong; ++g) {
        wrong = check_gripper(p, before, g);
    }
    for (size_t w = 0; w < p->table.storage.wafer_count && !wrong; ++w) {
        wrong = check_wafer(p, before, w);
    }
    return wrong;
}

/* A refused step changes nothing. */
static const char *check_refusal(const pair_t *p, const pair_t *before) {
    const bool same = memcmp(p->wafer, before->wafer, sizeof p->wafer) == 0 &&
                      memcmp(p->gripper, before->gripper, sizeof p->gripper) == 0;
    return same ? NULL : "a refused step changed something";
}

enum { STEPS = 24 };

/* A run that is drawn beforehand, so that a failing one can be repeated with fewer steps. */
typedef struct {
    wh_grasp_config_t config;
    size_t wafers, grippers;
    wh_wafer_t start[MODEL_WAFERS];
    wh_gripper_input_t input[STEPS][MODEL_GRIPPERS];
    bool skip[STEPS];
} script_t;

/* Level and on a grid, so that values equal each other and the limits; or tilted a little. */
static wh_pose_t draw_pose(bool grid, double reach, double height) {
    if (grid) {
        const double x = (int)wh_test_below(5) * reach / 4;
        return wh_test_at(x, 0, ((int)wh_test_below(17) - 8) * 0.125);
    }
    wh_pose_t pose = wh_test_random_pose(reach);
    pose.R = wh_test_random_turn(wh_test_below(4) ? 0.09 : 0.2);
    pose.r.z = WH_REAL(wh_test_uniform(-height, height));
    return pose;
}

/* The rotation is as far from orthonormal as is allowed, or now and then farther. */
static void wear_out(wh_mat3_t *R) {
    const double limit = 0.45 * (double)WH_ROTATION_TOLERANCE;
    const wh_mat3_t exact = *R;
    wh_pose_t tried = wh_pose_identity();
    do {
        for (int k = 0; k < 9; ++k) {
            R->m[k / 3][k % 3] = exact.m[k / 3][k % 3] + WH_REAL(wh_test_uniform(-limit, limit));
        }
        tried.R = *R;
    } while (wh_pose_validate(&tried) != WH_OK);
}

static void spoil(wh_gripper_input_t *input) {
    const wh_real_t bad[] = {WH_REAL(NAN), WH_REAL(INFINITY), WH_REAL(-INFINITY)};
    const wh_real_t spoilt = bad[wh_test_below(3)];
    wh_real_t *entry = input->base_from_gripper.R.m[wh_test_below(3)];
    entry += wh_test_below(3);
    switch (wh_test_below(4)) {
    case 0:
        *entry = spoilt;
        break;
    case 1:
        input->base_from_gripper.r.y = spoilt;
        break;
    case 2:
        *entry += WH_REAL(0.01);
        break;
    default:
        input->valve = wh_test_below(2) ? 2 : -1;
    }
}

/* The parameters from which a run is drawn. */
typedef struct {
    bool grid, worn;
    double height;
    uint32_t patience; /* the larger, the rarer a valve is switched */
} manner_t;

static void draw_input(const manner_t *manner, const wh_gripper_input_t *before, wh_gripper_input_t *input) {
    input->base_from_gripper =
        before && wh_test_below(2) ? before->base_from_gripper : draw_pose(manner->grid, 40, manner->height);
    input->valve = before && wh_test_below(manner->patience) ? before->valve : (int32_t)wh_test_below(2);
    if (manner->worn) {
        wear_out(&input->base_from_gripper.R);
    }
}

static void draw_start(const manner_t *manner, script_t *s) {
    for (size_t w = 0; w < s->wafers; ++w) {
        s->start[w].base_from_wafer = draw_pose(manner->grid, 30, manner->height);
        if (manner->worn) {
            wear_out(&s->start[w].base_from_wafer.R);
        }
    }
}

static void draw_script(script_t *s) {
    manner_t manner = {.grid = wh_test_below(3) == 0};
    manner.worn = wh_test_below(4) == 0;
    manner.height = wh_test_uniform(0.4, 6);
    manner.patience = 2 + wh_test_below(5);
    memset(s, 0, sizeof *s);
    s->config = wh_grasp_config_default();
    s->config.near_projz = wh_test_below(2) ? WH_REAL(4.5) : WH_REAL(1.5);
    s->config.near_projxy = wh_test_below(2) ? 100 : 30;
    s->wafers = wh_test_below(MODEL_WAFERS + 1);
    s->grippers = 2 + wh_test_below(MODEL_GRIPPERS - 1);
    draw_start(&manner, s);
    for (size_t step = 0; step < STEPS; ++step) {
        for (size_t g = 0; g < s->grippers; ++g) {
            draw_input(&manner, step ? &s->input[step - 1][g] : NULL, &s->input[step][g]);
        }
    }
    for (size_t step = 0; step < STEPS && wh_test_below(4) == 0; ++step) {
        spoil(&s->input[step][wh_test_below((uint32_t)s->grippers)]);
        step += wh_test_below(8);
    }
}

static void start(pair_t *p, script_t *s) {
    memset(p, 0, sizeof *p);
    memcpy(p->wafer, s->start, sizeof p->wafer);
    const wh_grasp_storage_t storage = {p->wafer, s->wafers, p->gripper, s->grippers, NULL, 0};
    assert_int_equal(wh_grasp_init(&p->table, &s->config, &storage), WH_OK);
    p->list.events = p->event;
    p->list.capacity = WH_EVENTS_PER_GRIPPER * s->grippers;
    p->model.config = s->config;
    p->model.wafers = (int)s->wafers;
    p->model.grippers = (int)s->grippers;
    for (size_t w = 0; w < s->wafers; ++w) {
        p->model.wafer[w] = s->start[w].base_from_wafer;
        p->model.holder[w] = p->model.let_go_by[w] = -1;
    }
    for (size_t g = 0; g < s->grippers; ++g) {
        p->model.holds[g] = -1;
        p->model.valve[g] = 1;
        p->model.gripper[g] = wh_pose_identity();
        p->model.approach[g].wafer = p->model.contest[g].wafer = -1;
    }
}

/* One step of both; returns what is wrong after it, or null. */
static const char *take_step(pair_t *p, const wh_gripper_input_t *input) {
    static pair_t before;
    memcpy(&before, p, sizeof before);
    const wh_status_t status = wh_grasp_step(&p->table, input, &p->list);
    const char *wrong = status == model_step(&p->model, input) ? NULL : "the status";
    wrong = wrong ? wrong : compare_state(p);
    wrong = wrong ? wrong : compare_events(p);
    wrong = wrong ? wrong : check_invariants(p, &before);
    wrong = wrong ? wrong : wh_grasp_is_consistent(&p->table) ? NULL : "wh_grasp_is_consistent";
    return wrong || status == WH_OK ? wrong : check_refusal(p, &before);
}

/* Plays the script's steps; returns the step at which table and model differ, or STEPS. */
static size_t play(pair_t *p, script_t *s, const char **wrong) {
    start(p, s);
    for (size_t step = 0; step < STEPS; ++step) {
        if (s->skip[step]) {
            continue;
        }
        *wrong = take_step(p, s->input[step]);
        if (*wrong) {
            return step;
        }
    }
    return STEPS;
}

/* Leaves out each step without which it still fails, and prints the remaining ones. */
static void explain(pair_t *p, script_t *s, unsigned run, size_t step, const char *wrong) {
    print_error("run %u, step %zu: %s (%zu wafers, %zu grippers)\n", run, step, wrong, s->wafers,
                s->grippers);
    size_t left = STEPS;
    for (size_t k = STEPS; k-- > 0;) {
        const char *still;
        s->skip[k] = true;
        s->skip[k] = play(p, s, &still) != STEPS;
        left -= s->skip[k];
    }
    print_error("it takes %zu steps:", left);
    for (size_t k = 0; k < STEPS; ++k) {
        if (!s->skip[k]) {
            print_error(" %zu", k);
        }
    }
    step = play(p, s, &wrong);
    print_error("; then at step %zu: %s\n", step, wrong);
    fail();
}

static void table_and_model_agree(void **state) {
    (void)state;
    static pair_t pair;
    static script_t script;
    wh_grasp_counters_t sum = {0};
    wh_rounds_t rounds = WH_ROUNDS(300, RUNS, 0.6);
    while (wh_round(&rounds)) {
        const char *wrong = NULL;
        draw_script(&script);
        const size_t step = play(&pair, &script, &wrong);
        if (step != STEPS) {
            explain(&pair, &script, (unsigned)rounds.number, step, wrong);
        }
        const wh_grasp_counters_t *c = &pair.table.counters;
        sum.picked += c->picked;
        sum.released += c->released;
        sum.handed_over += c->handed_over;
        sum.near_misses += c->near_misses;
        sum.contested += c->contested;
        sum.refused += c->refused;
    }
    printf("%d runs: %llu picked, %llu released, %llu handed over, %llu near misses, %llu contested, %llu "
           "refused\n",
           rounds.made, (unsigned long long)sum.picked, (unsigned long long)sum.released,
           (unsigned long long)sum.handed_over, (unsigned long long)sum.near_misses,
           (unsigned long long)sum.contested, (unsigned long long)sum.refused);
    const uint64_t runs = (uint64_t)rounds.made;
    assert_true(sum.picked > runs && sum.released > runs / 2 && sum.handed_over > runs / 10 &&
                sum.near_misses > runs / 10 && sum.contested > runs / 10 && sum.refused > runs / 50);
}

/* ------------------------------------------------------------------------------------------------------------ does it creep? */

/* The paper's Wafer 2. */
static const double offset_x = 13.794;
static const double offset_y = 7.2385;

#if defined(WH_FLOAT)
enum { CYCLES = 20000 };
/* Measured: 0.003 mm, at radii of up to 900 mm. */
#define BOUND 0.05
#else
enum { CYCLES = 100000 };
#define BOUND 1e-9
#endif

enum { SLOTS = 25 };

typedef struct {
    double heading, x, y, z;
} station_t;

static wh_pose_t slot_pose(const station_t *s, uint32_t slot, double above) {
    return wh_test_pose(wh_test_rotation(0, 0, 1, s->heading), s->x, s->y, s->z + 10 * slot + above);
}

static void go(cell_t *cell, const station_t *s, uint32_t slot, double above, int valve) {
    cell->input[0].base_from_gripper = slot_pose(s, slot, above);
    cell->input[0].valve = valve;
    cell_step(cell);
}

/* The key poses of a GET: below, on contact within eps_projz, above. */
static void get(cell_t *cell, const station_t *s, uint32_t slot) {
    go(cell, s, slot, -3, OPEN);
    go(cell, s, slot, -0.25, OPEN);
    cell_expect_held(cell, 0, 0);
    go(cell, s, slot, 3, OPEN);
}

/* The key poses of a PUT: the wafer is released where it was taken, so that the height repeats as well. */
static void put(cell_t *cell, const station_t *s, uint32_t slot) {
    go(cell, s, slot, 3, OPEN);
    go(cell, s, slot, -0.25, CLOSED);
    cell_expect_held(cell, 0, WH_NONE);
    go(cell, s, slot, -3, CLOSED);
}

/* Each time it is another value: few recurring values would hold the wafer on the few numbers that
 * they round to. */
static station_t draw_station(void) {
    const double around = wh_test_uniform(0, 2 * WH_TEST_PI);
    const double radius = wh_test_uniform(500, 900);
    const double heading = wh_test_uniform(0, 2 * WH_TEST_PI);
    const station_t s = {heading, radius * cos(around), radius * sin(around), wh_test_uniform(600, 1000)};
    return s;
}

static void offsets_survive(void **state) {
    (void)state;
    cell_t cell;
    (void)wh_test_seed();
    station_t drawn = draw_station();
    const station_t *s = &drawn;
    uint32_t slot = 0;
    const wh_pose_t slot_from_wafer = wh_test_pose(wh_test_rotation(0, 0, 1, 0.4), offset_x, offset_y, 0);
    const wh_pose_t home = slot_pose(s, slot, 0);
    const wh_pose_t start = wh_pose_compose(&home, &slot_from_wafer);
    double worst = 0;
    double worst_R = 0;
    cell_begin_default(&cell);
    assert_int_equal(wh_grasp_place(&cell.table, 0, &start), WH_OK);
    for (int cycle = 0; cycle < CYCLES; ++cycle) {
        get(&cell, s, slot);
        drawn = draw_station();
        slot = wh_test_below(SLOTS);
        put(&cell, s, slot);
        const wh_pose_t here = slot_pose(s, slot, 0);
        const wh_pose_t now = wh_pose_relative(&here, &cell.wafer[0].base_from_wafer);
        worst = fmax(worst, wh_test_difference_r(&now, &slot_from_wafer));
        worst_R = fmax(worst_R, wh_test_difference_R(&now, &slot_from_wafer));
    }
    printf("%d cycles: the offset moved by at most %.3g mm, the rotation by %.3g\n", CYCLES, worst, worst_R);
    assert_near(worst, 0, BOUND);
    assert_near(worst_R, 0, BOUND / 100);
    assert_int_equal(cell.table.counters.picked, CYCLES);
    assert_int_equal(cell.table.counters.near_misses, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(table_and_model_agree),
                                       cmocka_unit_test(offsets_survive)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
