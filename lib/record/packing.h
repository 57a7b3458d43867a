/* Puts spans of time that overlap side by side in lanes: in a plot each lane is a row. */
#ifndef WH_RECORD_PACKING_H
#define WH_RECORD_PACKING_H

#include <stddef.h>

typedef struct {
    double begin, end;
    size_t lane; /* the result, from 0 */
} wh_packed_t;

/* Gives each span the first lane that is free at its begin: no span in that lane ends later. The spans are
 * in the order of their begins. Returns the number of lanes. Cost: spans times lanes. */
size_t wh_packing(wh_packed_t spans[], size_t count);

#endif
