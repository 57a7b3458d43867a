/* A tree of axis-aligned boxes over things at rest. Finding the things near a place costs the logarithm of
 * their number.
 *
 * Items are numbered from 0. The tree is complete and is in one array, with node i above nodes 2 i and 2 i
 * + 1. Its leaves are in the order of a space-filling curve (Morton's) at the time it was built. If a box
 * changes, the nodes above it are updated; the order stays until the tree is built again. It uses no heap
 * and no recursion; the arrays belong to the caller.
 */
#ifndef WH_COLLISION_TREE_H
#define WH_COLLISION_TREE_H

#include "../math/vector.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(tree);

/* From `low` to `high`, mm in base. A box with low above high is empty: it overlaps nothing. */
typedef struct {
    wh_vec3_t low, high;
} wh_box_t;

/* Only the functions below write to it, except the parts that the caller fills for wh_tree_build. */
typedef struct {
    wh_box_t *nodes;  /* wh_tree_nodes(count) of them: node 1 is the root */
    int32_t *order;   /* count: item at each leaf */
    int32_t *leaf_of; /* count: leaf of each item */
    uint64_t *codes;  /* count: used only by wh_tree_build */
    size_t count;     /* items, up to 2^28 */
    size_t leaves;    /* the least power of two that is at least count */
} wh_tree_t;

/* An empty box. */
wh_box_t wh_box_empty(void) WH_SYMBOL(wh_box_empty);

/* True if two boxes have a point in common, surfaces included. */
bool wh_box_overlap(const wh_box_t *a, const wh_box_t *b) WH_SYMBOL(wh_box_overlap);

/* The box enlarged by `margin` (mm) to all sides; an empty one stays empty. */
wh_box_t wh_box_grown(const wh_box_t *box, wh_real_t margin) WH_SYMBOL(wh_box_grown);

/* The number of nodes of a tree with `count` items. */
size_t wh_tree_nodes(size_t count) WH_SYMBOL(wh_tree_nodes);

/* Builds the tree over boxes[0 .. count - 1]. The caller has filled in tree->nodes, order, leaf_of, codes
 * and count. Items with an empty box are in the tree, but no search finds them. Equal boxes give equal
 * trees. Cost: n log n. */
void wh_tree_build(wh_tree_t *tree, const wh_box_t boxes[]) WH_SYMBOL(wh_tree_build);

/* Gives an item another box. Cost: log n. */
void wh_tree_set(wh_tree_t *tree, int32_t item, const wh_box_t *box) WH_SYMBOL(wh_tree_set);

/* The item's latest box. */
wh_box_t wh_tree_box(const wh_tree_t *tree, int32_t item) WH_SYMBOL(wh_tree_box);

/* Finds the items whose boxes overlap this one, in the leaves' order. Writes at most `capacity` of them to
 * `found`; returns their number. Cost: log n plus linear in the number found, while the tree is well
 * ordered. */
size_t wh_tree_find(const wh_tree_t *tree, const wh_box_t *box, int32_t found[], size_t capacity)
    WH_SYMBOL(wh_tree_find);

WH_HEADER_END

#endif
