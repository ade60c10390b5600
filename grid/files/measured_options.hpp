// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How a file of measurements is read: values that it may omit, or that replace its own.
///
/// \code
///   const ReadGrid found = read(parse_grid, "grid.csv", {.machine = machine});
/// \endcode
#pragma once

#include <optional>

#include "model/machine.hpp"

namespace chaintrue::grid::files {

/// Overrides single values of the tape in a file of holes.
struct TapeOptions {
  std::optional<double> sigma_mm;
  std::optional<double> zero_offset_mm;
  std::optional<double> zero_offset_sigma_mm;
  std::optional<double> hole_sigma_mm;
};

struct MeasuredOptions {
  /// Replaces the machine of the file.
  std::optional<Machine> machine = std::nullopt;
  /// Used for a file that names no machine: the machine of the map to be checked.
  std::optional<Machine> otherwise = std::nullopt;
  /// A few readings, which only check a map, need not be enough for a fit.
  bool few = false;
  /// The measured values of a CSV whose header says mm are in inches: marks, lengths and distances,
  /// but not the commands. JSON has the units of its keys.
  bool inches = false;
  TapeOptions tape = {};
};

}  // namespace chaintrue::grid::files
