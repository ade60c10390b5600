// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The catalogue's effects as a set of distances sees them: how large each is beyond what settings
/// can imitate, and which look alike. By secants at the nominal strength, whitened by
/// K = V + A P A' (holes_fit.hpp).
#pragma once

#include <vector>

#include "grid/holes/holes_plan.hpp"

namespace chaintrue::grid {

/// Largest first. Effects of the paper, and those that depend on the visit, are left out: distances
/// between holes know neither. \throws std::invalid_argument for a set without a machine.
[[nodiscard]] std::vector<SeenEffect> seen_effects(const MeasuredHoles& set);

/// An effect alone as the cause of what the distances show.
struct ScoredCause {
  std::string effect;  ///< "nothing" where the settings explain it all
  std::string side;
  double probability = 0.0;
  /// Of the effect over nothing, in natural units.
  double log_evidence = 0.0;
  /// Of the effect's first parameter, by the name it has in files; one sigma.
  std::string parameter;
  double value = 0.0;
  double sigma = 0.0;
};

/// Each effect by itself against nothing at all, most probable first: the residuals r about the
/// machine as stated are N(0, K + s^2 g g'), g the secant and s the effect's usual size; nothing
/// has half of the probability beforehand, the effects share the rest. Readings that `fit` set
/// aside are left out. One cause at a time: grid/diagnosis weighs several together, from chain
/// readings. \throws as seen_effects.
[[nodiscard]] std::vector<ScoredCause> scored_causes(const MeasuredHoles& set, const HolesFit& fit);

}  // namespace chaintrue::grid
