/* Internal to the limits: the model of an axis's times, and the search for the limits nearest to them. */
#ifndef WH_ESTIMATE_LIMITS_INTERNAL_HPP
#define WH_ESTIMATE_LIMITS_INTERNAL_HPP

#include "limits.h"
#include "rows_internal.hpp"

namespace wh_estimate {

constexpr int limit_count = 3;
constexpr int parameter_count = WH_LIMIT_PARAMETERS;
constexpr double least_sd_s = 1e-7; /* no log's clock is more exact */
constexpr unsigned all_limits = 7U; /* a set of limits has a bit for each */

using limit_rows_t = rows_t<parameter_count>;

/* The limits' logarithms, and the delay. */
struct model_t {
    double p[parameter_count];
    bool is_free[parameter_count];
    double squares; /* of the weighted residuals */
};

/* Data shared by all fits of an axis. */
struct data_t {
    wh_timed_move_t *moves;
    size_t count;
    bool with_delay;
    double scale[limit_count];  /* of the limits: the least values that the quickest moves need */
    double beyond[limit_count]; /* logarithm of a limit that no move reaches */
    double weights[WH_LIMITS_MOST_MOVES];
    double sizes[WH_LIMITS_MOST_MOVES]; /* to be sorted */
    bool is_used[WH_LIMITS_MOST_MOVES];
};

/* The time of a move minus the model's. */
double rest_of(const data_t &data, const model_t &model, size_t i);

/* The equations of a step, towards the times, or towards times that are all `later`. */
limit_rows_t rows_of(const data_t &data, const model_t &model, double later = 0);

/* The sum of weighted squares, and a model plus a step; for the descent. */
double squares_of(const data_t &data, const model_t &model);
model_t stepped(const model_t &from, const limit_rows_t::vector_t &step);

/* The largest speed, acceleration or jerk in the moves that are used. */
double peak_of(const data_t &data, const model_t &model, int limit);

/* The best fit with the present weights that has only the limits of a set. */
void fit_set(const data_t &data, unsigned set, model_t *best);

/* Sets scales, and which moves are used: those that agree with the model of all limits that most moves
 * agree with. Returns their number; `sd` is the deviation of one time. */
size_t fit_agreed(data_t &data, model_t *all, double *sd);

} // namespace wh_estimate

#endif
