// SPDX-License-Identifier: GPL-3.0-or-later
// Simulated sessions of four belts: consistent commands and lengths, each cause where it acts, and
// anchors recovered by the fit.
#include <gmock/gmock.h>

#include "grid/belts/belts_fit.hpp"
#include "model/belts/belt_effects.hpp"
#include "tests/support/belt_frame.hpp"

namespace chaintrue::grid {
namespace {

using model::Belt;
using testing_support::stated;

TEST(SimulatedBelts, EveryCauseShowsInWhatFiveAnchorsLeave) {
  for (const model::effects::Effect* effect : model::belts::belt_effects()) {
    SCOPED_TRACE(std::string(effect->id));
    std::map<std::string, double> parameters;
    // Three times the usual size, within the bounds: heights are weakly observable.
    const auto& size = effect->parameters[0];
    parameters[std::string(size.name)] = std::min(3.0 * size.nominal, size.upper);
    const auto fit = fit_belts(testing_support::belts_session(
        {.noise_mm = 0.05,
         .hidden = {{std::string(effect->id), std::string(name(effect->sides[0])), parameters}}}));
    ASSERT_TRUE(fit);
    // 157 checks: the sigma of noise alone is within 6 % of 0.05 mm; four sigmas of that.
    EXPECT_TRUE(fit->residual_sigma_mm > 1.24 * 0.05 || !fit->bad.empty());
  }
}

TEST(SimulatedBelts, StateTheStatedFrameAndRevealBadReadings) {
  synthetic::BeltsSpec spec;
  spec.bad_readings = 3;
  spec.seed = 5;
  const MeasuredBelts made = testing_support::belts_session(spec);
  ASSERT_EQ(made.points.size(), 81U);
  EXPECT_EQ(made.machine.anchors.tl.x_mm, -27.6);
  EXPECT_EQ(fit_belts(made)->bad.size(), 3U);
  spec.columns = 1;
  EXPECT_THROW((void)testing_support::belts_session(spec), std::logic_error);
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
