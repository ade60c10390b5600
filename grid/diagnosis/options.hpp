// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Options of a diagnosis, and reasons for its failure.
#pragma once

#include <compare>
#include <cstdint>

#include "grid/progress.hpp"
#include "model/failure.hpp"

namespace chaintrue::model::effects {
struct Effect;
enum class EffectSide;
}  // namespace chaintrue::model::effects

namespace chaintrue::grid::diagnosis {

/// An effect of the catalogue at a side.
struct CauseId {
  const model::effects::Effect* effect = nullptr;
  model::effects::EffectSide side{};  ///< EffectSide::none
  friend auto operator<=>(const CauseId&, const CauseId&) = default;
};

struct DiagnosisOptions {
  std::uint64_t seed = 1;
  bool improvement =
      true;  ///< error of the tool today; held-out errors, naming repeated in each fold
  bool next_measurements = true;
  bool stability = true;  ///< the naming without each point, column and row of marks
  /// Number of orders of visits that were tried: each may give a false alarm.
  int orders_tried = 1;
  bool order_assumed = false;  ///< the points' order is assumed, not recorded
  /// Chain or paper, which no points distinguish: the owner states that it is the chain.
  bool accept_class = false;
  /// Average the probabilities over parts of the bed if there is a pattern (bed_parts.hpp).
  bool average_parts = true;
  Progress progress{};
};

enum class DiagnosisReason {
  no_machine,
  no_lengths,
  too_few_points,  ///< or distances
  no_noise,        ///< neither stated nor in repeats
  point_unreachable,
  contradictory_settings,  ///< the machine contradicts the grid's readings of it
};
using DiagnosisFailure = Failure<DiagnosisReason>;

}  // namespace chaintrue::grid::diagnosis
