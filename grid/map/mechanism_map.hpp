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
///   const auto map = MechanismMap::of(fitted, measured_points);
///   const auto lengths = map.lengths({100.0, -900.0});
/// \endcode
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "grid/map/length_map.hpp"
#include "grid/map/lengths_check.hpp"
#include "model/calibration/sheet_placement.hpp"
#include "model/mechanism.hpp"

namespace chaintrue::grid {

/// Where points of the sheet are in a mechanism's frame, and back. Immutable, thread safe.
class SheetInFrame {
 public:
  virtual ~SheetInFrame() = default;
  [[nodiscard]] virtual model::ToolPosition in_frame(model::BedPoint sheet) const = 0;
  [[nodiscard]] virtual model::BedPoint on_sheet(model::ToolPosition position) const = 0;
  /// On each axis, besides the fit's covariance.
  [[nodiscard]] virtual double own_variance_mm2(model::BedPoint /*sheet*/) const { return 0.0; }
};

/// A sheet that was shifted and turned.
class LaidSheet final : public SheetInFrame {
 public:
  explicit LaidSheet(model::SheetPlacement laid = {}) : laid_(laid) {}
  [[nodiscard]] model::ToolPosition in_frame(model::BedPoint sheet) const override;
  [[nodiscard]] model::BedPoint on_sheet(model::ToolPosition position) const override;

 private:
  model::SheetPlacement laid_;
};

/// The shift and turn that lay `from` on `to`, by least squares.
[[nodiscard]] model::SheetPlacement laid_on(const std::vector<model::MarkPoint>& from,
                                            const std::vector<model::BedPoint>& to);

struct PlacedMechanism {
  std::shared_ptr<const model::Mechanism> mechanism;
  std::shared_ptr<const SheetInFrame> sheet;
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
  MechanismMap(PlacedMechanism fitted, MechanismSpread spread, MeasuredArea area);
  /// In the mechanism's own frame, over its extent. \throws std::invalid_argument for fewer than
  /// three points.
  [[nodiscard]] static MechanismMap of(const FittedMechanism& fitted,
                                       const std::vector<model::BedPoint>& measured);

  [[nodiscard]] std::span<const std::string_view> length_names() const override;
  [[nodiscard]] tl::expected<LengthsAnswer, MapFailure> query(model::BedPoint point) const override;
  [[nodiscard]] tl::expected<model::ChainLengths, MapFailure> lengths(
      model::BedPoint point) const override;
  [[nodiscard]] tl::expected<model::BedPoint, MapFailure> tool(
      model::ChainLengths lengths) const override;
  [[nodiscard]] MapStatus status(model::BedPoint point) const override;
  [[nodiscard]] const interp::Rectangle& domain() const override { return area_.domain(); }
  /// One sigma of the first two lengths; a point that lengths() answers.
  [[nodiscard]] model::ChainLengths sigma(model::BedPoint point) const;
  [[nodiscard]] Eigen::Matrix2Xd tool_spread(model::BedPoint point) const override;
  /// Corners of what was measured.
  [[nodiscard]] std::vector<model::BedPoint> hull() const;

 private:
  PlacedMechanism fitted_;
  MechanismSpread spread_;
  MeasuredArea area_;
};

}  // namespace chaintrue::grid
