// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The frozen list of sealed sets on which two versions of the diagnosis are compared: kinds of
/// sets with their seeds, spread evenly over the list, so that each part of it has every kind in
/// the same proportion. A set depends on its kind and seed alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sealed/judge/outcome.hpp"

namespace chaintrue::sealed {

struct PlannedSet {
  std::string kind;
  std::uint64_t seed = 0;
  bool operator==(const PlannedSet&) const = default;
};

/// All kinds, in the order of the table.
[[nodiscard]] std::vector<std::string> kinds();
/// All sets, in the order in which they are run.
[[nodiscard]] std::vector<PlannedSet> plan();
/// Part `shard` (from 1) of `shards` parts of the list; together they are the list.
[[nodiscard]] std::vector<PlannedSet> shard_of(const std::vector<PlannedSet>& list,
                                               std::size_t shard,
                                               std::size_t shards);
/// Draws the set, diagnoses it and compares with the truth. An exception counts as a failed set.
/// \throws std::invalid_argument for a kind that is not in the list.
[[nodiscard]] Outcome run_set(const PlannedSet& set);

}  // namespace chaintrue::sealed
