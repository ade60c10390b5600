// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// sealed_belts: hides a cause, nothing, or bad readings in many sessions of four belts, has each
/// diagnosed, opens the answers and prints how often the diagnosis was right. Not part of the test
/// run; its table stands in docs/maslow4.md.
///
///   sealed_belts --sets 1000 --first-seed 1 --show
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "sealed/judge/belts_trial.hpp"

namespace {

using chaintrue::generator::BeltRecipe;
using chaintrue::sealed::BeltsTrial;

struct Arguments {
  int sets = 200;
  std::uint64_t first_seed = 1;
  std::string effect;
  bool show = false;
};

template <class Right>
void run(const char* what, const BeltRecipe& recipe, const Arguments& arguments, Right right) {
  int good = 0, held = 0, single = 0, right_belt = 0, separable = 0, good_separable = 0;
  for (int k = 0; k < arguments.sets; ++k) {
    const auto seed = arguments.first_seed + static_cast<std::uint64_t>(k);
    const BeltsTrial trial = chaintrue::sealed::run_belts_trial(recipe, seed);
    good += right(trial);
    held += trial.held;
    separable += trial.separable;
    good_separable += trial.separable && right(trial);
    const bool of_one = trial.secret.side.size() == 2;
    single += of_one && trial.named;
    right_belt += of_one && trial.named && trial.right_belt;
    if (arguments.show && !right(trial)) {
      fmt::print("  seed {}{}: {} {} {:.4g} from visit {} of strength {:.1f}: {}\n",
                 seed,
                 trial.separable ? " (separable)" : "",
                 trial.secret.effect,
                 trial.secret.side,
                 trial.secret.size,
                 trial.secret.first_visit,
                 trial.secret.strength,
                 trial.sentence);
    }
  }
  fmt::print("{:<44}{:>6} of {:>5}  {:6.1f} %   held in {:5.1f} %", what, good, arguments.sets,
             100.0 * good / arguments.sets, 100.0 * held / arguments.sets);
  if (separable > 0)
    fmt::print("   of separable {} of {}", good_separable, separable);
  if (single > 0) fmt::print("   right belt in {:5.1f} % of {}", 100.0 * right_belt / single, single);
  fmt::print("\n");
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("How often the diagnosis of four belts is right");
  app.add_option("--sets", arguments.sets, "Of each kind");
  app.add_option("--first-seed", arguments.first_seed, "Of the first set");
  app.add_option("--effect", arguments.effect, "Hide this one only");
  app.add_flag("--show", arguments.show, "Tell each set that was not right");
  CLI11_PARSE(app, argc, argv);
  const auto exact = [](const BeltsTrial& t) { return t.exact; };
  run("strength 6 to 8: named, alone", {arguments.effect, false, 6.0, 8.0, 0}, arguments, exact);
  run("8 to 12", {arguments.effect, false, 8.0, 12.0, 0}, arguments, exact);
  run("12 to 60", {arguments.effect, false, 12.0, 60.0, 0}, arguments, exact);
  if (!arguments.effect.empty()) return 0;
  run("nothing hidden: nothing named", {"", true, 6.0, 8.0, 0}, arguments, [](const BeltsTrial& t) {
    return !t.named;
  });
  run("three bad readings: found, and no others", {"", true, 6.0, 8.0, 3}, arguments,
      [](const BeltsTrial& t) { return t.bad_found; });
  run("the same beside a cause of 12 to 60", {"", false, 12.0, 60.0, 3}, arguments,
      [](const BeltsTrial& t) { return t.bad_found; });
}
