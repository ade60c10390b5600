// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/observation/observation.hpp"

#include <Eigen/Cholesky>

namespace chaintrue::grid::observation {

bool SheetPrior::knows(model::Setting setting) const {
  switch (setting) {
    case model::Setting::sheet_x_mm:
      return knows_x;
    case model::Setting::sheet_y_mm:
      return knows_y;
    case model::Setting::sheet_rotation_rad:
      return knows_rotation;
    default:
      return true;
  }
}

const std::vector<const Kind*>& kinds() {
#define CHAINTRUE_OBSERVATION(id) &id,
  static const std::vector<const Kind*> kKinds = {
#include "grid/observation/kinds.def"
  };
#undef CHAINTRUE_OBSERVATION
  return kKinds;
}

Eigen::MatrixXd marginal_covariance(const Linearisation& line,
                                    const Eigen::VectorXd& nuisance_sigma) {
  const Eigen::MatrixXd shared = line.by_nuisance * nuisance_sigma.asDiagonal();
  Eigen::MatrixXd covariance = shared * shared.transpose();
  Eigen::Index row = 0;
  for (const UnitState& unit : line.units) {
    const Eigen::Index n = unit.covariance.rows();
    covariance.block(row, row, n, n) += unit.covariance;
    row += n;
  }
  return covariance;
}

Eigen::MatrixXd whitening(const UnitState& unit) {
  const Eigen::Index n = unit.covariance.rows();
  return Eigen::MatrixXd(unit.covariance.llt().matrixL())
      .triangularView<Eigen::Lower>()
      .solve(Eigen::MatrixXd::Identity(n, n));
}

}  // namespace chaintrue::grid::observation
