// SPDX-License-Identifier: GPL-3.0-or-later
#include "generator/hidden/belt_strength.hpp"

#include <cmath>

namespace chaintrue::generator {

double level_span(const std::array<double, 3>& anchor, double x, double y) {
  return std::hypot(anchor[0] - x, anchor[1] - y);
}

AnchorProjection::AnchorProjection(const BeltFrame& frame,
                                   const std::vector<std::array<double, 2>>& places) {
  const auto count = static_cast<Eigen::Index>(places.size());
  Eigen::MatrixXd design = Eigen::MatrixXd::Zero(4 * count, 5 + 2 * count);
  for (Eigen::Index n = 0; n < count; ++n) {
    const auto& at = places[static_cast<std::size_t>(n)];
    for (Eigen::Index i = 0; i < 4; ++i) {
      const auto& anchor = frame.anchors[static_cast<std::size_t>(i)];
      const double level = level_span(anchor, at[0], at[1]);
      const double belt = level - frame.reach_mm;
      const double share = belt / std::hypot(belt, anchor[2]);
      const double ux = share * (at[0] - anchor[0]) / level;
      const double uy = share * (at[1] - anchor[1]) / level;
      const Eigen::Index row = 4 * n + i;
      design(row, 5 + 2 * n) = ux;
      design(row, 6 + 2 * n) = uy;
      if (i == 0) design(row, 0) = -ux, design(row, 1) = -uy;
      if (i == 1) design(row, 2) = -ux, design(row, 3) = -uy;
      if (i == 3) design(row, 4) = -ux;
    }
  }
  taken_ = Projection(design);
}

Eigen::VectorXd AnchorProjection::left_of(const std::vector<FourLengths>& change) const {
  Eigen::VectorXd off(4 * static_cast<Eigen::Index>(change.size()));
  for (Eigen::Index k = 0; k < off.size(); ++k)
    off(k) = change[static_cast<std::size_t>(k / 4)][static_cast<std::size_t>(k % 4)];
  return taken_.left_of(off);
}

}  // namespace chaintrue::generator
