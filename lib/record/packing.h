/* Spans of time that overlap, side by side in lanes: for a plot, where each lane is a row. */
#ifndef WH_RECORD_PACKING_H
#define WH_RECORD_PACKING_H

#include <stddef.h>

typedef struct {
    double begin, end;
    size_t lane; /* written: from 0 */
} wh_packed_t;

/* Gives each span, which are in the order in which they begin, the first lane that is free by then: in which
 * no span ends later. Returns how many lanes there are. Cost: spans times lanes. */
size_t wh_packing(wh_packed_t spans[], size_t count);

#endif
