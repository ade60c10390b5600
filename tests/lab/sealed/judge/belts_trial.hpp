// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The diagnosis of one hidden session of four belts, compared with the truth.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "generator/hidden/belt_draw.hpp"
#include "sealed/judge/trial.hpp"

namespace chaintrue::sealed {

struct BeltsTrial {
  std::uint64_t seed = 0;
  int points = 0;
  generator::BeltSecret secret;
  bool failed = false;
  bool named = false;        ///< any cause
  bool exact = false;        ///< the hidden cause alone, with its belt
  bool held = false;         ///< the hidden cause is among the named ones
  bool right_belt = false;   ///< the first named cause has the hidden belt
  /// At its strength these data distinguish the hidden cause from every other in 95 of 100 cases,
  /// by their collinearity after projection on the anchors.
  bool separable = false;
  bool bad_found = false;    ///< exactly the bad readings, each by point and belt
  std::string verdict;          ///< as in files; empty if it failed
  std::vector<NamedCause> causes;
};
/// The owner's view of it.
[[nodiscard]] grid::MeasuredBelts measured_belts_of(const generator::BeltDraw& draw);
[[nodiscard]] BeltsTrial run_belts_trial(const generator::BeltRecipe& recipe, std::uint64_t seed);

}  // namespace chaintrue::sealed
