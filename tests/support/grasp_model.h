/* A slow, obvious model of the sampled grasp table: it follows the rules one by one, with none of
 * the library's code but its structs. Each sum is written from left to right, as the library
 * promises, so bits can be compared. */
#ifndef WH_TESTS_SUPPORT_GRASP_MODEL_H
#define WH_TESTS_SUPPORT_GRASP_MODEL_H

#include <math.h>
#include <string.h>

#include "grasp/grasp.h"

enum { MODEL_WAFERS = 6, MODEL_GRIPPERS = 4, MODEL_EVENTS = 32 };

typedef struct {
    wh_grasp_config_t config;
    int wafers, grippers;
    wh_pose_t wafer[MODEL_WAFERS];
    int holder[MODEL_WAFERS], let_go_by[MODEL_WAFERS];
    wh_pose_t gripper[MODEL_GRIPPERS], grasp[MODEL_GRIPPERS];
    int valve[MODEL_GRIPPERS], holds[MODEL_GRIPPERS];
    wh_encounter_t approach[MODEL_GRIPPERS], contest[MODEL_GRIPPERS];
    uint64_t slice;
    wh_grasp_counters_t counters;
    wh_event_t event[MODEL_EVENTS];
    int events;
} model_t;

static wh_mat3_t model_product(const wh_mat3_t *a, const wh_mat3_t *b) {
    wh_mat3_t c;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            c.m[i][j] = a->m[i][0] * b->m[0][j] + a->m[i][1] * b->m[1][j] + a->m[i][2] * b->m[2][j];
        }
    }
    return c;
}

static wh_mat3_t model_transpose(const wh_mat3_t *a) {
    wh_mat3_t c;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            c.m[i][j] = a->m[j][i];
        }
    }
    return c;
}

/* R^T R */
static wh_mat3_t model_square(const wh_mat3_t *R) {
    const wh_mat3_t T = model_transpose(R);
    return model_product(&T, R);
}

/* R (3 I - R^T R) / 2 */
static wh_mat3_t model_mended(const wh_mat3_t *R) {
    wh_mat3_t S = model_square(R);
    for (int i = 0; i < 9; ++i) {
        S.m[i / 3][i % 3] = ((i % 4 ? 0 : 3) - S.m[i / 3][i % 3]) / 2;
    }
    return model_product(R, &S);
}

static bool model_is_rotation(const wh_mat3_t *R) {
    const wh_mat3_t S = model_square(R);
    for (int i = 0; i < 9; ++i) {
        const wh_real_t off = S.m[i / 3][i % 3] - (i % 4 ? 0 : 1);
        if (!(off <= WH_ROTATION_TOLERANCE && off >= -WH_ROTATION_TOLERANCE)) {
            return false;
        }
    }
    return R->m[0][0] * (R->m[1][1] * R->m[2][2] - R->m[1][2] * R->m[2][1]) -
               R->m[0][1] * (R->m[1][0] * R->m[2][2] - R->m[1][2] * R->m[2][0]) +
               R->m[0][2] * (R->m[1][0] * R->m[2][1] - R->m[1][1] * R->m[2][0]) >
           0;
}

/* R_w = R_g G, r_w = R_g g + r_g */
static wh_pose_t model_carried(const wh_pose_t *by, const wh_pose_t *grasp) {
    wh_pose_t w;
    const wh_real_t(*R)[3] = by->R.m;
    const wh_vec3_t g = grasp->r;
    w.R = model_product(&by->R, &grasp->R);
    if (!model_is_rotation(&w.R)) {
        w.R = model_mended(&w.R);
    }
    w.r.x = R[0][0] * g.x + R[0][1] * g.y + R[0][2] * g.z + by->r.x;
    w.r.y = R[1][0] * g.x + R[1][1] * g.y + R[1][2] * g.z + by->r.y;
    w.r.z = R[2][0] * g.x + R[2][1] * g.y + R[2][2] * g.z + by->r.z;
    return w;
}

