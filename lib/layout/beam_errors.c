#include "beam_errors.h"

#include <math.h>
#include <string.h>

#include "layout_fields.h"

/* The field of each draw, whose row has its name and its range. Never renumber fields: the same seeds would
 * then give other trials. */
static const struct {
    const char *unit;
    uint32_t field;
    bool is_size;
} draws[WH_BEAM_DRAWS] = {[WH_BEAM_DX] = {"mm", 0x500, false},
                          [WH_BEAM_DY] = {"mm", 0x501, false},
                          [WH_BEAM_LATE] = {"s", 0x502, true}};

const char *wh_beam_draw_name(wh_beam_draw_t draw) {
    return wh_layout_beam_width_fields[draw].name;
}

const char *wh_beam_draw_unit(wh_beam_draw_t draw) {
    return draws[draw].unit;
}

double wh_beam_draw_most(wh_beam_draw_t draw) {
    return wh_layout_beam_width_fields[draw].most;
}

bool wh_beam_draw_is_size(wh_beam_draw_t draw) {
    return draws[draw].is_size;
}

static double own_of(wh_beam_draw_t draw, const wh_layout_beam_t *beam) {
    return draw == WH_BEAM_DX ? beam->dx : draw == WH_BEAM_DY ? beam->dy : beam->late;
}

bool wh_beam_draw_fits(wh_beam_draw_t draw, const wh_layout_beam_t *beam, double error) {
    return fabs(own_of(draw, beam) + error) <= wh_beam_draw_most(draw);
}

void wh_errors_draw_beam(const wh_errors_t *errors, const wh_trial_t *trial, size_t beam,
                         double drawn[WH_BEAM_DRAWS]) {
    if (errors->given) {
        memcpy(drawn, errors->given->beams[beam], WH_BEAM_DRAWS * sizeof *drawn);
        return;
    }
    for (size_t i = 0; i < WH_BEAM_DRAWS; ++i) {
        const double value = (double)wh_spread_draw(&errors->beams[beam].of[i], trial, draws[i].field, beam);
        drawn[i] = draws[i].is_size ? fabs(value) : value;
    }
}

void wh_beam_draw_apply(const double drawn[WH_BEAM_DRAWS], wh_layout_t *layout, size_t b) {
    layout->beams[b].dx += drawn[WH_BEAM_DX];
    layout->beams[b].dy += drawn[WH_BEAM_DY];
    layout->beams[b].late += drawn[WH_BEAM_LATE];
    layout->doors[b].delay_on += drawn[WH_BEAM_LATE];
    layout->doors[b].delay_off += drawn[WH_BEAM_LATE];
}

/* --------------------------------------------------------------------------------------------------- read */
