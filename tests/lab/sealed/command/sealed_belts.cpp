// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// sealed_belts: hides a cause, nothing, or bad readings in many sessions of four belts, diagnoses
/// each, compares with the truth and prints how often the diagnosis was right. Not part of the test
/// run; its table is in docs/maslow4_rates.md.
///
///   sealed_belts --sets 1000 --threads 2
#include <array>

#include "sealed/command/sets.hpp"
#include "sealed/judge/belts_trial.hpp"

namespace {

using chaintrue::generator::BeltRecipe;
using chaintrue::sealed::BeltsTrial;
using chaintrue::sealed::Sets;

int count(const std::vector<BeltsTrial>& trials, const auto& is_so) {
  return static_cast<int>(std::ranges::count_if(trials, is_so));
}

bool is_wrong(const BeltsTrial& t) { return t.named && t.verdict == "named" && !t.exact; }
bool is_set(const BeltsTrial& t) { return t.named && t.verdict != "named"; }

struct Kind {
  const char* name;
  const char* what;
  BeltRecipe recipe;
  bool (*right)(const BeltsTrial&);
};

const Kind kKinds[] = {
    {"weak", "strength 6 to 8: named, alone", {"", false, 6.0, 8.0, 0}, [](const BeltsTrial& t) { return t.exact; }},
    {"middle", "8 to 12", {"", false, 8.0, 12.0, 0}, [](const BeltsTrial& t) { return t.exact; }},
    {"strong", "12 to 60", {"", false, 12.0, 60.0, 0}, [](const BeltsTrial& t) { return t.exact; }},
    {"nothing", "nothing hidden: nothing named", {"", true, 6.0, 8.0, 0}, [](const BeltsTrial& t) { return !t.named; }},
    {"bad", "three bad readings: found, and no others", {"", true, 6.0, 8.0, 3}, [](const BeltsTrial& t) { return t.bad_found; }},
    {"bad_beside", "the same beside a cause of 12 to 60", {"", false, 12.0, 60.0, 3}, [](const BeltsTrial& t) { return t.bad_found; }}};

void run(const Kind& kind, const Sets& sets) {
  const auto trials = sets.each([&](std::uint64_t seed) { return chaintrue::sealed::run_belts_trial(kind.recipe, seed); });
  const auto of_one = [](const BeltsTrial& t) { return t.secret.side.size() == 2 && t.named; };
  fmt::print("{:<44}{:>6} of {:>5}, held in {}; of separable {} of {}; right belt in {} of {}\n"
             "  otherwise {} in a set that holds it, {} in one that does not, {} a pattern, {} silent, {} wrong\n",
             kind.what,
             count(trials, kind.right),
             sets.count,
             count(trials, [](const auto& t) { return t.held; }),
             count(trials, [&](const auto& t) { return t.separable && kind.right(t); }),
             count(trials, [](const auto& t) { return t.separable; }),
             count(trials, [&](const auto& t) { return of_one(t) && t.right_belt; }),
             count(trials, of_one),
             count(trials, [](const auto& t) { return is_set(t) && t.held; }),
             count(trials, [](const auto& t) { return is_set(t) && !t.held; }),
             count(trials, [](const auto& t) { return t.verdict == "unknown_pattern"; }),
             count(trials, [](const auto& t) { return !t.named && t.verdict != "unknown_pattern"; }),
             count(trials, is_wrong));
  std::fflush(stdout);
}

/// Stretch, yielding anchors and a belt's scale in turn: the same machine measured with one pull
/// and with two.
void run_two_pulls(const char* what, double least, double most, const Sets& sets) {
  constexpr std::array kEffects = {"belt_stretch", "anchor_flex", "belt_scale"};
  const auto with_pulls = [&](const std::vector<double>& pulls) {
    return sets.each([&](std::uint64_t seed) {
      BeltRecipe recipe{kEffects[(seed - sets.first_seed) % kEffects.size()], false, least, most, 0};
      recipe.pulls = pulls;
      return chaintrue::sealed::run_belts_trial(recipe, seed);
    });
  };
  const auto exact = [](const BeltsTrial& t) { return t.exact; };
  const auto one = with_pulls(BeltRecipe{}.pulls), two = with_pulls({1.0, 1.6});
  int parted = 0;
  for (std::size_t k = 0; k < one.size(); ++k) parted += is_set(one[k]) && two[k].exact ? 1 : 0;
  fmt::print("{:<20} one pull: named alone {} of {}, wrongly {}, a set {}\n"
             "{:<20} two pulls: named alone {}, held {}, wrongly {}; of those sets {}; of separable {} of {}\n",
             what,
             count(one, exact),
             sets.count,
             count(one, is_wrong),
             count(one, is_set),
             "",
             count(two, exact),
             count(two, [](const auto& t) { return t.held; }),
             count(two, is_wrong),
             parted,
             count(two, [](const auto& t) { return t.separable && t.exact; }),
             count(two, [](const auto& t) { return t.separable; }));
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  Sets sets;
  std::string only;
  CLI::App app("How often the diagnosis of four belts is right");
  sets.offer(app);
  app.add_option("--only", only, "weak, middle, strong, nothing, bad, bad_beside or two_pulls");
  return chaintrue::sealed::run_command(app, argc, argv, [&] {
    if (only == "two_pulls") {
      run_two_pulls("strength 6 to 8", 6.0, 8.0, sets);
      run_two_pulls("8 to 12", 8.0, 12.0, sets);
      run_two_pulls("12 to 60", 12.0, 60.0, sets);
    }
    for (const Kind& kind : kKinds) {
      if (only.empty() || only == kind.name) run(kind, sets);
    }
  });
}
