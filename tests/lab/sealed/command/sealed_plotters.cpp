// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// sealed_plotters: hides a cause in many test drawings of V-plotters, diagnoses each, and prints how
/// often the cause was named, alone or in a set of at most three. Not part of the test run; its table
/// is in docs/diagnosis_rates.md.
///
///   sealed_plotters --sets 40 --sound 100
#include <map>

#include "sealed/command/sets.hpp"
#include "sealed/judge/plotter_sets.hpp"

namespace {

using chaintrue::sealed::HiddenCause;
using chaintrue::sealed::PlotterKind;
using chaintrue::sealed::PlotterOutcome;

struct Arguments {
  int sets = 40;
  int sound = 100;
  double least = 8.0;
  double most = 16.0;
  std::string kind;  ///< alone; empty: all
};

void print_row(PlotterKind kind, const HiddenCause& cause, int sets, const Arguments& arguments) {
  std::map<PlotterOutcome, int> count;
  for (int seed = 1; seed <= sets; ++seed) {
    const auto set = chaintrue::sealed::plotter_set(
        kind, cause, arguments.least, arguments.most, static_cast<std::uint64_t>(seed));
    ++count[chaintrue::sealed::outcome_of(set)];
  }
  fmt::print("| {} | {} {} | {} | {} | {} | {} | {} | {} |\n",
             chaintrue::sealed::name(kind),
             cause.effect.empty() ? "nothing" : cause.effect,
             cause.side,
             sets,
             count[PlotterOutcome::named],
             count[PlotterOutcome::in_set],
             count[PlotterOutcome::wrong],
             count[PlotterOutcome::nothing],
             count[PlotterOutcome::refused]);
  std::fflush(stdout);
}

void run(const Arguments& arguments) {
  fmt::print("| plotter | hidden | sets | alone | in a set | wrong | no name | refused |\n"
             "|---|---|---|---|---|---|---|---|\n");
  for (const PlotterKind kind : chaintrue::sealed::kPlotterKinds) {
    if (!arguments.kind.empty() && arguments.kind != chaintrue::sealed::name(kind)) continue;
    for (const HiddenCause& cause : chaintrue::sealed::causes_of(kind))
      print_row(kind, cause, arguments.sets, arguments);
    print_row(kind, {}, arguments.sound, arguments);
  }
}

}  // namespace

int main(int count, char** words) {
  Arguments arguments;
  CLI::App app{"Rates of the diagnosis of V-plotters on sealed drawings"};
  app.add_option("--sets", arguments.sets, "Of each cause of each kind");
  app.add_option("--sound", arguments.sound, "Of each kind, with nothing hidden");
  app.add_option("--least", arguments.least, "Strength");
  app.add_option("--most", arguments.most, "Strength");
  app.add_option("--kind", arguments.kind, "One kind alone, such as \"light pen\"");
  return chaintrue::sealed::run_command(app, count, words, [&] { run(arguments); });
}
