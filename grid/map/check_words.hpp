// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the weighed hypotheses of a check come to: the verdict with its probability, and its
/// sentences. Private to grid.
#pragma once

#include <functional>
#include <string>

#include "grid/map/check_evidence.hpp"
#include "model/mechanism.hpp"

namespace chaintrue::grid {

/// What a check calls what was calibrated, what was read, and the mechanism's own changes.
struct CheckWords {
  std::string subject;   ///< "the map"
  std::string readings;  ///< "points"
  std::string valid;     ///< "The map is still valid"
  std::string rezero;    ///< "The map is valid after re-zeroing"
  std::string again;     ///< "The map is to be measured again"
  /// A change of the mechanism's as a clause: "the zero of the left chain has shifted by +1.00 mm".
  std::function<std::string(const CheckHypothesis&)> change;
  /// A sentence that follows `rezero`; empty: none.
  std::function<std::string(const Check&)> what_to_set = {};
};

/// By the names of the mechanism's lengths and parameters.
[[nodiscard]] CheckWords words_of(const model::Mechanism& mechanism);

[[nodiscard]] Check judged(const CheckReadings& readings, const CheckWords& words);

}  // namespace chaintrue::grid
