/* The errors of beams in a study: the width of each, and a trial's draw of it.
 *
 * A width describes a fact about a beam that motion control does not know: how far in and to the left of its
 * place in the layout it truly stands, or how much later its latches come. Only the size of a drawn delay
 * counts. A trial adds each draw to the beam's own dx, dy and late.
 */
#ifndef WH_LAYOUT_BEAM_ERRORS_H
#define WH_LAYOUT_BEAM_ERRORS_H

#include "layout.h"

/* Its field's name, its unit, "mm" or "s", and the largest width, or the largest error that is given: with
 * the beam's own no more than that either way. Names are constant texts. */
const char *wh_beam_draw_name(wh_beam_draw_t draw);
const char *wh_beam_draw_unit(wh_beam_draw_t draw);
double wh_beam_draw_most(wh_beam_draw_t draw);

/* True for an error whose size alone counts: it is never below 0. */
bool wh_beam_draw_is_size(wh_beam_draw_t draw);

/* True if the beam may truly be off by `error` more than the layout has it. */
bool wh_beam_draw_fits(wh_beam_draw_t draw, const wh_layout_beam_t *beam, double error);

/* Changes beam b of a trial's layout, which is not a face, by the draw. The caller then places it anew:
 * wh_layout_place_beam. */
void wh_beam_draw_apply(const double drawn[WH_BEAM_DRAWS], wh_layout_t *layout, size_t b);

#endif
