// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The statistics of the laboratory compared with published and closed-form values; the list of sealed sets, the
/// lines of their outcomes, the stored table, and the criterion for rejecting one version against another.
#include "sealed/judge/rates.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "sealed/judge/binomial.hpp"
#include "sealed/judge/plan.hpp"
#include "tests/support/files.hpp"

namespace chaintrue::sealed {
namespace {

using testing::HasSubstr;

constexpr double kDigits = 1e-10;  // of closed forms: lgamma of a few hundred to 1e-13
constexpr double kPrinted = 5e-5;  // of values that are printed with four digits

TEST(Binomial, TailsAreTheirSums) {
  EXPECT_NEAR(probability_of_at_least(0, 5, 0.3), 1.0, kDigits);
  EXPECT_NEAR(probability_of_at_least(5, 5, 0.3), std::pow(0.3, 5), kDigits);
  EXPECT_NEAR(probability_of_at_least(3, 4, 0.5), 5.0 / 16.0, kDigits);
  EXPECT_EQ(probability_of_at_least(6, 5, 0.3), 0.0);
  EXPECT_EQ(probability_of_at_least(1, 5, 0.0), 0.0);
  EXPECT_EQ(probability_of_at_least(5, 5, 1.0), 1.0);
  EXPECT_NEAR(probability_of_at_least(100, 100, 0.01) / 1e-200, 1.0,
              1e-9);  // the exponential of 460 times 1e-13
  EXPECT_THROW((void)probability_of_at_least(1, 5, 1.1), std::invalid_argument);
}

// Clopper and Pearson: for no hit and for all hits the bounds have a closed form; 8 of 10 and 5 of
// 50 as printed by tables and by R's binom.test.
TEST(Binomial, BoundsOfARate) {
  EXPECT_NEAR(rate_bounds_95(0, 200).upper, 1.0 - std::pow(0.025, 1.0 / 200.0), kDigits);
  EXPECT_NEAR(rate_bounds_95(50, 50).lower, std::pow(0.025, 1.0 / 50.0), kDigits);
  EXPECT_EQ(rate_bounds_95(50, 50).upper, 1.0);
  EXPECT_NEAR(rate_bounds_95(8, 10).lower, 0.4439, kPrinted);
  EXPECT_NEAR(rate_bounds_95(8, 10).upper, 0.9748, kPrinted);
  EXPECT_NEAR(rate_bounds_95(5, 50).lower, 0.0333, kPrinted);
  EXPECT_NEAR(rate_bounds_95(5, 50).upper, 0.2181, kPrinted);
  EXPECT_THROW((void)rate_bounds_95(3, 2), std::invalid_argument);
}

// By hand: rate 1/2; squares 4, 0, 4 about it; sigma sqrt(3/2 8) / 60 = 0.05774; t of 2 is 4.303. Clusters that agree by
// chance are no better than as many independent sets.
TEST(Binomial, BoundsOfClustersAreThoseOfTheRatioEstimate) {
  const RateBounds three = clustered_bounds({{12, 20}, {10, 20}, {8, 20}});
  EXPECT_NEAR(three.lower, 0.5 - 4.303 * 0.057735, 1e-6);
  EXPECT_NEAR(three.upper, 0.5 + 4.303 * 0.057735, 1e-6);
  EXPECT_EQ(clustered_bounds({{10, 20}, {10, 20}, {10, 20}}).lower, rate_bounds_95(30, 60).lower);
  EXPECT_EQ(clustered_bounds({{10, 20}}).upper, 1.0);
}

// Twice the one-sided chance is McNemar's exact test: 16 against 6 of 22 is 0.0525, 8 against 2 of
// ten 0.1094.
TEST(Binomial, SignTest) {
  EXPECT_NEAR(2.0 * sign_test(16, 6), 0.0525, kPrinted);
  EXPECT_NEAR(2.0 * sign_test(8, 2), 0.1094, kPrinted);
  EXPECT_NEAR(sign_test(0, 5), 1.0, kDigits);
  EXPECT_NEAR(sign_test(0, 0), 1.0, kDigits);
}

const std::string kLine =
    "two 1010000 28 15.50 chain_stretch:-,tooth_skip:left several_causes "
    "chain_stretch:-,tooth_skip:left~link_miscount:left leads,held,all";

TEST(Outcomes, LinesRoundTrip) {
  const Outcome outcome = parse_outcome(kLine);
  EXPECT_EQ(outcome.hidden.size(), 2u);
  EXPECT_TRUE(outcome.has("all") && outcome.has("is_several_causes"));
  EXPECT_FALSE(outcome.has("al"));
  for (const std::string& line :
       {kLine, std::string("nothing 1100000 28 0.00 - failed - -"), kLine + " mm=0.25,n=3"})
    EXPECT_EQ(line_of(parse_outcome(line)), line);
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

TEST(SealedPlan, ShardsCoverTheListAndHoldEachKindInItsShare) {
  constexpr std::size_t kShards = 16;
  const std::vector<PlannedSet> list = plan();
  std::map<std::string, int> whole;
  std::set<std::pair<std::string, std::uint64_t>> sets;
  for (const PlannedSet& set : list) {
    ++whole[set.kind];
    EXPECT_TRUE(sets.emplace(set.kind, set.seed).second);
  }
  std::vector<PlannedSet> all;
  for (std::size_t k = 1; k <= kShards; ++k) {
    std::map<std::string, int> part;
    for (const PlannedSet& set : shard_of(list, k, kShards)) {
      ++part[set.kind];
      all.push_back(set);
    }
    // The sets of a kind are evenly spaced, so that a cut changes their number by one at either end.
    for (const auto& [kind, count] : whole) EXPECT_NEAR(part[kind], count / 16.0, 2.0) << kind;
  }
  EXPECT_TRUE(all == list);
  EXPECT_THROW((void)shard_of(list, 5, 4), std::invalid_argument);
}

// A misspelt kind would make a row without sets.
TEST(Rates, EachRowIsOfAKindOfTheList) {
  std::set<std::string> counted;
  for (const RateRow& row : rate_rows()) counted.insert(row.kind);
  EXPECT_THAT(kinds(), testing::UnorderedElementsAreArray(counted));
}

TEST(Rates, TheFrozenTableIsOfTheFrozenOutcomes) {
  const std::string folder = CHAINTRUE_FIXTURES "/sealed/",
                    text = testing_support::read_text(folder + "outcomes.txt");
  const std::vector<Outcome> frozen = parse_outcomes(text);
  EXPECT_EQ(text_of(sorted(frozen)), text);
  EXPECT_EQ(rates_table(frozen), testing_support::read_text(folder + "rates.md"));
}

/// Sets without a cause, some of them with a name given.
std::vector<Outcome> with_names(int sets, int named, int from = 0) {
  std::vector<Outcome> outcomes;
  for (int k = 0; k < sets; ++k) {
    const bool names = k >= from && k < from + named;
    outcomes.push_back({.kind = "nothing", .seed = static_cast<std::uint64_t>(k), .points = 28});
    outcomes.back().verdict = names ? "named" : "nothing_found";
    outcomes.back().facts = {"no_pattern", "no_more_bad"};
    outcomes.back().add("no_name", !names);
  }
  return outcomes;
}

TEST(Compared, NetsGainsAgainstLosses) {
  const Comparison moved = compare(with_names(300, 6, 0), with_names(300, 6, 3));
  const auto row = std::ranges::find(moved.rows, "no cause named",
                                     [](const auto& own) { return own.row.right_is; });
  EXPECT_EQ(row->lost, 3);
  EXPECT_EQ(row->gained, 3);
  EXPECT_EQ(row->both, 291);
  EXPECT_EQ(moved.changed.size(), 6u);
  EXPECT_FALSE(moved.worse());
}

// Three of 100 are three points, yet three changes in one direction occur by chance in one of eight
// runs; five of 1000 are hardly by chance, yet only half a point.
TEST(Compared, WorseIsMoreThanAPointAndMoreThanChance) {
  EXPECT_FALSE(compare(with_names(100, 0), with_names(100, 3)).worse());
  EXPECT_FALSE(compare(with_names(1000, 0), with_names(1000, 5)).worse());
  const Comparison worse = compare(with_names(300, 0), with_names(300, 5));
  EXPECT_TRUE(worse.worse());
  EXPECT_THAT(comparison_table(worse), HasSubstr("WORSE"));
  EXPECT_FALSE(compare(with_names(300, 5), with_names(300, 0)).worse());
}

TEST(Compared, RefusesOtherSets) {
  std::vector<Outcome> other = with_names(3, 0);
  other.back().hidden = {"drift:left"};
  EXPECT_THROW((void)compare(with_names(3, 0), other), std::invalid_argument);
}

TEST(Compared, ASetThatFailsIsLost) {
  std::vector<Outcome> failing = with_names(300, 0);
  for (std::size_t k = 0; k < 5; ++k) failing[k].fail();
  EXPECT_TRUE(compare(with_names(300, 0), failing).worse());
}

TEST(Rates, ContradictWhatIsAskedBeyondChance) {
  const std::vector<RateRow> asked = {
      {"nothing", "no cause named", "nothing", {"no_name"}, 0.0, 1e9, {}, 0.99}};
  EXPECT_EQ(missed(with_names(100, 4), asked), "");  // by chance twice in a hundred runs
  EXPECT_THAT(missed(with_names(100, 10), asked), HasSubstr("90 of 100, 99.0 % asked"));
}

TEST(Numbers, AreThoseOfKindsWaysAndAll) {
  std::vector<Outcome> outcomes(3);
  for (std::size_t k = 0; k < outcomes.size(); ++k) {
    outcomes[k].kind = k < 2 ? "drift:28" : "drift:60";
    outcomes[k].numbers["mm"] = 1.0 + static_cast<double>(k);
  }
  const std::string table = numbers_table(outcomes);
  EXPECT_THAT(table, HasSubstr("| :28 | mm | 2 | 1.500 | 1.581 | 2.000 | 1.000 | 2.000 |"));
  EXPECT_THAT(table, HasSubstr("| drift | mm | 3 | 2.000 | 2.160 | 2.000 | 1.000 | 3.000 |"));
}

}  // namespace
}  // namespace chaintrue::sealed
