/* Least squares row by row. Each equation is turned into a triangle at once (Givens), so any number of them
 * takes constant memory, and no precision is lost by squaring. The triangle's singular values are those of
 * all rows. */
#ifndef WH_ESTIMATE_ROWS_INTERNAL_HPP
#define WH_ESTIMATE_ROWS_INTERNAL_HPP

#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>

namespace wh_estimate {

/* A direction counts as not seen if its singular value is below this part of the largest. */
constexpr double unseen = 1e-8;

/* The eigenvalues of a symmetric matrix, in rising order, and their directions as columns. */
struct own_t {
    Eigen::Vector3d values;
    Eigen::Matrix3d vectors;
};
own_t own_of(const Eigen::Matrix3d &symmetric);

/* A parameter is not determined if it has more than this share in an unseen direction. */
constexpr double unseen_share = 1e-6;

/* The linear numbers of a geometry whose column is level. */
constexpr int level_parameters = 8;

template <int N> class rows_t {
  public:
    using vector_t = Eigen::Matrix<double, N, 1>;
    using matrix_t = Eigen::Matrix<double, N, N>;

    /* Adds one equation: row * step = rest. */
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

    /* Call it once after the last row. It first brings columns to one length, because parameters have
     * different units. rows.cpp defines it, for the sizes that are in use. */
    void solve();

    /* The step of Levenberg and Marquardt; damping 0 gives that of Gauss and Newton, without unseen
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

    /* The standard deviation of a parameter if rows have a deviation of 1; infinite if the rows do not
     * determine it. */
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

    /* A row's part in each seen direction, times that direction's deviation. Products of two rows' parts
     * are the covariances of the fit's predictions for them, if rows have a deviation of 1. Unseen
     * directions are left out. */
    vector_t pull(const vector_t &row) const {
        vector_t along = directions_.transpose() * row.cwiseQuotient(lengths_);
        for (int k = 0; k < N; ++k) {
            along(k) = is_seen(k) ? along(k) / sigmas_(k) : 0;
        }
        return along;
    }

    /* A row's parts in the directions that the rows do not determine. */
    vector_t unseen_part(const vector_t &row) const {
        vector_t beside = directions_.transpose() * row.cwiseQuotient(lengths_);
        for (int k = 0; k < N; ++k) {
            beside(k) = is_seen(k) ? 0 : beside(k);
        }
        return beside;
    }

    /* The number of directions that the rows determine. */
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

/* Levenberg and Marquardt's descent, with constant weights. There must be rows_of, squares_of and stepped
 * for `data` and `model`; the model has its squares. */
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
