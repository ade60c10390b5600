// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// sealed_belts: hides a cause, nothing, or bad readings in many sessions of four belts, diagnoses
/// each, compares with the truth and prints how often the diagnosis was right. Not part of the test
/// run; its table is in docs/maslow4_rates.md.
///
///   sealed_belts --sets 1000 --first-seed 1 --show
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>

#include "sealed/judge/belts_trial.hpp"

namespace {

using chaintrue::generator::BeltRecipe;
using chaintrue::sealed::BeltsTrial;

struct Arguments {
  int sets = 200;
  std::uint64_t first_seed = 1;
  std::string effect;
  std::string only;
  bool show = false;
  bool go_on = false;
};

/// P-values of noise whose frequencies are counted.
constexpr std::array kChances = {0.1, 0.01, 0.001};

/// The sessions that were not right.
struct Missed {
  int set_with = 0, set_without = 0, pattern = 0, silent = 0, wrong = 0;
  void count(const BeltsTrial& t) {
    if (t.verdict == "unknown_pattern") {
      ++pattern;
    } else if (!t.named) {
      ++silent;
    } else if (t.verdict == "named") {
      ++wrong;
    } else {
      ++(t.held ? set_with : set_without);
    }
  }
};

void show(const BeltsTrial& trial) {
  fmt::print("  seed {}{}: {} {} {:.4g} from visit {} of strength {:.1f}, p {:.4f}: {}\n",
             trial.seed,
             trial.separable ? " (separable)" : "",
             trial.secret.effect,
             trial.secret.side,
             trial.secret.size,
             trial.secret.first_visit,
             trial.secret.strength,
             trial.family_wise_p,
             trial.sentence);
  for (const auto& [point, belt] : trial.secret.bad)
    fmt::print("    bad: point {}, belt {} of tl tr bl br\n", point, belt);
  std::fflush(stdout);
}

template <class Right>
void run(const char* kind,
         const char* what,
         const BeltRecipe& recipe,
         const Arguments& arguments,
         Right right) {
  if (!arguments.only.empty() && arguments.only != kind) return;
  int good = 0, held = 0, single = 0, right_belt = 0, separable = 0, good_separable = 0;
  int proposed = 0, parted = 0;
  std::array<int, 3> below{};
  Missed missed;
  for (int k = 0; k < arguments.sets; ++k) {
    const auto seed = arguments.first_seed + static_cast<std::uint64_t>(k);
    const BeltsTrial trial = chaintrue::sealed::run_belts_trial(recipe, seed, arguments.go_on);
    good += right(trial);
    held += trial.held;
    separable += trial.separable;
    good_separable += trial.separable && right(trial);
    const bool of_one = trial.secret.side.size() == 2;
    single += of_one && trial.named;
    right_belt += of_one && trial.named && trial.right_belt;
    proposed += trial.proposed > 0;
    parted += trial.parted;
    for (std::size_t i = 0; i < below.size(); ++i) below[i] += trial.family_wise_p < kChances[i];
    if (right(trial)) continue;
    missed.count(trial);
    if (arguments.show) show(trial);
  }
  fmt::print("{:<44}{:>6} of {:>5}  {:6.1f} %   held in {:5.1f} %",
             what,
             good,
             arguments.sets,
             100.0 * good / arguments.sets,
             100.0 * held / arguments.sets);
  if (separable > 0) fmt::print("   of separable {} of {}", good_separable, separable);
  if (single > 0) fmt::print("   right belt in {:5.1f} % of {}", 100.0 * right_belt / single, single);
  if (proposed > 0) fmt::print("   once measured as proposed {} of {}", parted, proposed);
  fmt::print("\n  missed: {} in a set that holds it, {} in one that does not, {} a pattern, {} silent, {} wrong\n",
             missed.set_with,
             missed.set_without,
             missed.pattern,
             missed.silent,
             missed.wrong);
  fmt::print("  chance of noise told below {} / {} / {} in {} / {} / {}\n",
             kChances[0],
             kChances[1],
             kChances[2],
             below[0],
             below[1],
             below[2]);
  std::fflush(stdout);
}

/// Stretch, anchors that give and a belt's scale in turn: the same machine measured with one pull and
/// with two.
void run_two_pulls(const char* what, double least, double most, const Arguments& arguments) {
  constexpr std::array kEffects = {"belt_stretch", "anchor_flex", "belt_scale"};
  int right_by_one = 0, open = 0, parted = 0, right_by_two = 0, wrong_by_two = 0, wrong_by_one = 0;
  int separable = 0, good_separable = 0, held = 0;
  for (int k = 0; k < arguments.sets; ++k) {
    const auto seed = arguments.first_seed + static_cast<std::uint64_t>(k);
    BeltRecipe recipe{kEffects[static_cast<std::size_t>(k) % kEffects.size()], false, least, most, 0};
    const BeltsTrial one = chaintrue::sealed::run_belts_trial(recipe, seed);
    recipe.pulls = {1.0, 1.6};
    const BeltsTrial two = chaintrue::sealed::run_belts_trial(recipe, seed);
    right_by_one += one.exact;
    wrong_by_one += one.named && one.verdict == "named" && !one.exact;
    wrong_by_two += two.named && two.verdict == "named" && !two.exact;
    const bool left_open = one.named && one.verdict != "named";
    open += left_open;
    parted += left_open && two.exact;
    right_by_two += two.exact;
    held += two.held;
    separable += two.separable;
    good_separable += two.separable && two.exact;
    if (!two.exact && arguments.show) show(two);
  }
  fmt::print("{:<20} one pull: named alone {} of {}, wrongly {}, a set {}\n",
             what, right_by_one, arguments.sets, wrong_by_one, open);
  fmt::print("{:<20} two pulls: named alone {} of {}, held {}, wrongly {}; of those sets {} of {}; "
             "of separable {} of {}\n",
             "", right_by_two, arguments.sets, held, wrong_by_two, parted, open, good_separable, separable);
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
  app.add_option("--only", arguments.only, "weak, middle, strong, nothing, bad, bad_beside or two_pulls");
  app.add_flag("--follow", arguments.go_on, "Measure what is proposed where no single name is given");
  CLI11_PARSE(app, argc, argv);
  if (arguments.only == "two_pulls") {
    run_two_pulls("strength 6 to 8", 6.0, 8.0, arguments);
    run_two_pulls("8 to 12", 8.0, 12.0, arguments);
    run_two_pulls("12 to 60", 12.0, 60.0, arguments);
    return 0;
  }
  const auto exact = [](const BeltsTrial& t) { return t.exact; };
  run("weak", "strength 6 to 8: named, alone", {arguments.effect, false, 6.0, 8.0, 0}, arguments, exact);
  run("middle", "8 to 12", {arguments.effect, false, 8.0, 12.0, 0}, arguments, exact);
  run("strong", "12 to 60", {arguments.effect, false, 12.0, 60.0, 0}, arguments, exact);
  if (!arguments.effect.empty()) return 0;
  run("nothing", "nothing hidden: nothing named", {"", true, 6.0, 8.0, 0}, arguments, [](const BeltsTrial& t) {
    return !t.named;
  });
  run("bad", "three bad readings: found, and no others", {"", true, 6.0, 8.0, 3}, arguments,
      [](const BeltsTrial& t) { return t.bad_found; });
  run("bad_beside", "the same beside a cause of 12 to 60", {"", false, 12.0, 60.0, 3}, arguments,
      [](const BeltsTrial& t) { return t.bad_found; });
}
