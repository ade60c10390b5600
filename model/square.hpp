// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The test square: its sides, diagonals and bows when a controller with the kinematics of one
/// machine drives another.
///
/// At each point of the commanded outline the controller pays out the lengths of its own
/// kinematics; the tool goes where the true machine, with its effects, reads those lengths. Visits
/// (hysteresis, drift) are not modelled.
///
/// \code
///   const SquareTask task{.size_mm = 100, .corner = {-1040, -465}};
///   const auto square = predict_square(machine, controller_machine, task);
///   fmt::print("top: {:.2f} mm\n", square->side(SquareSide::top).length_mm);
/// \endcode
#pragma once

#include <array>
#include <tl/expected.hpp>
#include <vector>

#include "model/kinematics.hpp"
#include "model/machine.hpp"

namespace chaintrue::model {

struct SquareTask {
  double size_mm = 100.0;
  /// Lower left corner, or upper left where `below`.
  BedPoint corner{};
  bool below = false;
  /// Points of each side that are computed, its ends included.
  int points_per_side = 101;
};

/// Clockwise from the lower left corner.
enum class SquareSide { left, top, right, bottom };
inline constexpr SquareSide kSquareSides[] = {SquareSide::left, SquareSide::top, SquareSide::right,
                                              SquareSide::bottom};

struct CutSide {
  double length_mm = 0.0;  ///< corner to corner
  double bow_mm =
      0.0;  ///< farthest from the straight line between the corners; outwards is positive
};

struct CutSquare {
  /// The outline, side by side, clockwise; a corner ends one side and begins the next, and occurs
  /// twice.
  std::vector<BedPoint> commanded;
  std::vector<BedPoint> cut;
  std::array<CutSide, 4> sides;
  double rising_diagonal_mm = 0.0;   ///< lower left to upper right
  double falling_diagonal_mm = 0.0;  ///< upper left to lower right
  BedPoint offset;                   ///< the cut corners' middle less the commanded one
  double rotation_rad = 0.0;         ///< of the cut corners, counter-clockwise
  const CutSide& side(SquareSide side) const { return sides[static_cast<std::size_t>(side)]; }
};

/// The points of the outline as commanded, in the order of CutSquare::commanded.
/// \throws std::invalid_argument for a size that is no positive number or fewer than two points to a
/// side.
std::vector<BedPoint> outline_of(const SquareTask& task);
/// The measurements of a square cut through `cut`, one point for each of the outline. \throws
/// std::invalid_argument as above, and for another number of points.
CutSquare measured_square(const SquareTask& task, std::vector<BedPoint> cut);

struct SquarePlace {
  BedPoint commanded;
  bool of_controller = false;  ///< the controller's own kinematics has no length for it
};
using SquareFailure = Failure<PoseReason, SquarePlace>;

/// \throws std::invalid_argument for a size that is no positive number, fewer than two points to a
/// side, or machines with problems.
[[nodiscard]] tl::expected<CutSquare, SquareFailure> predict_square(
    const Machine& machine, const Machine& controller_machine, const SquareTask& task,
    Model model = Model::elastic);

}  // namespace chaintrue::model
