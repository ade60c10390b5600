// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// sealed_draws: hides a cause in many sets of data, diagnoses each, compares with the truth and
/// prints how often the diagnosis was right. Not part of the test run; its tables are in
/// docs/diagnosis_rates.md. Same options, same table, for any --threads.
///
///   sealed_draws --sets 2000 --mix single --points mix --threads 2
#include <map>

#include "sealed/command/sets.hpp"
#include "sealed/judge/table.hpp"

namespace {

namespace generator = chaintrue::generator;
using chaintrue::sealed::Trial;
using chaintrue::sealed::TrialOptions;

int points_of(const std::string& points, std::uint64_t index) {
  constexpr int kMix[] = {28, 60, 117};
  return points == "mix" ? kMix[index % 3] : std::stoi(points);
}

const std::map<std::string, generator::Extent> kExtents = {
    {"whole", generator::Extent::whole},
    {"without_corners", generator::Extent::without_corners},
    {"left_side", generator::Extent::left_side}};
const std::map<std::string, generator::PatternGroup> kPatterns = {
    {"smooth", generator::PatternGroup::smooth},
    {"short_scale", generator::PatternGroup::short_scale},
    {"broad", generator::PatternGroup::broad},
    {"other", generator::PatternGroup::other}};

Trial run(TrialOptions options, std::uint64_t seed) {
  try {
    return chaintrue::sealed::run_trial(options, seed);
  } catch (const std::exception& trouble) {
    fmt::print(stderr, "seed {}: {}\n", seed, trouble.what());
    Trial trial;
    trial.seed = seed;
    trial.points = options.recipe.points;
    trial.failed = true;
    return trial;
  }
}

}  // namespace

int main(int argc, char** argv) {
  chaintrue::sealed::Sets sets;
  TrialOptions options;
  std::string mix = "single", points = "mix", cause;
  double delta = 0.0;
  CLI::App app("Hides a cause in many sets of data and counts how often it is found.");
  sets.offer(app);
  app.add_option("--mix", mix, "single, nothing, heavy, wrong_noise, uneven_noise, two, three, unlisted, bad_points, "
                               "bad_points_and_effect, no_order, rounded, beside, two_beside, pattern, near");
  app.add_option("--points", points, "28, 60, 117, 200, 465 or mix")
      ->check(CLI::IsMember({"28", "60", "117", "200", "465", "mix"}));
  app.add_option("--patterns", options.recipe.patterns, "smooth, short_scale, broad, other")
      ->transform(CLI::CheckedTransformer(kPatterns));
  app.add_option("--delta", delta, "One strength in place of 6 to 22");
  app.add_option("--cause", cause, "This effect in place of a draw");
  app.add_option("--extent", options.recipe.extent, "whole, without_corners, left_side")
      ->transform(CLI::CheckedTransformer(kExtents));
  app.add_flag("--gain", options.improvement, "Held-out errors, reported and true");
  app.add_flag("--follow-up", options.follow_up, "Measure on where a set is left");
  app.add_flag("--other-machines", options.recipe.other_machines, "Draw the machine as well");
  return chaintrue::sealed::run_command(app, argc, argv, [&] {
    const auto kind = generator::mix_of(mix);
    if (!kind) throw std::invalid_argument("no such mix: " + mix);
    options.recipe.kind = *kind;
    if (delta > 0.0) options.recipe.delta = delta;
    for (const auto& card : generator::cards()) {
      if (card.id == cause) options.recipe.cause = card.cause;
    }
    if (!cause.empty() && !options.recipe.cause) throw std::invalid_argument("no such effect: " + cause);
    const std::vector<Trial> trials = sets.each([&](std::uint64_t seed) {
      TrialOptions own = options;
      own.recipe.points = points_of(points, seed - sets.first_seed);
      return run(own, seed);
    });
    fmt::print("{}", chaintrue::sealed::markdown(options, trials));
  });
}
