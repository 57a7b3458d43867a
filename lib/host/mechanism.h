/* The mechanism that a port stands for: the whole cell, or one of its robots, aligners and load ports.
 *
 * Constant tables and pure functions: any thread.
 */
#ifndef WH_HOST_MECHANISM_H
#define WH_HOST_MECHANISM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "../layout/layout.h"
#include "words.h"

/* Room for the reason why there is none of that name. */
#define WH_MECHANISM_PROBLEM 1000

/* No two ports of a cell stand for one mechanism, and the whole cell is every mechanism. */
typedef struct {
    wh_mechanism_t kind;
    int32_t index;     /* of a robot or a station in the layout; WH_NONE: it is all of that kind */
    const char *name;  /* in the layout; null: all of that kind */
    uint32_t grippers; /* which are its own, bits */
} wh_port_mechanism_t;

/* All mechanisms of a kind in a layout; null: no layout is known, and no mechanism has grippers. */
wh_port_mechanism_t wh_mechanism_all(wh_mechanism_t kind, const wh_layout_t *layout);

/* The robot or the station of this name. The dialect's kind says which, if it is not the cell: else it is a
 * robot if one is called so, and of stations an aligner if it turns wafers. False if there is none:
 * `problem` tells the name and those that there are. */
bool wh_mechanism_find(wh_mechanism_t kind, const char *name, const wh_layout_t *layout,
                       wh_port_mechanism_t *mechanism, char problem[WH_MECHANISM_PROBLEM]);

/* The name of the only mechanism of this kind; null: there are several, or none, or it is the whole cell. */
const char *wh_mechanism_only(wh_mechanism_t kind, const wh_layout_t *layout);

/* True if no port may stand for `a` while another one stands for `b`. */
bool wh_mechanisms_clash(const wh_port_mechanism_t *a, const wh_port_mechanism_t *b);

/* True if a controller of that kind knows the word. */
bool wh_mechanism_does(wh_mechanism_t kind, const wh_word_t *word);

#endif
