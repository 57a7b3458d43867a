#include "tree.h"

/* It is beyond any cell, but finite, so that differences stay numbers. */
#define FAR WH_REAL(1e30)

wh_box_t wh_box_empty(void) {
    const wh_box_t empty = {{FAR, FAR, FAR}, {-FAR, -FAR, -FAR}};
    return empty;
}

bool wh_box_overlap(const wh_box_t *a, const wh_box_t *b) {
    return a->low.x <= b->high.x && b->low.x <= a->high.x && a->low.y <= b->high.y && b->low.y <= a->high.y &&
           a->low.z <= b->high.z && b->low.z <= a->high.z;
}

wh_box_t wh_box_grown(const wh_box_t *box, wh_real_t margin) {
    wh_box_t grown = *box;
    if (!(box->low.x > box->high.x)) {
        const wh_vec3_t by = {margin, margin, margin};
        grown.low = wh_vec3_subtract(&box->low, &by);
        grown.high = wh_vec3_add(&box->high, &by);
    }
    return grown;
}

static wh_real_t least(wh_real_t a, wh_real_t b) {
    return a < b ? a : b;
}

static wh_box_t join(const wh_box_t *a, const wh_box_t *b) {
    const wh_box_t both = {{least(a->low.x, b->low.x), least(a->low.y, b->low.y), least(a->low.z, b->low.z)},
                           {wh_real_max(a->high.x, b->high.x), wh_real_max(a->high.y, b->high.y),
                            wh_real_max(a->high.z, b->high.z)}};
    return both;
}

/* ---------------------------------------------------------------------------------------------- the order */

/* Spreads the lower 21 bits of v: two zeros between each and the next. */
static uint64_t spread(uint64_t v) {
    v &= 0x1fffff;
    v = (v | v << 32) & 0x1f00000000ffff;
    v = (v | v << 16) & 0x1f0000ff0000ff;
    v = (v | v << 8) & 0x100f00f00f00f00f;
    v = (v | v << 4) & 0x10c30c30c30c30c3;
    return (v | v << 2) & 0x1249249249249249;
}

/* A coordinate on a raster of 2^21 steps of 1/16 mm about base's origin. Cells hardly extend beyond this
 * range. */
static uint64_t raster(wh_real_t low, wh_real_t high) {
    const wh_real_t steps = 8 * (low + high) + WH_REAL(1048576);
    if (!(steps > 0)) {
        return 0;
    }
    return steps < WH_REAL(2097151) ? (uint64_t)steps : 2097151;
}

static uint64_t code_of(const wh_box_t *box) {
    return spread(raster(box->low.x, box->high.x)) | spread(raster(box->low.y, box->high.y)) << 1 |
           spread(raster(box->low.z, box->high.z)) << 2;
}

static bool is_before(const wh_tree_t *tree, int32_t a, int32_t b) {
    return tree->codes[a] != tree->codes[b] ? tree->codes[a] < tree->codes[b] : a < b;
}

/* Heap sort: in place, n log n for any order. */
static void sift(wh_tree_t *tree, size_t root, size_t count) {
    const int32_t item = tree->order[root];
    for (size_t child = 2 * root + 1; child < count; child = 2 * root + 1) {
        if (child + 1 < count && is_before(tree, tree->order[child], tree->order[child + 1])) {
            ++child;
        }
        if (!is_before(tree, item, tree->order[child])) {
            break;
        }
        tree->order[root] = tree->order[child];
        root = child;
    }
    tree->order[root] = item;
}

static void sort(wh_tree_t *tree) {
    for (size_t root = tree->count / 2; root > 0; --root) {
        sift(tree, root - 1, tree->count);
    }
    for (size_t last = tree->count; last > 1; --last) {
        const int32_t item = tree->order[last - 1];
        tree->order[last - 1] = tree->order[0];
        tree->order[0] = item;
        sift(tree, 0, last - 1);
    }
}

/* ----------------------------------------------------------------------------------------------- the tree */

static size_t leaves_for(size_t count) {
    size_t leaves = 1;
    while (leaves < count) {
        leaves *= 2;
    }
    return leaves;
}

size_t wh_tree_nodes(size_t count) {
    return 2 * leaves_for(count);
}

void wh_tree_build(wh_tree_t *tree, const wh_box_t boxes[]) {
    tree->leaves = leaves_for(tree->count);
    for (size_t i = 0; i < tree->count; ++i) {
        tree->order[i] = (int32_t)i;
        tree->codes[i] = code_of(&boxes[i]);
    }
    sort(tree);
    for (size_t leaf = 0; leaf < tree->leaves; ++leaf) {
        tree->nodes[tree->leaves + leaf] = leaf < tree->count ? boxes[tree->order[leaf]] : wh_box_empty();
        if (leaf < tree->count) {
            tree->leaf_of[tree->order[leaf]] = (int32_t)leaf;
        }
    }
    for (size_t node = tree->leaves - 1; node > 0; --node) {
        tree->nodes[node] = join(&tree->nodes[2 * node], &tree->nodes[2 * node + 1]);
    }
}

void wh_tree_set(wh_tree_t *tree, int32_t item, const wh_box_t *box) {
    size_t node = tree->leaves + (size_t)tree->leaf_of[item];
    tree->nodes[node] = *box;
    for (node /= 2; node > 0; node /= 2) {
        tree->nodes[node] = join(&tree->nodes[2 * node], &tree->nodes[2 * node + 1]);
    }
}

wh_box_t wh_tree_box(const wh_tree_t *tree, int32_t item) {
    return tree->nodes[tree->leaves + (size_t)tree->leaf_of[item]];
}

/* The next node of a walk that does not go below `node`; 0 at the end. */
static size_t next_beside(size_t node) {
    while (node & 1U) {
        node /= 2;
    }
    return node == 0 ? 0 : node + 1;
}

size_t wh_tree_find(const wh_tree_t *tree, const wh_box_t *box, int32_t found[], size_t capacity) {
    size_t count = 0;
    size_t node = tree->count > 0 ? 1 : 0;
    while (node != 0) {
        const bool hit = wh_box_overlap(&tree->nodes[node], box);
        if (hit && node < tree->leaves) {
            node *= 2;
            continue;
        }
        if (hit) {
            if (count < capacity) {
                found[count] = tree->order[node - tree->leaves];
            }
            ++count;
        }
        node = next_beside(node);
    }
    return count;
}
