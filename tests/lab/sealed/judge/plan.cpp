// SPDX-License-Identifier: GPL-3.0-or-later
#include "sealed/judge/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <variant>

#include "sealed/judge/holes_trial.hpp"

namespace chaintrue::sealed {
namespace {

using generator::BeltRecipe;
using generator::Mix;
using generator::PatternGroup;

struct Chains {
  Mix mix = Mix::single;
  PatternGroup patterns = PatternGroup::smooth;
};
struct Holes {
  bool long_chain = false;
};
struct Kind {
  const char* name;
  std::uint64_t first_seed;
  int sets;
  std::variant<Chains, Holes, BeltRecipe> recipe;
};

/// Seeds that are not used for any table of docs/ or any test. The number of sets of a kind follows
/// from one point of its rate: of 600 sets, one point is six.
const std::vector<Kind>& all_kinds() {
  static const std::vector<Kind> list = {
      {"single", 1'000'000, 900, Chains{Mix::single}},
      {"two", 1'010'000, 500, Chains{Mix::two}},
      {"three", 1'020'000, 400, Chains{Mix::three}},
      {"beside", 1'030'000, 600, Chains{Mix::alongside}},
      {"beside_other", 1'040'000, 400, Chains{Mix::alongside, PatternGroup::other}},
      {"pattern", 1'050'000, 400, Chains{Mix::pattern}},
      {"near", 1'060'000, 400, Chains{Mix::near}},
      {"unlisted", 1'070'000, 400, Chains{Mix::unlisted}},
      {"bad_points", 1'080'000, 500, Chains{Mix::bad_points}},
      {"bad_points_and_effect", 1'090'000, 500, Chains{Mix::bad_points_and_effect}},
      {"nothing", 1'100'000, 600, Chains{Mix::nothing}},
      {"heavy", 1'110'000, 500, Chains{Mix::heavy}},
      {"wrong_noise", 1'120'000, 500, Chains{Mix::wrong_noise}},
      {"holes", 1'130'000, 300, Holes{true}},
      {"holes_nothing", 1'140'000, 300, Holes{false}},
      {"belts_weak", 1'150'000, 500, BeltRecipe{"", false, 6.0, 8.0, 0}},
      {"belts_middle", 1'160'000, 500, BeltRecipe{"", false, 8.0, 12.0, 0}},
      {"belts_strong", 1'170'000, 500, BeltRecipe{"", false, 12.0, 60.0, 0}},
      {"belts_nothing", 1'180'000, 400, BeltRecipe{"", true, 6.0, 8.0, 0}},
      {"belts_bad", 1'190'000, 300, BeltRecipe{"", true, 6.0, 8.0, 3}},
      {"belts_bad_and_cause", 1'200'000, 300, BeltRecipe{"", false, 12.0, 60.0, 3}}};
  return list;
}

const Kind& kind_of(const std::string& name) {
  for (const Kind& kind : all_kinds()) {
    if (name == kind.name) return kind;
  }
  throw std::invalid_argument("no kind of sealed sets: \"" + name + "\"");
}

/// Three of four sets have 28 points, where causes are hardest to distinguish, and one has 60.
int points_of(std::uint64_t seed) { return seed % 4 == 3 ? 60 : 28; }

generator::Recipe recipe_of(const Chains& chains, std::uint64_t seed) {
  generator::Recipe recipe;
  recipe.kind = chains.mix;
  recipe.patterns = chains.patterns;
  recipe.points = points_of(seed);
  return recipe;
}

Outcome run(const Kind& kind, const Chains& chains, std::uint64_t seed) {
  TrialOptions options;
  options.recipe = recipe_of(chains, seed);
  return outcome_of(kind.name, run_trial(options, seed));
}

Outcome run(const Kind& kind, const Holes& holes, std::uint64_t seed) {
  return outcome_of(kind.name, run_holes_trial(holes.long_chain, seed));
}

Outcome run(const Kind& kind, const BeltRecipe& recipe, std::uint64_t seed) {
  return outcome_of(kind.name, run_belts_trial(recipe, seed));
}

}  // namespace

std::vector<std::string> kinds() {
  std::vector<std::string> names;
  for (const Kind& kind : all_kinds()) names.emplace_back(kind.name);
  return names;
}

std::vector<PlannedSet> plan() {
  struct Placed {
    double at;  // share of its kind before it
    PlannedSet set;
  };
  std::vector<Placed> placed;
  for (const Kind& kind : all_kinds()) {
    for (int k = 0; k < kind.sets; ++k) {
      placed.push_back({(k + 0.5) / kind.sets,
                        {kind.name, kind.first_seed + static_cast<std::uint64_t>(k)}});
    }
  }
  std::stable_sort(
      placed.begin(), placed.end(), [](const auto& a, const auto& b) { return a.at < b.at; });
  std::vector<PlannedSet> list;
  for (Placed& one : placed) list.push_back(std::move(one.set));
  return list;
}

std::vector<PlannedSet> shard_of(const std::vector<PlannedSet>& list,
                                 std::size_t shard,
                                 std::size_t shards) {
  if (shards == 0 || shard == 0 || shard > shards) {
    throw std::invalid_argument(fmt::format("no shard {} of {}", shard, shards));
  }
  const auto cut = [&](std::size_t part) {
    return list.begin() + static_cast<std::ptrdiff_t>(list.size() * part / shards);
  };
  return {cut(shard - 1), cut(shard)};
}

Outcome run_set(const PlannedSet& set) {
  const Kind& kind = kind_of(set.kind);
  try {
    return std::visit([&](const auto& recipe) { return run(kind, recipe, set.seed); }, kind.recipe);
  } catch (const std::exception& trouble) {
    fmt::print(stderr, "{} {}: {}\n", set.kind, set.seed, trouble.what());
    Outcome failed;
    failed.kind = set.kind;
    failed.seed = set.seed;
    failed.verdict = "failed";
    return failed;
  }
}

}  // namespace chaintrue::sealed
