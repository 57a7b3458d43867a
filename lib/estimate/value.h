/* The estimate of one number: its value with its standard deviation, or the statement that the measurements
 * do not determine it. These are plain structs; nothing keeps a reference; all functions of the room are
 * reentrant, and equal measurements give equal bits in one build. */
#ifndef WH_ESTIMATE_VALUE_H
#define WH_ESTIMATE_VALUE_H

#include <stdbool.h>
#include <stddef.h>

#include "../math/status.h"

/* One number. */
typedef struct {
    double value, sd; /* without meaning unless is_determined */
    bool is_determined;
} wh_estimate_value_t;

/* Room for the reason why something is not determined, and for the missing measurements: one line, without
 * a full stop. */
#define WH_ESTIMATE_REASON 400

#endif
