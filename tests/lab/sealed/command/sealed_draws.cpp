// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// sealed_draws: hides a cause in many sets of data, diagnoses each, compares with the truth and
/// prints how often the diagnosis was right. Not part of the test run; its tables are in
/// docs/diagnosis_rates.md. Same options, same table, for any --threads.
///
///   sealed_draws --sets 2000 --mix single --points mix --threads 2
#include <fmt/format.h>

#include <map>

#include "sealed/command/campaign.hpp"
#include "sealed/judge/calibration.hpp"
#include "sealed/judge/trial.hpp"

namespace {

using namespace chaintrue;
using generator::Mix;
using generator::PatternGroup;
using sealed::Outcome;

const std::map<std::string, PatternGroup> kPatterns = {{"smooth", PatternGroup::smooth},
                                                       {"short_scale", PatternGroup::short_scale},
                                                       {"broad", PatternGroup::broad},
                                                       {"other", PatternGroup::other}};

int points_of(const std::string& points, std::uint64_t index) {
  constexpr int kMix[] = {28, 60, 117};
  return points == "mix" ? kMix[index % 3] : std::stoi(points);
}

/// By the row of the table of rates that counts them.
std::string rate_kind_of(const generator::Recipe& recipe) {
  if (recipe.kind == Mix::alongside || recipe.kind == Mix::two_alongside)
    return recipe.patterns == PatternGroup::other ? "beside_other" : "beside";
  return std::string(word(recipe.kind));
}

/// For every cause that is named, alone, among several or in a set; and how often those of 0.95 and more act.
void print_claims(const std::vector<Outcome>& outcomes) {
  sealed::Calibration calibration;
  int sure = 0, right = 0;
  for (const Outcome& outcome : outcomes) {
    for (const std::string& word : outcome.named) {
      const sealed::Claim claim = sealed::parse_claim(word);
      const bool acts =
          std::ranges::any_of(outcome.hidden, [&](const auto& id) { return claim.means(id); });
      calibration.add(claim.probability, acts);
      sure += claim.probability >= 0.95 ? 1 : 0;
      right += claim.probability >= 0.95 && acts ? 1 : 0;
    }
  }
  fmt::print("{} claims: calibration error {:.3f}; of those of 95 % or more {} of {} are right\n\n",
             calibration.claims(), calibration.error(), right, sure);
}

}  // namespace

int main(int argc, char** argv) {
  sealed::Campaign campaign("Hides a cause in many sets of data and counts how often it is found.",
                            argc, argv);
  sealed::TrialOptions options{.more = true};
  generator::Recipe& recipe = options.recipe;
  std::string mix = "single", points = "mix";
  std::vector<std::string> mixes;
  for (const auto& [kind, name] : generator::kMixes) mixes.emplace_back(name);
  CLI::App& app = campaign.app;
  app.add_option("--mix", mix, "What is hidden")->check(CLI::IsMember(mixes));
  app.add_option("--points", points, "28, 60, 117, 200, 465 or mix")
      ->check(CLI::IsMember({"28", "60", "117", "200", "465", "mix"}));
  app.add_option("--patterns", recipe.patterns, "smooth, short_scale, broad, other")
      ->transform(CLI::CheckedTransformer(kPatterns));
  app.add_option("--delta", recipe.delta, "One strength in place of 6 to 22");
  app.add_flag("--gain", options.improvement, "Held-out errors, reported and true");
  app.add_flag("--follow-up", options.follow_up, "Measure on where a set is left");
  std::vector<sealed::RateRow> rows = sealed::rate_rows();
  for (sealed::RateRow& row : sealed::rows_of("draws")) rows.push_back(std::move(row));
  const auto list = [&] {
    recipe.kind = *generator::mix_of(mix);
    return campaign.sets_of({rate_kind_of(recipe)});
  };
  campaign.finish = [](std::vector<Outcome>& outcomes) { print_claims(outcomes); };
  return campaign.run(
      list,
      [&](const sealed::PlannedSet& set) {
        sealed::TrialOptions own = options;
        own.recipe.points = points_of(points, set.seed - campaign.first_seed);
        return std::vector{or_failed(set, [&] { return run_trial(set.kind, own, set.seed); })};
      },
      rows);
}