/* G = R_g^T R_w, mended; g = R_g^T (r_w - r_g) */
static wh_pose_t model_grasp(const wh_pose_t *by, const wh_pose_t *w) {
    wh_pose_t G;
    const wh_mat3_t T = model_transpose(&by->R);
    const wh_real_t d[3] = {w->r.x - by->r.x, w->r.y - by->r.y, w->r.z - by->r.z};
    G.R = model_product(&T, &w->R);
    G.R = model_mended(&G.R);
    G.r.x = T.m[0][0] * d[0] + T.m[0][1] * d[1] + T.m[0][2] * d[2];
    G.r.y = T.m[1][0] * d[0] + T.m[1][1] * d[1] + T.m[1][2] * d[2];
    G.r.z = T.m[2][0] * d[0] + T.m[2][1] * d[1] + T.m[2][2] * d[2];
    return G;
}

static wh_real_t model_size(wh_real_t a) {
    return a > 0 ? a : -a;
}

/* (1)-(8) */
static wh_proximity_t model_measure(const model_t *m, int w, const wh_pose_t *by) {
    wh_proximity_t p;
    const wh_real_t(*R)[3] = m->wafer[w].R.m;
    memset(&p, 0, sizeof p);
    p.dr.x = m->wafer[w].r.x - by->r.x;
    p.dr.y = m->wafer[w].r.y - by->r.y;
    p.dr.z = m->wafer[w].r.z - by->r.z;
    p.n1_proj_n2 = R[0][2] * by->R.m[0][2] + R[1][2] * by->R.m[1][2] + R[2][2] * by->R.m[2][2];
    p.dr_proj_xy.x = R[0][0] * p.dr.x + R[1][0] * p.dr.y + R[2][0] * p.dr.z;
    p.dr_proj_xy.y = R[0][1] * p.dr.x + R[1][1] * p.dr.y + R[2][1] * p.dr.z;
    p.dr_proj_xy.z = R[0][2] * p.dr.x + R[1][2] * p.dr.y + R[2][2] * p.dr.z;
    p.dr_proj_z = p.dr_proj_xy.z;
    p.dr_proj_xy_norm = wh_real_sqrt(p.dr_proj_xy.x * p.dr_proj_xy.x + p.dr_proj_xy.y * p.dr_proj_xy.y);
    p.failed |= model_size(p.dr_proj_z) < m->config.tolerance.projz ? 0U : 1U;
    p.failed |= p.dr_proj_xy_norm < m->config.tolerance.projxy ? 0U : 2U;
    p.failed |= p.n1_proj_n2 > m->config.tolerance.planar ? 0U : 4U;
    p.ready = !p.failed;
    return p;
}

static void model_event(model_t *m, wh_event_kind_t kind, int w, int g, int other, uint64_t when,
                        const wh_proximity_t *measured) {
    wh_event_t *e = &m->event[m->events++];
    memset(e, 0, sizeof *e);
    e->kind = kind;
    e->slice = m->slice;
    e->measured_slice = when;
    e->wafer = w;
    e->gripper = g;
    e->other = other;
    if (measured) {
        e->measured = *measured;
    }
    m->counters.picked += kind == WH_EVENT_PICKED;
    m->counters.released += kind == WH_EVENT_RELEASED;
    m->counters.handed_over += kind == WH_EVENT_HANDED_OVER;
    m->counters.near_misses += kind == WH_EVENT_NEAR_MISS;
    m->counters.contested += kind == WH_EVENT_CONTESTED;
}

/* The wafer with the smallest |dr_proj_z| among those for which this gripper is ready, free or held. */
static int model_best(const model_t *m, const wh_pose_t *by, bool held) {
    int best = -1;
    for (int w = 0; w < m->wafers; ++w) {
        if ((m->holder[w] >= 0) == held && model_measure(m, w, by).ready &&
            (best < 0 || model_size(model_measure(m, w, by).dr_proj_z) <
                             model_size(model_measure(m, best, by).dr_proj_z))) {
            best = w;
        }
    }
    return best;
}

static void model_pick(model_t *m, int g, const wh_gripper_input_t *in) {
    const int w = model_best(m, &in->base_from_gripper, false);
    if (in->valve == 1 || m->holds[g] >= 0 || w < 0) {
        return;
    }
    const wh_proximity_t p = model_measure(m, w, &in->base_from_gripper);
    model_event(m, m->let_go_by[w] >= 0 ? WH_EVENT_HANDED_OVER : WH_EVENT_PICKED, w, g, m->let_go_by[w],
                m->slice, &p);
    m->holder[w] = g;
    m->holds[g] = w;
    m->grasp[g] = model_grasp(&in->base_from_gripper, &m->wafer[w]);
}

