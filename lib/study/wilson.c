#include "wilson.h"

#include <math.h>

#define Z 1.959963984540054

wh_confidence_t wh_wilson_interval(uint64_t hits, uint64_t trials) {
    if (trials == 0) {
        const wh_confidence_t unknown = {0, 0, 1};
        return unknown;
    }
    const double n = (double)trials;
    const double p = (double)hits / n;
    const double centre = p + Z * Z / (2 * n);
    const double reach = Z * sqrt(p * (1 - p) / n + Z * Z / (4 * n * n));
    const double scale = 1 + Z * Z / n;
    const wh_confidence_t interval = {p, hits == 0 ? 0 : (centre - reach) / scale,
                                      hits == trials ? 1 : (centre + reach) / scale};
    return interval;
}
