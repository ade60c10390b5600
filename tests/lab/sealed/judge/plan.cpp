// SPDX-License-Identifier: GPL-3.0-or-later
#include "sealed/judge/plan.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "grid/containers.hpp"
#include "sealed/judge/belts_trial.hpp"
#include "sealed/judge/holes_trial.hpp"

namespace chaintrue::sealed {
namespace {

using generator::Mix;
using generator::PatternGroup;

using Run = std::function<Outcome(const std::string& kind, std::uint64_t seed, bool more)>;

/// Three of four sets have 28 points, where causes are hardest to distinguish, and one has 60.
Run chains(Mix mix, PatternGroup patterns = PatternGroup::smooth) {
  return [=](const std::string& kind, std::uint64_t seed, bool more) {
    TrialOptions options{.more = more};
    options.recipe.kind = mix;
    options.recipe.patterns = patterns;
    options.recipe.points = seed % 4 == 3 ? 60 : 28;
    return run_trial(kind, options, seed);
  };
}

Run holes(bool long_chain) {
  return [=](const std::string& kind, std::uint64_t seed, bool) {
    return run_holes_trial(kind, long_chain, seed);
  };
}

Run belts(double least_strength, double most_strength, int bad_readings = 0) {
  return [=](const std::string& kind, std::uint64_t seed, bool more) {
    return run_belts_trial(
        kind, {"", most_strength == 0.0, least_strength, most_strength, bad_readings}, seed, more);
  };
}

struct Kind {
  const char* name;
  std::uint64_t first_seed;
  int sets;
  Run run;
};

/// Seeds that are not used for any table of docs/ or any test. The number of sets of a kind follows
/// from one point of its rate: of 600 sets, one point is six.
const std::vector<Kind>& all_kinds() {
  static const std::vector<Kind> list = {
      {"single", 1'000'000, 900, chains(Mix::single)},
      {"two", 1'010'000, 500, chains(Mix::two)},
      {"three", 1'020'000, 400, chains(Mix::three)},
      {"beside", 1'030'000, 600, chains(Mix::alongside)},
      {"beside_other", 1'040'000, 400, chains(Mix::alongside, PatternGroup::other)},
      {"pattern", 1'050'000, 400, chains(Mix::pattern)},
      {"near", 1'060'000, 400, chains(Mix::near)},
      {"unlisted", 1'070'000, 400, chains(Mix::unlisted)},
      {"bad_points", 1'080'000, 500, chains(Mix::bad_points)},
      {"bad_points_and_effect", 1'090'000, 500, chains(Mix::bad_points_and_effect)},
      {"nothing", 1'100'000, 600, chains(Mix::nothing)},
      {"heavy", 1'110'000, 500, chains(Mix::heavy)},
      {"wrong_noise", 1'120'000, 500, chains(Mix::wrong_noise)},
      {"holes", 1'130'000, 300, holes(true)},
      {"holes_nothing", 1'140'000, 300, holes(false)},
      {"belts_weak", 1'150'000, 500, belts(6.0, 8.0)},
      {"belts_middle", 1'160'000, 500, belts(8.0, 12.0)},
      {"belts_strong", 1'170'000, 500, belts(12.0, 60.0)},
      {"belts_nothing", 1'180'000, 400, belts(0.0, 0.0)},
      {"belts_bad", 1'190'000, 300, belts(0.0, 0.0, 3)},
      {"belts_bad_and_cause", 1'200'000, 300, belts(12.0, 60.0, 3)}};
  return list;
}

const Kind& kind_of(const std::string& name) {
  for (const Kind& kind : all_kinds()) {
    if (name == kind.name) return kind;
  }
  throw std::invalid_argument("no kind of sealed sets: \"" + name + "\"");
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
      placed.push_back(
          {(k + 0.5) / kind.sets, {kind.name, kind.first_seed + static_cast<std::uint64_t>(k)}});
    }
  }
  grid::stable_sort(placed, grid::ascending(&Placed::at));
  std::vector<PlannedSet> list;
  for (Placed& one : placed) list.push_back(std::move(one.set));
  return list;
}

std::vector<PlannedSet> shard_of(const std::vector<PlannedSet>& list, std::size_t shard,
                                 std::size_t shards) {
  if (shards == 0 || shard == 0 || shard > shards) {
    throw std::invalid_argument(fmt::format("no shard {} of {}", shard, shards));
  }
  const auto cut = [&](std::size_t part) {
    return list.begin() + static_cast<std::ptrdiff_t>(list.size() * part / shards);
  };
  return {cut(shard - 1), cut(shard)};
}

Outcome run_set(const PlannedSet& set, bool more) {
  const Kind& kind = kind_of(set.kind);
  return or_failed(set, [&] { return kind.run(set.kind, set.seed, more); });
}

Outcome or_failed(const PlannedSet& set, const std::function<Outcome()>& run) {
  try {
    return run();
  } catch (const std::exception& trouble) {
    fmt::print(stderr, "{} {}: {}\n", set.kind, set.seed, trouble.what());
    Outcome outcome{.kind = set.kind, .seed = set.seed};
    outcome.fail();
    return outcome;
  }
}

}  // namespace chaintrue::sealed
