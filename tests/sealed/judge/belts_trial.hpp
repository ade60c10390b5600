// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// One hidden session of four belts diagnosed, and the answer opened.
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
  bool named = false;        ///< anything at all
  bool exact = false;        ///< what is hidden, alone, with its belt
  bool held = false;         ///< what is hidden is among what is named
  bool right_belt = false;   ///< what is named first is of the hidden belt
  /// At its strength these data tell what is hidden from every other cause, 95 of 100 times, by how
  /// alike they look once the anchors have taken their share.
  bool separable = false;
  bool bad_found = false;    ///< the bad readings, each by point and belt, and no others
  std::string sentence;
  std::string verdict;          ///< as files have it; empty where it failed
  std::vector<NamedCause> causes;
  double family_wise_p = 1.0;
  double probability = 0.0;     ///< that what is hidden acts, as the table of hypotheses has it
  /// Where no single name was given and the trial went on: places that were proposed and measured,
  /// and whether what is hidden was then named alone.
  int proposed = 0;
  bool parted = false;
};
/// `go_on`: where no single name is given, what is proposed is measured and diagnosed once more.
[[nodiscard]] BeltsTrial run_belts_trial(const generator::BeltRecipe& recipe,
                                         std::uint64_t seed,
                                         bool go_on = false);

}  // namespace chaintrue::sealed
