// SPDX-License-Identifier: GPL-3.0-or-later
// A machine file may contain effects of the paper and of the visit: they are removed from the data,
// once, and no map over the bed includes them.
#include "grid/map/corrected_data.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "grid/synthetic/generator.hpp"
#include "model/reading_model.hpp"

namespace chaintrue::grid {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

const std::vector<model::AppliedEffect> kOfThePaper = {{"tape_scale", "x", {{"scale", 0.0008}}},
                                                       {"axes_skew", "", {{"angle_rad", 0.001}}}};
const std::vector<model::AppliedEffect> kOfTheVisit = {
    {"direction_hysteresis", "left", {{"half_width_mm", 0.6}}},
    {"drift", "right", {{"rate_mm_per_visit", 0.05}}},
    {"tooth_skip", "left", {{"links", 1.0}, {"first_visit", 20.0}}},
    {"link_miscount", "right", {{"links", -1.0}, {"visit", 7.0}}},
    {"zero_shift", "right", {{"shift_mm", -4.5}, {"first_visit", 12.0}}}};
const std::vector<model::AppliedEffect> kOfTheMachine = {
    {"chain_stretch", "", {{"compliance_per_n", 4e-6}}},
    {"chain_pitch_error", "left", {{"elongation", 0.001}}}};

model::Machine machine_with(const std::vector<std::vector<model::AppliedEffect>>& lists) {
  model::Machine machine;
  for (const auto& list : lists)
    machine.effects.insert(machine.effects.end(), list.begin(), list.end());
  return machine;
}

/// A session without noise on a machine with these effects; the grid's machine is that machine.
synthetic::SyntheticSession session(const model::Machine& machine) {
  synthetic::SyntheticSpec spec;
  spec.design.columns = 7;
  spec.design.rows = 4;
  spec.order = synthetic::VisitingOrder::serpentine_rows;
  spec.noise = {};
  spec.noise.length_mm = 0.0;
  spec.noise.position_mm = 0.0;
  return synthetic::generate(machine, spec).value();
}

// The truth is the generator's: the tool's position, and the repeatable reading there.
TEST(CorrectedData, EqualTruePlacesAndRepeatableReadings) {
  const auto measured = session(machine_with({kOfThePaper, kOfTheMachine, kOfTheVisit}));
  const auto corrected = corrected_data(measured.grid);
  ASSERT_TRUE(corrected) << corrected.error().sentence();
  const model::ReadingModel repeatable(machine_with({kOfTheMachine}));
  double largest_taken_out_mm = 0.0;
  for (std::size_t i = 0; i < measured.grid.points.size(); ++i) {
    const MeasuredPoint& point = corrected->grid.points[i];
    const model::BedPoint place = measured.answer.places[i];
    EXPECT_NEAR(point.mark.x_mm, place.x_mm, 1e-9) << i;  // an affine map and its inverse
    EXPECT_NEAR(point.mark.y_mm, place.y_mm, 1e-9) << i;
    const model::ChainLengths expected = repeatable.at(place).value().lengths;
    // Readings are written to 1e-9 mm relative to 4 m of chain, the tolerance of the equilibrium.
    EXPECT_NEAR(point.lengths->left_mm, expected.left_mm, 1e-6) << i;
    EXPECT_NEAR(point.lengths->right_mm, expected.right_mm, 1e-6) << i;
    largest_taken_out_mm =
        std::max(largest_taken_out_mm,
                 std::abs(measured.grid.points[i].lengths->left_mm - expected.left_mm));
  }
  EXPECT_GT(largest_taken_out_mm, 6.0);  // the skipped link: the correction is not zero
  EXPECT_EQ(corrected->notes.size(), 2U);
}

TEST(CorrectedData, AreCorrectedOnce) {
  const auto measured = session(machine_with({kOfThePaper, kOfTheMachine, kOfTheVisit}));
  const auto once = corrected_data(measured.grid);
  ASSERT_TRUE(once);
  const auto twice = corrected_data(once->grid);
  ASSERT_TRUE(twice);
  EXPECT_TRUE(twice->notes.empty());
  for (std::size_t i = 0; i < once->grid.points.size(); ++i) {
    EXPECT_EQ(twice->grid.points[i].mark.x_mm, once->grid.points[i].mark.x_mm);
    EXPECT_EQ(twice->grid.points[i].lengths->left_mm, once->grid.points[i].lengths->left_mm);
  }
  EXPECT_EQ(once->grid.machine->effects.size(), kOfTheMachine.size());
}

TEST(CorrectedData, EqualTheDataWithoutSuchEffects) {
  const auto measured = session(machine_with({kOfTheMachine}));
  const auto corrected = corrected_data(measured.grid);
  ASSERT_TRUE(corrected);
  EXPECT_TRUE(corrected->notes.empty());
  for (std::size_t i = 0; i < measured.grid.points.size(); ++i)
    EXPECT_EQ(corrected->grid.points[i].lengths->left_mm, measured.grid.points[i].lengths->left_mm);
}

TEST(CorrectedData, ReportEffectsThatNeedTheOrder) {
  auto measured = session(machine_with({kOfTheVisit}));
  for (MeasuredPoint& point : measured.grid.points) point.order.reset();
  const auto corrected = corrected_data(measured.grid);
  ASSERT_TRUE(corrected);
  EXPECT_THAT(corrected->notes,
              Contains(HasSubstr("could not be removed from the readings: the order")));
  EXPECT_EQ(corrected->grid.points[3].lengths->left_mm, measured.grid.points[3].lengths->left_mm);
}

// docs/effects.md: what a tape reads over the true distance is 1 + scale; its zero offset is no part of it.
TEST(CorrectedData, ATapeThatReadsLongIsShortened) {
  MeasuredHoles set;
  set.machine = machine_with({{{"tape_scale", "both", {{"scale", 0.001}}}}});
  set.tape.tape_zero_offset_mm = 100.0;
  set.distances.resize(1);
  set.distances[0].distance_mm = 100.0 + 2002.0;
  const MeasuredHoles corrected = with_true_tape(set);
  EXPECT_NEAR(corrected.distances[0].distance_mm, 100.0 + 2000.0, 1e-9);  // rounding of 2 m
  EXPECT_TRUE(corrected.machine->effects.empty());
}

// The map of a machine with stated drift, skip and hysteresis equals that of one without.
TEST(FitOnAnExtendedMachine, PutsNoEffectOfTheVisitOrThePaperIntoTheMap) {
  const auto disturbed = session(machine_with({kOfThePaper, kOfTheMachine, kOfTheVisit}));
  const auto clean = session(machine_with({kOfTheMachine}));
  const auto map = fit(disturbed.grid);
  const auto clean_map = fit(clean.grid);
  ASSERT_TRUE(map) << map.error().sentence();
  ASSERT_TRUE(clean_map);
  for (const model::MarkPoint place :
       {model::MarkPoint{0.0, 0.0}, model::MarkPoint{-900.0, 400.0},
        model::MarkPoint{730.0, -410.0}, model::MarkPoint{1100.0, 500.0}}) {
    const auto answer = map->query(place);
    const auto clean_answer = clean_map->query(place);
    ASSERT_TRUE(answer);
    ASSERT_TRUE(clean_answer);
    // Both maps are fitted to the same numbers up to rounding.
    EXPECT_NEAR(answer->lengths.left_mm, clean_answer->lengths.left_mm, 1e-5);
    EXPECT_NEAR(answer->lengths.right_mm, clean_answer->lengths.right_mm, 1e-5);
  }
  EXPECT_THAT(map->contents().notes, Contains(HasSubstr("drift right")));
  ASSERT_NE(map->machine(), nullptr);
  for (const model::AppliedEffect& effect : map->machine()->effects)
    EXPECT_TRUE(effect.effect == "chain_stretch" || effect.effect == "chain_pitch_error");
}

// The machine file's effects of the machine itself are used: nothing remains for the surface.
TEST(FitOnAnExtendedMachine, UsesItsEffects) {
  const auto measured = session(machine_with({kOfTheMachine}));
  MeasuredGrid plain = measured.grid;
  plain.machine->effects.clear();
  const auto leftover = [](const MeasuredGrid& grid) {
    const auto map = fit(grid);
    double largest_mm = 0.0;
    for (const MapPoint& point : map.value().contents().points)
      largest_mm = std::max(largest_mm, point.sheet_placed_mm.norm());
    return largest_mm;
  };
  EXPECT_LT(leftover(measured.grid), 1e-4);  // the machine is exactly the one that was read
  EXPECT_GT(leftover(plain), 1.0);
}

}  // namespace
}  // namespace chaintrue::grid
