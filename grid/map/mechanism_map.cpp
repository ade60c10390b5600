// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/mechanism_map.hpp"

#include <cmath>
#include <utility>

#include "grid/containers.hpp"
#include "interp/linear_algebra.hpp"

namespace chaintrue::grid {
namespace {

tl::expected<model::ChainLengths, model::MechanismFailure> lengths_of(const PlacedMechanism& placed,
                                                                      model::BedPoint point) {
  return placed.mechanism->first_lengths(placed.sheet->in_frame(point));
}

}  // namespace

model::ToolPosition LaidSheet::in_frame(model::BedPoint sheet) const {
  const model::BedPoint at = laid_.to_bed(model::identity_placement(sheet));
  return {at.x_mm, at.y_mm};
}

model::BedPoint LaidSheet::on_sheet(model::ToolPosition position) const {
  return model::identity_placement(laid_.to_mark({position.x_mm, position.y_mm}));
}

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

MechanismMap::MechanismMap(PlacedMechanism fitted, MechanismSpread spread, MeasuredArea area)
    : fitted_(std::move(fitted)), spread_(std::move(spread)), area_(std::move(area)) {}

MechanismMap MechanismMap::of(const FittedMechanism& fitted,
                              const std::vector<model::BedPoint>& measured) {
  const PlacedMechanism best{fitted.mechanism, std::make_shared<const LaidSheet>()};
  const model::MechanismExtent e = fitted.mechanism->extent();
  std::vector<model::MarkPoint> points;
  for (const model::BedPoint point : measured) points.push_back(model::identity_placement(point));
  return {best,
          spread_about(fitted.mechanism->values(),
                       fitted.covariance,
                       [&](const Eigen::VectorXd& values) {
                         return PlacedMechanism{fitted.mechanism->with_values(values), best.sheet};
                       }),
          MeasuredArea(points, {e.x_min_mm, e.x_max_mm, e.y_min_mm, e.y_max_mm})};
}

std::span<const std::string_view> MechanismMap::length_names() const {
  return fitted_.mechanism->lengths();
}

tl::expected<LengthsAnswer, MapFailure> MechanismMap::query(model::BedPoint point) const {
  if (!area_.domain().contains(point.x_mm, point.y_mm))
    return tl::unexpected(MapReason::outside_map);
  const auto found = fitted_.mechanism->predict(
      fitted_.sheet->in_frame(point), {}, model::Derivatives::by_position);
  if (!found) return tl::unexpected(unreachable(found.error()));
  return LengthsAnswer{found->lengths_mm, sigma(point), tool_spread(point).norm(), status(point)};
}

tl::expected<model::ChainLengths, MapFailure> MechanismMap::lengths(model::BedPoint point) const {
  if (!area_.domain().contains(point.x_mm, point.y_mm))
    return tl::unexpected(MapReason::outside_map);
  const auto found = lengths_of(fitted_, point);
  if (!found) return tl::unexpected(unreachable(found.error()));
  return *found;
}

tl::expected<model::BedPoint, MapFailure> MechanismMap::tool(model::ChainLengths lengths) const {
  const auto found = fitted_.mechanism->locate_by_first(lengths);
  if (!found) return tl::unexpected(unreachable(found.error()));
  return fitted_.sheet->on_sheet(*found);
}

MapStatus MechanismMap::status(model::BedPoint point) const {
  return area_.status(model::identity_placement(point));
}

model::ChainLengths MechanismMap::sigma(model::BedPoint point) const {
  const auto centre = lengths_of(spread_.centre, point);
  model::ChainLengths variance;
  for (const PlacedMechanism& other : spread_.others) {
    const auto there = lengths_of(other, point);
    if (!centre || !there) continue;
    variance.left_mm += std::pow(there->left_mm - centre->left_mm, 2);
    variance.right_mm += std::pow(there->right_mm - centre->right_mm, 2);
  }
  const double own = fitted_.sheet->own_variance_mm2(point);
  return {std::sqrt(variance.left_mm + own), std::sqrt(variance.right_mm + own)};
}

Eigen::Matrix2Xd MechanismMap::tool_spread(model::BedPoint point) const {
  const auto others = std::ssize(spread_.others);
  Eigen::Matrix2Xd spread = Eigen::Matrix2Xd::Zero(2, others + 2);
  if (const auto paid_out = lengths_of(spread_.centre, point)) {
    for (Eigen::Index i = 0; i < others; ++i) {
      const PlacedMechanism& other = spread_.others[as_size(i)];
      const auto there = other.mechanism->locate_by_first(*paid_out);
      if (!there) continue;
      const model::BedPoint tool = other.sheet->on_sheet(*there);
      spread.col(i) << tool.x_mm - point.x_mm, tool.y_mm - point.y_mm;
    }
  }
  spread.rightCols<2>() =
      std::sqrt(fitted_.sheet->own_variance_mm2(point)) * Eigen::Matrix2d::Identity();
  return spread;
}

std::vector<model::BedPoint> MechanismMap::hull() const {
  std::vector<model::BedPoint> corners;
  for (const model::MarkPoint corner : area_.hull()) corners.push_back({corner.x_mm, corner.y_mm});
  return corners;
}

}  // namespace chaintrue::grid
