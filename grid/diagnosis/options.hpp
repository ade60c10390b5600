// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What may be asked of a diagnosis, and why there may be none.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "grid/diagnosis/cause_id.hpp"
#include "grid/progress.hpp"
#include "model/failure.hpp"

namespace chaintrue::grid::diagnosis {

/// Steps that can be left out to see what they are worth. All on but for such experiments.
struct Steps {
  bool project_settings = true;  ///< off: settings stay as calibrated while effects are scored
  bool whiten = true;            ///< off: all chain lengths with one weight, no position noise
  bool anchor_noise = true;      ///< off: the noise is whatever the best fit leaves
  bool average_location = true;  ///< off: the best location counts in full
  bool robust = true;            ///< off: no point is set aside
  bool average_parts = true;     ///< off: the probabilities of all readings, also given a pattern
};

struct DiagnosisOptions {
  std::uint64_t seed = 1;
  bool improvement = true;  ///< error of the tool today; held-out errors, naming repeated in each fold
  bool next_measurements = true;
  bool stability = true;       ///< the naming without each point, column and row of marks
  /// Orders of visits that the readings were tried with: each is a chance of a false alarm.
  int orders_tried = 1;
  bool order_assumed = false;  ///< the points' order was assumed by somebody, not measured
  /// Chain or paper, which no points tell apart: the person has it that it is the chain.
  bool accept_class = false;
  /// Nothing but this cause is looked for: what somebody who knew it would find.
  std::optional<CauseId> given_cause{};
  Steps steps;
  Progress progress{};
};

enum class DiagnosisReason {
  no_machine,
  no_lengths,
  too_few_points,  ///< or distances
  no_noise,        ///< neither stated nor in repeats
  point_unreachable,
  contradictory_settings,  ///< the machine and the grid's readings of it cannot both be
};
using DiagnosisFailure = Failure<DiagnosisReason>;

}  // namespace chaintrue::grid::diagnosis
