// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/mechanism_map.hpp"

#include "interp/linear_algebra.hpp"

namespace chaintrue::grid {

model::SheetPlacement laid_on(const std::vector<model::MarkPoint>& from,
                              const std::vector<model::BedPoint>& to) {
  const auto count = as_double(from.size());
  model::MarkPoint a;
  model::BedPoint b;
  for (std::size_t i = 0; i < from.size(); ++i) {
    a = {a.x_mm + from[i].x_mm / count, a.y_mm + from[i].y_mm / count};
    b = {b.x_mm + to[i].x_mm / count, b.y_mm + to[i].y_mm / count};
  }
  double along = 0.0;
  double across = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const double x = from[i].x_mm - a.x_mm;
    const double y = from[i].y_mm - a.y_mm;
    const double u = to[i].x_mm - b.x_mm;
    const double v = to[i].y_mm - b.y_mm;
    along += x * u + y * v;
    across += x * v - y * u;
  }
  model::SheetPlacement sheet{0.0, 0.0, std::atan2(across, along)};
  const model::BedPoint turned = sheet.to_bed(a);
  sheet.x_mm = b.x_mm - turned.x_mm;
  sheet.y_mm = b.y_mm - turned.y_mm;
  return sheet;
}

MechanismSpread spread_about(const Eigen::VectorXd& values,
                             const Eigen::MatrixXd& covariance,
                             const PlacedAt& placed) {
  MechanismSpread spread{placed(values), {}};
  const linear::SymmetricEigen parts(covariance);
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    const double variance = parts.eigenvalues()[i];
    // Below this a direction adds less than rounding.
    if (!(variance > 1e-12 * parts.eigenvalues().maxCoeff())) continue;
    spread.others.push_back(placed(values + std::sqrt(variance) * parts.eigenvectors().col(i)));
  }
  return spread;
}

}  // namespace chaintrue::grid
