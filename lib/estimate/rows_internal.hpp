/* Least squares row by row: the equations are turned into a triangle as they come (Givens), so that any
 * number of them takes the same memory and no precision is lost by squaring. The triangle's singular
 * values are those of all rows. */
#ifndef WH_ESTIMATE_ROWS_INTERNAL_HPP
#define WH_ESTIMATE_ROWS_INTERNAL_HPP

#include <Eigen/Dense>
#include <cmath>

namespace wh_estimate {

/* A direction counts as not seen if its singular value is below this part of the largest. */
constexpr double unseen = 1e-8;

/* A parameter is not determined if it has more than this share in an unseen direction. */
constexpr double unseen_share = 1e-6;

template <int N> class rows_t {
  public:
    using vector_t = Eigen::Matrix<double, N, 1>;
    using matrix_t = Eigen::Matrix<double, N, N>;

    /* One more equation: row * step = rest. */
    void add(vector_t row, double rest) {
        for (int i = 0; i < N; ++i) {
            const double length = std::hypot(triangle_(i, i), row(i));
            if (length > 0) {
                const double c = triangle_(i, i) / length;
                const double s = row(i) / length;
                for (int k = i; k < N; ++k) {
                    turn(c, s, triangle_(i, k), row(k));
                }
                turn(c, s, rests_(i), rest);
            }
        }
    }

    /* To be called once after the last row. Columns are brought to one length first: parameters have
     * different units. */
    void solve() {
        for (int k = 0; k < N; ++k) {
            const double length = triangle_.col(k).norm();
            lengths_(k) = length > 0 ? length : 1;
        }
        const matrix_t scaled = triangle_ * lengths_.cwiseInverse().asDiagonal();
        const Eigen::JacobiSVD<matrix_t> svd(scaled, Eigen::ComputeFullU | Eigen::ComputeFullV);
        if (svd.info() != Eigen::Success) { /* numbers that are not finite: nothing is seen */
            return;
        }
        sigmas_ = svd.singularValues();
        directions_ = svd.matrixV();
        shares_ = svd.matrixU().transpose() * rests_;
    }

    /* The step of Levenberg and Marquardt; damping 0 is that of Gauss and Newton, without unseen
     * directions. */
    vector_t step(double damping) const {
        vector_t along = vector_t::Zero();
        for (int k = 0; k < N; ++k) {
            if (is_seen(k)) {
                along(k) = sigmas_(k) * shares_(k) / (sigmas_(k) * sigmas_(k) + damping);
            }
        }
        return (directions_ * along).cwiseQuotient(lengths_);
    }

    /* The standard deviation of a parameter where rows have a deviation of 1; infinite if the rows do not
     * tell it. */
    double deviation(int parameter) const {
        double square = 0;
        for (int k = 0; k < N; ++k) {
            const double share = directions_(parameter, k);
            if (is_seen(k)) {
                square += share * share / (sigmas_(k) * sigmas_(k));
            } else if (std::abs(share) > unseen_share) {
                return HUGE_VAL;
            }
        }
        return std::sqrt(square) / lengths_(parameter);
    }

    /* What a row takes of each seen direction, by that one's deviation: products of two rows' are the
     * covariances of what the fit says of them, where rows have a deviation of 1. Unseen directions are
     * left out. */
    vector_t pull(const vector_t &row) const {
        vector_t along = directions_.transpose() * row.cwiseQuotient(lengths_);
        for (int k = 0; k < N; ++k) {
            along(k) = is_seen(k) ? along(k) / sigmas_(k) : 0;
        }
        return along;
    }

    /* A row's parts in the directions that the rows do not tell. */
    vector_t unseen_part(const vector_t &row) const {
        vector_t beside = directions_.transpose() * row.cwiseQuotient(lengths_);
        for (int k = 0; k < N; ++k) {
            beside(k) = is_seen(k) ? 0 : beside(k);
        }
        return beside;
    }

    /* How many directions the rows tell. */
    int rank() const {
        int count = 0;
        for (int k = 0; k < N; ++k) {
            count += is_seen(k) ? 1 : 0;
        }
        return count;
    }

  private:
    static void turn(double c, double s, double &above, double &below) {
        const double old = above;
        above = c * old + s * below;
        below = c * below - s * old;
    }

    bool is_seen(int k) const {
        return sigmas_(k) > unseen * sigmas_(0);
    }

    matrix_t triangle_ = matrix_t::Zero();
    matrix_t directions_ = matrix_t::Zero();
    vector_t rests_ = vector_t::Zero();
    vector_t lengths_ = vector_t::Ones();
    vector_t sigmas_ = vector_t::Zero();
    vector_t shares_ = vector_t::Zero();
};

/* Levenberg and Marquardt's descent, with the weights as they are: `data` and `model` have rows_of,
 * squares_of and stepped beside them, and the model its squares. */
template <typename Data, typename Model> void descend(const Data &data, Model *model, int rounds) {
    double damping = 1e-3;
    model->squares = squares_of(data, *model);
    for (int round = 0; round < rounds; ++round) {
        const auto rows = rows_of(data, *model);
        Model next = *model;
        for (bool is_better = false; !is_better; damping *= is_better ? 0.1 : 10) {
            if (damping > 1e6) {
                return;
            }
            next = stepped(*model, rows.step(damping));
            next.squares = squares_of(data, next);
            is_better = next.squares < model->squares;
        }
        const bool is_done = next.squares > model->squares * (1 - 1e-12);
        *model = next;
        if (is_done) {
            return;
        }
    }
}

} // namespace wh_estimate

#endif
