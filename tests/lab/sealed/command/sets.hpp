// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Shared by the commands of the laboratory: sets of a run of seeds, on several threads, and files
/// of outcomes that are continued, joined and compared.
///
/// \code
///   CLI::App app("How often a reported law is right");
///   Sets sets{.count = 60};
///   sets.offer(app);
///   return run_command(app, argc, argv, [&] { print(sets.each([](std::uint64_t seed) { return run(seed); })); });
/// \endcode
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <set>
#include <string>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include "sealed/judge/plan.hpp"
#include "sealed/judge/rates.hpp"

namespace chaintrue::sealed {

/// Exit codes: a row is worse than in an earlier version; a file cannot be read, or has other sets.
inline constexpr int kWorse = 1;
inline constexpr int kBadInput = 3;

struct Sets {
  int count = 200;
  std::uint64_t first_seed = 1;
  int threads = 1;

  void offer(CLI::App& app) {
    app.add_option("--sets", count, "Of each kind")->check(CLI::Range(1, 1000000));
    app.add_option("--first-seed", first_seed, "Of the first set; each has the next");
    app.add_option("--threads", threads, "Sets at a time")->check(CLI::Range(1, 64));
  }
  /// In the order of the seeds, for any number of threads.
  template <class Try>
  [[nodiscard]] auto each(const Try& attempt) const {
    std::vector<std::invoke_result_t<const Try&, std::uint64_t>> all(static_cast<std::size_t>(count));
    std::atomic<int> next{0};
    const auto work = [&] {
      for (int k = next++; k < count; k = next++)
        all[static_cast<std::size_t>(k)] = attempt(first_seed + static_cast<std::uint64_t>(k));
    };
    std::vector<std::jthread> workers;
    for (int k = 1; k < threads; ++k) workers.emplace_back(work);
    work();
    workers.clear();
    return all;
  }
};

/// \returns the exit code of `body`, or kBadInput with the message of an exception.
template <class Body>
int run_command(CLI::App& app, int argc, char** argv, const Body& body) {
  CLI11_PARSE(app, argc, argv);
  try {
    if constexpr (std::is_void_v<std::invoke_result_t<const Body&>>) {
      body();
      return 0;
    } else {
      return body();
    }
  } catch (const std::exception& trouble) {
    fmt::print(stderr, "{}\n", trouble.what());
    return kBadInput;
  }
}

/// A file of outcomes belongs to one version of the diagnosis and to one process at a time.
struct OutcomeFile {
  std::string file;
  std::string shard = "1/1";
  std::size_t most = std::numeric_limits<std::size_t>::max();
  std::vector<std::string> join;
  std::string against;
  bool show = false;

  void offer(CLI::App& app) {
    app.add_option("FILE", file, "Outcomes, a line each: read, added to, sorted")->required();
    app.add_option("--shard", shard, "Part of the list, as in 3/16");
    app.add_option("--most", most, "Sets to run; 0: none, the table of what there is");
    app.add_option("--join", join, "Outcomes of another file of the same version");
    app.add_option("--against", against, "Compare with these outcomes, set by set");
    app.add_flag("--show", show, "Print each outcome that is another");
  }
  /// For the file and those that are joined.
  [[nodiscard]] std::vector<Outcome> known() const {
    std::vector<Outcome> outcomes;
    if (std::filesystem::exists(file)) outcomes = read_outcomes(file);
    for (const std::string& other : join) {
      const std::vector<Outcome> more = read_outcomes(other);
      outcomes.insert(outcomes.end(), more.begin(), more.end());
    }
    return sorted(std::move(outcomes));
  }
  /// Runs the sets of a list that `outcomes` does not have, under their kind and `suffix`; each outcome is
  /// written as soon as it is known.
  void run(const std::vector<PlannedSet>& list,
           const std::string& suffix,
           const std::function<std::vector<Outcome>(const PlannedSet&)>& attempt,
           std::vector<Outcome>& outcomes) const {
    std::size_t part = 0, parts = 0;
    char end = 0;
    if (std::sscanf(shard.c_str(), "%zu/%zu%c", &part, &parts, &end) != 2)
      throw std::invalid_argument("--shard \"" + shard + "\": expected as in 3/16");
    std::set<std::pair<std::string, std::uint64_t>> done;
    for (const Outcome& outcome : outcomes) done.emplace(outcome.kind, outcome.seed);
    write_outcomes(file, outcomes);
    std::ofstream out(file, std::ios::binary | std::ios::app);
    std::size_t count = 0;
    for (const PlannedSet& set : shard_of(list, part, parts)) {
      if (count == most) break;
      if (done.contains({set.kind + suffix, set.seed})) continue;
      for (Outcome& outcome : attempt(set)) {
        out << line_of(outcome) << "\n" << std::flush;
        outcomes.push_back(std::move(outcome));
      }
      if (!out) throw std::invalid_argument(file + " cannot be written");
      if (++count % 50 == 0) fmt::print(stderr, "\r{} sets", count);
    }
    outcomes = sorted(std::move(outcomes));
    write_outcomes(file, outcomes);
  }
  /// \returns the exit code.
  [[nodiscard]] int print_comparison(const std::vector<Outcome>& before,
                                     const std::vector<Outcome>& now,
                                     const std::vector<RateRow>& rows = rate_rows()) const {
    const Comparison comparison = compare(before, now, rows);
    if (comparison.sets == 0) throw std::invalid_argument("no set is in both files");
    fmt::print("{}\n{} of {} sets compared, {} with another outcome\n",
               comparison_table(comparison),
               comparison.sets,
               before.size(),
               comparison.changed.size());
    if (show) {
      for (const auto& [old, other] : comparison.changed)
        fmt::print("- {}\n+ {}\n", line_of(old), line_of(other));
    }
    return comparison.worse() ? kWorse : 0;
  }
};

}  // namespace chaintrue::sealed
