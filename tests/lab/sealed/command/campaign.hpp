// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A campaign: sets that are drawn, diagnosed and judged one after the other, on several threads; their
/// outcomes, which may be kept in a file, continued, joined and compared with those of another version; and
/// the tables of their facts and numbers.
///
/// \code
///   Campaign campaign("How often a reported law is right", argc, argv);
///   campaign.sets = 60;
///   return campaign.run([&] { return campaign.sets_of({"laws", "nothing"}); }, run_laws, laws_rows());
/// \endcode
///
/// Exit codes: 1: a row is worse than in an earlier version, or contradicts what is asked of it; 3: a file
/// cannot be read, or has other sets.
#include <CLI/CLI.hpp>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "sealed/judge/plan.hpp"
#include "sealed/judge/rates.hpp"

namespace chaintrue::sealed {

struct Campaign {
  CLI::App app;
  int argc;
  char** argv;
  int sets = 200;
  std::uint64_t first_seed = 1;
  std::vector<std::string> only;
  bool show = false;
  std::string file;
  std::string against;
  std::vector<Outcome> before;  ///< those of `against`
  /// Facts that need all outcomes.
  std::function<void(std::vector<Outcome>&)> finish = [](std::vector<Outcome>&) {};

  Campaign(const std::string& about, int argc, char** argv);

  /// A kind, or its part before a slash or colon, is one of `only`, if there are any.
  bool is_asked(const std::string& kind) const;
  /// So many, else `sets`, of each kind that is asked for.
  std::vector<PlannedSet> sets_of(const std::vector<std::string>& kinds,
                                  std::optional<int> count = std::nullopt) const;

  using List = std::function<std::vector<PlannedSet>()>;
  /// An outcome of a set has its kind, or one that begins with it and a colon.
  using Run = std::function<std::vector<Outcome>(const PlannedSet&)>;
  /// Parses the command line, then makes the list. \returns the exit code.
  int run(const List& list, const Run& attempt, const std::vector<RateRow>& rows);

 private:
  std::string shard_ = "1/1";
  std::size_t most_ = std::numeric_limits<std::size_t>::max();
  int threads_ = 1;
  std::vector<std::string> join_;

  [[nodiscard]] std::vector<Outcome> outcomes_of(const std::vector<PlannedSet>& list,
                                                 const Run& attempt) const;
  int print(const std::vector<Outcome>& outcomes, const std::vector<RateRow>& rows) const;
};

}  // namespace chaintrue::sealed
