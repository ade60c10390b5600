// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The error of the tool that a compensated program is to be cut with: what the map does not know of
/// itself along the cuts, and what the path strays by.
#pragma once

#include <optional>
#include <string>

#include "tools/cli/gcode_job.hpp"
#include "tools/gcode/expected_error.hpp"

namespace chaintrue::cli {

/// `map` is empty where the map does not know its error, `path_mm` what the simulated tool strays by
/// at most. Adds the two: neither knows the other's direction.
struct PromisedError {
  std::optional<gcode::ExpectedError> map;
  double path_mm = 0.0;
  /// But for the scale of four belts, which no tape has shown.
  bool is_without_scale = false;

  /// Of cuts on the measured part; empty where there are none.
  [[nodiscard]] std::optional<double> measured_mm() const;
  /// Of those outside.
  [[nodiscard]] std::optional<double> outside_mm() const;
};

/// What the machine's map or anchors know of cuts at these places.
[[nodiscard]] PromisedError promised_along(const gcode::CutPlaces& cuts,
                                           const GcodeMachine& machine,
                                           double path_mm);
/// Whole sentences, a line each; empty where nothing is cut or known.
[[nodiscard]] std::string in_words(const PromisedError& error);
/// For --json, as members of an object: `"expected_mm": 0.28, ...`; null where it is not known.
[[nodiscard]] std::string as_members(const PromisedError& error);

}  // namespace chaintrue::cli
