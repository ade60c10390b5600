// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What compensation needs to know of a machine: the lengths its chains must have for a point, and
/// back.
///
/// compensation_target.hpp makes one of a compensation map; tests make them of formulas.
#pragma once

#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "model/coordinates.hpp"

namespace chaintrue::gcode {

enum class TargetStatus { inside, edge, extrapolated };
enum class TargetFailure { outside, unreachable, not_converged };
/// A clause: "lies outside the map", ...
[[nodiscard]] std::string_view explain(TargetFailure failure);

struct TargetAnswer {
  model::ChainLengths lengths;
  model::ChainLengths sigma;  ///< 1 sigma of each
  TargetStatus status = TargetStatus::inside;
};

struct BedRectangle {
  double left_mm = 0.0;
  double right_mm = 0.0;
  double bottom_mm = 0.0;
  double top_mm = 0.0;
};

/// Thread safe and stateless. Both directions agree to 1e-6 mm.
class TargetMap {
 public:
  virtual ~TargetMap() = default;
  [[nodiscard]] virtual tl::expected<model::ChainLengths, TargetFailure> lengths(
      model::BedPoint point) const = 0;
  [[nodiscard]] virtual tl::expected<TargetAnswer, TargetFailure> query(
      model::BedPoint point) const = 0;
  [[nodiscard]] virtual TargetStatus status(model::BedPoint point) const = 0;
  /// Where the tool stands when the chains have these lengths.
  [[nodiscard]] virtual tl::expected<model::BedPoint, TargetFailure> tool(
      model::ChainLengths lengths) const = 0;
  /// Where lengths() may answer.
  [[nodiscard]] virtual BedRectangle bounds() const = 0;
};

}  // namespace chaintrue::gcode
