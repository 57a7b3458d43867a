/* Normal equations of a few unknowns; internal to the room. */
#ifndef WH_ALIGN_SOLVE_INTERNAL_H
#define WH_ALIGN_SOLVE_INTERNAL_H

#include "../math/config.h"

#define WH_NORMAL_TERMS 7

/* Sums of weight times products of the derivatives (the upper triangle), and of derivatives and residual. */
typedef struct {
    size_t terms;
    double matrix[WH_NORMAL_TERMS][WH_NORMAL_TERMS];
    double right[WH_NORMAL_TERMS];
} wh_normal_t;

void wh_normal_begin(wh_normal_t *normal, size_t terms) WH_SYMBOL(wh_normal_begin);

void wh_normal_add(wh_normal_t *normal, const double *derivatives, double residual, double weight)
    WH_SYMBOL(wh_normal_add);

/* By Cholesky's factors: `right` becomes the solution and `matrix`, whole, the inverse. Returns false, and
 * numbers without meaning, if the matrix is not safely positive. */
bool wh_normal_solve(wh_normal_t *normal) WH_SYMBOL(wh_normal_solve);

#endif
