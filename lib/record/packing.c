#include "packing.h"

#include <stdlib.h>

#include "../text/array.h"

size_t wh_packing(wh_packed_t spans[], size_t count) {
    double *ends = wh_array_new(count, sizeof *ends);
    size_t lanes = 0;
    for (size_t i = 0; i < count; ++i) {
        size_t lane = 0;
        while (lane < lanes && ends[lane] > spans[i].begin) {
            ++lane;
        }
        lanes = lane == lanes ? lanes + 1 : lanes;
        ends[lane] = spans[i].end;
        spans[i].lane = lane;
    }
    free(ends);
    return lanes;
}
