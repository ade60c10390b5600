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

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "grid/containers.hpp"
#include "grid/map/length_map.hpp"
#include "grid/map/lengths_check.hpp"
#include "grid/map/tool_displacement.hpp"
#include "grid/plane_vectors.hpp"
#include "interp/eigen.hpp"
#include "model/calibration/sheet_placement.hpp"
#include "model/mechanism.hpp"

namespace chaintrue::grid {

/// Where points of the sheet are in a mechanism's frame, and back:
///
///   on_sheet(m) = laid(raw + d(raw)),   raw = factor (m - origin)                            (2)
///
/// The inverse is found by fixed-point iteration: d changes by less than 0.01 mm per mm.
struct SheetInFrame {
  /// The placement of what the mechanism cuts, on the sheet.
  model::SheetPlacement laid;
  /// The sheet's millimetres over those of the frame.
  double factor = 1.0;
  model::ToolPosition origin{};
  /// d; null: none.
  std::shared_ptr<const ToolDisplacement> displacement = nullptr;

  model::ToolPosition in_frame(model::BedPoint sheet) const;
  model::BedPoint on_sheet(model::ToolPosition position) const;
  /// On each axis, besides the fit's covariance.
  double own_variance_mm2(model::BedPoint sheet) const {
    return displacement ? displacement->own_variance_mm2(laid.to_mark(sheet)) : 0.0;
  }
};

/// The shift and turn that lay `from` on `to`, by least squares.
model::SheetPlacement laid_on(const std::vector<model::MarkPoint>& from,
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
using PlacedAt = std::function<PlacedMechanism(const VectorXd& values)>;
MechanismSpread spread_about(const VectorXd& values, const MatrixXd& covariance,
                             const PlacedAt& placed);

class MechanismMap : public LengthMap {
 public:
  MechanismMap(PlacedMechanism fitted, MechanismSpread spread, MeasuredArea area)
      : fitted_(std::move(fitted)), spread_(std::move(spread)), area_(std::move(area)) {}
  /// In the mechanism's own frame, over its extent. \throws std::invalid_argument for fewer than
  /// three points.
  static MechanismMap of(const FittedMechanism& fitted,
                         const std::vector<model::BedPoint>& measured);

  std::span<const std::string_view> length_names() const override {
    return fitted_.mechanism->lengths();
  }

  [[nodiscard]] tl::expected<LengthsAnswer, MapFailure> query(model::BedPoint point) const override;

  [[nodiscard]] tl::expected<model::ChainLengths, MapFailure> lengths(
      model::BedPoint point) const override;

  [[nodiscard]] tl::expected<model::BedPoint, MapFailure> tool(
      model::ChainLengths lengths) const override;

  [[nodiscard]] MapStatus status(model::BedPoint point) const override {
    return area_.status(model::identity_placement(point));
  }

  const interp::Rectangle& domain() const override { return area_.domain(); }
  /// One sigma of the first two lengths; a point that lengths() answers.
  model::ChainLengths sigma(model::BedPoint point) const;

  Matrix2Xd tool_spread(model::BedPoint point) const override;

  /// Corners of what was measured.
  std::vector<model::BedPoint> hull() const;

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
