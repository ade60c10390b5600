// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// sealed_draws: hides a cause in many sets of data, diagnoses each, compares with the truth and
/// prints how often the diagnosis was right. Not part of the test run; its tables are in
/// docs/diagnosis_rates.md. Same options, same table, for any --jobs.
///
///   sealed_draws --sets 2000 --mix single --points mix --jobs 2 --csv single.csv
///   sealed_draws --sets 500 --mix single --delta 6 --points 60 --ablation projection
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <cstdio>
#include <exception>
#include <fstream>
#include <map>
#include <thread>

#include "sealed/judge/table.hpp"

namespace {

using chaintrue::sealed::Trial;
using chaintrue::sealed::TrialOptions;

struct Arguments {
  int sets = 200;
  std::string mix = "single";
  std::string points = "mix";
  std::uint64_t first_seed = 1;
  int jobs = 1;
  double delta = 0.0;
  std::string ablation;
  std::string cause;
  std::string csv;
  std::string extent = "whole";
  std::string patterns = "smooth";
  bool improvement = false;
  bool follow_up = false;
  bool other_machines = false;
  bool show = false;
};

int points_of(const Arguments& arguments, int index) {
  constexpr int kMix[] = {28, 60, 117};
  return arguments.points == "mix" ? kMix[index % 3] : std::stoi(arguments.points);
}

using chaintrue::grid::diagnosis::Steps;
const std::map<std::string, bool Steps::*> kSteps = {{"projection", &Steps::project_settings},
                                                     {"whitening", &Steps::whiten},
                                                     {"anchor", &Steps::anchor_noise},
                                                     {"location", &Steps::average_location},
                                                     {"robust", &Steps::robust}};
const std::map<std::string, chaintrue::generator::Extent> kExtents = {
    {"whole", chaintrue::generator::Extent::whole},
    {"without_corners", chaintrue::generator::Extent::without_corners},
    {"left_side", chaintrue::generator::Extent::left_side}};

const std::map<std::string, chaintrue::generator::PatternGroup> kPatterns = {
    {"smooth", chaintrue::generator::PatternGroup::smooth},
    {"short_scale", chaintrue::generator::PatternGroup::short_scale},
    {"broad", chaintrue::generator::PatternGroup::broad},
    {"other", chaintrue::generator::PatternGroup::other}};

std::string known_cause(const std::string& word) {
  for (const auto& card : chaintrue::generator::cards()) {
    if (card.id == word) return "";
  }
  return "no such effect: " + word;
}

TrialOptions options_of(const Arguments& arguments) {
  namespace generator = chaintrue::generator;
  TrialOptions options;
  options.recipe.kind = *generator::mix_of(arguments.mix);
  if (arguments.delta > 0.0) options.recipe.delta = arguments.delta;
  options.recipe.other_machines = arguments.other_machines;
  options.recipe.patterns = kPatterns.at(arguments.patterns);
  options.recipe.extent = kExtents.at(arguments.extent);
  for (const auto& card : generator::cards()) {
    if (card.id == arguments.cause) options.recipe.cause = card.cause;
  }
  if (!arguments.ablation.empty()) options.steps.*kSteps.at(arguments.ablation) = false;
  options.improvement = arguments.improvement;
  options.follow_up = arguments.follow_up;
  return options;
}

std::vector<Trial> run_all(const Arguments& arguments, const TrialOptions& options) {
  std::vector<Trial> trials(static_cast<std::size_t>(arguments.sets));
  std::atomic<int> next{0};
  const auto work = [&] {
    for (int i = next++; i < arguments.sets; i = next++) {
      TrialOptions own = options;
      own.recipe.points = points_of(arguments, i);
      const auto seed = arguments.first_seed + static_cast<std::uint64_t>(i);
      Trial& trial = trials[static_cast<std::size_t>(i)];
      try {
        trial = chaintrue::sealed::run_trial(own, seed);
      } catch (const std::exception& trouble) {
        trial.seed = seed;
        trial.points = own.recipe.points;
        trial.failed = true;
        trial.failure = trouble.what();
      }
      if (trial.failed) fmt::print(stderr, "\nseed {}: {}\n", seed, trial.failure);
      if (i % 50 == 49) fmt::print(stderr, "\r{} of {}", i + 1, arguments.sets);
    }
  };
  std::vector<std::thread> workers;
  for (int k = 0; k < arguments.jobs; ++k) workers.emplace_back(work);
  for (std::thread& worker : workers) worker.join();
  fmt::print(stderr, "\n");
  return trials;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("Hides a cause in many sets of data and counts how often it is found.");
  app.add_option("--sets", arguments.sets, "how many")->check(CLI::Range(1, 1000000));
  app.add_option("--mix",
                 arguments.mix,
                 "single, nothing, heavy, wrong_noise, uneven_noise, two, "
                 "three, unlisted, bad_points, bad_points_and_effect, no_order, rounded, "
                 "beside, two_beside, pattern, near")
      ->check([](const std::string& word) {
        return chaintrue::generator::mix_of(word) ? std::string() : "no such mix: " + word;
      });
  app.add_option("--points", arguments.points, "28, 60, 117, 200, 465 or mix")
      ->check(CLI::IsMember({"28", "60", "117", "200", "465", "mix"}));
  app.add_option("--patterns", arguments.patterns, "smooth, short_scale, broad, other")
      ->check(CLI::IsMember(kPatterns));
  app.add_option("--first-seed", arguments.first_seed, "of a run of seeds");
  app.add_option("--jobs", arguments.jobs, "threads")->check(CLI::Range(1, 64));
  app.add_option("--delta", arguments.delta, "one strength in place of 6 to 22");
  app.add_option("--ablation", arguments.ablation, "a step to leave out")
      ->check(CLI::IsMember(kSteps));
  app.add_option("--cause", arguments.cause, "this effect in place of a draw")->check(known_cause);
  app.add_option("--extent", arguments.extent, "whole, without_corners, left_side")
      ->check(CLI::IsMember(kExtents));
  app.add_flag("--gain", arguments.improvement, "held-out errors, reported and true");
  app.add_flag("--follow-up", arguments.follow_up, "measure on where a set is left");
  app.add_flag("--other-machines", arguments.other_machines, "draw the machine as well");
  app.add_option("--csv", arguments.csv, "a line a set, to this file");
  app.add_flag("--show", arguments.show, "print the first set's grid and stop");
  CLI11_PARSE(app, argc, argv);

  TrialOptions options = options_of(arguments);
  if (arguments.show) {
    options.recipe.points = points_of(arguments, 0);
    const auto set = chaintrue::generator::draw_set(options.recipe, arguments.first_seed);
    fmt::print("{}", set.grid_text);
    for (std::size_t i = 0; i < set.answer.hidden.size(); ++i) {
      const auto& h = set.answer.hidden[i];
      fmt::print(stderr,
                 "{} size {:.6g} place {:.4g} delta {:.2f}\n",
                 chaintrue::sealed::id_of(h),
                 h.size,
                 h.place,
                 set.answer.delta[i]);
    }
    return 0;
  }
  const std::vector<Trial> trials = run_all(arguments, options);
  fmt::print("{}", chaintrue::sealed::markdown(options, trials));
  if (!arguments.csv.empty()) {
    std::ofstream(arguments.csv, std::ios::binary) << chaintrue::sealed::csv(trials);
  }
  return 0;
}
