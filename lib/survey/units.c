/* Tells of valid numbers that look as if they were given in another unit: those that layout_guesses.c
 * found, and a cell in metres. */
#include "feasibility_internal.h"

/* A cell whose stations are all nearer to base than this was probably meant in metres, mm. */
#define SMALL_CELL 10

static wh_real_t farthest_of(const wh_vec3_t *at) {
    return wh_real_max(wh_real_abs(at->x), wh_real_max(wh_real_abs(at->y), wh_real_abs(at->z)));
}

static void look_at_places(wh_feasibility_t *check) {
    const wh_layout_t *layout = check->layout;
    wh_real_t most = 0;
    for (size_t s = 0; s < layout->station_count; ++s) {
        if (layout->stations[s].taught) {
            most = wh_real_max(most, farthest_of(&layout->places[s].base_from_station.r));
        }
    }
    if (most > 0 && most < SMALL_CELL) {
        (void)wh_feasibility_add(
            check, WH_FINDING_UNIT, WH_NONE,
            "no station is farther than %g mm from base's origin: that looks like metres "
            "(`at` is in mm)",
            most);
        wh_feasibility_warn(check);
    }
}

void wh_feasibility_units(wh_feasibility_t *check) {
    const wh_layout_t *layout = check->layout;
    look_at_places(check);
    for (size_t i = 0; i < layout->guess_count; ++i) {
        (void)wh_feasibility_add(check, WH_FINDING_UNIT, WH_NONE, "%s", layout->guesses[i]);
        wh_feasibility_warn(check);
    }
}
