#include "rim_errors.h"

#include <math.h>
#include <string.h>

#include "../math/trig.h"
#include "layout_fields.h"

/* The field of each draw, whose row has its name and its range. Never renumber fields: the same seeds would
 * then give other trials. */
static const struct {
    const char *unit;
    uint32_t field;
    bool is_size;
} draws[WH_RIM_DRAWS] = {
    [WH_RIM_DIAMETER] = {"mm", 0x110, false},     [WH_RIM_NOTCH_DEPTH] = {"mm", 0x111, false},
    [WH_RIM_NOTCH_ANGLE] = {"deg", 0x112, false}, [WH_RIM_NOTCH_BOTTOM] = {"mm", 0x113, false},
    [WH_RIM_NOTCH_CORNER] = {"mm", 0x114, false}, [WH_RIM_FLAT] = {"mm", 0x115, false},
    [WH_RIM_SECOND_FLAT] = {"mm", 0x116, false},  [WH_RIM_CHIP_DEPTH] = {"mm", 0x117, true},
    [WH_RIM_CHIP_WIDTH] = {"mm", 0x118, true},    [WH_RIM_BOW] = {"mm", 0x119, false},
    [WH_RIM_SADDLE] = {"mm", 0x11A, false},       [WH_RIM_GLASS] = {"", 0x11B, true},
    [WH_RIM_CHIP_AT] = {"deg", 0x11C, false},     [WH_RIM_SADDLE_AT] = {"deg", 0x11D, false}};

/* A chip is never narrower, mm. */
#define LEAST_CHIP_WIDTH 0.01
/* The width of a chip without a width of its own, as a multiple of its depth. */
#define CHIP_SLENDERNESS 4

const char *wh_rim_draw_name(wh_rim_draw_t draw) {
    static const char *const directions[] = {"chip_at", "saddle_at"};
    return draw < WH_RIM_WIDTHS ? wh_layout_rim_width_fields[draw].name : directions[draw - WH_RIM_WIDTHS];
}

const char *wh_rim_draw_unit(wh_rim_draw_t draw) {
    return draws[draw].unit;
}

double wh_rim_draw_most(wh_rim_draw_t draw) {
    return draw < WH_RIM_WIDTHS ? wh_layout_rim_width_fields[draw].most : 360;
}

bool wh_rim_draw_is_size(wh_rim_draw_t draw) {
    return draws[draw].is_size;
}

bool wh_rim_draw_concerns(wh_rim_draw_t draw, const wh_rim_t *rim) {
    const bool is_notch = draw >= WH_RIM_NOTCH_DEPTH && draw <= WH_RIM_NOTCH_CORNER;
    const bool is_chip = draw == WH_RIM_CHIP_DEPTH || draw == WH_RIM_CHIP_WIDTH || draw == WH_RIM_CHIP_AT;
    return is_notch                     ? rim->notch.depth > 0
           : is_chip                    ? rim->chip_count < WH_RIM_CHIPS
           : draw == WH_RIM_FLAT        ? rim->flats[0].length > 0
           : draw == WH_RIM_SECOND_FLAT ? rim->flats[1].length > 0
                                        : true;
}

/* Where a chip is is drawn only with a chip, and likewise for the saddle. */
static double draw_direction(const wh_trial_t *trial, wh_rim_draw_t draw, size_t wafer, double beside) {
    const wh_spread_t all_round = {180, WH_SHAPE_UNIFORM};
    return beside != 0 ? (double)wh_spread_draw(&all_round, trial, draws[draw].field, wafer) : 0;
}

void wh_rim_draw_all(const wh_rim_spreads_t *spreads, const wh_trial_t *trial, size_t wafer,
                     const wh_rim_t *rim, double drawn[WH_RIM_DRAWS]) {
    for (int i = 0; i < (int)WH_RIM_WIDTHS; ++i) {
        const wh_rim_draw_t draw = (wh_rim_draw_t)i;
        const double value = wh_rim_draw_concerns(draw, rim)
                                 ? (double)wh_spread_draw(&spreads->of[i], trial, draws[i].field, wafer)
                                 : 0;
        drawn[i] = draws[i].is_size ? fabs(value) : value;
    }
    drawn[WH_RIM_CHIP_AT] = draw_direction(trial, WH_RIM_CHIP_AT, wafer, drawn[WH_RIM_CHIP_DEPTH]);
    drawn[WH_RIM_SADDLE_AT] = draw_direction(trial, WH_RIM_SADDLE_AT, wafer, drawn[WH_RIM_SADDLE]);
}

static void add_chip(const double drawn[WH_RIM_DRAWS], wh_rim_t *rim) {
    const double depth = drawn[WH_RIM_CHIP_DEPTH];
    const double width = drawn[WH_RIM_CHIP_WIDTH] > 0 ? drawn[WH_RIM_CHIP_WIDTH] : CHIP_SLENDERNESS * depth;
    if (depth > 0) {
        rim->chips[rim->chip_count++] = (wh_chip_t){(double)wh_rad_from_deg((wh_real_t)drawn[WH_RIM_CHIP_AT]),
                                                    fmax(fmax(width, depth), LEAST_CHIP_WIDTH), depth};
    }
}