static bool model_near(const model_t *m, const wh_proximity_t *p) {
    return model_size(p->dr_proj_z) < m->config.near_projz && p->dr_proj_xy_norm < m->config.near_projxy;
}

static wh_real_t model_far(const model_t *m, const wh_proximity_t *p) {
    const wh_real_t z = p->dr_proj_z / m->config.tolerance.projz;
    const wh_real_t xy = p->dr_proj_xy_norm / m->config.tolerance.projxy;
    return z * z + xy * xy;
}

static void model_watch(model_t *m, wh_encounter_t *e, int w, const wh_proximity_t *p) {
    e->wafer = w;
    e->holder = m->holder[w];
    e->slice = m->slice;
    e->measured = *p;
}

static void model_miss(model_t *m, wh_encounter_t *e, int g) {
    model_event(m, WH_EVENT_NEAR_MISS, e->wafer, g, -1, e->slice, &e->measured);
    e->wafer = -1;
}

static void model_follow(model_t *m, wh_encounter_t *e, int g, const wh_pose_t *by) {
    const wh_proximity_t p = model_measure(m, e->wafer, by);
    if (!model_near(m, &p)) {
        model_miss(m, e, g);
    } else if (model_far(m, &p) < model_far(m, &e->measured)) {
        model_watch(m, e, e->wafer, &p);
    }
}

static void model_look(model_t *m, wh_encounter_t *e, const wh_pose_t *by) {
    for (int w = 0; w < m->wafers; ++w) {
        const wh_proximity_t p = model_measure(m, w, by);
        if (m->holder[w] < 0 && model_near(m, &p) &&
            (e->wafer < 0 || model_size(p.dr_proj_z) < model_size(e->measured.dr_proj_z))) {
            model_watch(m, e, w, &p);
        }
    }
}

static void model_approach(model_t *m, int g, const wh_gripper_input_t *in) {
    wh_encounter_t *e = &m->approach[g];
    const bool busy = m->holds[g] >= 0 && in->valve == 0;
    if (e->wafer >= 0 && (busy || m->holder[e->wafer] >= 0)) {
        e->wafer = -1;
    } else if (e->wafer >= 0 && in->valve == 1) {
        model_miss(m, e, g);
    } else if (e->wafer >= 0) {
        model_follow(m, e, g, &in->base_from_gripper);
    } else if (in->valve == 0 && !busy) {
        model_look(m, e, &in->base_from_gripper);
    }
}

static void model_contest(model_t *m, int g, const wh_gripper_input_t *in) {
    wh_encounter_t *e = &m->contest[g];
    const bool may = in->valve == 0 && m->holds[g] < 0;
    if (e->wafer >= 0) {
        const int holder = m->holder[e->wafer];
        const bool handed_over = holder >= 0 && holder != e->holder;
        if (may && holder == e->holder && model_measure(m, e->wafer, &in->base_from_gripper).ready) {
            return;
        }
        if (!handed_over) {
            model_event(m, WH_EVENT_CONTESTED, e->wafer, g, e->holder, e->slice, &e->measured);
        }
        e->wafer = -1;
    }
    const int w = may ? model_best(m, &in->base_from_gripper, true) : -1;
    if (w >= 0) {
        const wh_proximity_t p = model_measure(m, w, &in->base_from_gripper);
        model_watch(m, e, w, &p);
    }
}

static wh_status_t model_refuses(const wh_gripper_input_t *in) {
    wh_real_t number[12];
    memcpy(number, in->base_from_gripper.R.m, 9 * sizeof number[0]);
    number[9] = in->base_from_gripper.r.x;
    number[10] = in->base_from_gripper.r.y;
    number[11] = in->base_from_gripper.r.z;
    for (int i = 0; i < 12; ++i) {
        if (!isfinite(number[i])) {
            return WH_STATUS_NOT_FINITE;
        }
    }
    if (!model_is_rotation(&in->base_from_gripper.R)) {
        return WH_STATUS_NOT_A_ROTATION;
    }
    return in->valve == 0 || in->valve == 1 ? WH_OK : WH_STATUS_BAD_VALVE;
}

