// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/noise_draws.hpp"

#include <algorithm>

#include "grid/diagnosis/best_model.hpp"
#include "grid/linear_algebra.hpp"
#include "grid/synthetic/random.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// X in units of what each unknown may be beforehand.
Eigen::MatrixXd design_of(const Analysis& a) {
  const MarginalisedSystem& marginalised = marginalised_system(a);
  const Eigen::Index n = marginalised.kept.size();
  const Eigen::Index settings = a.system.by_setting.cols();
  const auto causes = static_cast<Eigen::Index>(a.estimate.free.size());
  Eigen::MatrixXd design(n, settings + causes);
  design.leftCols(settings) =
      linear::scaled_columns(marginalised.kept.of(a.system.by_setting), a.system.sigma);
  for (Eigen::Index k = 0; k < causes; ++k) {
    const int column = a.estimate.regressors[a.estimate.free[static_cast<std::size_t>(k)]];
    design.col(settings + k) = marginalised.kept(a.system.g.col(column)) * kWideSignalToNoise /
                               std::max(marginalised.g.col(column).norm(), 1e-12);
  }
  return design;
}

}  // namespace

Eigen::MatrixXd left_of_noise(const Analysis& a,
                              Nuisances nuisances,
                              int draws,
                              std::uint64_t stream) {
  const Eigen::MatrixXd design = design_of(a);
  const Eigen::Index n = design.rows();
  const Eigen::Index shared = a.system.nuisances;
  const auto by_nuisance =
      design.middleCols(a.system.by_setting.cols() - shared, shared);
  const linear::Cholesky normal(linear::one_plus_gram(design));
  synthetic::Random random(a.options.seed, stream);
  Eigen::MatrixXd z(n, draws);
  Eigen::VectorXd u(shared);
  for (Eigen::Index draw = 0; draw < draws; ++draw) {
    for (Eigen::Index i = 0; i < n; ++i) z(i, draw) = random.normal();
    for (Eigen::Index q = 0; q < shared; ++q) u(q) = random.normal();
    linear::add_product(z.col(draw), 1.0, by_nuisance, u);
  }
  const Eigen::MatrixXd taken = normal.solve(linear::product(linear::transposed(design), z));
  linear::add_product(z, -1.0, design, taken);
  if (nuisances == Nuisances::put_back && shared > 0) {
    linear::add_product(
        z, 1.0, by_nuisance, taken.middleRows(a.system.by_setting.cols() - shared, shared));
  }
  return z;
}

}  // namespace chaintrue::grid::diagnosis
