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
  SheetPlacement laid;
  /// The sheet's millimetres over those of the frame.
  double factor = 1.0;
  ToolPosition origin{};
  /// d; null: none.
  std::shared_ptr<const ToolDisplacement> displacement = nullptr;

  ToolPosition in_frame(BedPoint sheet) const;
  BedPoint on_sheet(ToolPosition position) const;
  /// On each axis, besides the fit's covariance.
  double own_variance_mm2(BedPoint sheet) const {
    return displacement ? displacement->own_variance_mm2(laid.to_mark(sheet)) : 0.0;
  }
};

/// The shift and turn that lay `from` on `to`, by least squares.
SheetPlacement laid_on(const std::vector<MarkPoint>& from, const std::vector<BedPoint>& to);

struct PlacedMechanism {
  std::shared_ptr<const Mechanism> mechanism;
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
  static MechanismMap of(const FittedMechanism& fitted, const std::vector<BedPoint>& measured);

  std::span<const std::string_view> length_names() const override {
    return fitted_.mechanism->lengths();
  }

  [[nodiscard]] tl::expected<LengthsAnswer, MapFailure> query(BedPoint point) const override;

  [[nodiscard]] tl::expected<ChainLengths, MapFailure> lengths(BedPoint point) const override;

  [[nodiscard]] tl::expected<BedPoint, MapFailure> tool(ChainLengths lengths) const override;

  [[nodiscard]] MapStatus status(BedPoint point) const override {
    return area_.status(model::identity_placement(point));
  }

  const interp::Rectangle& domain() const override { return area_.domain(); }
  /// One sigma of the first two lengths; a point that lengths() answers.
  ChainLengths sigma(BedPoint point) const;

  Matrix2Xd tool_spread(BedPoint point) const override;

  /// Corners of what was measured.
  std::vector<BedPoint> hull() const;

 private:
  static tl::expected<ChainLengths, model::MechanismFailure> lengths_of(
      const PlacedMechanism& placed, BedPoint point) {
    return placed.mechanism->first_lengths(placed.sheet.in_frame(point));
  }

  PlacedMechanism fitted_;
  MechanismSpread spread_;
  MeasuredArea area_;
};

}  // namespace chaintrue::grid
