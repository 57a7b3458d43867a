/* What an estimate says of one number: the value with its standard deviation, or that the measurements do not
 * tell it. Plain structs; nothing keeps a reference; all functions of the room are reentrant, and the same
 * measurements give the same bits in one build. */
#ifndef WH_ESTIMATE_VALUE_H
#define WH_ESTIMATE_VALUE_H

#include <stdbool.h>
#include <stddef.h>

#include "../math/status.h"

/* One number. */
typedef struct {
    double value, sd; /* of no meaning unless is_determined */
    bool is_determined;
} wh_estimate_value_t;

/* Room for why something is not determined, and which measurements are missing: one line, no stop. */
#define WH_ESTIMATE_REASON 400

#endif
