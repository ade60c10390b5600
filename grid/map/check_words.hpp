// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The verdict of a check with its probability and sentences, from the hypotheses' probabilities.
/// Private to grid.
#pragma once

#include <functional>
#include <string>

#include "grid/map/check_evidence.hpp"

namespace chaintrue::grid {

/// A check's words for the calibration, the readings, and changes of the mechanism.
struct CheckWords {
  std::string subject;   ///< "the map"
  std::string readings;  ///< "points"
  std::string valid;     ///< "The map is still valid"
  std::string rezero;    ///< "The map is valid after re-zeroing"
  std::string again;     ///< "The map must be measured again"
  /// A change of the mechanism's as a clause: "the zero of the left chain has shifted by +1.00 mm".
  std::function<std::string(const CheckHypothesis&)> change;
  /// Follows `rezero`; empty: none.
  std::function<std::string(const Check&)> what_to_set = {};
};

Check judged(const CheckReadings& readings, const CheckWords& words);

}  // namespace chaintrue::grid
