// SPDX-License-Identifier: GPL-3.0-or-later
// The fit to distances: left-out predictions compared with refits, the truth recovered without noise,
// bad readings named.
#include <gmock/gmock.h>

#include <cmath>

#include "grid/map/joint_fit.hpp"
#include "model/calibration/setting.hpp"
#include "tests/holes/hole_sets.hpp"

namespace chaintrue::grid {
namespace {

using testing::HasSubstr;
using testing_support::classic;
using testing_support::cut_holes;
using testing_support::nine_holes;
using testing_support::usual_holes;

/// Nine holes with each edge measured from two of them.
MeasuredHoles with_edges() {
  MeasuredHoles set = nine_holes();
  for (const SheetEdge edge : kSheetEdges) {
    for (const std::size_t hole : {std::size_t{0}, std::size_t{8}}) {
      set.distances.push_back({.from = hole, .edge = edge});
      set.distances.back().distance_mm = commanded_mm(set, set.distances.back());
    }
  }
  return set;
}

double spacing(const model::Machine& machine) {
  return machine.motors.right.x_mm - machine.motors.left.x_mm;
}

TEST(HoleDistances, HolesAreWhereTheirChainsPutThem) {
  // Cut by a machine exactly as stated, the distances are the commanded ones.
  const auto distances = observation::TapeDistances::of(with_edges());
  const auto predicted = distances->predicted({model::ReadingModel(classic()), {}});
  ASSERT_TRUE(predicted);
  // The inverse converges to 1e-9 mm.
  EXPECT_LT((distances->measured() - *predicted).cwiseAbs().maxCoeff(), 1e-7);
}

TEST(HolesFit, RecoversTheTruthWithoutNoise) {
  MeasuredHoles design = nine_holes();
  design.hole_sigma_mm = 0.0;
  auto made = synthetic::simulate_holes(design, usual_holes(5));
  ASSERT_TRUE(made);
  // Readings to all digits, and a fit with that noise.
  const observation::DistanceGeometry exact = observation::distance_geometry(design, made->places);
  for (std::size_t k = 0; k < made->set.distances.size(); ++k)
    made->set.distances[k].distance_mm = exact.predicted_mm[static_cast<Eigen::Index>(k)];
  made->set.tape.sigma_mm = 0.001;
  made->set.noise_dof = 1e9;
  const auto fit = joint_fit(made->set);
  ASSERT_TRUE(fit);
  for (const FittedDistance& distance : fit->distances.front().distances)
    EXPECT_NEAR(distance.measured_mm, distance.predicted_mm, 0.005) << "some sigmas of 0.001 mm";
  EXPECT_NEAR(spacing(fit->estimate.machine), spacing(made->truth), 0.1);
  for (const std::size_t side : {0u, 1u}) {
    const double elongation = made->truth.effects[side].parameters.at("elongation");
    const auto scale = static_cast<Eigen::Index>(6 + side);
    // A tenth of a millimetre of 3 m, as for the spacing.
    EXPECT_NEAR(fit->estimate.knowledge.mean[scale], 1.0 / (1.0 + elongation) - 1.0, 3e-5);
  }
}

TEST(HolesFit, TheSheetIsFoundFromItsEdges) {
  MeasuredHoles design = with_edges();
  design.sheet.size_sigma_mm = 0.2;
  auto made = synthetic::simulate_holes(design, usual_holes(7));
  ASSERT_TRUE(made);
  // With the sheet displaced, the positions on it are those of the bed, moved back.
  const model::SheetPlacement laid{7.0, -4.0, 0.006};
  std::vector<model::MarkPoint> marks;
  for (const model::MarkPoint& place : made->places)
    marks.push_back(laid.to_mark(model::identity_placement(place)));
  const observation::DistanceGeometry on_sheet = observation::distance_geometry(design, marks);
  for (std::size_t k = 20; k < made->set.distances.size(); ++k)
    made->set.distances[k].distance_mm = on_sheet.predicted_mm[static_cast<Eigen::Index>(k)];
  const auto fit = joint_fit(made->set);
  ASSERT_TRUE(fit);
  for (std::size_t i = 0; i < marks.size(); ++i) {
    // The tape's 0.5 mm at two readings an edge, four sigmas.
    EXPECT_NEAR(fit->distances.front().holes[i].place.x_mm, marks[i].x_mm, 1.5);
    EXPECT_NEAR(fit->distances.front().holes[i].place.y_mm, marks[i].y_mm, 1.5);
  }
}

TEST(HolesFit, ALargerSheetMovesEachEdgeByHalfTheDifference) {
  MeasuredHoles set = with_edges();
  set.sheet.width_mm = 2440.0;
  set.sheet.height_mm = 1220.0;
  const auto places = synthetic::simulate_holes(set, usual_holes(7))->places;
  const observation::DistanceGeometry as_said = observation::distance_geometry(set, places);
  for (const auto& [size, axis] :
       {std::pair(&set.sheet.width_mm, 0), std::pair(&set.sheet.height_mm, 1)}) {
    constexpr double kLarger = 2.0;
    **size += kLarger;
    const Eigen::VectorXd moved =
        observation::distance_geometry(set, places).predicted_mm - as_said.predicted_mm;
    **size -= kLarger;
    ASSERT_GT(moved.norm(), 0.0);
    // It is linear: the remainder is rounding of metres.
    EXPECT_LT((moved - kLarger * as_said.by_size.col(axis)).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(HolesFit, PlacesAFreeSheetByTheCommandedHoles) {
  const auto made = cut_holes(11);
  const auto fit = joint_fit(made.set);
  ASSERT_TRUE(fit);
  double x = 0.0;
  double y = 0.0;
  double turn = 0.0;
  for (std::size_t i = 0; i < fit->distances.front().holes.size(); ++i) {
    const model::MarkPoint at = fit->distances.front().holes[i].predicted;
    const model::BedPoint wanted = made.set.holes[i].commanded;
    x += at.x_mm - wanted.x_mm;
    y += at.y_mm - wanted.y_mm;
    turn += wanted.x_mm * (at.y_mm - wanted.y_mm) - wanted.y_mm * (at.x_mm - wanted.x_mm);
  }
  // Sums over nine holes; the last iteration moved less than 1e-3 sigmas.
  EXPECT_NEAR(x, 0.0, 0.02);
  EXPECT_NEAR(y, 0.0, 0.02);
  EXPECT_NEAR(turn / 1e6, 0.0, 0.02);
}

TEST(HolesFit, LeftOutPredictionEqualsAFitWithoutTheReading) {
  MeasuredHoles design = nine_holes();
  design.hole_sigma_mm = 0.0;  // so that a hole's own error does not correlate readings
  design.noise_dof = 1e9;      // so that the noise is not estimated again
  design.tape.sigma_mm = 2.0;  // and no reading is an outlier
  design.tape.tape_zero_offset_sigma_mm =
      0.0;  // so that the distance of two holes is what is predicted
  MeasuredHoles quiet = design;
  quiet.tape.sigma_mm = 0.5;
  auto made = synthetic::simulate_holes(quiet, usual_holes(13));
  made->set.tape.sigma_mm = 2.0;
  const auto whole = joint_fit(made->set);
  ASSERT_TRUE(whole);
  for (std::size_t k = 0; k < made->set.distances.size(); k += 5) {
    MeasuredHoles without = made->set;
    without.distances.erase(without.distances.begin() + static_cast<std::ptrdiff_t>(k));
    const auto fit = joint_fit(without);
    ASSERT_TRUE(fit);
    const auto distance = made->set.distances[k];
    const model::MarkPoint a = fit->distances.front().holes[distance.from].predicted;
    const model::MarkPoint b = fit->distances.front().holes[distance.to].predicted;
    const double predicted = std::hypot(a.x_mm - b.x_mm, a.y_mm - b.y_mm);
    // The two differ by the curvature of the model over the change by one reading, a few 1e-3 mm.
    EXPECT_NEAR(whole->distances.front().distances[k].left_out_mm, distance.distance_mm - predicted,
                0.01);
  }
}

TEST(HolesFit, NamesABadReadingAndRejectsIt) {
  auto made = cut_holes(1);
  made.set.distances[1].distance_mm -= 10.0;
  const auto fit = joint_fit(made.set);
  ASSERT_TRUE(fit) << "seed 1";
  for (std::size_t k = 0; k < fit->distances.front().distances.size(); ++k)
    EXPECT_EQ(fit->distances.front().distances[k].rejected, k == 1) << "seed 1, distance " << k;
  EXPECT_THAT(fit->map.contents().notes.front(),
              testing::AllOf(HasSubstr(words_of(made.set, made.set.distances[1])),
                             HasSubstr("shorter than the others predict")));
}

TEST(HolesFit, ReportsAForgottenHookOffsetIfTheFitFails) {
  MeasuredHoles design = nine_holes();
  design.tape.tape_zero_offset_mm = 40.0;
  auto made = synthetic::simulate_holes(design, usual_holes(3));
  EXPECT_TRUE(joint_fit(made->set)) << "stated, it does no harm";
  made->set.tape.tape_zero_offset_mm = 0.0;
  const auto fit = joint_fit(made->set);
  const std::string words =
      fit ? testing::PrintToString(fit->map.contents().notes) : fit.error().sentence();
  EXPECT_THAT(words, HasSubstr("hook offset"));
}

TEST(HolesFit, MapRoundTripsAndEqualsTheFittedMachine) {
  const auto made = cut_holes(21);
  const auto fit = joint_fit(made.set);
  const CompensationMap map = fit->map;
  for (const FittedHole& hole : fit->distances.front().holes) {
    const auto answer = map.query(hole.predicted);
    ASSERT_TRUE(answer);
    // At the fitted machine's position of a hole the map's lengths are those that were paid out;
    // the last iteration moved the settings by less than 1e-3 sigmas.
    EXPECT_NEAR(answer->lengths.left_mm, hole.lengths.left_mm, 0.01);
    EXPECT_NEAR(answer->lengths.right_mm, hole.lengths.right_mm, 0.01);
  }
  testing_support::expect_round_trip(map);
}

TEST(HolesFit, ThrowsOnBrokenPreconditions) {
  MeasuredHoles set = nine_holes();
  set.distances.clear();
  EXPECT_THROW((void)joint_fit(set), std::invalid_argument);
  set = nine_holes();
  set.machine.reset();
  EXPECT_EQ(joint_fit(set).error().reason, FitFailure::Reason::no_machine);
  EXPECT_THROW((void)observation::TapeDistances::in_given_order(set), std::invalid_argument);
}

// A taped motor spacing is a reading of the machine, for holes as for a grid.
TEST(HolesFit, AReadingOfTheMotorSpacingMovesTheMotors) {
  MeasuredHoles set = cut_holes(5).set;
  const double without_mm = spacing(joint_fit(set)->estimate.machine);
  for (const double other_mm : {-10.0, 10.0}) {
    set.readings = {{ReadingOf::motor_spacing, "", without_mm + other_mm, 0.01}};
    const auto fit = joint_fit(set);
    ASSERT_TRUE(fit) << fit.error().sentence();
    // 0.01 mm of the reading against 1 mm of the distances: a thousandth of the difference remains,
    // plus the effect of ten millimetres on the estimated noise.
    EXPECT_NEAR(spacing(fit->estimate.machine), without_mm + other_mm, 0.1);
    const auto together = joint_fit({{"first", set}, {"second", nine_holes()}});
    ASSERT_TRUE(together) << together.error().sentence();
    EXPECT_NEAR(spacing(together->estimate.machine), without_mm + other_mm, 0.1);
  }
}

TEST(HolesFit, ReportsImpossibleReadings) {
  MeasuredHoles set = nine_holes();
  set.readings = {{ReadingOf::sled_mass, "", -1.0, 0.1}};
  const auto fit = joint_fit(set);
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().reason, FitFailure::Reason::impossible_readings);
  EXPECT_THAT(fit.error().sentence(), HasSubstr("with the set's readings put in, "));
}

TEST(HolesFit, ReportsAHoleOutOfReach) {
  MeasuredHoles set = nine_holes();
  set.holes[0] = {"Z", {0.0, 1500.0}};
  const auto fit = joint_fit(set);
  ASSERT_FALSE(fit);
  EXPECT_THAT(fit.error().sentence(),
              HasSubstr("the controller cannot reach hole Z at (0.0, 1500.0)"));
  const auto distances = observation::TapeDistances::of(set);
  ASSERT_FALSE(distances);
  EXPECT_EQ(distances.error(), fit.error().sentence());
}

}  // namespace
}  // namespace chaintrue::grid
