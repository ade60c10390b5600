// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// sealed_rates: diagnoses the frozen list of sealed sets of chains, holes and belts, one line for
/// each set, and prints the table of rates; or compares two versions of the diagnosis on the same
/// sets. fixtures/sealed/outcomes.txt contains the frozen outcomes (docs/diagnosis_rates.md).
///
///   sealed_rates now.txt --shard 3/16                      # of an hour and a half, resumable
///   sealed_rates all.txt --join now1.txt --join now2.txt --most 0
///   sealed_rates now.txt --against fixtures/sealed/outcomes.txt
///
/// A file belongs to one version of the diagnosis and to one process at a time. Exit code 1: a row
/// is worse; 3: a file cannot be read, or has other sets.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>
#include <stdexcept>

#include "sealed/judge/plan.hpp"
#include "sealed/judge/rates.hpp"

namespace {

using namespace chaintrue::sealed;

constexpr int kWorse = 1;
constexpr int kBadInput = 3;

struct Arguments {
  std::string file;
  std::string shard = "1/1";
  std::vector<std::string> kinds;
  std::vector<std::string> join;
  std::string against;
  std::size_t most = std::numeric_limits<std::size_t>::max();
  bool show = false;
};

using Key = std::pair<std::string, std::uint64_t>;

std::set<Key> keys_of(const std::vector<Outcome>& outcomes) {
  std::set<Key> keys;
  for (const Outcome& outcome : outcomes) keys.emplace(outcome.kind, outcome.seed);
  return keys;
}

std::vector<Outcome> known(const Arguments& arguments) {
  std::vector<Outcome> outcomes;
  if (std::filesystem::exists(arguments.file)) outcomes = read_outcomes(arguments.file);
  for (const std::string& other : arguments.join) {
    const std::vector<Outcome> more = read_outcomes(other);
    outcomes.insert(outcomes.end(), more.begin(), more.end());
  }
  return sorted(std::move(outcomes));
}

/// The requested shard, of the whole list or of the sets in the frozen outcomes.
std::vector<PlannedSet> asked(const Arguments& arguments, const std::vector<Outcome>& frozen) {
  std::vector<PlannedSet> list = plan();
  if (!arguments.against.empty()) {
    const std::set<Key> wanted = keys_of(frozen);
    std::erase_if(list, [&](const PlannedSet& set) { return !wanted.contains({set.kind, set.seed}); });
  }
  std::size_t shard = 0, shards = 0;
  char end = 0;
  if (std::sscanf(arguments.shard.c_str(), "%zu/%zu%c", &shard, &shards, &end) != 2) {
    throw std::invalid_argument("--shard \"" + arguments.shard + "\": expected as in 3/16");
  }
  list = shard_of(list, shard, shards);
  if (!arguments.kinds.empty()) {
    std::erase_if(list, [&](const PlannedSet& set) {
      const auto& kept = arguments.kinds;
      return std::find(kept.begin(), kept.end(), set.kind) == kept.end();
    });
  }
  return list;
}

/// Each outcome is written as soon as it is known.
void run(const Arguments& arguments,
         const std::vector<PlannedSet>& list,
         std::vector<Outcome>& outcomes) {
  const std::set<Key> done = keys_of(outcomes);
  write_outcomes(arguments.file, outcomes);
  std::ofstream file(arguments.file, std::ios::binary | std::ios::app);
  std::size_t count = 0;
  for (const PlannedSet& set : list) {
    if (count == arguments.most) break;
    if (done.contains({set.kind, set.seed})) continue;
    outcomes.push_back(run_set(set));
    file << line_of(outcomes.back()) << "\n" << std::flush;
    if (!file) throw std::invalid_argument(arguments.file + " cannot be written");
    if (++count % 50 == 0) fmt::print(stderr, "\r{} of {}", count, list.size());
  }
  outcomes = sorted(std::move(outcomes));
  write_outcomes(arguments.file, outcomes);
}

int print_comparison(const Arguments& arguments,
                     const std::vector<Outcome>& frozen,
                     const std::vector<Outcome>& outcomes) {
  const Comparison comparison = compare(frozen, outcomes);
  if (comparison.sets == 0) throw std::invalid_argument("no set is in both files");
  fmt::print("{}\n{} of {} frozen sets compared, {} with another outcome\n",
             comparison_table(comparison),
             comparison.sets,
             frozen.size(),
             comparison.changed.size());
  if (arguments.show) {
    for (const auto& [before, now] : comparison.changed) {
      fmt::print("- {}\n+ {}\n", line_of(before), line_of(now));
    }
  }
  return comparison.worse() ? kWorse : 0;
}

int run_all(const Arguments& arguments) {
  std::vector<Outcome> frozen;
  if (!arguments.against.empty()) frozen = sorted(read_outcomes(arguments.against));
  std::vector<Outcome> outcomes = known(arguments);
  run(arguments, asked(arguments, frozen), outcomes);
  if (!arguments.against.empty()) return print_comparison(arguments, frozen, outcomes);
  fmt::print("{}", rates_table(outcomes));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("The rates of the diagnosis on the frozen list of sealed sets");
  app.add_option("FILE", arguments.file, "Outcomes, a line a set: read, added to, sorted")->required();
  app.add_option("--shard", arguments.shard, "Part of the list, as in 3/16");
  app.add_option("--kind", arguments.kinds, "Sets of this kind only")->check(CLI::IsMember(kinds()));
  app.add_option("--join", arguments.join, "Outcomes of another file of the same version");
  app.add_option("--most", arguments.most, "Sets to run; 0: none, the table of what there is");
  app.add_option("--against", arguments.against, "Compare with these outcomes, on their sets");
  app.add_flag("--show", arguments.show, "Print each outcome that is another");
  CLI11_PARSE(app, argc, argv);
  try {
    return run_all(arguments);
  } catch (const std::exception& trouble) {
    fmt::print(stderr, "{}\n", trouble.what());
    return kBadInput;
  }
}
