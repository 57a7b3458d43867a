#include "merge.h"

#include "angle_internal.h"

/* A point farther from the median is light that fell through, mm. */
#define APART 0.2

/* The sorted radii of the points that see the rim; returns their number. */
static size_t sort_radii(const wh_rim_point_t points[], size_t count, double radii[WH_MERGE_TURNS]) {
    size_t seen = 0;
    for (size_t i = 0; i < count; ++i) {
        if (points[i].sight == WH_SIGHT_RIM) {
            size_t place = seen;
            while (place > 0 && radii[place - 1] > points[i].radius) {
                radii[place] = radii[place - 1];
                --place;
            }
            radii[place] = points[i].radius;
            ++seen;
        }
    }
    return seen;
}

static double mean_of(const double radii[], size_t count) {
    const double median = (radii[(count - 1) / 2] + radii[count / 2]) / 2;
    double sum = 0;
    size_t near = 0;
    for (size_t i = 0; i < count; ++i) {
        if (fabs(radii[i] - median) <= APART) {
            sum += radii[i];
            ++near;
        }
    }
    return near > 0 ? sum / (double)near : median;
}

wh_rim_point_t wh_rim_points_merge(const wh_rim_point_t points[], size_t count) {
    double radii[WH_MERGE_TURNS] = {0};
    const size_t seen = sort_radii(points, count, radii);
    wh_rim_point_t merged = points[0];
    if (2 * seen >= count) {
        merged.sight = WH_SIGHT_RIM;
        merged.radius = mean_of(radii, seen);
        return merged;
    }
    size_t i = 0;
    while (points[i].sight == WH_SIGHT_RIM) {
        ++i;
    }
    merged.sight = points[i].sight;
    return merged;
}
