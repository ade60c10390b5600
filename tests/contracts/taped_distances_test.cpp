// SPDX-License-Identifier: GPL-3.0-or-later
/// Laws of distances that were taped between positions of any mechanism: four belts with a scale, and
/// a toy that no product code knows.
#include <gtest/gtest.h>

#include "grid/observation/belt_lengths.hpp"
#include "model/belts/belt_mechanism.hpp"
#include "tests/contracts/toy_mechanism.hpp"
#include "tests/support/belt_frame.hpp"

namespace chaintrue::grid::observation {
namespace {

using MechanismPtr = std::shared_ptr<const model::Mechanism>;

MechanismPtr belts() {
  const auto made =
      model::make_belt_mechanism(testing_support::stated(model::BeltLengths::belt_and_arm), 20.0,
                                 model::BeltScaleKnowledge{0.02});
  Eigen::VectorXd values = made->values();
  values[5] = 0.004;
  return made->with_values(values);
}

MechanismPtr toy() { return std::make_shared<const model::ToyMechanism>(-1000.0, 1200.0); }

/// Some way into the extent.
model::ToolPosition within(const model::Mechanism& mechanism, double x, double y) {
  const model::MechanismExtent e = mechanism.extent();
  return {e.x_min_mm + x * (e.x_max_mm - e.x_min_mm), e.y_min_mm + y * (e.y_max_mm - e.y_min_mm)};
}

AtHole hole(const model::Mechanism& mechanism, double x, double y) {
  const model::ToolPosition meant = within(mechanism, x, y);
  std::vector<bool> deciding(mechanism.lengths().size(), false);
  deciding[0] = deciding[1] = true;
  return {mechanism.predict(meant, {})->lengths_mm, deciding, meant};
}

/// Between every two kinds of ends.
std::vector<TapedDistance> distances(const model::Mechanism& mechanism) {
  const std::vector<TapeEnd> from = {AtPlace{0}, AtFixedPoint{0}, hole(mechanism, 0.2, 0.3)};
  const std::vector<TapeEnd> to = {AtPlace{1}, AtFixedPoint{1}, hole(mechanism, 0.8, 0.7)};
  std::vector<TapedDistance> all;
  for (const TapeEnd& a : from) {
    for (const TapeEnd& b : to) all.push_back({a, b, 0.0, 1.0});
  }
  return all;
}

TEST(TapedDistances, DerivativesAreThoseOfDifferences) {
  for (const MechanismPtr& mechanism : {belts(), toy()}) {
    SCOPED_TRACE(mechanism->kind());
    const std::array<model::ToolPosition, 2> places = {within(*mechanism, 0.3, 0.4),
                                                       within(*mechanism, 0.7, 0.6)};
    for (const TapedDistance& distance : distances(*mechanism)) {
      const auto line = distance_line(*mechanism, distance, places);
      ASSERT_TRUE(line);
      const auto at = [&](const model::Mechanism& other,
                          const std::array<model::ToolPosition, 2>& ends) {
        return distance_line(other, distance, ends).value().predicted_mm;
      };
      for (Eigen::Index p = 0; p < mechanism->values().size(); ++p) {
        const bool is_scale = mechanism->parameters()[static_cast<std::size_t>(p)].unit.empty();
        const double step = is_scale ? 1e-6 : 0.01;
        const Eigen::VectorXd move = step * Eigen::VectorXd::Unit(mechanism->values().size(), p);
        const double slope = (at(*mechanism->with_values(mechanism->values() + move), places) -
                              at(*mechanism->with_values(mechanism->values() - move), places)) /
                             (2.0 * step);
        // A position of a hole is found to 1e-9 mm, over the step; the scale's by metres of way.
        EXPECT_NEAR(line->by_parameter[p], slope, is_scale ? 1e-2 : 1e-6);
      }
      for (std::size_t e = 0; e < 2; ++e) {
        const bool is_place = std::holds_alternative<AtPlace>(e == 0 ? distance.from : distance.to);
        for (const int axis : {0, 1}) {
          constexpr double kStep = 0.01;
          auto up = places;
          auto down = places;
          (axis == 0 ? up[e].x_mm : up[e].y_mm) += kStep;
          (axis == 0 ? down[e].x_mm : down[e].y_mm) -= kStep;
          const double slope = (at(*mechanism, up) - at(*mechanism, down)) / (2.0 * kStep);
          // Third derivatives of metres, and rounding.
          if (is_place) {
            EXPECT_NEAR(line->by_end[e][axis], slope, 1e-8);
          }
        }
      }
    }
  }
}

TEST(TapedDistances, UnreachableOnesAreNamed) {
  const MechanismPtr mechanism = belts();
  AtHole nowhere = hole(*mechanism, 0.5, 0.5);
  nowhere.lengths_mm.head<2>().setConstant(200.0);
  const auto line = distance_line(*mechanism, {nowhere, AtFixedPoint{0}, 100.0, 1.0}, {});
  ASSERT_FALSE(line);
  EXPECT_FALSE(line.error().reason.name.empty());
}

/// Four belts at three places, two of which a tape joins.
struct Taped {
  MechanismPtr mechanism = belts();
  std::vector<LengthsAtPlace> places;
  std::vector<TapedDistance> distances;
};

Taped taped() {
  Taped set;
  std::vector<model::ToolPosition> at;
  for (const auto& [x, y] : {std::pair(0.2, 0.3), std::pair(0.6, 0.5), std::pair(0.8, 0.8)}) {
    at.push_back(within(*set.mechanism, x, y));
    LengthsAtPlace place;
    place.index = set.places.size();
    place.name = std::to_string(set.places.size() + 1);
    place.lengths_mm = set.mechanism->predict(at.back(), {})->lengths_mm;
    set.places.push_back(std::move(place));
  }
  TapedDistance distance{AtPlace{0}, AtPlace{2}, 0.0, 0.5};
  distance.distance_mm =
      distance_line(*set.mechanism, distance, {at[0], at[2]}).value().predicted_mm;
  set.distances.push_back(distance);
  return set;
}

TEST(TapedDistances, AddARowToABlockOfPlaces) {
  const Taped set = taped();
  const BeltLengthReadings alone(set.places, false, {.length_mm = 0.5}, 15.0);
  const BeltLengthReadings with(set.places, false, {.length_mm = 0.5}, 15.0, set.distances);
  EXPECT_EQ(alone.rows(), 6);
  EXPECT_EQ(with.rows(), 7);
  ASSERT_EQ(with.blocks().size(), 2U);
  const auto line = with.linearise(View(set.mechanism), columns_of(with));
  ASSERT_TRUE(line);
  // Readings equal predictions: lengths and distance agree to the accuracy of positions.
  EXPECT_LT((with.measured() - line->predicted).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(TapedDistances, AnEndWithTooFewLengthsGivesNoInformation) {
  Taped set = taped();
  set.places[2].counting = {true, false, false, false};
  const BeltLengthReadings with(set.places, false, {.length_mm = 0.5}, 15.0, set.distances);
  EXPECT_EQ(with.rows(), 4);
}

TEST(TapedDistances, ToAKnownPositionThrow) {
  const Taped set = taped();
  const model::ToolPosition given = within(*set.mechanism, 0.8, 0.8);
  std::vector<LengthsAtPlace> known = set.places;
  known[2].known = given;
  EXPECT_THROW(BeltLengthReadings(known, false, {.length_mm = 0.5}, 15.0, set.distances),
               std::invalid_argument);
  std::vector<LengthsAtPlace> about = set.places;
  about[2].about = given;
  EXPECT_THROW(BeltLengthReadings(about, false, {.length_mm = 0.5}, 15.0, set.distances),
               std::invalid_argument);
}

/// The change of whitened residuals if each place is linearised about a position some millimetres
/// from the one by its lengths.
double change_about(const Taped& set, double off_mm) {
  std::vector<LengthsAtPlace> moved = set.places;
  for (LengthsAtPlace& place : moved) {
    place.lengths_mm[2] += 2.0;
    const model::ToolPosition at = *set.mechanism->locate(place.lengths_mm, place.visit);
    place.about = {at.x_mm + 0.6 * off_mm, at.y_mm - 0.8 * off_mm};
  }
  std::vector<LengthsAtPlace> found = moved;
  for (LengthsAtPlace& place : found) place.about.reset();
  const auto squares = [&](const std::vector<LengthsAtPlace>& places) {
    const BeltLengthReadings readings(places, false, {.length_mm = 0.5}, 15.0);
    const auto line = readings.linearise(View(set.mechanism), columns_of(readings));
    Eigen::VectorXd lengths(static_cast<Eigen::Index>(readings.units().size()));
    for (const Unit& unit : readings.units()) {
      const auto own = line.value().predicted.segment(unit.first_row, unit.rows);
      lengths[static_cast<Eigen::Index>(&unit - readings.units().data())] = own.norm();
    }
    return lengths;
  };
  return (squares(moved) - squares(found)).cwiseAbs().maxCoeff();
}

TEST(GivenPositions, ChangeTheResidualsToSecondOrderOnly) {
  const Taped set = taped();
  const double near = change_about(set, 2.0);
  EXPECT_GT(near, 0.0);
  EXPECT_LT(
      near,
      0.02);  // 2 mm squared over a metre of belt, a few times for lengths of different directions
  // A quarter of a second-order error is left at half the way; higher orders are 2 mm over a metre.
  EXPECT_NEAR(change_about(set, 1.0) / near, 0.25, 0.02);
}

}  // namespace
}  // namespace chaintrue::grid::observation
