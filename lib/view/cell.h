/* A cell for Drake's viewer: the bodies in one message (LOAD), their places in another (DRAW).
 *
 * Bodies have a folder before their name, which the viewer shows as a tree: "robot::forearm",
 * "stations::A", "grippers::EE", "doors::OUTER", "held::EE", "wafers::Wafer 1", "obstacles".
 *
 * A body's colour is part of LOAD, and a LOAD that differs from the last one makes the viewer restart. So a
 * held wafer gets its gripper's colour by a cover, "held::EE", which lies over it and is a quarter of a
 * millimetre larger all around. A cover without a wafer waits WH_VIEW_AWAY below the floor. Parts that
 * collided become red, in a LOAD of their own; the run ends there.
 *
 * Host code: it ends the program if out of memory. Nothing is allocated after wh_view_cell_open.
 */
#ifndef WH_VIEW_CELL_H
#define WH_VIEW_CELL_H

#include "../layout/doors.h"
#include "../layout/links.h"
#include "geometry.h"

/* mm: beyond the view of the viewer's camera. */
#define WH_VIEW_AWAY 1e6

/* The parts to leave out of a cell that is too large for a message. */
typedef enum { WH_VIEW_ALL, WH_VIEW_NO_LEDGES, WH_VIEW_BOXES, WH_VIEW_DETAILS } wh_view_detail_t;

/* `links` is the index of the arms' first link among the bodies, and so on. */
typedef struct {
    const wh_layout_t *layout; /* borrowed */
    wh_view_detail_t detail;
    wh_view_bodies_t bodies;
    size_t links, grippers, doors, covers, wafers;
    /* For each part of the collision world, including wafers: its body, or WH_NONE, and its shape there. */
    int32_t (*shown)[2];
    int32_t hit[2];    /* the parts that are red, or WH_NONE */
    float plain[2][4]; /* their own colours */
    wh_links_t robots;
} wh_view_cell_t;

/* The visible part of a state. */
typedef struct {
    int64_t utime;
    const wh_pose_t *base_from_grippers; /* one for each of the layout's grippers */
    const wh_real_t *axes;               /* the machine's, as commanded; null: not known */
    const wh_doors_t *door_places;       /* of the state; null: use the axes */
    const wh_wafer_t *wafers;
} wh_view_look_t;

/* Makes both messages of a layout, which must outlive them; everything is at its place before a run. With
 * WH_VIEW_NO_LEDGES no ledges are shown. With WH_VIEW_BOXES boxes also replace meshes. Cost: quadratic in
 * the points of meshes. */
void wh_view_cell_open(wh_view_cell_t *cell, const wh_layout_t *layout, wh_view_detail_t detail);

/* Sets the present places of everything, for `draw`. Cost: a square root for each body. */
void wh_view_cell_move(wh_view_cell_t *cell, const wh_view_look_t *look);

/* Sets the places before a run. */
void wh_view_cell_rest(wh_view_cell_t *cell);

/* Paints two parts of the collision world red in `load`, in place of the earlier ones; WH_NONE: none. A red
 * wafer has no cover. Returns false if nothing changes. */
bool wh_view_cell_set_hit(wh_view_cell_t *cell, const int32_t parts[2]);

void wh_view_cell_free(wh_view_cell_t *cell);

#endif
