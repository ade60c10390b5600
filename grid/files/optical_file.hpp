// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The scan that the optical calibration of WebControl and GroundControl writes: the command that
/// puts the sled's camera over each printed square.
///
/// Two blocks of 15 lines with 31 numbers, mm, with an empty line between them: first the errors in
/// x, then those in y. The first line is the top of the sheet (iy = 7 .. -7), the first number its
/// left end (ix = -15 .. 15). A square lies at (ix, iy) times the pitch. The error is the command
/// less the square's position, so
///
///   command = square + error                                                                (1)
///
/// puts the tool on the square. 0.00 in both blocks: not visited. A scan of the remaining errors
/// with a compensation switched on has the same form but another meaning; (1) does not hold for it.
#pragma once

#include <optional>
#include <string>

#include "grid/files/input_error.hpp"
#include "grid/observation/visiting_order.hpp"

namespace chaintrue::grid::files {

inline constexpr int kOpticalSquares = 15 * 31;

struct OpticalOptions {
  /// Includes the controller that executed the commands.
  Machine machine;
  /// Between two squares; 3 inches on the printed banner.
  double pitch_mm = 76.2;
  std::optional<VisitingOrder> order;
};

/// Points with commands; the sheet placed by hand (20 mm, 10 mrad); no noise stated.
/// `file` is the name used in messages and, without its folder, the grid's. \throws InputError with
/// every problem of the file, or if the machine has no controller.
MeasuredGrid parse_optical(const std::string& text, const std::string& file,
                           const OpticalOptions& options);

}  // namespace chaintrue::grid::files
