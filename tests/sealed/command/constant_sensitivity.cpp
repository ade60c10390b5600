// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// constant_sensitivity: what halving and doubling each constant of the diagnosis does to the sealed
/// rates. Prints a table in Markdown, a line a constant; the same sets for every line. A chance or
/// share of a half and more is varied by its complement.
///
///   constant_sensitivity --sets 120 --jobs 2
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <atomic>
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

struct Constant {
  const char* name;
  double* value;
};

const std::vector<Constant>& constants() {
#define CHAINTRUE_CONSTANT(name, value, meaning, source) {#name, &diagnosis::name},
  static const std::vector<Constant> kConstants = {
#include "grid/diagnosis/constants.def"
  };
#undef CHAINTRUE_CONSTANT
  return kConstants;
}

double varied(double value, double factor) {
  return value >= 0.5 && value < 1.0 ? 1.0 - (1.0 - value) / factor : factor * value;
}

struct Rates {
  double exact = 0.0;       ///< of single causes: named as it is
  double in_set = 0.0;      ///< or in the set
  double both = 0.0;        ///< of two causes: both named
  double false_name = 0.0;  ///< of empty sets
  double misnamed = 0.0;    ///< of unlisted patterns: a name with 95 % or more
};

double share(const std::string& mix, int sets, int jobs, bool (*counts)(const Trial&)) {
  std::atomic<int> next{0};
  std::atomic<int> counted{0};
  const auto work = [&] {
    for (int i = next++; i < sets; i = next++) {
      chaintrue::sealed::TrialOptions options;
      options.recipe.kind = *generator::mix_of(mix);
      options.recipe.points = i % 2 == 0 ? 28 : 60;
      const Trial trial = run_trial(options, 90000 + static_cast<std::uint64_t>(i));
      counted += !trial.failed && counts(trial) ? 1 : 0;
    }
  };
  std::vector<std::thread> workers;
  for (int k = 0; k < jobs; ++k) workers.emplace_back(work);
  for (std::thread& worker : workers) worker.join();
  return static_cast<double>(counted) / sets;
}

Rates rates_of(int sets, int jobs) {
  const auto exact = [](const Trial& t) {
    return t.verdict == diagnosis::Verdict::named && leads_right(t);
  };
  const auto sure = [](const Trial& t) {
    return t.verdict == diagnosis::Verdict::named && t.causes.front().probability >= 0.95;
  };
  return {share("single", sets, jobs, exact),
          share("single", sets, jobs, [](const Trial& t) { return in_set(t); }),
          share("two", sets / 2, jobs, [](const Trial& t) { return all_named(t); }),
          share("nothing", sets, jobs, [](const Trial& t) { return names_something(t); }),
          share("unlisted", sets / 2, jobs, sure)};
}

void print(const std::string& what, const Rates& r) {
  fmt::print("| {} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.1f} |\n",
             what,
             100.0 * r.exact,
             100.0 * r.in_set,
             100.0 * r.both,
             100.0 * r.false_name,
             100.0 * r.misnamed);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  int sets = 120;
  int jobs = 1;
  std::string only;
  CLI::App app("What halving and doubling each constant does to the sealed rates.");
  app.add_option("--sets", sets, "of each mix; half as many of two causes and of patterns")
      ->check(CLI::Range(2, 100000));
  app.add_option("--jobs", jobs, "threads")->check(CLI::Range(1, 64));
  app.add_option("--only", only, "this constant");
  CLI11_PARSE(app, argc, argv);
  fmt::print("{} sets of each mix at 28 and 60 points, seeds from 90000 on; per cent.\n\n", sets);
  fmt::print("| | exact | in the set | both of two | false name | pattern misnamed |\n");
  fmt::print("|---|---|---|---|---|---|\n");
  print("as it is", rates_of(sets, jobs));
  for (const Constant& constant : constants()) {
    if (!only.empty() && only != constant.name) continue;
    const double usual = *constant.value;
    for (const double factor : {0.5, 2.0}) {
      *constant.value = varied(usual, factor);
      print(fmt::format("{} = {:.4g}", constant.name, *constant.value), rates_of(sets, jobs));
    }
    *constant.value = usual;
  }
  return 0;
}
