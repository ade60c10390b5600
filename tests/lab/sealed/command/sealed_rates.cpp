// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// sealed_rates: diagnoses the frozen list of sealed sets of chains, holes and belts, one line for
/// each set, and prints the table of rates; or compares two versions of the diagnosis on the same
/// sets. fixtures/sealed/outcomes.txt contains the frozen outcomes (docs/diagnosis_rates.md).
///
///   sealed_rates now.txt --shard 3/16                      # of an hour and a half, resumable
///   sealed_rates all.txt --join now1.txt --join now2.txt --most 0
///   sealed_rates now.txt --against fixtures/sealed/outcomes.txt
#include <set>

#include "sealed/command/campaign.hpp"

int main(int argc, char** argv) {
  using namespace chaintrue::sealed;
  Campaign campaign("The rates of the diagnosis on the frozen list of sealed sets", argc, argv);
  // The whole list, or what of it is in the frozen outcomes.
  const auto list = [&] {
    std::set<std::pair<std::string, std::uint64_t>> frozen;
    for (const Outcome& outcome : campaign.before) frozen.emplace(outcome.kind, outcome.seed);
    std::vector<PlannedSet> all = plan();
    std::erase_if(all, [&](const PlannedSet& set) {
      return (!frozen.empty() && !frozen.contains({set.kind, set.seed})) ||
             !campaign.is_asked(set.kind);
    });
    return all;
  };
  return campaign.run(
      list, [](const PlannedSet& set) { return std::vector{run_set(set)}; }, rate_rows());
}
