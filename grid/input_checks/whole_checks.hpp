// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Errors in a whole file of points, each with its correction: an axis turned round, columns
/// exchanged, units, minus signs left out, a tape read from another mark, another origin.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "grid/input_checks/findings.hpp"
#include "grid/observation/measured_grid.hpp"

namespace chaintrue::grid::input_checks {

struct WholeError {
  ProblemKind kind = ProblemKind::axes;
  /// What was expected, and what it looks like: a sentence's end.
  std::string sentence;
  /// The point as it was meant; `place` is where the machine as stated puts its reading.
  std::function<void(MeasuredPoint& point, model::BedPoint place)> mend;
  /// Lengths or commands change, and with them the place.
  bool mends_readings = false;
  /// Of lengths, a machine that is stated as much off looks the same.
  bool is_doubtful = false;
};

/// Those that a file like this one may have.
[[nodiscard]] std::vector<WholeError> whole_errors(const MeasuredGrid& grid, Written written);

}  // namespace chaintrue::grid::input_checks
