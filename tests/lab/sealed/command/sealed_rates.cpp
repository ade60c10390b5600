// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// sealed_rates: diagnoses the frozen list of sealed sets of chains, holes and belts, one line for
/// each set, and prints the table of rates; or compares two versions of the diagnosis on the same
/// sets. fixtures/sealed/outcomes.txt contains the frozen outcomes (docs/diagnosis_rates.md).
///
///   sealed_rates now.txt --shard 3/16                      # of an hour and a half, resumable
///   sealed_rates all.txt --join now1.txt --join now2.txt --most 0
///   sealed_rates now.txt --against fixtures/sealed/outcomes.txt
///
/// Exit code 1: a row is worse; 3: a file cannot be read, or has other sets.
#include "sealed/command/sets.hpp"

namespace {

using namespace chaintrue::sealed;

/// The whole list, or what of it is in the frozen outcomes; of some kinds alone where there are any.
std::vector<PlannedSet> asked(const std::vector<Outcome>& frozen, const std::vector<std::string>& kinds) {
  std::set<std::pair<std::string, std::uint64_t>> wanted;
  for (const Outcome& outcome : frozen) wanted.emplace(outcome.kind, outcome.seed);
  std::vector<PlannedSet> list = plan();
  std::erase_if(list, [&](const PlannedSet& set) {
    return (!wanted.empty() && !wanted.contains({set.kind, set.seed})) ||
           (!kinds.empty() && std::ranges::find(kinds, set.kind) == kinds.end());
  });
  return list;
}

}  // namespace

int main(int argc, char** argv) {
  OutcomeFile file;
  std::vector<std::string> only;
  CLI::App app("The rates of the diagnosis on the frozen list of sealed sets");
  file.offer(app);
  app.add_option("--kind", only, "Sets of this kind only")->check(CLI::IsMember(kinds()));
  return run_command(app, argc, argv, [&] {
    std::vector<Outcome> frozen;
    if (!file.against.empty()) frozen = sorted(read_outcomes(file.against));
    std::vector<Outcome> outcomes = file.known();
    file.run(asked(frozen, only), "", [](const PlannedSet& set) { return std::vector{run_set(set)}; }, outcomes);
    if (!file.against.empty()) return file.print_comparison(frozen, outcomes);
    fmt::print("{}", rates_table(outcomes));
    return 0;
  });
}
