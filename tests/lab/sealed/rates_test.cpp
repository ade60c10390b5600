// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The stored outcomes of the sealed sets and their table; build/sealed_rates compares a version with them
/// (docs/diagnosis_rates.md).
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

TEST(Rates, TheFrozenTableIsOfTheFrozenOutcomes) {
  const std::vector<Outcome> frozen = outcomes_in("outcomes.txt");
  EXPECT_EQ(text_of(sorted(frozen)), text_in("outcomes.txt"));
  EXPECT_EQ(rates_table(frozen), text_in("rates.md"));
}

// A nearly certain entry of the table is among the causes, for every verdict.
TEST(Rates, TableAgreesWithTheSentence) {
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
