// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// sealed_belts: hides a cause, nothing, or bad readings in many sessions of four belts, diagnoses
/// each, compares with the truth and prints how often the diagnosis was right. Not part of the test
/// run; its table is in docs/maslow4_rates.md.
///
///   sealed_belts --sets 1000 --threads 2
///   sealed_belts --only two_pulls          // the same machines measured with one pull and with two
#include <array>

#include "sealed/command/campaign.hpp"
#include "sealed/judge/belts_trial.hpp"

namespace {

using namespace chaintrue::sealed;

const std::string kTwoPulls = "two_pulls/";

struct Strengths {
  const char* name;
  double least, most;
};
constexpr Strengths kStrengths[] = {
    {"weak", 6.0, 8.0}, {"middle", 8.0, 12.0}, {"strong", 12.0, 60.0}};

/// Stretch, yielding anchors and a belt's scale in turn.
std::vector<Outcome> run_two_pulls(const PlannedSet& set, std::uint64_t index) {
  constexpr std::array kEffects = {"belt_stretch", "anchor_flex", "belt_scale"};
  const auto strength =
      std::ranges::find(kStrengths, set.kind.substr(kTwoPulls.size()), &Strengths::name);
  chaintrue::generator::BeltRecipe recipe{kEffects[index % kEffects.size()], false, strength->least,
                                          strength->most, 0};
  const Outcome one = run_belts_trial(set.kind + ":one_pull", recipe, set.seed, true);
  recipe.pulls = {1.0, 1.6};
  Outcome two = run_belts_trial(set.kind + ":two_pulls", recipe, set.seed, true);
  two.add("was_set", one.has("set"));
  return {one, two};
}

}  // namespace

int main(int argc, char** argv) {
  Campaign campaign("How often the diagnosis of four belts is right", argc, argv);
  const auto list = [&] {
    std::vector<std::string> all;
    for (const std::string& kind : kinds()) {
      if (kind.starts_with("belts_")) all.push_back(kind);
    }
    for (const Strengths& strength : kStrengths) {
      if (!campaign.only.empty()) all.push_back(kTwoPulls + strength.name);
    }
    return campaign.sets_of(all);
  };
  const auto run = [&](const PlannedSet& set) {
    return set.kind.starts_with(kTwoPulls) ? run_two_pulls(set, set.seed - campaign.first_seed)
                                           : std::vector{run_set(set, true)};
  };
  std::vector<RateRow> rows = rate_rows();
  for (RateRow& row : rows_of("belts")) rows.push_back(std::move(row));
  return campaign.run(list, run, rows);
}
