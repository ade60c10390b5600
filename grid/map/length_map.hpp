// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The interface of a calibrated machine, for any mechanism: lengths for a point, with their sigmas
/// and the point's distance from what was measured, and the point for lengths.
///
/// The first two lengths place the tool: a controller pays them out, and they alone decide where it
/// is. Others follow it there.
///
/// \code
///   if (const auto answer = map.query({100.0, -200.0})) use(answer->lengths_mm, answer->sigma);
///   if (const auto point = map.tool({1702.1, 1821.4})) use(*point);
/// \endcode
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <tl/expected.hpp>

#include "grid/map/measured_area.hpp"
#include "interp/eigen.hpp"
#include "interp/surface.hpp"
#include "model/failure.hpp"
#include "model/kinematics.hpp"
#include "model/mechanism.hpp"

namespace chaintrue::grid {

enum class MapReason {
  outside_map,    ///< off the domain, or refused
  unreachable,    ///< the machine cannot hold the tool there
  not_converged,  ///< the inverse found no point
};
std::string_view sentence_of(MapReason reason);
/// Set for `unreachable`.
using MapFailure = Failure<MapReason>;
[[nodiscard]] MapFailure unreachable(const model::MechanismFailure& why);

struct LengthsAnswer {
  VectorXd lengths_mm;  ///< in the order of the names
  ChainLengths sigma;   ///< 1 sigma of the first two
  /// Root of the summed variances of the tool's x and y; empty: not known.
  std::optional<double> tool_sigma_mm;
  MapStatus status = MapStatus::inside;
};

/// Immutable, thread safe. Both directions agree to 1e-6 mm.
class LengthMap {
 public:
  virtual ~LengthMap() = default;
  /// Words for the lengths: left, right.
  virtual std::span<const std::string_view> length_names() const = 0;
  [[nodiscard]] virtual tl::expected<LengthsAnswer, MapFailure> query(BedPoint point) const = 0;
  /// Only the first two, several times faster: for points of a path between its corners.
  [[nodiscard]] virtual tl::expected<ChainLengths, MapFailure> lengths(BedPoint point) const = 0;
  /// The tool's position for these lengths.
  [[nodiscard]] virtual tl::expected<BedPoint, MapFailure> tool(ChainLengths lengths) const = 0;
  [[nodiscard]] virtual MapStatus status(BedPoint point) const = 0;
  /// Uncertainty of the tool sent to a point which lengths() answers: x and y, mm, one column for
  /// one sigma of each direction of the posterior, the same directions everywhere. No columns if
  /// nothing is uncertain.
  virtual Matrix2Xd tool_spread(BedPoint /*point*/) const { return Matrix2Xd(2, 0); }
  /// Where lengths() may answer.
  virtual const interp::Rectangle& domain() const = 0;

 protected:
  LengthMap() = default;
  LengthMap(const LengthMap&) = default;
  LengthMap(LengthMap&&) = default;
  LengthMap& operator=(const LengthMap&) = default;
  LengthMap& operator=(LengthMap&&) = default;
};

}  // namespace chaintrue::grid
