// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Taped distances between positions of a mechanism's tool: places where it stood, points of the
/// mechanism, and holes that it cut.
///
///   a, b   ends, in the mechanism's frame
///   s      true millimetres over those of the frame
///
///   d = s |b - a|                                                                            (1)
///
/// The lengths that the controller paid out determine a hole's position: f(q) = l, dq/dtheta =
/// -J^-1 df/dtheta.
///
/// \code
///   const TapedDistance distance{AtPlace{4}, AtFixedPoint{0}, 1834.0, 1.0};
///   const auto line = distance_line(mechanism, distance, {position_of_place_4, {}});
///   if (line) residual = distance.distance_mm - line->predicted_mm;
/// \endcode
#pragma once

#include <array>
#include <tl/expected.hpp>
#include <variant>

#include "grid/containers.hpp"
#include "interp/eigen.hpp"
#include "model/mechanism.hpp"

namespace chaintrue::grid::observation {

/// A place at which lengths were read, by its number in the file.
struct AtPlace {
  std::size_t index = 0;
};
/// One of Mechanism::fixed_points().
struct AtFixedPoint {
  std::size_t index = 0;
};
struct AtHole {
  VectorXd lengths_mm;  ///< paid out
  Flags deciding;       ///< two lengths that determine the tool's position
  ToolPosition meant;   ///< the commanded position
};
using TapeEnd = std::variant<AtPlace, AtFixedPoint, AtHole>;

struct TapedDistance {
  TapeEnd from;
  TapeEnd to;
  double distance_mm = 0.0;
  double sigma_mm = 1.0;  ///< of the tape and its ends
};

/// (1) and its derivatives: by the positions of its ends, if they are places, and by theta.
struct DistanceLine {
  double predicted_mm = 0.0;
  std::array<RowVector2d, 2> by_end;
  RowVectorXd by_parameter;
};

/// An end in the mechanism's frame, and its derivative by theta.
struct PlacedEnd {
  Vector2d at;
  Matrix2Xd by_parameter;
};
[[nodiscard]] tl::expected<PlacedEnd, model::MechanismFailure> placed_hole(
    const Mechanism& mechanism, const AtHole& hole);

/// `places` are the positions of its ends; entries for ends that are not places are ignored.
[[nodiscard]] tl::expected<DistanceLine, model::MechanismFailure> distance_line(
    const Mechanism& mechanism, const TapedDistance& distance,
    const std::array<ToolPosition, 2>& places);

}  // namespace chaintrue::grid::observation
