// SPDX-License-Identifier: GPL-3.0-or-later
// Verdicts from given probabilities: the named cause is the fitted cause.
#include "grid/diagnosis/decision.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "model/effects/catalogue.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

struct SetOfCauses {
  std::vector<int> causes;
  double probability = 0.0;
};

/// The decision for these sets, each together with a pattern or without, with every cause in its own class.
Decision decided(const std::vector<SetOfCauses>& sets, std::size_t causes, bool detected = true,
                 int discrepancy = 0) {
  RegressorSystem system;
  std::vector<CauseClass> classes;
  for (std::size_t k = 0; k < causes; ++k) {
    const model::effects::Effect* effect = model::effects::catalogue()[k];
    Regressor regressor;
    regressor.cause = {effect, effect->sides.front()};
    system.regressors.push_back(regressor);
    classes.push_back({regressor.cause});
  }
  ModelComparison comparison;
  comparison.marginalised_systems.resize(1);
  for (const SetOfCauses& own : sets) {
    CandidateModel model;
    model.regressors = own.causes;
    model.discrepancy = discrepancy;
    model.log_weight = std::log(own.probability);
    comparison.models.push_back(model);
  }
  return decide(system, comparison, {}, detected, classes);
}

TEST(Decision, FitsTheNamedCause) {
  // The first cause is likeliest as a single cause; the second has the largest total over all sets.
  const Decision found = decided({{{0}, 0.35}, {{1}, 0.31}, {{1, 2}, 0.20}, {{1, 3, 4}, 0.10}}, 5);
  ASSERT_EQ(found.verdict, Verdict::named);
  EXPECT_EQ(found.listed, std::vector<std::size_t>{1});
  EXPECT_EQ(found.regressors, std::vector<int>{1});
}

TEST(Decision, FitsANamedCauseWithoutItsPartners) {
  const Decision found = decided({{{0}, 0.34}, {{1, 2}, 0.31}, {{1, 3, 4}, 0.31}}, 5);
  ASSERT_EQ(found.verdict, Verdict::named);
  EXPECT_EQ(found.listed, std::vector<std::size_t>{1});
  EXPECT_EQ(found.regressors, std::vector<int>{1});
}

TEST(Decision, NamesNothingThatNoiseCouldMake) {
  const std::vector<SetOfCauses> likely = {{{0}, 0.98}, {{}, 0.02}};
  EXPECT_EQ(decided(likely, 2, true, -1).verdict, Verdict::named);
  const Decision within_noise = decided(likely, 2, false, -1);
  EXPECT_NE(within_noise.verdict, Verdict::named);
  EXPECT_TRUE(within_noise.listed.empty());
}

}  // namespace
}  // namespace chaintrue::grid::diagnosis
