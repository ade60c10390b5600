// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// An excerpt of the frozen sealed sets, each of which must have its stored outcome: a rate cannot
/// be tested on a few dozen sets, a change of any of them can. The rates are those of
/// build/sealed_rates (docs/diagnosis_rates.md).
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "sealed/judge/plan.hpp"
#include "sealed/judge/rates.hpp"
#include "sealed/posed.hpp"

namespace chaintrue::sealed {
namespace {

using generator::Mix;

std::string text_in(const std::string& name) {
  const std::string path = std::string(CHAINTRUE_FIXTURES) + "/sealed/" + name;
  std::ifstream file(path, std::ios::binary);
  EXPECT_TRUE(file) << path;
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::vector<Outcome> outcomes_in(const std::string& name) { return parse_outcomes(text_in(name)); }

class Excerpt : public testing::TestWithParam<std::string> {};

// If a change is intended: build/sealed_rates new.txt --against fixtures/sealed/excerpt.txt
// rewrites the file, once the whole list is not worse.
TEST_P(Excerpt, HasTheFrozenOutcome) {
  int sets = 0;
  for (const Outcome& frozen : outcomes_in("excerpt.txt")) {
    if (frozen.kind != GetParam()) continue;
    ++sets;
    EXPECT_EQ(line_of(run_set({frozen.kind, frozen.seed})), line_of(frozen));
  }
  EXPECT_GE(sets, 5);
}

INSTANTIATE_TEST_SUITE_P(Rates,
                         Excerpt,
                         testing::ValuesIn(kinds()),
                         [](const auto& kind) { return kind.param; });

// The excerpt may be rewritten, the frozen outcomes may not: the excerpt is compared with them.
TEST(Rates, TheExcerptIsOfTheFrozenSetsAndNotWorse) {
  const std::vector<Outcome> excerpt = outcomes_in("excerpt.txt");
  const Comparison comparison = compare(outcomes_in("outcomes.txt"), excerpt);
  EXPECT_EQ(comparison.sets, static_cast<int>(excerpt.size()));
  EXPECT_FALSE(comparison.worse()) << comparison_table(comparison);
}

TEST(Rates, TheFrozenTableIsOfTheFrozenOutcomes) {
  const std::vector<Outcome> frozen = outcomes_in("outcomes.txt");
  EXPECT_EQ(text_of(sorted(frozen)), text_in("outcomes.txt"));
  EXPECT_EQ(rates_table(frozen), text_in("rates.md"));
}

// A nearly certain entry of the table is among the causes, for every verdict.
TEST(Rates, TheTableNeverContradictsTheSentence) {
  for (const Mix mix : {Mix::alongside, Mix::two_alongside, Mix::unlisted, Mix::near}) {
    TrialOptions options;
    options.recipe.kind = mix;
    options.recipe.points = 28;
    for (const Trial& t : trials(options, 9800, 4)) {
      SCOPED_TRACE(std::string(word(mix)) + " seed " + std::to_string(t.seed));
      for (const auto& h : t.hypotheses) {
        const bool abstains = h.effect == "nothing" || h.effect == "unknown" ||
                              h.effect == "noise" || h.effect == "bad_points" ||
                              h.effect == "law";
        if (abstains || h.probability < 0.99) continue;
        const std::string id = h.effect + ":" + (h.side.empty() ? "-" : h.side);
        EXPECT_TRUE(std::any_of(t.causes.begin(), t.causes.end(), [&](const NamedCause& c) {
          return means(c, id);
        })) << id;
      }
    }
  }
}

}  // namespace
}  // namespace chaintrue::sealed
