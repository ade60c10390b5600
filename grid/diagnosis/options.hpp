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
  /// Given a pattern the probabilities are averaged over parts of the bed (bed_parts.hpp).
  bool average_parts = true;
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
