/* Which nodes of the search for the best schedule are kept: not those that another one beats. */
#include <stdlib.h>
#include <string.h>

#include "../math/hash.h"
#include "best_internal.h"

uint64_t wh_best_kind(const problem_t *problem, const node_t *node) {
    uint64_t hash = WH_HASH_START;
    for (int32_t w = 0; w < problem->wafers; ++w) {
        hash = wh_hash_word(hash, (uint64_t)(uint16_t)node->step[w] << 16 | (uint16_t)node->at[w]);
    }
    for (int32_t r = 0; r < problem->robots; ++r) {
        hash = wh_hash_word(hash, (uint16_t)node->robot_at[r]);
    }
    return hash;
}

static int by_bound(const void *a, const void *b) {
    const node_t *one = a, *other = b;
    if (one->bound_us != other->bound_us) {
        return one->bound_us < other->bound_us ? -1 : 1;
    }
    if (one->rest_us != other->rest_us) {
        return one->rest_us < other->rest_us ? -1 : 1;
    }
    return one->parent < other->parent ? -1 : one->parent > other->parent ? 1 : 0;
}

void wh_best_sort(node_t nodes[], size_t count) {
    qsort(nodes, count, sizeof *nodes, by_bound);
}

static int by_kind(const void *a, const void *b) {
    const node_t *one = a, *other = b;
    if (one->kind != other->kind) {
        return one->kind < other->kind ? -1 : 1;
    }
    return by_bound(a, b);
}

static bool is_same_kind(const node_t *a, const node_t *b) {
    return memcmp(a->step, b->step, sizeof a->step) == 0 && memcmp(a->at, b->at, sizeof a->at) == 0 &&
           memcmp(a->robot_at, b->robot_at, sizeof a->robot_at) == 0;
}

static bool are_robots_earlier(const problem_t *problem, const node_t *a, const node_t *b) {
    bool are = true;
    for (int32_t r = 0; are && r < problem->robots; ++r) {
        are = a->free_us[r] <= b->free_us[r];
    }
    return are;
}

static bool are_wafers_earlier(const problem_t *problem, const node_t *a, const node_t *b) {
    bool are = true;
    for (int32_t w = 0; are && w < problem->wafers; ++w) {
        are = a->ready_us[w] <= later(b->ready_us[w], b->now_us);
    }
    return are;
}

/* When a place was taken matters to robots alone that are free since before that. */
static bool are_places_earlier(const problem_t *problem, const node_t *a, const node_t *b) {
    int64_t free_us = a->free_us[0];
    bool are = true;
    for (int32_t r = 1; r < problem->robots; ++r) {
        free_us = a->free_us[r] < free_us ? a->free_us[r] : free_us;
    }
    for (int32_t p = 0; are && p < problem->places; ++p) {
        are = a->picked_us[p] <= later(b->picked_us[p], b->now_us) &&
              a->empty_us[p] <= later(b->empty_us[p], b->now_us) &&
              (a->taken_us[p] <= b->taken_us[p] || a->taken_us[p] < free_us);
    }
    return are;
}

/* True if whatever goes on from `b` can go on from `a` as early. Nothing begins before now. */
static bool beats(const problem_t *problem, const node_t *a, const node_t *b) {
    return a->now_us <= b->now_us && is_same_kind(a, b) && are_robots_earlier(problem, a, b) &&
           are_wafers_earlier(problem, a, b) && are_places_earlier(problem, a, b);
}

/* How many of its kind a node is compared with. */
#define COMPARED 400

size_t wh_best_drop_beaten(const problem_t *problem, node_t nodes[], size_t count) {
    size_t kept = 0, first = 0;
    if (count > 0) {
        qsort(nodes, count, sizeof *nodes, by_kind);
    }
    for (size_t i = 0; i < count; ++i) {
        bool beaten = false;
        first = kept > 0 && nodes[kept - 1].kind == nodes[i].kind ? first : kept;
        for (size_t k = first; k < kept && k < first + COMPARED && !beaten; ++k) {
            beaten = beats(problem, &nodes[k], &nodes[i]);
        }
        if (!beaten) {
            nodes[kept++] = nodes[i];
        }
    }
    return kept;
}
