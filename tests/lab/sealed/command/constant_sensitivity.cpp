// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// constant_sensitivity: the change of the sealed rates by halving and doubling each constant of the
/// diagnosis. Prints a table in Markdown, two lines for each constant; every line uses the same
/// sets, so that differences from the first line are caused by the constant. A probability or a
/// share is varied by its odds, a factor on the noise by its excess over one.
///
///   constant_sensitivity --sets 40 --jobs 2
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "grid/diagnosis/constants.hpp"
#include "sealed/judge/trial.hpp"

#ifndef CHAINTRUE_VARY_CONSTANTS
#error "constants do not vary here"
#endif

namespace {

namespace diagnosis = chaintrue::grid::diagnosis;
namespace generator = chaintrue::generator;
using chaintrue::sealed::Trial;

/// An adjustable constant: its usual values, their change by a factor, and how they are set.
struct Constant {
  std::string name;
  std::vector<double> usual;
  double (*varied)(double usual, double factor);
  std::function<void(const std::vector<double>&)> set;
};

double by_odds(double probability, double factor) {
  const double odds = factor * probability / (1.0 - probability);
  return odds / (1.0 + odds);
}

double scaled(double value, double factor) { return factor * value; }

double beyond_one(double value, double factor) { return 1.0 + factor * (value - 1.0); }

template <class Values>
void set_all(Values& values, const std::vector<double>& to) {
  std::copy(to.begin(), to.end(), values.begin());
}

std::vector<Constant> constants() {
  std::vector<Constant> result;
  const auto add = [&](const char* name, double& value) {
    result.push_back(
        {name, {value}, value > 0.0 && value < 1.0 ? by_odds : scaled, [&value](const auto& to) {
           value = to.front();
         }});
  };
  const auto add_count = [&](const char* name, std::size_t& value) {
    result.push_back({name, {static_cast<double>(value)}, scaled, [&value](const auto& to) {
                        value = static_cast<std::size_t>(std::lround(to.front()));
                      }});
  };
  const auto add_all = [&](const char* name, auto& values, double (*varied)(double, double)) {
    result.push_back({name, {values.begin(), values.end()}, varied, [&values](const auto& to) {
                        set_all(values, to);
                      }});
  };
#define CHAINTRUE_CONSTANT(name, value, meaning, source) add(#name, diagnosis::name);
#define CHAINTRUE_COUNT(name, value, meaning, source) add_count(#name, diagnosis::name);
#include "grid/diagnosis/constants.def"
#undef CHAINTRUE_CONSTANT
#undef CHAINTRUE_COUNT
  add_all("kLargerNoise", diagnosis::kLargerNoise, beyond_one);
  add_all("kDiscrepancyStrengths", diagnosis::kDiscrepancyStrengths, scaled);
  return result;
}

struct Mix {
  const char* name;
  const char* words;
  int share_of_sets;  ///< one in this number
  std::uint64_t first_seed;
};
constexpr Mix kMixes[] = {{"single", "one cause", 1, 90000},
                          {"two", "two causes", 2, 91000},
                          {"three", "three causes", 2, 96000},
                          {"bad_points_and_effect", "a cause and bad points", 2, 92000},
                          {"nothing", "nothing", 2, 93000},
                          {"wrong_noise", "noise stated wrongly", 2, 94000},
                          {"unlisted", "a pattern that is not listed", 2, 95000}};
/// Number of points at which a constant matters most; with more points causes are distinguished for
/// every value.
constexpr int kPoints = 28;
/// For one cause: strengths near the threshold of naming; the other mixes are as drawn.
constexpr double kStrengths[] = {5.0, 6.0, 7.0, 8.0};

/// The trials of every mix, in order.
struct Trials {
  std::vector<Trial> of_mix[std::size(kMixes)];
};

std::vector<Trial> run_mix(const Mix& mix, int sets, int jobs) {
  std::vector<Trial> trials(static_cast<std::size_t>(sets));
  std::atomic<int> next{0};
  const auto work = [&] {
    for (int i = next++; i < sets; i = next++) {
      chaintrue::sealed::TrialOptions options;
      options.recipe.kind = *generator::mix_of(mix.name);
      options.recipe.points = kPoints;
      if (mix.first_seed == kMixes[0].first_seed) {
        options.recipe.delta = kStrengths[static_cast<std::size_t>(i) % std::size(kStrengths)];
      }
      options.stability = false;  // a quarter of the time, and independent of the constants
      trials[static_cast<std::size_t>(i)] =
          run_trial(options, mix.first_seed + static_cast<std::uint64_t>(i));
    }
  };
  std::vector<std::thread> workers;
  for (int k = 0; k < jobs; ++k) workers.emplace_back(work);
  for (std::thread& worker : workers) worker.join();
  return trials;
}

Trials run_all(int sets, int jobs) {
  Trials trials;
  for (std::size_t m = 0; m < std::size(kMixes); ++m) {
    trials.of_mix[m] = run_mix(kMixes[m], sets / kMixes[m].share_of_sets, jobs);
  }
  return trials;
}

double percent(const std::vector<Trial>& trials, const std::function<bool(const Trial&)>& counts) {
  const auto counted = std::count_if(
      trials.begin(), trials.end(), [&](const Trial& t) { return !t.failed && counts(t); });
  return 100.0 * static_cast<double>(counted) / static_cast<double>(trials.size());
}

bool same_answer(const Trial& a, const Trial& b) {
  return a.failed == b.failed && a.verdict == b.verdict &&
         std::equal(a.causes.begin(),
                    a.causes.end(),
                    b.causes.begin(),
                    b.causes.end(),
                    [](const auto& x, const auto& y) { return x.id == y.id; });
}

/// Trials whose verdict or causes differ from those of `usual`.
int changed(const Trials& usual, const Trials& now) {
  int count = 0;
  for (std::size_t m = 0; m < std::size(kMixes); ++m) {
    for (std::size_t i = 0; i < now.of_mix[m].size(); ++i) {
      count += same_answer(usual.of_mix[m][i], now.of_mix[m][i]) ? 0 : 1;
    }
  }
  return count;
}

/// Processor time, averaged over all trials.
double mean_seconds(const Trials& trials) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const std::vector<Trial>& mix : trials.of_mix) {
    for (const Trial& trial : mix) sum += trial.seconds;
    count += mix.size();
  }
  return sum / static_cast<double>(count);
}

