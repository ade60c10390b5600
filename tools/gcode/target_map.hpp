// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What compensation needs to know of a machine: the lengths its chains must have for a point, and
/// back.
///
/// compensation_target.hpp makes one of a compensation map; tests make them of formulas.
#pragma once

#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "model/kinematics.hpp"

namespace chaintrue::gcode {

enum class TargetStatus { inside, edge, extrapolated };
/// Why there is no chain length, tool or command for a point.
struct CorrectionFailure {
  enum class Reason {
    outside_map,
    unreachable,  ///< the machine has no pose there
    not_converged,
    controller,  ///< out of reach of the controller's own kinematics
  };
  using enum Reason;
  CorrectionFailure(Reason why, std::optional<model::PoseFailure> from = std::nullopt)  // NOLINT
      : reason(why), pose(from) {}

  Reason reason;
  /// Of `unreachable` and `controller`, where it is known.
  std::optional<model::PoseFailure> pose;
  friend bool operator==(const CorrectionFailure&, const CorrectionFailure&) = default;
};
/// A clause: "lies outside the map", ...; with the pose's own cause behind it.
[[nodiscard]] std::string explain(const CorrectionFailure& failure);

struct TargetAnswer {
  model::ChainLengths lengths;
  model::ChainLengths sigma;  ///< 1 sigma of each
  TargetStatus status = TargetStatus::inside;
  /// One sigma of where the tool is: the root of the summed variances of x and y.
  std::optional<double> tool_sigma_mm = std::nullopt;
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
  [[nodiscard]] virtual tl::expected<model::ChainLengths, CorrectionFailure> lengths(
      model::BedPoint point) const = 0;
  [[nodiscard]] virtual tl::expected<TargetAnswer, CorrectionFailure> query(
      model::BedPoint point) const = 0;
  [[nodiscard]] virtual TargetStatus status(model::BedPoint point) const = 0;
  /// Where the tool stands when the chains have these lengths.
  [[nodiscard]] virtual tl::expected<model::BedPoint, CorrectionFailure> tool(
      model::ChainLengths lengths) const = 0;
  /// Where lengths() may answer.
  [[nodiscard]] virtual BedRectangle bounds() const = 0;
};

}  // namespace chaintrue::gcode
