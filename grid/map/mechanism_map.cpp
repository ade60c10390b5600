// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/mechanism_map.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "interp/linear_algebra.hpp"

namespace chaintrue::grid {

BedPoint SheetInFrame::on_sheet(ToolPosition position) const {
  MarkPoint raw{factor * (position.x_mm - origin.x_mm), factor * (position.y_mm - origin.y_mm)};
  if (displacement) {
    const Vector2d moved = displacement->at(raw);
    raw.x_mm += moved.x();
    raw.y_mm += moved.y();
  }
  return laid.to_bed(raw);
}

ToolPosition SheetInFrame::in_frame(BedPoint sheet) const {
  // Each round reduces the error to a few thousandths, the slope of the displacement.
  constexpr int kMostRounds = 40;
  constexpr double kConvergedMm = 1e-10;
  const MarkPoint there = laid.to_mark(sheet);
  MarkPoint raw = there;
  for (int round = 0; displacement && round < kMostRounds; ++round) {
    const Vector2d by = displacement->at(raw);
    const MarkPoint next{there.x_mm - by.x(), there.y_mm - by.y()};
    const double moved = distance_mm(next, raw);
    raw = next;
    if (moved < kConvergedMm) break;
  }
  return {origin.x_mm + raw.x_mm / factor, origin.y_mm + raw.y_mm / factor};
}

SheetPlacement laid_on(const std::vector<MarkPoint>& from, const std::vector<BedPoint>& to) {
  Matrix2Xd a(2, std::ssize(from)), b(2, std::ssize(from));
  for (const auto i : each_index(from)) {
    a.col(as_index(i)) = vector_of(from[i]);
    b.col(as_index(i)) = vector_of(to[i]);
  }
  const MatrixXd t = Eigen::umeyama(a, b, false);
  return {t(0, 2), t(1, 2), std::atan2(t(1, 0), t(0, 0))};
}

MechanismSpread spread_about(const VectorXd& values, const MatrixXd& covariance,
                             const PlacedAt& placed) {
  MechanismSpread spread{placed(values), {}};
  const linear::SymmetricEigen parts(covariance);
  for (const Index i : each_below(values.size())) {
    const double variance = parts.eigenvalues()[i];
    // Below this a direction adds less than rounding.
    if (!(variance > 1e-12 * parts.eigenvalues().maxCoeff())) continue;
    spread.others.push_back(placed(values + std::sqrt(variance) * parts.eigenvectors().col(i)));
  }
  return spread;
}

MechanismMap MechanismMap::of(const FittedMechanism& fitted,
                              const std::vector<BedPoint>& measured) {
  const PlacedMechanism best{fitted.mechanism, {}};
  const model::MechanismExtent e = fitted.mechanism->extent();
  std::vector<MarkPoint> points;
  for (const BedPoint point : measured) points.push_back(model::identity_placement(point));
  return {best,
          spread_about(fitted.mechanism->values(), fitted.covariance,
                       [&](const VectorXd& values) {
                         return PlacedMechanism{fitted.mechanism->with_values(values), best.sheet};
                       }),
          MeasuredArea(points, {e.x_min_mm, e.x_max_mm, e.y_min_mm, e.y_max_mm})};
}

tl::expected<LengthsAnswer, MapFailure> MechanismMap::query(BedPoint point) const {
  if (!area_.domain().contains(point.x_mm, point.y_mm))
    return tl::unexpected(MapReason::outside_map);
  const auto found = fitted_.mechanism->predict(fitted_.sheet.in_frame(point), {},
                                                model::Derivatives::by_position);
  if (!found) return tl::unexpected(unreachable(found.error()));
  return LengthsAnswer{found->lengths_mm, sigma(point), tool_spread(point).norm(), status(point)};
}

tl::expected<ChainLengths, MapFailure> MechanismMap::lengths(BedPoint point) const {
  if (!area_.domain().contains(point.x_mm, point.y_mm))
    return tl::unexpected(MapReason::outside_map);
  const auto found = lengths_of(fitted_, point);
  if (!found) return tl::unexpected(unreachable(found.error()));
  return *found;
}

tl::expected<BedPoint, MapFailure> MechanismMap::tool(ChainLengths lengths) const {
  const auto found = fitted_.mechanism->locate_by_first(lengths);
  if (!found) return tl::unexpected(unreachable(found.error()));
  return fitted_.sheet.on_sheet(*found);
}

ChainLengths MechanismMap::sigma(BedPoint point) const {
  const auto centre = lengths_of(spread_.centre, point);
  Vector2d variance = Vector2d::Constant(fitted_.sheet.own_variance_mm2(point));
  for (const PlacedMechanism& other : spread_.others) {
    const auto there = lengths_of(other, point);
    if (centre && there) variance += difference(*there, *centre).cwiseAbs2();
  }
  return {std::sqrt(variance[0]), std::sqrt(variance[1])};
}

Matrix2Xd MechanismMap::tool_spread(BedPoint point) const {
  const auto others = std::ssize(spread_.others);
  Matrix2Xd spread = Matrix2Xd::Zero(2, others + 2);
  if (const auto paid_out = lengths_of(spread_.centre, point)) {
    for (const Index i : each_below(others)) {
      const PlacedMechanism& other = spread_.others[as_size(i)];
      const auto there = other.mechanism->locate_by_first(*paid_out);
      if (!there) continue;
      const BedPoint tool = other.sheet.on_sheet(*there);
      spread.col(i) = difference(tool, point);
    }
  }
  spread.rightCols<2>() = std::sqrt(fitted_.sheet.own_variance_mm2(point)) * Matrix2d::Identity();
  return spread;
}

std::vector<BedPoint> MechanismMap::hull() const {
  std::vector<BedPoint> corners;
  for (const MarkPoint corner : area_.hull()) corners.push_back({corner.x_mm, corner.y_mm});
  return corners;
}

}  // namespace chaintrue::grid
