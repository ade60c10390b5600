// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The map of any calibrated mechanism: lengths and tool by the mechanism, on a sheet with its
/// fitted placement.
///
///   lengths(p) = f(in_frame(p)),   tool(l) = on_sheet(f^-1(l))                              (1)
///
/// Sigmas come from mechanisms and sheets one sigma away, one for each column of the covariance's
/// root: the sum of squares of their lengths' differences, plus the sheet's own uncertainty.
///
/// \code
///   const auto map = of(fitted, measured_points);
///   const auto lengths = map.lengths({100.0, -900.0});
/// \endcode
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "grid/containers.hpp"
#include "grid/map/length_map.hpp"
#include "grid/map/lengths_check.hpp"
#include "grid/map/tool_displacement.hpp"
#include "grid/plane_vectors.hpp"
#include "model/calibration/sheet_placement.hpp"
#include "model/mechanism.hpp"

namespace chaintrue::grid {

/// Where points of the sheet are in a mechanism's frame, and back:
///
///   on_sheet(m) = laid(raw + d(raw)),   raw = factor (m - origin)                            (2)
///
/// The inverse is found by fixed-point iteration: d changes by less than 0.01 mm per mm.
struct SheetInFrame {
  /// Of what the mechanism cuts, on the sheet.
  model::SheetPlacement laid;
  /// The sheet's millimetres over those of the frame.
  double factor = 1.0;
  model::ToolPosition origin{};
  /// d; null: none.
  std::shared_ptr<const ToolDisplacement> displacement = nullptr;

  [[nodiscard]] model::ToolPosition in_frame(model::BedPoint sheet) const;
  [[nodiscard]] model::BedPoint on_sheet(model::ToolPosition position) const;
  /// On each axis, besides the fit's covariance.
  [[nodiscard]] double own_variance_mm2(model::BedPoint sheet) const {
    return displacement ? displacement->own_variance_mm2(laid.to_mark(sheet)) : 0.0;
  }
};

/// The shift and turn that lay `from` on `to`, by least squares.
[[nodiscard]] model::SheetPlacement laid_on(const std::vector<model::MarkPoint>& from,
                                            const std::vector<model::BedPoint>& to);

struct PlacedMechanism {
  std::shared_ptr<const model::Mechanism> mechanism;
  SheetInFrame sheet;
};

/// States one sigma away, and the centre.
struct MechanismSpread {
  PlacedMechanism centre;
  std::vector<PlacedMechanism> others;
};
using PlacedAt = std::function<PlacedMechanism(const Eigen::VectorXd& values)>;
[[nodiscard]] MechanismSpread spread_about(const Eigen::VectorXd& values,
                                           const Eigen::MatrixXd& covariance,
                                           const PlacedAt& placed);

class MechanismMap : public LengthMap {
 public:
  MechanismMap(PlacedMechanism fitted, MechanismSpread spread, MeasuredArea area)
      : fitted_(std::move(fitted)), spread_(std::move(spread)), area_(std::move(area)) {}
  /// In the mechanism's own frame, over its extent. \throws std::invalid_argument for fewer than
  /// three points.
  [[nodiscard]] static MechanismMap of(const FittedMechanism& fitted,
                                       const std::vector<model::BedPoint>& measured) {
    const PlacedMechanism best{fitted.mechanism, {}};
    const model::MechanismExtent e = fitted.mechanism->extent();
    std::vector<model::MarkPoint> points;
    for (const model::BedPoint point : measured) points.push_back(model::identity_placement(point));
    return {
        best,
        spread_about(fitted.mechanism->values(),
                     fitted.covariance,
                     [&](const Eigen::VectorXd& values) {
                       return PlacedMechanism{fitted.mechanism->with_values(values), best.sheet};
                     }),
        MeasuredArea(points, {e.x_min_mm, e.x_max_mm, e.y_min_mm, e.y_max_mm})};
  }

