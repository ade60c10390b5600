// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The error of the tool that a compensated program is to be cut with: what the map does not know of
/// itself along the cuts, and what the path strays by.
#pragma once

#include <optional>
#include <string>

#include "tools/gcode/expected_error.hpp"

namespace chaintrue::cli {

/// `map` is empty where the map does not know its error, `path_mm` what the simulated tool strays by
/// at most. Adds the two: neither knows the other's direction.
struct PromisedError {
  std::optional<gcode::ExpectedError> map;
  double path_mm = 0.0;

  /// Of cuts on the measured part; empty where there are none.
  [[nodiscard]] std::optional<double> measured_mm() const;
  /// Of those outside.
  [[nodiscard]] std::optional<double> outside_mm() const;
};

/// Whole sentences, a line each; empty where nothing is cut or known.
[[nodiscard]] std::string in_words(const PromisedError& error);
/// For --json, as members of an object: `"expected_mm": 0.28, ...`; null where it is not known.
[[nodiscard]] std::string as_members(const PromisedError& error);

}  // namespace chaintrue::cli