/* The two saddles add up to one in the direction of the larger one's; a wafer that has one keeps it. */
static void add_saddle(const double drawn[WH_RIM_DRAWS], wh_rim_t *rim) {
    if (rim->saddle == 0) {
        rim->saddle_direction = (double)wh_rad_from_deg((wh_real_t)drawn[WH_RIM_SADDLE_AT]);
    }
    rim->saddle += drawn[WH_RIM_SADDLE];
}

bool wh_rim_draw_apply(const double drawn[WH_RIM_DRAWS], wh_rim_t *rim) {
    bool is_any = false;
    for (int i = 0; i < (int)WH_RIM_WIDTHS; ++i) {
        is_any = is_any || drawn[i] != 0;
    }
    if (!is_any) {
        return false;
    }
    rim->radius += drawn[WH_RIM_DIAMETER] / 2;
    rim->notch.depth += drawn[WH_RIM_NOTCH_DEPTH];
    rim->notch.opening += (double)wh_rad_from_deg((wh_real_t)drawn[WH_RIM_NOTCH_ANGLE]);
    rim->notch.bottom += drawn[WH_RIM_NOTCH_BOTTOM];
    rim->notch.corner += drawn[WH_RIM_NOTCH_CORNER];
    rim->flats[0].length += drawn[WH_RIM_FLAT];
    rim->flats[1].length += drawn[WH_RIM_SECOND_FLAT];
    rim->bow += drawn[WH_RIM_BOW];
    add_saddle(drawn, rim);
    add_chip(drawn, rim);
    rim->transmission += drawn[WH_RIM_GLASS];
    return true;
}

/* ------------------------------------------------------------------------------------------------- bounds */

bool wh_rim_draw_leaves_rim(const double drawn[WH_RIM_DRAWS], const wh_rim_t *rim) {
    wh_rim_t changed = *rim;
    (void)wh_rim_draw_apply(drawn, &changed);
    /* A depth of 0 is no notch, a length of 0 no flat: what has one keeps it. */
    return wh_rim_validate(&changed, NULL) == WH_OK && (rim->notch.depth > 0) == (changed.notch.depth > 0) &&
           (rim->flats[0].length > 0) == (changed.flats[0].length > 0) &&
           (rim->flats[1].length > 0) == (changed.flats[1].length > 0);
}

static double reach_of(const wh_rim_spreads_t *spreads, const wh_rim_t *rim, int draw) {
    return wh_rim_draw_concerns((wh_rim_draw_t)draw, rim) ? wh_spread_reach(&spreads->of[draw]) : 0;
}

/* Tests each draw by itself, at its largest in both directions. */
static wh_rim_draw_t find_alone(const wh_rim_spreads_t *spreads, const wh_rim_t *rim) {
    for (int i = 0; i < (int)WH_RIM_WIDTHS; ++i) {
        double drawn[WH_RIM_DRAWS] = {0};
        bool good = true;
        for (int sign = draws[i].is_size ? 1 : -1; sign <= 1; sign += 2) {
            drawn[i] = sign * reach_of(spreads, rim, i);
            good = good && wh_rim_draw_leaves_rim(drawn, rim);
        }
        /* Nothing is drawn for a chip without a depth, so its width is checked here. */
        const double chip = i == (int)WH_RIM_CHIP_WIDTH ? fabs(drawn[i]) : 0;
        if (!good || chip > wh_rim_draw_most(WH_RIM_CHIP_WIDTH)) {
            return (wh_rim_draw_t)i;
        }
    }
    return WH_RIM_DRAWS;
}

/* The notch's together: its roundings must leave straight flanks. */
static bool is_notch_good(const wh_rim_spreads_t *spreads, const wh_rim_t *rim) {
    bool good = true;
    for (unsigned corner = 0; corner < 16; ++corner) {
        double drawn[WH_RIM_DRAWS] = {0};
        for (int i = 0; i < 4; ++i) {
            const int draw = (int)WH_RIM_NOTCH_DEPTH + i;
            drawn[draw] = ((corner >> i & 1U) != 0 ? 1 : -1) * reach_of(spreads, rim, draw);
        }
        good = good && wh_rim_draw_leaves_rim(drawn, rim);
    }
    return good;
}

wh_rim_draw_t wh_rim_draw_too_wide(const wh_rim_spreads_t *spreads, const wh_rim_t *rim) {
    const wh_rim_draw_t alone = find_alone(spreads, rim);
    if (alone != WH_RIM_DRAWS || is_notch_good(spreads, rim)) {
        return alone;
    }
    int first = (int)WH_RIM_NOTCH_DEPTH;
    while (!(spreads->of[first].width > 0)) {
        ++first;
    }
    return (wh_rim_draw_t)first;
}
