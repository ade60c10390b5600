// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include <algorithm>

#include "grid/map/fit.hpp"
#include "grid/map/query_points.hpp"
#include "tests/map/synthetic_grid.hpp"

namespace chaintrue {
namespace {

using grid::CompensationMap;
using testing_support::true_tool_rms_mm;
using testing_support::usual_spec;

grid::synthetic::SyntheticSession session(const grid::synthetic::SyntheticSpec& spec) {
  return grid::synthetic::generate(model::Machine{}, spec).value();
}

CompensationMap fitted(const grid::MeasuredGrid& grid) { return grid::fit(grid).value(); }

TEST(ResidualFit, LeavesAFractionOfTheErrorOfTheStatedMachine) {
  const auto made = session(usual_spec(1));
  // 28 points of 0.35 mm noise on the tool and 9 or so effective parameters: about 0.2 mm; twice
  // that is allowed.
  EXPECT_LT(true_tool_rms_mm(fitted(made.grid), made.answer), 0.4) << "seed 1";
}

TEST(ResidualFit, PlacesASheetThatWasLaidByHand) {
  auto spec = usual_spec(7);
  spec.sheet = grid::SheetUncertainty{};
  const auto made = session(spec);
  const CompensationMap map = fitted(made.grid);
  EXPECT_LT(true_tool_rms_mm(map, made.answer),
            0.4);  // as without a sheet: its placement only moves the frame
  const model::MarkPoint mark{300.0, -200.0};
  const model::BedPoint bed = map.to_bed(mark);
  const auto by_mark = map.query(mark);
  const auto by_bed = map.query(map.to_mark(bed));
  ASSERT_TRUE(by_mark && by_bed);
  EXPECT_NEAR(by_mark->lengths.left_mm, by_bed->lengths.left_mm,
              1e-9);  // rounding of a rotation there and back
}

TEST(ResidualFit, RejectsBadPoints) {
  auto spec = usual_spec(40);
  spec.bad = {2, 10.0};
  const auto made = session(spec);
  const CompensationMap map = fitted(made.grid);
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < map.contents().points.size(); ++i) {
    if (map.contents().points[i].bad) found.push_back(i);
  }
  auto hidden = made.answer.bad_points;
  std::sort(hidden.begin(), hidden.end());
  EXPECT_EQ(found, hidden) << "seed 40";
  EXPECT_LT(true_tool_rms_mm(map, made.answer), 0.45);
  EXPECT_THAT(map.contents().notes, testing::Contains(testing::HasSubstr("was left out")));
}

TEST(ResidualFit, MeetsPointsAndTruthWithoutNoise) {
  auto spec = usual_spec(5);
  spec.noise = {};
  spec.repeats = 0;
  const auto made = session(spec);
  EXPECT_FALSE(made.grid.noise);
  EXPECT_LT(true_tool_rms_mm(fitted(made.grid), made.answer),
            0.01);  // the model class contains the truth exactly
}

TEST(ResidualFit, EstimatesMissingNoiseFromRepeats) {
  auto spec = usual_spec(11);
  spec.repeats = 20;
  auto made = session(spec);
  made.grid.noise.reset();
  const grid::MapNoise noise = fitted(made.grid).contents().noise;
  EXPECT_EQ(noise.source, grid::NoiseSource::repeats);
  EXPECT_NEAR(noise.length_mm * noise.factor_found, 0.2,
              0.08);  // 40 degrees of freedom: 11 % a sigma, three and a half
}

TEST(ResidualFit, InverseFindsTheQueriedPoint) {
  const CompensationMap map = fitted(session(usual_spec(2)).grid);
  for (double x = -1200.0; x <= 1200.0; x += 300.0) {
    for (double y = -600.0; y <= 600.0; y += 200.0) {
      const auto answer = map.query({x, y});
      ASSERT_TRUE(answer);
      const auto back = map.inverse(answer->lengths);
      ASSERT_TRUE(back);
      // The last Newton step is below 1e-9 mm.
      EXPECT_NEAR(back->x_mm, x, 1e-8);
      EXPECT_NEAR(back->y_mm, y, 1e-8);
    }
  }
}

TEST(ResidualFit, ReadingsOfTheMachineSharpenTheSettings) {
  auto made = session(usual_spec(9));
  const auto& truth = made.answer.machine.motors;
  const auto sigma_of_spacing = [](const CompensationMap& map) {
    const auto& surface = std::get<grid::ModelSurface>(map.contents().surface);
    Eigen::VectorXd row = Eigen::VectorXd::Zero(surface.covariance_factor.rows());
    row[0] = -1.0;
    row[2] = 1.0;
    return (row.transpose() * surface.covariance_factor).norm();
  };
  const double before = sigma_of_spacing(fitted(made.grid));
  made.grid.readings = {
      {grid::ReadingOf::motor_spacing, "", truth.right.x_mm - truth.left.x_mm, 0.1}};
  const CompensationMap map = fitted(made.grid);
  EXPECT_LT(sigma_of_spacing(map), 0.1);  // the tape alone has that accuracy
  EXPECT_LT(sigma_of_spacing(map), before);
  const auto& motors = map.machine()->motors;
  EXPECT_NEAR(motors.right.x_mm - motors.left.x_mm, truth.right.x_mm - truth.left.x_mm,
              0.4);  // four of its sigmas
}

TEST(ResidualFit, ReportsAnAsymmetricMachine) {
  auto spec = usual_spec(6);
  spec.draw_settings = false;
  const auto symmetric = fitted(session(spec).grid);
  ASSERT_TRUE(symmetric.contents().mirror);
  EXPECT_TRUE(symmetric.contents().mirror->holds) << symmetric.contents().mirror->sentence;
  spec.offsets = {{model::Setting::motor_left_y_mm, 8.0}};
  const auto tilted = fitted(session(spec).grid);
  EXPECT_FALSE(tilted.contents().mirror->holds);
  EXPECT_THAT(tilted.contents().mirror->sentence,
              testing::HasSubstr("does not mirror the left one"));
}

TEST(ResidualFit, TakesNumbersWithoutSigmaAsExact) {
  auto spec = usual_spec(13);
  spec.sheet = grid::SheetUncertainty{0.0, 0.0};
  auto made = session(spec);
  made.grid.machine->uncertainty.motor_position_mm = 0.0;
  const CompensationMap map = fitted(made.grid);
  for (const grid::SettingResult& result : map.contents().settings) {
    if (result.setting == model::Setting::chain_zero_left_mm ||
        result.setting == model::Setting::chain_zero_right_mm) {
      continue;
    }
    EXPECT_NEAR(result.calibrated, result.stated, 1e-6);  // ten of the sigmas that count as zero
  }
}

TEST(ResidualFit, RefusesAnImpossibleReading) {
  auto grid = session(usual_spec(1)).grid;
  grid.readings = {{grid::ReadingOf::link_pitch, "left", 12.7, 0.001}};
  const auto map = grid::fit(grid);
  ASSERT_FALSE(map);
  EXPECT_EQ(map.error().reason, grid::FitFailure::Reason::impossible_readings);
  EXPECT_THAT(map.error().sentence(), testing::HasSubstr("elongation"));
}

TEST(ResidualFit, ReadingsOfOneThingCountOnceHoweverOftenTheyAreGiven) {
  auto made = session(usual_spec(1));
  made.grid.readings = {{grid::ReadingOf::link_pitch, "left", 6.355, 0.001}};
  const CompensationMap once = fitted(made.grid);
  made.grid.readings.push_back(made.grid.readings.front());
  const CompensationMap twice = fitted(made.grid);
  ASSERT_EQ(twice.machine()->effects.size(), 1u);
  EXPECT_NEAR(twice.machine()->effects[0].parameters.at("elongation"),
              once.machine()->effects[0].parameters.at("elongation"),
              1e-12);  // a mean of equal numbers
}

TEST(ResidualFit, NeedsAMachine) {
  auto grid = session(usual_spec(1)).grid;
  grid.machine.reset();
  const auto map = grid::fit(grid);
  ASSERT_FALSE(map);
  EXPECT_EQ(map.error().reason, grid::FitFailure::Reason::no_machine);
}

TEST(ResidualFit, NamesAPointThatTheMachineCannotReach) {
  auto grid = session(usual_spec(1)).grid;
  grid.points[3].mark = {0.0, 1200.0};  // above the motors
  const auto map = grid::fit(grid);
  ASSERT_FALSE(map);
  EXPECT_EQ(map.error().reason, grid::FitFailure::Reason::point_unreachable);
  EXPECT_THAT(map.error().sentence(), testing::HasSubstr("point 4 at (0.0, 1200.0)"));
}

TEST(MapFile, RoundTripsToTheByte) {
  auto spec = usual_spec(4);
  spec.sheet = grid::SheetUncertainty{};
  // Sigmas are kept to seven digits.
  testing_support::expect_round_trip(fitted(session(spec).grid));
}

TEST(QueryPoints, EqualsSingleQueries) {
  const CompensationMap map = fitted(session(usual_spec(4)).grid);
  const std::vector<model::MarkPoint> marks = {{0.0, 0.0}, {-700.0, 333.0}, {1e5, 0.0}, {0.0, 0.0}};
  std::vector<grid::MapAnswerOrFailure> answers(marks.size());
  std::vector<grid::MapLengthsOrFailure> lengths(marks.size());
  grid::query(map, marks, answers);
  grid::lengths(map, marks, lengths);
  for (std::size_t i = 0; i < marks.size(); ++i) {
    const auto alone = map.query(marks[i]);
    ASSERT_EQ(answers[i].has_value(), alone.has_value()) << i;
    ASSERT_EQ(lengths[i].has_value(), alone.has_value()) << i;
    if (!alone) {
      EXPECT_EQ(answers[i].error(), alone.error());
      continue;
    }
    EXPECT_EQ(answers[i]->lengths.left_mm, alone->lengths.left_mm);
    EXPECT_EQ(answers[i]->covariance, alone->covariance);
    EXPECT_EQ(lengths[i]->lengths.right_mm, alone->lengths.right_mm);
  }
  EXPECT_THROW(grid::query(map, marks, std::span(answers).first(3)), std::invalid_argument);
}

}  // namespace
}  // namespace chaintrue