  [[nodiscard]] std::span<const std::string_view> length_names() const override {
    return fitted_.mechanism->lengths();
  }

  [[nodiscard]] tl::expected<LengthsAnswer, MapFailure> query(
      model::BedPoint point) const override {
    if (!area_.domain().contains(point.x_mm, point.y_mm))
      return tl::unexpected(MapReason::outside_map);
    const auto found = fitted_.mechanism->predict(
        fitted_.sheet.in_frame(point), {}, model::Derivatives::by_position);
    if (!found) return tl::unexpected(unreachable(found.error()));
    return LengthsAnswer{found->lengths_mm, sigma(point), tool_spread(point).norm(), status(point)};
  }

  [[nodiscard]] tl::expected<model::ChainLengths, MapFailure> lengths(
      model::BedPoint point) const override {
    if (!area_.domain().contains(point.x_mm, point.y_mm))
      return tl::unexpected(MapReason::outside_map);
    const auto found = lengths_of(fitted_, point);
    if (!found) return tl::unexpected(unreachable(found.error()));
    return *found;
  }

  [[nodiscard]] tl::expected<model::BedPoint, MapFailure> tool(
      model::ChainLengths lengths) const override {
    const auto found = fitted_.mechanism->locate_by_first(lengths);
    if (!found) return tl::unexpected(unreachable(found.error()));
    return fitted_.sheet.on_sheet(*found);
  }

  [[nodiscard]] MapStatus status(model::BedPoint point) const override {
    return area_.status(model::identity_placement(point));
  }

  [[nodiscard]] const interp::Rectangle& domain() const override { return area_.domain(); }
  /// One sigma of the first two lengths; a point that lengths() answers.
  [[nodiscard]] model::ChainLengths sigma(model::BedPoint point) const {
    const auto centre = lengths_of(spread_.centre, point);
    model::ChainLengths variance;
    for (const PlacedMechanism& other : spread_.others) {
      const auto there = lengths_of(other, point);
      if (!centre || !there) continue;
      variance.left_mm += std::pow(there->left_mm - centre->left_mm, 2);
      variance.right_mm += std::pow(there->right_mm - centre->right_mm, 2);
    }
    const double own = fitted_.sheet.own_variance_mm2(point);
    return {std::sqrt(variance.left_mm + own), std::sqrt(variance.right_mm + own)};
  }

  [[nodiscard]] Eigen::Matrix2Xd tool_spread(model::BedPoint point) const override {
    const auto others = std::ssize(spread_.others);
    Eigen::Matrix2Xd spread = Eigen::Matrix2Xd::Zero(2, others + 2);
    if (const auto paid_out = lengths_of(spread_.centre, point)) {
      for (Eigen::Index i = 0; i < others; ++i) {
        const PlacedMechanism& other = spread_.others[as_size(i)];
        const auto there = other.mechanism->locate_by_first(*paid_out);
        if (!there) continue;
        const model::BedPoint tool = other.sheet.on_sheet(*there);
        spread.col(i) = difference(tool, point);
      }
    }
    spread.rightCols<2>() =
        std::sqrt(fitted_.sheet.own_variance_mm2(point)) * Eigen::Matrix2d::Identity();
    return spread;
  }

  /// Corners of what was measured.
  [[nodiscard]] std::vector<model::BedPoint> hull() const {
    std::vector<model::BedPoint> corners;
    for (const model::MarkPoint corner : area_.hull())
      corners.push_back({corner.x_mm, corner.y_mm});
    return corners;
  }

 private:
  static tl::expected<model::ChainLengths, model::MechanismFailure> lengths_of(
      const PlacedMechanism& placed, model::BedPoint point) {
    return placed.mechanism->first_lengths(placed.sheet.in_frame(point));
  }

  PlacedMechanism fitted_;
  MechanismSpread spread_;
  MeasuredArea area_;
};

}  // namespace chaintrue::grid
