/* Eigen's decompositions, each once, because they take longer to compile than all other code of this
 * room. */
#include "rows_internal.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

#include "geometry.h"
#include "limits.h"

namespace wh_estimate {

own_t own_of(const Eigen::Matrix3d &symmetric) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> own(symmetric);
    return {own.eigenvalues(), own.eigenvectors()};
}

template <int N> void rows_t<N>::solve() {
    for (int k = 0; k < N; ++k) {
        const double length = triangle_.col(k).norm();
        lengths_(k) = length > 0 ? length : 1;
    }
    const matrix_t scaled = triangle_ * lengths_.cwiseInverse().asDiagonal();
    const Eigen::JacobiSVD<matrix_t> svd(scaled, Eigen::ComputeFullU | Eigen::ComputeFullV);
    if (svd.info() != Eigen::Success) { /* numbers that are not finite: no direction is seen */
        return;
    }
    sigmas_ = svd.singularValues();
    directions_ = svd.matrixV();
    shares_ = svd.matrixU().transpose() * rests_;
}

template void rows_t<WH_GEOMETRY_PARAMETERS>::solve();
template void rows_t<level_parameters>::solve();
template void rows_t<WH_LIMIT_PARAMETERS>::solve();

} // namespace wh_estimate
