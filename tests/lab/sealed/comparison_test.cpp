// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The list of sealed sets, the lines of their outcomes, and the criterion for rejecting one
/// version against another.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>

#include "sealed/judge/plan.hpp"
#include "sealed/judge/rates.hpp"

namespace chaintrue::sealed {
namespace {

using testing::HasSubstr;

const std::string kLine =
    "two 1010000 28 15.50 chain_stretch:-,tooth_skip:left several_causes "
    "chain_stretch:-,tooth_skip:left~link_miscount:left leads,held,all";

TEST(Outcomes, LinesRoundTrip) {
  const Outcome outcome = parse_outcome(kLine);
  EXPECT_EQ(outcome.seed, 1010000u);
  EXPECT_EQ(outcome.hidden.size(), 2u);
  EXPECT_TRUE(outcome.has("all"));
  EXPECT_FALSE(outcome.has("al"));
  EXPECT_EQ(line_of(outcome), kLine);
  const std::string nothing = "nothing 1100000 28 0.00 - failed - -";
  EXPECT_EQ(line_of(parse_outcome(nothing)), nothing);
}

TEST(Outcomes, RefuseInvalidLines) {
  EXPECT_THROW((void)parse_outcome("two 1010000 28"), std::invalid_argument);
  EXPECT_THROW((void)parse_outcome("two 1x 28 15.50 - named - -"), std::invalid_argument);
  EXPECT_THROW((void)parse_outcomes("two 1010000\n"), std::invalid_argument);
}

TEST(Outcomes, ATruncatedLineRunsAgain) {
  EXPECT_EQ(parse_outcomes("# made by\n\n" + kLine + "\ntwo 10100").size(), 1u);
  EXPECT_TRUE(parse_outcomes("two 10100").empty());
}

TEST(Outcomes, OneSetHasOneOutcome) {
  const Outcome one = parse_outcome(kLine);
  EXPECT_EQ(sorted({one, one}).size(), 1u);
  Outcome other = one;
  other.verdict = "named";
  EXPECT_THROW((void)sorted({one, other}), std::invalid_argument);
}

TEST(SealedPlan, ShardsCoverTheList) {
  const std::vector<PlannedSet> list = plan();
  for (const std::size_t shards : {1u, 7u, 16u}) {
    std::vector<PlannedSet> all;
    for (std::size_t k = 1; k <= shards; ++k) {
      const auto part = shard_of(list, k, shards);
      all.insert(all.end(), part.begin(), part.end());
    }
    EXPECT_TRUE(all == list) << shards;
  }
  EXPECT_THROW((void)shard_of(list, 0, 4), std::invalid_argument);
  EXPECT_THROW((void)shard_of(list, 5, 4), std::invalid_argument);
}

TEST(SealedPlan, EachShardHoldsEachKindInItsShare) {
  const std::vector<PlannedSet> list = plan();
  std::map<std::string, int> whole;
  for (const PlannedSet& set : list) ++whole[set.kind];
  constexpr std::size_t kShards = 16;
  for (std::size_t k = 1; k <= kShards; ++k) {
    std::map<std::string, int> part;
    for (const PlannedSet& set : shard_of(list, k, kShards)) ++part[set.kind];
    // The sets of a kind are evenly spaced, so that a cut changes their number by one at either
    // end.
    for (const auto& [kind, sets] : whole) EXPECT_NEAR(part[kind], sets / 16.0, 2.0) << kind;
  }
}

TEST(SealedPlan, HasNoDuplicates) {
  std::set<std::pair<std::string, std::uint64_t>> sets;
  for (const PlannedSet& set : plan()) EXPECT_TRUE(sets.emplace(set.kind, set.seed).second);
}

// A misspelt fact or kind would make a row in which every set is wrong, or a row without sets.
TEST(Rates, EachRowIsOfAKindOfTheList) {
  const std::vector<std::string> all = kinds();
  std::set<std::string> counted;
  for (const RateRow& row : rate_rows()) {
    EXPECT_THAT(all, testing::Contains(row.kind)) << row.hidden;
    counted.insert(row.kind);
  }
  EXPECT_EQ(counted.size(), all.size());
}

/// Sets without a cause, the first of them with a name given.
std::vector<Outcome> with_names(int sets, int named, int from = 0) {
  std::vector<Outcome> outcomes;
  for (int k = 0; k < sets; ++k) {
    Outcome o;
    o.kind = "nothing";
    o.seed = static_cast<std::uint64_t>(k);
    o.points = 28;
    o.facts = {"no_pattern", "no_more_bad"};
    const bool names = k >= from && k < from + named;
    o.verdict = names ? "named" : "nothing_found";
    if (names) o.named = {"chain_sag:-"};
    if (!names) o.facts.emplace_back("no_name");
    outcomes.push_back(o);
  }
  return outcomes;
}

const RowComparison& names_row(const Comparison& comparison) {
  return *std::find_if(comparison.rows.begin(), comparison.rows.end(), [](const auto& row) {
    return row.right_is == "no cause named";
  });
}

TEST(Compared, EqualRatesAreNotWorse) {
  const Comparison same = compare(with_names(300, 3), with_names(300, 3));
  EXPECT_EQ(same.sets, 300);
  EXPECT_EQ(names_row(same).both, 297);
  EXPECT_TRUE(same.changed.empty());
  EXPECT_FALSE(same.worse());
}

TEST(Compared, NetsGainsAgainstLosses) {
  const Comparison moved = compare(with_names(300, 6, 0), with_names(300, 6, 3));
  const RowComparison& row = names_row(moved);
  EXPECT_EQ(row.lost, 3);
  EXPECT_EQ(row.gained, 3);
  EXPECT_EQ(row.difference(), 0.0);
  EXPECT_EQ(moved.changed.size(), 6u);
  EXPECT_FALSE(moved.worse());
}

// Three of 100 are three points, yet three changes in one direction occur by chance in one of eight
// runs; five of 1000 are hardly by chance, yet only half a point.
TEST(Compared, WorseIsMoreThanAPointAndMoreThanChance) {
  EXPECT_FALSE(compare(with_names(100, 0), with_names(100, 3)).worse());
  EXPECT_FALSE(compare(with_names(1000, 0), with_names(1000, 5)).worse());
  EXPECT_TRUE(compare(with_names(300, 0), with_names(300, 5)).worse());
  EXPECT_FALSE(compare(with_names(300, 5), with_names(300, 0)).worse());
}

// A tool with 10 % false alarms is rejected on the sets of the frozen list.
TEST(Compared, RefusesTenPercentFalseAlarms) {
  const Comparison worse = compare(with_names(300, 2), with_names(300, 30));
  EXPECT_TRUE(worse.worse());
  EXPECT_THAT(comparison_table(worse), HasSubstr("WORSE"));
}

TEST(Compared, RefusesOtherSets) {
  std::vector<Outcome> other = with_names(3, 0);
  other.back().hidden = {"drift:left"};
  EXPECT_THROW((void)compare(with_names(3, 0), other), std::invalid_argument);
}

TEST(Compared, ASetThatFailsIsLost) {
  std::vector<Outcome> failing = with_names(300, 0);
  for (std::size_t k = 0; k < 5; ++k) {
    failing[k].verdict = "failed";
    failing[k].facts.clear();
  }
  EXPECT_TRUE(compare(with_names(300, 0), failing).worse());
}

TEST(Compared, TheTableCountsSetsAndStatesBounds) {
  EXPECT_THAT(rates_table(with_names(200, 0)),
              HasSubstr("| nothing | no cause named | 100.0 | 200 of 200 | 98.2 to 100.0 |"));
}

}  // namespace
}  // namespace chaintrue::sealed