static void model_carry(model_t *m, const wh_gripper_input_t *in) {
    for (int g = 0; g < m->grippers; ++g) {
        const int w = m->holds[g];
        if (w >= 0) {
            m->wafer[w] = model_carried(&in[g].base_from_gripper, &m->grasp[g]);
        }
        if (w >= 0 && in[g].valve == 1) {
            m->holder[w] = -1;
            m->holds[g] = -1;
            m->let_go_by[w] = g;
        }
    }
}

static wh_status_t model_step(model_t *m, const wh_gripper_input_t *in) {
    m->events = 0;
    for (int g = 0; g < m->grippers; ++g) {
        const wh_status_t status = model_refuses(&in[g]);
        if (status != WH_OK) {
            ++m->counters.refused;
            ++m->slice;
            model_event(m, WH_EVENT_BAD_INPUT, -1, g, -1, m->slice, NULL);
            --m->slice;
            return status;
        }
    }
    ++m->slice;
    model_carry(m, in);
    for (int g = 0; g < m->grippers; ++g) {
        model_pick(m, g, &in[g]);
    }
    for (int g = 0; g < m->grippers; ++g) {
        for (int w = 0; w < m->wafers; ++w) {
            if (m->let_go_by[w] == g && m->holder[w] < 0) {
                const wh_proximity_t p = model_measure(m, w, &in[g].base_from_gripper);
                model_event(m, WH_EVENT_RELEASED, w, g, -1, m->slice, &p);
            }
        }
    }
    for (int g = 0; g < m->grippers; ++g) {
        model_approach(m, g, &in[g]);
        model_contest(m, g, &in[g]);
        m->gripper[g] = in[g].base_from_gripper;
        m->valve[g] = in[g].valve;
    }
    for (int w = 0; w < m->wafers; ++w) {
        m->let_go_by[w] = -1;
    }
    return WH_OK;
}

/* The state's hash over the model's state, written from the text of the header alone. */
static void model_hash_word(uint64_t *h, uint64_t w) {
    *h = (*h ^ w) * UINT64_C(0x9e3779b97f4a7c15);
    *h ^= *h >> 32;
}

static void model_hash_int(uint64_t *h, int64_t value) {
    model_hash_word(h, (uint64_t)value);
}

static void model_hash_real(uint64_t *h, wh_real_t value) {
    union {
        wh_real_t value;
        uint32_t bits32;
        uint64_t bits64;
    } u;
    u.bits64 = 0;
    u.value = value;
    model_hash_word(h, sizeof value == 4 ? u.bits32 : u.bits64);
}

static void model_hash_vector(uint64_t *h, wh_vec3_t v) {
    model_hash_real(h, v.x);
    model_hash_real(h, v.y);
    model_hash_real(h, v.z);
}

static void model_hash_pose(uint64_t *h, const wh_pose_t *pose) {
    for (int i = 0; i < 9; ++i) {
        model_hash_real(h, pose->R.m[i / 3][i % 3]);
    }
    model_hash_vector(h, pose->r);
}

static void model_hash_encounter(uint64_t *h, const wh_encounter_t *e) {
    model_hash_int(h, e->wafer);
    if (e->wafer >= 0) {
        model_hash_int(h, e->holder);
        model_hash_word(h, e->slice);
        model_hash_vector(h, e->measured.dr);
        model_hash_real(h, e->measured.n1_proj_n2);
        model_hash_real(h, e->measured.dr_proj_z);
        model_hash_vector(h, e->measured.dr_proj_xy);
        model_hash_real(h, e->measured.dr_proj_xy_norm);
    }
}

static uint64_t model_hash(const model_t *m) {
    uint64_t h = UINT64_C(0x6a09e667f3bcc908);
    model_hash_word(&h, m->slice);
    for (int w = 0; w < m->wafers; ++w) {
        model_hash_pose(&h, &m->wafer[w]);
        model_hash_int(&h, m->holder[w]);
    }
    for (int g = 0; g < m->grippers; ++g) {
        model_hash_pose(&h, &m->gripper[g]);
        model_hash_int(&h, m->valve[g]);
        model_hash_int(&h, m->holds[g]);
        if (m->holds[g] >= 0) {
            model_hash_pose(&h, &m->grasp[g]);
        }
        model_hash_encounter(&h, &m->approach[g]);
        model_hash_encounter(&h, &m->contest[g]);
    }
    return h;
}

#endif
