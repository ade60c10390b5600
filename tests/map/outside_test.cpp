// SPDX-License-Identifier: GPL-3.0-or-later
// The values of maps beyond their points, for each of the five policies.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "grid/map/fit.hpp"
#include "tests/map/synthetic_grid.hpp"

namespace chaintrue {
namespace {

using grid::CompensationMap;
using grid::MapStatus;
using grid::Outside;
using model::MarkPoint;

const std::vector<Outside> kWays = {Outside::continued, Outside::refuse, Outside::fade,
                                    Outside::linear, Outside::clamp};

/// Points in the middle of the bed only, with margins of 300 mm and more.
grid::MeasuredGrid middle_grid(bool noisy) {
  auto spec = testing_support::usual_spec(21);
  if (!noisy) spec.noise = {};
  if (!noisy) spec.jitter_mm = 0.0;
  if (!noisy) spec.repeats = 0;
  auto made = grid::synthetic::generate(model::Machine{}, spec).value();
  for (auto& point : made.grid.points) {
    const double bump = std::cos(point.mark.x_mm / 400.0);
    if (point.lengths) point.lengths->left_mm += bump;
  }
  std::erase_if(made.grid.points,
                [](const grid::MeasuredPoint& point) { return std::abs(point.mark.x_mm) > 850.0; });
  return made.grid;
}

CompensationMap map_of(const grid::MeasuredGrid& grid, Outside way) {
  grid::FitOptions options;
  options.outside = {way, 150.0};
  return grid::fit(grid, options).value();
}

class OutsideTheMap : public testing::TestWithParam<bool> {};

TEST_P(OutsideTheMap, EveryPolicyIsContinuousWithTrueSlopes) {
  const CompensationMap own = map_of(middle_grid(GetParam()), Outside::continued);
  for (const Outside way : kWays) {
    SCOPED_TRACE(static_cast<int>(way));
    const CompensationMap map = own.with_outside({way, 150.0});
    constexpr double kStepMm = 0.25;
    int answered = 0;
    for (double x = -1210.0; x < 1210.0; x += kStepMm) {
      const auto here = map.query({x, 120.0});
      const auto next = map.query({x + kStepMm, 120.0});
      if (!here || !next) continue;
      ++answered;
      // The slopes at both ends predict the step to the error of the trapezoidal rule, some 1e-6
      // mm; a jump, or a wrong slope, is detected. Only clamp has a kink, at the hull: half a step
      // of the slope, the bump's 1 / 400 and a tenth.
      const double predicted =
          0.5 * kStepMm * (here->mark_jacobian(0, 0) + next->mark_jacobian(0, 0));
      const double kink = way == Outside::clamp ? 0.5 * kStepMm * 1.1 / 400.0 : 0.0;
      ASSERT_NEAR(next->lengths.left_mm - here->lengths.left_mm, predicted, kink + 2e-5) << x;
      const auto as_it_is = own.query({x, 120.0});
      ASSERT_GE(here->sigma.left_mm, as_it_is->sigma.left_mm * (1.0 - 1e-12)) << x;
    }
    EXPECT_GT(answered, 6000);
  }
}

TEST_P(OutsideTheMap, AllPoliciesAgreeWithinThePoints) {
  const CompensationMap own = map_of(middle_grid(GetParam()), Outside::continued);
  for (const Outside way : kWays) {
    const CompensationMap map = own.with_outside({way, 150.0});
    for (const MarkPoint p : {MarkPoint{0.0, 0.0}, {-700.0, 300.0}, {650.0, -500.0}}) {
      ASSERT_EQ(map.status(p), MapStatus::inside);
      EXPECT_EQ(map.query(p)->lengths.left_mm, own.query(p)->lengths.left_mm);
      EXPECT_EQ(map.query(p)->sigma.right_mm, own.query(p)->sigma.right_mm);
    }
  }
}

TEST_P(OutsideTheMap, DerivativesAreDifferences) {
  testing_support::expect_derivatives_are_differences(
      map_of(middle_grid(GetParam()), Outside::continued));
}

INSTANTIATE_TEST_SUITE_P(NoisyAndLattice, OutsideTheMap, testing::Bool());

TEST(OutsideTheMapByName, AFactorIsThatOfTheSigmasBeyondThePoints) {
  constexpr double kFactor = 1.5;
  const CompensationMap own = map_of(middle_grid(true), Outside::continued);
  const CompensationMap wider = own.with_sigma_beyond(kFactor);
  int beyond = 0;
  for (double x = -1200.0; x <= 1200.0; x += 100.0) {
    const bool is_beyond = own.status({x, 0.0}) == MapStatus::extrapolated;
    beyond += is_beyond ? 1 : 0;
    const auto before = own.query({x, 0.0}).value(), after = wider.query({x, 0.0}).value();
    // The factor is squared and a root taken: rounding.
    EXPECT_NEAR(after.tool_sigma_mm / before.tool_sigma_mm, is_beyond ? kFactor : 1.0, 1e-12) << x;
  }
  EXPECT_GT(beyond, 0);
}

TEST(OutsideTheMapByName, FadesToTheMachineOrRefuses) {
  const grid::MeasuredGrid measured = middle_grid(true);
  const MarkPoint far{1210.0, 0.0};
  const CompensationMap faded = map_of(measured, Outside::fade);
  ASSERT_EQ(faded.status(far), MapStatus::extrapolated);
  const auto& surface = std::get<grid::ModelSurface>(faded.contents().surface);
  const double bare =
      (1.0 + surface.residual.scale.left) *
      model::ReadingModel(surface.machine).at(surface.sheet.to_bed(far))->lengths.left_mm;
  EXPECT_NEAR(faded.lengths(far)->lengths.left_mm, bare, 1e-9);

  const CompensationMap refusing = map_of(measured, Outside::refuse);
  EXPECT_EQ(refusing.status(far), MapStatus::outside);
  EXPECT_EQ(refusing.lengths(far).error(), grid::MapReason::outside_map);
  EXPECT_EQ(refusing.query(far).error(), grid::MapReason::outside_map);
  EXPECT_EQ(refusing.inverse(faded.lengths(far)->lengths).error(), grid::MapReason::outside_map);
}

TEST(OutsideTheMapByName, MapFilesKeepThePolicy) {
  const grid::MeasuredGrid measured = middle_grid(true);
  for (const Outside way : kWays) {
    SCOPED_TRACE(static_cast<int>(way));
    const CompensationMap map = map_of(measured, way);
    ASSERT_NE(map.status({1200.0, -600.0}), MapStatus::inside);
    testing_support::expect_round_trip(map);
  }
}

TEST(OutsideTheMapByName, DirectMapsInvert) {
  grid::FitOptions options;
  options.surface = grid::SurfaceKind::direct;
  const auto direct = grid::fit(middle_grid(false), options);
  ASSERT_TRUE(direct.has_value()) << direct.error().sentence();
  for (const Outside way : {Outside::continued, Outside::refuse, Outside::linear, Outside::clamp}) {
    SCOPED_TRACE(static_cast<int>(way));
    const CompensationMap map = direct->with_outside({way, 150.0});
    const interp::Rectangle& domain = map.contents().domain;
    for (int i = 0; i <= 20; ++i) {
      for (int j = 0; j <= 20; ++j) {
        const model::MarkPoint asked{domain.x_min + domain.width() * i / 20.0,
                                     domain.y_min + domain.height() * j / 20.0};
        const auto answer = map.query(asked);
        if (!answer || answer->status != MapStatus::inside) continue;
        const auto found = map.inverse(answer->lengths);
        ASSERT_TRUE(found.has_value()) << asked.x_mm << ", " << asked.y_mm;
        // The search stops at steps of 1e-9 mm.
        EXPECT_NEAR(found->x_mm, asked.x_mm, 1e-7);
        EXPECT_NEAR(found->y_mm, asked.y_mm, 1e-7);
      }
    }
  }
}

TEST(OutsideTheMapByName, DirectMapsRefuseToFade) {
  auto measured = middle_grid(false);
  grid::FitOptions options;
  options.surface = grid::SurfaceKind::direct;
  const auto map = grid::fit(measured, options);
  ASSERT_TRUE(map) << map.error().sentence();
  EXPECT_THROW(static_cast<void>(map->with_outside({Outside::fade, 100.0})), std::invalid_argument);
  EXPECT_EQ(map->with_outside({Outside::clamp, 100.0}).status({0.0, 0.0}), MapStatus::inside);
}

}  // namespace
}  // namespace chaintrue
