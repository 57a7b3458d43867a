/* The state's hash once more, from the header's words alone, over the model's state. */
#ifndef WH_TESTS_SUPPORT_GRASP_MODEL_HASH_H
#define WH_TESTS_SUPPORT_GRASP_MODEL_HASH_H

#include "support/grasp_model.h"

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
