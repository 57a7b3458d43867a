/* The grasp table and its model side by side: the first difference between them, and what must hold of the table
 * alone, as a phrase; null when all is well. */
#ifndef WH_TESTS_SUPPORT_GRASP_MODEL_COMPARE_H
#define WH_TESTS_SUPPORT_GRASP_MODEL_COMPARE_H

#include "support/grasp_model_hash.h"

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

/* What must hold whatever the model says. */
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

#endif