void print(const std::string& what, const Trials& usual, const Trials& now) {
  const auto exact = [](const Trial& t) {
    return t.verdict == diagnosis::Verdict::named && leads_right(t);
  };
  const auto sure = [](const Trial& t) {
    return t.verdict == diagnosis::Verdict::named && t.causes.front().probability >= 0.95;
  };
  const auto named = [](const Trial& t) { return names_something(t); };
  const auto all = [](const Trial& t) { return all_named(t); };
  const auto& [single, two, three, bad, nothing, wrong_noise, unlisted] = now.of_mix;
  std::string line = "| " + what;
  for (const double rate : {percent(single, exact),
                            percent(single, [](const Trial& t) { return in_set(t); }),
                            percent(two, all),
                            percent(three, all),
                            percent(bad, exact),
                            percent(nothing, named),
                            percent(wrong_noise, named),
                            percent(unlisted, sure)}) {
    line += fmt::format(" | {:.1f}", rate);
  }
  fmt::print("{} | {} | {:.2f} |\n", line, changed(usual, now), mean_seconds(now));
  std::fflush(stdout);
}

std::string in_words(const std::string& name, const std::vector<double>& values) {
  std::vector<std::string> texts;
  for (const double value : values) texts.push_back(fmt::format("{:.4g}", value));
  return fmt::format("{} = {}", name, fmt::join(texts, ", "));
}

void print_head(int sets) {
  int all = 0;
  std::string mixes;
  for (const Mix& mix : kMixes) {
    const int own = sets / mix.share_of_sets;
    all += own;
    mixes += fmt::format("{} with {} (seeds from {}), ", own, mix.words, mix.first_seed);
  }
  const auto error = [](int of) { return 100.0 * std::sqrt(0.97 * 0.03 / of); };
  fmt::print("{}{} points each, one cause of strength 5 to 8; rates in per cent. ", mixes, kPoints);
  fmt::print("One sigma of a rate of 97 % is {:.1f}, of half as many sets {:.1f}. ",
             error(sets),
             error(sets / 2));
  fmt::print("Changed: answers (verdict and names) other than those of the first line, of {}.\n\n",
             all);
  fmt::print("| | exact | in the set | both of two | all of three | exact beside bad points ");
  fmt::print("| false name | the same, noise stated wrongly | pattern misnamed | changed ");
  fmt::print("| seconds a set |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
}

}  // namespace

int main(int argc, char** argv) {
  int sets = 40;
  int jobs = 1;
  std::vector<std::string> only;
  CLI::App app("What halving and doubling each constant does to the sealed rates.");
  app.add_option("--sets", sets, "with one cause; half as many of each other mix")
      ->check(CLI::Range(2, 100000));
  app.add_option("--jobs", jobs, "threads")->check(CLI::Range(1, 64));
  app.add_option("--only", only, "these constants");
  CLI11_PARSE(app, argc, argv);
  print_head(sets);
  const Trials usual = run_all(sets, jobs);
  print("as it is", usual, usual);
  for (const Constant& constant : constants()) {
    if (!only.empty() && std::find(only.begin(), only.end(), constant.name) == only.end()) continue;
    for (const double factor : {0.5, 2.0}) {
      std::vector<double> now;
      for (const double value : constant.usual) now.push_back(constant.varied(value, factor));
      constant.set(now);
      print(in_words(constant.name, now), usual, run_all(sets, jobs));
    }
    constant.set(constant.usual);
  }
  return 0;
}
