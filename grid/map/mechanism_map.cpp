// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/mechanism_map.hpp"

#include "grid/plane_vectors.hpp"
#include "interp/linear_algebra.hpp"

namespace chaintrue::grid {

model::BedPoint SheetInFrame::on_sheet(model::ToolPosition position) const {
  model::MarkPoint raw{factor * (position.x_mm - origin.x_mm), factor * (position.y_mm - origin.y_mm)};
  if (displacement) {
    const Eigen::Vector2d moved = displacement->at(raw);
    raw.x_mm += moved.x();
    raw.y_mm += moved.y();
  }
  return laid.to_bed(raw);
}

model::ToolPosition SheetInFrame::in_frame(model::BedPoint sheet) const {
  // Each round reduces the error to a few thousandths, the slope of the displacement.
  constexpr int kMostRounds = 40;
  constexpr double kConvergedMm = 1e-10;
  const model::MarkPoint there = laid.to_mark(sheet);
  model::MarkPoint raw = there;
  for (int round = 0; displacement && round < kMostRounds; ++round) {
    const Eigen::Vector2d by = displacement->at(raw);
    const model::MarkPoint next{there.x_mm - by.x(), there.y_mm - by.y()};
    const double moved = distance_mm(next, raw);
    raw = next;
    if (moved < kConvergedMm) break;
  }
  return {origin.x_mm + raw.x_mm / factor, origin.y_mm + raw.y_mm / factor};
}

model::SheetPlacement laid_on(const std::vector<model::MarkPoint>& from,
                              const std::vector<model::BedPoint>& to) {
  const auto count = as_double(from.size());
  Eigen::Vector2d a = Eigen::Vector2d::Zero(), b = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) {
    a += vector_of(from[i]) / count;
    b += vector_of(to[i]) / count;
  }
  Eigen::Matrix2d moment = Eigen::Matrix2d::Zero();
  for (std::size_t i = 0; i < from.size(); ++i)
    moment += (vector_of(from[i]) - a) * (vector_of(to[i]) - b).transpose();
  model::SheetPlacement sheet{
      0.0, 0.0, std::atan2(moment(0, 1) - moment(1, 0), moment.trace())};
  const Eigen::Vector2d shift = b - sheet.rotation() * a;
  sheet.x_mm = shift.x();
  sheet.y_mm = shift.y();
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
