// SPDX-License-Identifier: GPL-3.0-or-later
// Properties of a plan: the required number of marks, on the bed, apart from each other, on a short
// route; an expected error that decreases with more points and equals the fit's.
#include "grid/planning/measurement_plan.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "grid/observation/length_points.hpp"
#include "interp/planner_nodes.hpp"

namespace chaintrue {
namespace {

using grid::MeasurementPlan;
using model::MarkPoint;

MeasurementPlan planned(const grid::PlanRequest& request) {
  auto plan = grid::plan_measurement(model::Machine{}, request);
  if (!plan) throw std::runtime_error(plan.error().sentence());
  return *std::move(plan);
}

double rms(const MeasurementPlan& plan) {
  double squares = 0.0;
  const auto errors = grid::expected_error_mm(plan.map, model::Bed{}, 24, 12);
  for (double error : errors) squares += error * error;
  return std::sqrt(squares / static_cast<double>(errors.size()));
}

class Plan : public testing::TestWithParam<int> {};

TEST_P(Plan, HasTheRequestedMarksOnTheBedAndApart) {
  const MeasurementPlan plan = planned({.points = GetParam()});
  const model::Bed bed;
  EXPECT_EQ(plan.marks.size(), static_cast<std::size_t>(GetParam()));
  EXPECT_EQ(plan.columns * plan.rows + plan.extra, GetParam());
  for (std::size_t i = 0; i < plan.marks.size(); ++i) {
    EXPECT_LE(std::abs(plan.marks[i].x_mm), 0.5 * bed.width_mm - 10.0);
    EXPECT_LE(std::abs(plan.marks[i].y_mm), 0.5 * bed.height_mm - 10.0);
    EXPECT_EQ(plan.marks[i].x_mm, std::trunc(plan.marks[i].x_mm));
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_GT(std::hypot(plan.marks[i].x_mm - plan.marks[j].x_mm,
                           plan.marks[i].y_mm - plan.marks[j].y_mm),
                grid::kRepeatDistanceMm);
    }
  }
}

TEST_P(Plan, HoldsEveryCrossingOfChebyshevLobattoLines) {
  const MeasurementPlan plan = planned({.points = GetParam()});
  const model::Bed bed;
  const auto x =
      interp::chebyshev_lobatto(10.0 - 0.5 * bed.width_mm, 0.5 * bed.width_mm - 10.0, plan.columns);
  const auto y =
      interp::chebyshev_lobatto(10.0 - 0.5 * bed.height_mm, 0.5 * bed.height_mm - 10.0, plan.rows);
  for (double row : y) {
    for (double column : x) {
      EXPECT_TRUE(std::any_of(plan.marks.begin(), plan.marks.end(),
                              [&](const MarkPoint& mark) {
                                // Marks are in whole mm.
                                return std::abs(mark.x_mm - column) < 1.0 &&
                                       std::abs(mark.y_mm - row) < 1.0;
                              }))
          << column << ", " << row;
    }
  }
}

TEST_P(Plan, WalksNoFartherThanRowByRow) {
  const MeasurementPlan plan = planned({.points = GetParam()});
  const model::Bed bed;
  double walk = 0.0;
  for (std::size_t i = 1; i < plan.marks.size(); ++i) {
    walk += std::hypot(plan.marks[i].x_mm - plan.marks[i - 1].x_mm,
                       plan.marks[i].y_mm - plan.marks[i - 1].y_mm);
  }
  // Every row once, every column's height once, and a detour of at most a bed's height for each
  // extra point.
  EXPECT_LE(walk, plan.rows * bed.width_mm + (1 + plan.extra) * bed.height_mm);
}

INSTANTIATE_TEST_SUITE_P(Counts, Plan, testing::Values(12, 28, 31));

TEST(PlanError, FallsWithMorePointsAndLessNoise) {
  const double usual = rms(planned({.points = 28}));
  EXPECT_LT(rms(planned({.points = 60})), usual);
  EXPECT_LT(rms(planned({.points = 28, .noise = {0.05, 0.05}})), usual);
}

TEST(PlanRefusal, NamesTheRangeOfPoints) {
  for (int points : {0, grid::kFewestPlanned - 1, grid::kMostPlanned + 1}) {
    try {
      static_cast<void>(grid::plan_measurement(model::Machine{}, {.points = points}));
      FAIL() << points << " points were planned";
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("12 to 200 points"));
    }
  }
}

TEST(PlanRefusal, NamesAPlaceThatTheMachineCannotMeasure) {
  model::Machine machine;
  machine.motors = {{-700.0, 700.0}, {700.0, 700.0}};
  const auto plan = grid::plan_measurement(machine, {.points = 28});
  ASSERT_FALSE(plan);
  EXPECT_THAT(plan.error().sentence(), testing::HasSubstr("the machine cannot measure at ("));
}

}  // namespace
}  // namespace chaintrue
