// SPDX-License-Identifier: GPL-3.0-or-later
// Simulated sessions of four belts: consistent commands and lengths, each cause where it acts, and
// anchors recovered by the fit.
#include <gmock/gmock.h>

#include "grid/belts/belts_fit.hpp"
#include "grid/synthetic/simulated_belts.hpp"
#include "model/belts/belt_effects.hpp"
#include "tests/belts/frame.hpp"

namespace chaintrue::grid {
namespace {

using model::Belt;
using testing_support::stated;
using testing_support::truth;

TEST(SimulatedBelts, WithoutNoiseTheTrueAnchorsAreFound) {
  synthetic::BeltsSpec spec;
  spec.noise_mm = 0.0;
  const auto made = synthetic::simulate_belts(stated(), truth(), spec);
  ASSERT_TRUE(made);
  ASSERT_EQ(made->points.size(), 81U);
  EXPECT_EQ(made->machine.anchors.tl.x_mm, -27.6);
  const auto fit = fit_belts(*made);
  ASSERT_TRUE(fit);
  // As without noise in belts_fit_test.cpp.
  EXPECT_NEAR(fit->coordinates[0].fitted_mm, truth().anchors.tl.x_mm, 1e-4);
  EXPECT_NEAR(fit->coordinates[4].fitted_mm, truth().anchors.br.x_mm, 1e-4);
}

TEST(SimulatedBelts, EveryCauseShowsInWhatFiveAnchorsLeave) {
  for (const model::effects::Effect* effect : model::belts::belt_effects()) {
    synthetic::BeltsSpec spec;
    spec.noise_mm = 0.05;
    std::map<std::string, double> parameters;
    // Three times the usual size, within the bounds: heights are weakly observable.
    const auto& size = effect->parameters[0];
    parameters[std::string(size.name)] = std::min(3.0 * size.nominal, size.upper);
    spec.hidden = {{std::string(effect->id), std::string(name(effect->sides[0])), parameters}};
    const auto made = synthetic::simulate_belts(stated(), truth(), spec);
    ASSERT_TRUE(made) << effect->id;
    const auto fit = fit_belts(*made);
    ASSERT_TRUE(fit) << effect->id;
    // 157 checks: the sigma of noise alone is within 6 % of 0.05 mm; four sigmas of that.
    EXPECT_TRUE(fit->residual_sigma_mm > 1.24 * 0.05 || !fit->bad.empty()) << effect->id;
  }
}

TEST(SimulatedBelts, RevealBadReadings) {
  synthetic::BeltsSpec spec;
  spec.bad_readings = 3;
  spec.seed = 5;
  const auto made = synthetic::simulate_belts(stated(), truth(), spec);
  ASSERT_TRUE(made);
  EXPECT_EQ(fit_belts(*made)->bad.size(), 3U);
  spec.columns = 1;
  EXPECT_THROW((void)synthetic::simulate_belts(stated(), truth(), spec), std::logic_error);
}

TEST(SimulatedBelts, AFlatFramePullsTheBeltsBehindItsMoves) {
  model::BeltMachine flat = stated();
  flat.orientation = model::Orientation::flat;
  const auto made = synthetic::simulate_belts(flat, flat, {});
  ASSERT_TRUE(made);
  EXPECT_THAT(*made->points[7].pulled, testing::ElementsAre(Belt::tl, Belt::bl));   // to the right
  EXPECT_THAT(*made->points[9].pulled, testing::ElementsAre(Belt::bl, Belt::br));   // up
  EXPECT_THAT(*made->points[10].pulled, testing::ElementsAre(Belt::tr, Belt::br));  // to the left
}

}  // namespace
}  // namespace chaintrue::grid
