/* Oracle: all slots of all stations, each checked by the text of cell/station.h in long double. */
#include "cell/station.h"
#include "support/pose.h"

#define ROUNDS 20000
#define STATIONS 4

static wh_station_t stations[STATIONS];
static wh_cell_t cell;

static long double dot(const long double a[3], const wh_mat3_t *R, int column) {
    return a[0] * (long double)R->m[0][column] + a[1] * (long double)R->m[1][column] +
           a[2] * (long double)R->m[2][column];
}

/* A few stations with a few slots, so near each other that a wafer can lie in several. */
static void draw_cell(void) {
    for (size_t s = 0; s < STATIONS; ++s) {
        stations[s].base_from_station = wh_test_random_pose(60);
        stations[s].base_from_station.R = wh_test_random_turn(0.3);
        stations[s].slots = 1 + (int32_t)wh_test_below(6);
        stations[s].pitch = WH_REAL(wh_test_uniform(5, 40));
        stations[s].chuck = WH_NONE;
    }
    cell.stations = stations;
    cell.count = wh_test_below(STATIONS + 1);
    cell.tolerance = wh_tolerance_paper();
    cell.tolerance.projxy = WH_REAL(wh_test_uniform(20, 90));
}

/* The square of the distance to a slot in which the wafer lies, or -1; *edge is true if rounding decides. */
static long double distance(const wh_station_t *station, int slot, const wh_pose_t *wafer, bool *edge) {
    const wh_pose_t *at = &station->base_from_station;
    const long double up = (long double)(slot - 1) * (long double)station->pitch;
    const long double dr[3] = {
        (long double)wafer->r.x - (long double)at->r.x - up * (long double)at->R.m[0][2],
        (long double)wafer->r.y - (long double)at->r.y - up * (long double)at->R.m[1][2],
        (long double)wafer->r.z - (long double)at->r.z - up * (long double)at->R.m[2][2]};
    const long double x = dot(dr, &at->R, 0);
    const long double y = dot(dr, &at->R, 1);
    const long double z = dot(dr, &at->R, 2);
    const long double n1[3] = {(long double)wafer->R.m[0][2], (long double)wafer->R.m[1][2],
                               (long double)wafer->R.m[2][2]};
    const long double room[3] = {(long double)station->pitch / 2 - fabsl(z),
                                 (long double)cell.tolerance.projxy - sqrtl(x * x + y * y),
                                 dot(n1, &at->R, 2) - (long double)cell.tolerance.planar};
    bool inside = true;
    for (int i = 0; i < 3; ++i) {
        inside = inside && room[i] > 0;
        *edge = *edge || fabsl(room[i]) < 1e-9L;
    }
    return inside ? x * x + y * y + z * z : -1;
}

/* The two nearest of all slots in which the wafer lies; -1 if there is no such slot. */
typedef struct {
    int32_t station, slot;
    long double best, second;
    bool edge;
} search_t;

static void consider(search_t *search, size_t s, int slot, const wh_pose_t *wafer) {
    const long double d = distance(&stations[s], slot, wafer, &search->edge);
    if (d >= 0 && (search->best < 0 || d < search->best)) {
        search->second = search->best;
        search->best = d;
        search->station = (int32_t)s;
        search->slot = slot;
    } else if (d >= 0 && (search->second < 0 || d < search->second)) {
        search->second = d;
    }
}

static search_t search_all(const wh_pose_t *wafer) {
    search_t search = {WH_NONE, 0, -1, -1, false};
    for (size_t s = 0; s < cell.count; ++s) {
        for (int slot = 1; slot <= stations[s].slots; ++slot) {
            consider(&search, s, slot, wafer);
        }
    }
    return search;
}

static void the_nearest_slot_of_all_is_found(void **state) {
    (void)state;
    int found = 0;
    wh_rounds_t rounds = WH_ROUNDS(500, ROUNDS, 0.3);
    while (wh_round(&rounds)) {
        draw_cell();
        wh_pose_t wafer = wh_test_random_pose(100);
        wafer.R = wh_test_random_turn(0.2);
        const search_t want = search_all(&wafer);
        wh_place_t got = {.station = WH_NONE};
        const bool lies = wh_cell_locate(&cell, &wafer, &got);
        if (!want.edge && (want.second < 0 || want.second - want.best > 1e-9L)) {
            assert_int_equal(lies, want.best >= 0);
            assert_int_equal(got.station, want.station);
            assert_int_equal(got.slot, want.slot);
            found += lies;
        }
    }
    assert_true(found > rounds.made / 20);
}

/* However rounding falls at the ends of a stack, the slot found belongs to the stack. */
static void what_is_found_is_a_slot(void **state) {
    (void)state;
    wh_rounds_t rounds = WH_ROUNDS(500, ROUNDS, 0.3);
    while (wh_round(&rounds)) {
        draw_cell();
        cell.count = 1;
        stations[0].base_from_station = wh_pose_identity();
        const double height = ((int)wh_test_below(8) - 0.5) * (double)stations[0].pitch;
        wh_pose_t wafer = wh_test_at(0, 0, height);
        wafer.r.z = wh_test_ulps(wafer.r.z, (int)wh_test_below(5) - 2);
        wh_place_t place;
        if (wh_cell_locate(&cell, &wafer, &place)) {
            assert_in_range(place.slot, 1, stations[0].slots);
            assert_true(wh_real_abs(place.dz) < stations[0].pitch / 2);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_nearest_slot_of_all_is_found),
        cmocka_unit_test(what_is_found_is_a_slot),
    };
    (void)wh_test_seed();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
