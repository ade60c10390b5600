// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The interface of a machine for the compensation: the chain lengths for a point, and the inverse.
///
/// Implemented by compensation_target.hpp for a map, and by tests with formulas.
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
    controller,  ///< outside the range of the controller's own kinematics
  };
  using enum Reason;
  CorrectionFailure(Reason why, std::optional<model::PoseFailure> from = std::nullopt)  // NOLINT
      : reason(why), pose(from) {}

  Reason reason;
  /// Of `unreachable` and `controller`, if known.
  std::optional<model::PoseFailure> pose;
  friend bool operator==(const CorrectionFailure&, const CorrectionFailure&) = default;
};
/// A clause: "lies outside the map", ...; followed by the pose's own cause.
[[nodiscard]] std::string explain(const CorrectionFailure& failure);

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

/// Thread safe and stateless. The two directions are consistent to 1e-6 mm.
class TargetMap {
 public:
  virtual ~TargetMap() = default;
  [[nodiscard]] virtual tl::expected<model::ChainLengths, CorrectionFailure> lengths(
      model::BedPoint point) const = 0;
  [[nodiscard]] virtual tl::expected<TargetAnswer, CorrectionFailure> query(
      model::BedPoint point) const = 0;
  [[nodiscard]] virtual TargetStatus status(model::BedPoint point) const = 0;
  /// The tool's position for these chain lengths.
  [[nodiscard]] virtual tl::expected<model::BedPoint, CorrectionFailure> tool(
      model::ChainLengths lengths) const = 0;
  /// The region outside of which lengths() has no answer.
  [[nodiscard]] virtual BedRectangle bounds() const = 0;
};

}  // namespace chaintrue::gcode
