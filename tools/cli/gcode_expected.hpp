// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The expected error of the tool for a compensated program: the map's uncertainty along the cuts,
/// and the path's deviation.
#pragma once

#include <optional>
#include <string>

#include "tools/cli/gcode_job.hpp"
#include "tools/gcode/expected_error.hpp"

namespace chaintrue::cli {

/// `map` is empty if the map's error is unknown, `path_mm` is the largest deviation of the
/// simulated tool. Adds the two: their directions are unrelated.
struct PromisedError {
  std::optional<gcode::ExpectedError> map;
  double path_mm = 0.0;
  /// Without the scale of four belts, if it was not taped.
  bool is_without_scale = false;

  /// For cuts on the measured part; empty if there are none.
  [[nodiscard]] std::optional<double> measured_mm() const;
  /// For cuts outside.
  [[nodiscard]] std::optional<double> outside_mm() const;
};

/// The uncertainty of the machine's map or anchors for cuts at these places.
[[nodiscard]] PromisedError promised_along(const gcode::CutPlaces& cuts,
                                           const GcodeMachine& machine,
                                           double path_mm);
/// Sentences, one per line; empty if nothing is cut or known.
[[nodiscard]] std::string in_words(const PromisedError& error);
/// For --json, as members of an object: `"expected_mm": 0.28, ...`; null if unknown.
[[nodiscard]] std::string as_members(const PromisedError& error);

}  // namespace chaintrue::cli
