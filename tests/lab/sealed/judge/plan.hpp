// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The frozen list of sealed sets on which two versions of the diagnosis are compared: kinds of
/// sets with their seeds, spread evenly over the list, so that each part of it has every kind in
/// the same proportion. A set depends on its kind and seed alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
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
std::vector<std::string> kinds();
/// All sets, in the order in which they are run.
std::vector<PlannedSet> plan();
/// Part `shard` (from 1) of `shards` parts of the list; together they are the list.
std::vector<PlannedSet> shard_of(const std::vector<PlannedSet>& list, std::size_t shard,
                                 std::size_t shards);
/// The outcome of `run`; a failed one, with the message on standard error, if it throws.
[[nodiscard]] Outcome or_failed(const PlannedSet& set, const std::function<Outcome()>& run);

/// Draws the set, diagnoses it and compares with the truth. An exception counts as a failed set.
/// `more`: facts besides those of the table of rates. \throws std::invalid_argument for a kind that is not in the list.
[[nodiscard]] Outcome run_set(const PlannedSet& set, bool more = false);

}  // namespace chaintrue::sealed
