// SPDX-License-Identifier: GPL-3.0-or-later
#include "sealed/command/campaign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <set>
#include <thread>

namespace chaintrue::sealed {
namespace {

constexpr int kWorse = 1;
constexpr int kBadInput = 3;

void append(std::vector<Outcome>& outcomes, std::vector<Outcome> more) {
  outcomes.insert(outcomes.end(), std::move_iterator(more.begin()), std::move_iterator(more.end()));
}

}  // namespace

Campaign::Campaign(const std::string& about, int count, char** words)
    : app(about), argc(count), argv(words) {
  app.add_option("FILE", file, "Outcomes, a line each: read, added to, sorted");
  app.add_option("--sets", sets, "Of each kind")->check(CLI::Range(1, 1000000));
  app.add_option("--first-seed,--seed", first_seed, "Of the first set; each has the next");
  app.add_option("--threads", threads_, "Sets at a time")->check(CLI::Range(1, 64));
  app.add_option("--only,--kind", only, "Sets of this kind; may be repeated");
  app.add_option("--shard", shard_, "Part of the list, as in 3/16");
  app.add_option("--most", most_, "Sets to run; 0: none, the table of what there is");
  app.add_option("--join", join_, "Outcomes of another file of the same version");
  app.add_option("--against", against, "Compare with these outcomes, set by set");
  app.add_flag("--show", show,
               "A line for each set; of two versions, for each outcome that is another");
}

bool Campaign::is_asked(const std::string& kind) const {
  return only.empty() || std::ranges::any_of(only, [&](const std::string& word) {
           return kind == word || kind.starts_with(word + "/") || kind.starts_with(word + ":");
         });
}

std::vector<PlannedSet> Campaign::sets_of(const std::vector<std::string>& kinds,
                                          std::optional<int> count) const {
  std::vector<PlannedSet> list;
  for (const std::string& kind : kinds) {
    const int own = is_asked(kind) ? count.value_or(sets) : 0;
    for (int k = 0; k < own; ++k)
      list.push_back({kind, first_seed + static_cast<std::uint64_t>(k)});
  }
  return list;
}

int Campaign::run(const List& list, const Run& attempt, const std::vector<RateRow>& rows) {
  CLI11_PARSE(app, argc, argv);
  try {
    if (!against.empty()) before = sorted(read_outcomes(against));
    std::vector<Outcome> outcomes = outcomes_of(list(), attempt);
    finish(outcomes);
    if (!before.empty()) finish(before);
    if (!file.empty()) write_outcomes(file, outcomes);
    return print(outcomes, rows);
  } catch (const std::exception& trouble) {
    fmt::print(stderr, "{}\n", trouble.what());
    return kBadInput;
  }
}

std::vector<Outcome> Campaign::outcomes_of(const std::vector<PlannedSet>& list,
                                           const Run& attempt) const {
  std::size_t part = 0, parts = 0;
  char end = 0;
  if (std::sscanf(shard_.c_str(), "%zu/%zu%c", &part, &parts, &end) != 2)
    throw std::invalid_argument("--shard \"" + shard_ + "\": expected as in 3/16");
  std::vector<Outcome> outcomes;
  if (std::filesystem::exists(file)) outcomes = read_outcomes(file);
  for (const std::string& other : join_) append(outcomes, read_outcomes(other));
  outcomes = sorted(std::move(outcomes));
  std::set<std::pair<std::string, std::uint64_t>> done;
  for (const Outcome& outcome : outcomes)
    done.insert({{outcome.kind, outcome.seed}, {outcome.group(), outcome.seed}});
  std::vector<PlannedSet> open = shard_of(list, part, parts);
  std::erase_if(open, [&](const PlannedSet& set) { return done.contains({set.kind, set.seed}); });
  open.resize(std::min(open.size(), most_));

  // A file belongs to one version of the diagnosis and to one process at a time.
  std::ofstream out;
  if (!file.empty()) {
    write_outcomes(file, outcomes);
    out.open(file, std::ios::binary | std::ios::app);
  }
  std::atomic<std::size_t> next{0};
  std::mutex writing;
  const auto work = [&] {
    for (std::size_t k = next++; k < open.size(); k = next++) {
      std::vector<Outcome> own = attempt(open[k]);
      const std::lock_guard lock(writing);
      out << text_of(own) << std::flush;
      if (show && against.empty()) {
        fmt::print("{}", text_of(own));
        std::fflush(stdout);
      }
      append(outcomes, std::move(own));
      if (outcomes.size() % 50 == 0) fmt::print(stderr, "\r{} outcomes", outcomes.size());
    }
  };
  {
    std::vector<std::jthread> workers;
    for (int k = 1; k < threads_; ++k) workers.emplace_back(work);
    work();
  }
  if (!file.empty() && !out) throw std::invalid_argument(file + " cannot be written");
  if (outcomes.empty()) throw std::invalid_argument("no sets are asked for");
  return sorted(std::move(outcomes));
}

int Campaign::print(const std::vector<Outcome>& outcomes, const std::vector<RateRow>& rows) const {
  if (against.empty()) {
    const std::string wrong = missed(outcomes, rows);
    fmt::print("{}{}{}", rates_table(outcomes, rows), numbers_table(outcomes), wrong);
    return wrong.empty() ? 0 : kWorse;
  }
  const Comparison comparison = compare(before, outcomes, rows);
  if (comparison.sets == 0) throw std::invalid_argument("no set is in both files");
  fmt::print("{}\n{} of {} sets compared, {} with another outcome\n", comparison_table(comparison),
             comparison.sets, before.size(), comparison.changed.size());
  if (show) {
    for (const auto& [old, other] : comparison.changed)
      fmt::print("- {}\n+ {}\n", line_of(old), line_of(other));
  }
  return comparison.worse() ? kWorse : 0;
}

}  // namespace chaintrue::sealed
