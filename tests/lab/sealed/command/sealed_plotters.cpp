// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// sealed_plotters: hides a cause in many test drawings of V-plotters, diagnoses each, and prints how
/// often the cause was named, alone or in a set of at most three. Not part of the test run; its table
/// is in docs/diagnosis_rates.md.
///
///   sealed_plotters --sets 40 --sound 100
#include <fmt/format.h>

#include "sealed/command/campaign.hpp"
#include "sealed/judge/plotter_sets.hpp"

namespace {

using namespace chaintrue::sealed;

struct Kind {
  std::string word;
  PlotterKind plotter;
  HiddenCause cause;
};

std::vector<Kind> all_kinds() {
  std::vector<Kind> kinds;
  for (const PlotterKind plotter : kPlotterKinds) {
    for (const HiddenCause& cause : causes_of(plotter))
      kinds.push_back({fmt::format("{}/{}_{}:hidden", name(plotter), cause.effect, cause.side),
                       plotter, cause});
    kinds.push_back({fmt::format("{}:sound", name(plotter)), plotter, {}});
  }
  return kinds;
}

Outcome run_drawing(const Kind& kind, std::uint64_t seed) {
  constexpr const char* kVerdicts[] = {"named", "in_set", "wrong", "nothing", "refused"};
  const PlotterSet set = plotter_set(kind.plotter, kind.cause, 8.0, 16.0, seed);
  const PlotterOutcome found = outcome_of(set);
  Outcome outcome{.kind = kind.word, .seed = seed, .strength = set.strength};
  outcome.verdict = kVerdicts[static_cast<std::size_t>(found)];
  outcome.add("right", found == PlotterOutcome::named || found == PlotterOutcome::in_set);
  return outcome;
}

}  // namespace

int main(int argc, char** argv) {
  Campaign campaign("Rates of the diagnosis of V-plotters on sealed drawings", argc, argv);
  campaign.sets = 40;
  int sound = 100;
  campaign.app.add_option("--sound", sound, "Sets of each plotter with nothing hidden");
  const std::vector<Kind> kinds = all_kinds();
  const auto list = [&] {
    std::vector<PlannedSet> sets;
    for (const Kind& kind : kinds) {
      const std::vector<PlannedSet> own =
          campaign.sets_of({kind.word}, kind.cause.effect.empty() ? sound : campaign.sets);
      sets.insert(sets.end(), own.begin(), own.end());
    }
    return sets;
  };
  return campaign.run(
      list,
      [&](const PlannedSet& set) {
        const Kind& kind = *std::ranges::find(kinds, set.kind, &Kind::word);
        return std::vector{run_drawing(kind, set.seed)};
      },
      rows_of("plotters"));
}
