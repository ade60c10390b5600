// SPDX-License-Identifier: GPL-3.0-or-later
// Priors of causes: the shares of one catalogue sum to that of one cause against nothing,
// independent of other catalogues.
#include <gtest/gtest.h>

#include <algorithm>

#include <cmath>
#include <map>
#include <string>

#include "grid/diagnosis/belts_analysis.hpp"
#include "grid/diagnosis/model_comparison.hpp"
#include "grid/synthetic/simulated_belts.hpp"
#include "model/effects/catalogue.hpp"
#include "sessions.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// A flat frame, whose belts are pulled in turn: every effect of belts can show.
RegressorSystem system_of_flat_frame() {
  model::BeltMachine machine;
  machine.orientation = model::Orientation::flat;
  machine.anchors = {
      {-20.0, 2050.0, 100.0}, {2910.0, 2070.0, 56.0}, {0.0, 0.0, 34.0}, {2950.0, 0.0, 78.0}};
  machine.anchors_known = true;
  synthetic::BeltsSpec spec;
  spec.columns = spec.rows = 5;
  spec.width_share = 0.6;
  spec.height_share = 0.5;
  spec.noise_mm = 0.3;
  spec.seed = 4;
  const MeasuredBelts belts = synthetic::simulate_belts(machine, machine, spec).value();
  const auto alone = belts::fit_anchors_robustly(belts);
  EXPECT_TRUE(alone);
  return system_of(belts, alone->state, observations_of(belts, alone->state, 0.3),
                   candidates(belts).testable);
}

double prior_of(const RegressorSystem& system, const std::vector<int>& set, bool pattern = false) {
  return std::exp(log_prior(system, set, pattern));
}

TEST(Prior, ShareOfBeltCausesDoesNotDependOnChainCauses) {
  const RegressorSystem system = system_of_flat_frame();
  // By effect, the prior of its testable sides; each other side would have as much.
  std::map<std::string, double> share;
  std::map<std::string, std::map<model::effects::EffectSide, bool>> sides;
  for (std::size_t k = 0; k < system.regressors.size(); ++k) {
    const Regressor& own = system.regressors[k];
    const std::string effect(own.cause.effect->id);
    share[effect] += prior_of(system, {static_cast<int>(k)});
    sides[effect][own.cause.side] = true;
  }
  double one = 0.0;
  for (const Regressor& own : system.regressors) {
    const std::string effect(own.cause.effect->id);
    if (own.expected || share[effect] == 0.0) continue;
    one += share[effect] * static_cast<double>(own.cause.effect->sides.size()) /
           static_cast<double>(sides[effect].size());
    share[effect] = 0.0;
  }
  // A sixth of the prior of nothing, as in belts_system.cpp. Rounding, of a thousand addends.
  EXPECT_NEAR(one, kPriorOfNothing / 6.0, 1e-9);
}

TEST(Prior, ExpectedCausesHaveProbabilityOneHalf) {
  const RegressorSystem system = system_of_flat_frame();
  std::vector<int> expected, other;
  for (std::size_t k = 0; k < system.regressors.size(); ++k) {
    const int number = static_cast<int>(k);
    if (system.regressors[k].expected) {
      expected.push_back(number);
    } else if (other.empty()) {
      other.push_back(number);
    }
  }
  ASSERT_EQ(expected.size(), 2u) << "belts stretch, anchors give";
  ASSERT_FALSE(other.empty());
  double alone = 0.0, with_another = 0.0;
  for (const int number : expected) {
    alone += prior_of(system, {number}) / prior_of(system, {});
    with_another +=
        prior_of(system, {std::min(number, other.front()), std::max(number, other.front())}) /
        prior_of(system, other);
  }
  // Rounding of logarithms.
  EXPECT_NEAR(alone, 1.0, 1e-12);
  EXPECT_NEAR(with_another, 1.0, 1e-12);
  const double both = prior_of(system, expected) / prior_of(system, {});
  EXPECT_GT(both, 0.0);
  EXPECT_LT(both, alone) << "both at once are rarer than one of them";
}

TEST(Prior, APatternMakesNoCauseOfBeltsLikelier) {
  const RegressorSystem system = system_of_flat_frame();
  for (int k = 0; k < static_cast<int>(system.regressors.size()); k += 40) {
    const double odds = prior_of(system, {k}) / prior_of(system, {});
    // Rounding of logarithms.
    EXPECT_NEAR(prior_of(system, {k}, true) / prior_of(system, {}, true), odds, 1e-12 * odds) << k;
  }
}

// A chain skips forwards as often as backwards, and the sign does not change how well it shows.
TEST(Prior, LinksAddedAreAsLikelyAsLinksLost) {
  const Analysis analysis = testing_support::analysis_of(testing_support::session_of({}, 11));
  const std::vector<Regressor>& regressors = analysis.system.regressors;
  int pairs = 0;
  for (const Regressor& lost : regressors) {
    if (!lost.fixed || lost.values.front() >= 0.0) continue;
    const auto added =
        std::find_if(regressors.begin(), regressors.end(), [&](const Regressor& other) {
          return other.cause == lost.cause && other.values.front() == -lost.values.front() &&
                 std::equal(other.values.begin() + 1, other.values.end(), lost.values.begin() + 1);
        });
    ASSERT_NE(added, regressors.end()) << lost.cause.effect->id;
    // The curvature of a chain's length over six millimetres.
    EXPECT_NEAR(lost.log_prior, added->log_prior, 0.05) << lost.cause.effect->id;
    ++pairs;
  }
  EXPECT_GT(pairs, 20);
}

}  // namespace
}  // namespace chaintrue::grid::diagnosis
