// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/chains/chain_changes.hpp"

#include <cstdlib>

namespace chaintrue::model {
namespace {

/// The chains that `side` names.
std::vector<std::size_t> chains_of(std::string_view side) {
  if (side == "left") return {0};
  if (side == "right") return {1};
  return {0, 1};
}

/// Zeros shift independently of each other.
void add_zeros(std::string_view side, MechanismChange& change) {
  for (const std::size_t chain : chains_of(side)) {
    change.quantities.push_back(
        {.kind = ChangedQuantity::Kind::added, .lengths = {chain}, .sigma = kZeroShiftSigmaMm});
  }
}

/// Both chains wear equally.
void add_pitch(std::string_view side, MechanismChange& change) {
  change.quantities.push_back({.kind = ChangedQuantity::Kind::elongation,
                               .lengths = chains_of(side),
                               .sigma = kPitchGrowthSigma,
                               .only_grows = true});
}

}  // namespace

std::vector<MechanismChange> changes_of_chains(double pitch_mm) {
  const ChangePriors& p = kChangePriors;
  std::vector<MechanismChange> changes;
  for (const char* side : {"left", "right", "both"}) {
    const bool one = chains_of(side).size() == 1;
    MechanismChange zero{Change::zero, side, true, one ? 0.5 * p.one_zero : p.both_zeros};
    add_zeros(side, zero);
    changes.push_back(std::move(zero));
    MechanismChange pitch{Change::pitch, side, false, p.pitch / 3.0};
    add_pitch(side, pitch);
    changes.push_back(std::move(pitch));
    MechanismChange both{Change::zeros_and_pitch, side, false, p.zeros_and_pitch / 3.0};
    add_zeros("both", both);
    add_pitch(side, both);
    changes.push_back(std::move(both));
  }
  for (const int teeth : {-2, -1, 1, 2}) {
    // A second tooth is four times as rare as the first.
    const double share = p.tooth * (std::abs(teeth) == 1 ? 0.2 : 0.05);
    for (const char* side : {"left", "right"}) {
      MechanismChange tooth{Change::tooth, side, true, share, {}, teeth};
      tooth.quantities.push_back({.lengths = chains_of(side), .mean = teeth * pitch_mm});
      changes.push_back(std::move(tooth));
    }
  }
  return changes;
}

}  // namespace chaintrue::model
