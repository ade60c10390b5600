// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The figures that are stated for thousands of sets (docs/diagnosis.md), held on a few dozen: each
/// count may fall short of its rate as chance lets it once in a thousand times.
#include <gtest/gtest.h>

#include <algorithm>

#include "sealed/posed.hpp"

namespace chaintrue::sealed {
namespace {

using generator::Mix;
using grid::diagnosis::Verdict;

TrialOptions options(Mix mix, int points) {
  TrialOptions o;
  o.recipe.kind = mix;
  o.recipe.points = points;
  return o;
}

int count(const std::vector<Trial>& all, bool (*hit)(const Trial&)) {
  return static_cast<int>(std::count_if(all.begin(), all.end(), hit));
}

// So that the log of a failure says which sets to look at.
void tell(const std::vector<Trial>& all, bool (*good)(const Trial&)) {
  for (const Trial& t : all) {
    if (good(t)) continue;
    std::string line = "seed " + std::to_string(t.seed) + " hidden";
    for (const auto& id : t.hidden) line += " " + id;
    line += " -> " + std::string(name(t.verdict));
    for (const auto& c : t.causes) line += " " + c.id;
    testing::Test::RecordProperty("seed_" + std::to_string(t.seed), line);
    std::printf("  %s %s\n", line.c_str(), t.failure.c_str());
  }
}

TEST(Rates, NothingHiddenIsNotNamed) {
  for (const Mix mix : {Mix::nothing, Mix::heavy, Mix::wrong_noise}) {
    SCOPED_TRACE(std::string(word(mix)));
    const auto all = trials(options(mix, 28), 9000, 20);
    tell(all, [](const Trial& t) { return !names_something(t); });
    EXPECT_LE(count(all, names_something), most(20, mix == Mix::nothing ? 0.01 : 0.02));
  }
}

TEST(Rates, OneHiddenCauseIsNamed) {
  for (const int points : {28, 60}) {
    SCOPED_TRACE(std::to_string(points) + " points");
    const int sets = points == 28 ? 50 : 6;
    const auto all = trials(options(Mix::single, points), 9100, sets);
    tell(all, leads_right);
    // 92 % of the 22 % below a delta of 8, 97 % of the 31 % below 12, 99 % of the others.
    EXPECT_GE(count(all, leads_right), fewest(sets, 0.968));
    EXPECT_GE(count(all, in_set), fewest(sets, 0.98));
  }
}

TEST(Rates, TwoHiddenCausesAreBothNamed) {
  const auto all = trials(options(Mix::two, 28), 9200, 20);
  tell(all, all_named);
  EXPECT_GE(count(all, all_named), fewest(20, 0.86));
}

TEST(Rates, WhatNoCatalogueListsIsRefused) {
  const auto refused = [](const Trial& t) { return t.verdict == Verdict::model_discrepancy; };
  const auto misnamed = [](const Trial& t) {
    return t.verdict == Verdict::named && t.causes.front().probability >= 0.95;
  };
  const auto all = trials(options(Mix::unlisted, 60), 9300, 10);
  tell(all, refused);
  EXPECT_GE(count(all, refused), fewest(10, 0.97));
  EXPECT_LE(count(all, misnamed), most(10, 0.01));
}

TEST(Rates, BadPointsAreSetAside) {
  const auto clean = [](const Trial& t) { return t.verdict == Verdict::outliers; };
  const auto slips = trials(options(Mix::bad_points, 28), 9400, 20);
  tell(slips, clean);
  EXPECT_GE(count(slips, clean), fewest(20, 0.97));
  const auto both = trials(options(Mix::bad_points_and_effect, 28), 9500, 20);
  tell(both, leads_right);
  EXPECT_GE(count(both, leads_right), fewest(20, 0.95));
}

}  // namespace
}  // namespace chaintrue::sealed
