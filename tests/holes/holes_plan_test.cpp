// SPDX-License-Identifier: GPL-3.0-or-later
// Plans of holes: a fit reaches the predicted accuracy, plans are better than a lattice, and rounds
// converge.
#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "grid/estimation/estimate.hpp"
#include "grid/map/joint_fit.hpp"
#include "grid/planning/holes_plan.hpp"
#include "tests/holes/hole_sets.hpp"

namespace chaintrue::grid {
namespace {

using testing::HasSubstr;
using testing_support::classic;

TEST(HolesPlan, HasTheRequestedHolesAndDistancesOnTheSheet) {
  const auto plan = plan_holes(classic(), {.holes = 9, .distances = 20});
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->set.holes.size(), 9u);
  EXPECT_EQ(plan->set.distances.size(), 20u);
  std::set<std::pair<std::size_t, std::size_t>> pairs;
  for (const HoleDistance& distance : plan->set.distances) {
    EXPECT_LT(distance.from, distance.to);
    EXPECT_TRUE(pairs.insert({distance.from, distance.to}).second) << "twice";
    EXPECT_DOUBLE_EQ(distance.distance_mm, commanded_mm(plan->set, distance));
  }
  for (const Hole& hole : plan->set.holes) {
    EXPECT_LE(std::abs(hole.commanded.x_mm), 0.5 * classic().bed.width_mm - 50.0);
    EXPECT_LE(std::abs(hole.commanded.y_mm), 0.5 * classic().bed.height_mm - 50.0);
  }
}

TEST(HolesPlan, PredictsTheErrorOfAFit) {
  const auto plan = plan_holes(classic(), {.holes = 9, .distances = 20});
  const auto made = synthetic::simulate_holes(plan->set, testing_support::usual_holes(2));
  const auto fit = joint_fit(made->set);
  ASSERT_TRUE(fit);
  const double reached = tool_sigma_mm(classic(), fit->estimate.knowledge.covariance);
  // The fit is linear about the true machine and uses the noise that it estimates with 15 degrees
  // of freedom: a fifth either way.
  EXPECT_NEAR(reached / plan->expected_rms_mm, fit->estimate.noise_factor, 0.2);
}

TEST(HolesPlan, WithEdgesTheSheetsPlaceIsMeasured) {
  const HolesPlanRequest request{.holes = 9, .edges = true};
  const auto plan = plan_holes(classic(), request);
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->set.distances.size(), 24u);
  const observation::SheetPrior measured = observation::sheet_measured(plan->set);
  EXPECT_TRUE(measured.knows_x && measured.knows_y && measured.knows_rotation);
  std::set<std::tuple<std::size_t, std::size_t, std::optional<SheetEdge>>> readings;
  for (const HoleDistance& distance : plan->set.distances) {
    EXPECT_TRUE(readings.insert({distance.from, distance.to, distance.edge}).second) << "twice";
    EXPECT_DOUBLE_EQ(distance.distance_mm, commanded_mm(plan->set, distance));
    if (distance.edge) {
      EXPECT_LE(distance.distance_mm, 1000.0) << "held square by eye";
    }
  }
  // Unknowns that a fit without edges cannot determine are known to the tape's accuracy.
  const auto known = [&plan](std::string_view what) {
    return std::find_if(plan->knowledge.begin(), plan->knowledge.end(),
                        [&](const auto& one) { return one.name == what; });
  };
  for (const char* what : {"the whole job, sideways", "the whole job, up or down"}) {
    ASSERT_NE(known(what), plan->knowledge.end());
    EXPECT_GE(known(what)->before, 50.0) << what;
    EXPECT_LE(known(what)->after, 1.0) << what;
  }
  EXPECT_LE(known("the whole job, turned")->after, 0.5) << "mm per metre";
}

TEST(HolesPlan, OmitsTheSheetsPlaceWithoutEdges) {
  const auto plan = plan_holes(classic(), {.holes = 9});
  ASSERT_TRUE(plan);
  for (const PlannedKnowledge& known : plan->knowledge)
    EXPECT_THAT(known.name, testing::Not(HasSubstr("whole job")));
}

TEST(HolesPlan, FewerEdgeDistancesRaiseTheError) {
  // The tool's whole error includes the part that remains for the best placement of the sheet.
  const double whole = plan_holes(classic(), {.holes = 9, .edges = true})->expected_rms_mm;
  const double shape = plan_holes(classic(), {.holes = 9, .distances = 24})->expected_rms_mm;
  EXPECT_GT(whole, shape);
}

TEST(HolesPlan, BeatsALatticeOfTheSameSize) {
  const HolesPlanRequest request{.holes = 9, .distances = 20};
  const auto plan = plan_holes(classic(), request);
  MeasuredHoles lattice;
  lattice.machine = classic();
  for (const double y : {500.0, 0.0, -500.0}) {
    for (const double x : {-1100.0, 0.0, 1100.0})
      lattice.holes.push_back({std::to_string(lattice.holes.size()), {x, y}});
  }
  // Neighbours, and the long diagonals.
  for (std::size_t a = 0; a < 9; ++a) {
    for (std::size_t b = a + 1; b < 9 && lattice.distances.size() < 20; ++b) {
      if (b == a + 1 || b == a + 3 || b == a + 4 || a + b == 8) {
        lattice.distances.push_back({.from = a, .to = b});
        lattice.distances.back().distance_mm = commanded_mm(lattice, lattice.distances.back());
      }
    }
  }
  const auto fit = joint_fit(lattice);
  ASSERT_TRUE(fit);
  EXPECT_LT(plan->expected_rms_mm, tool_sigma_mm(classic(), fit->estimate.knowledge.covariance) /
                                       fit->estimate.noise_factor);
}

TEST(HolesPlan, MoreDistancesAndABetterTapeReduceTheError) {
  const double twelve = plan_holes(classic(), {.holes = 9, .distances = 12})->expected_rms_mm;
  const double twenty = plan_holes(classic(), {.holes = 9, .distances = 20})->expected_rms_mm;
  const double fine =
      plan_holes(classic(), {.holes = 9, .distances = 20, .tape_sigma_mm = 0.2})->expected_rms_mm;
  EXPECT_LT(twenty, twelve);
  EXPECT_LT(fine, twenty);
}

TEST(HolesPlan, ListsTheEffectsItCanDetect) {
  const std::vector<DetectableEffect> found = detectable_effects(testing_support::nine_holes());
  const auto find = [&found](std::string_view effect, std::string_view side) {
    return std::find_if(found.begin(), found.end(), [&](const DetectableEffect& one) {
      return one.effect == effect && one.side == side;
    });
  };
  // 0.1 % of two metres is 2 mm on a tape of half a millimetre.
  ASSERT_NE(find("chain_pitch_error", "both"), found.end());
  EXPECT_GT(find("chain_pitch_error", "both")->sigmas, 3.0);
  // A tape is insensitive to effects of the visit and of the paper.
  EXPECT_EQ(find("drift", "left"), found.end());
  EXPECT_EQ(find("tape_scale", "both"), found.end());
}

TEST(HolesPlan, ExcludesTheSheetsPlaceFromTheEffects) {
  // The sheet's placement is free: three readings to its edges determine it, and make no other
  // effect observable, however far an effect moves or rotates all holes together.
  MeasuredHoles between = testing_support::nine_holes();
  const auto sigmas_of = [](const MeasuredHoles& set) {
    std::map<std::pair<std::string, std::string>, double> sigmas;
    for (const DetectableEffect& one : detectable_effects(set))
      sigmas[{one.effect, one.side}] = one.sigmas;
    return sigmas;
  };
  MeasuredHoles placed = between;
  placed.sheet.size_sigma_mm = 0.0;
  for (const std::size_t hole : {std::size_t{0}, std::size_t{8}})
    placed.distances.push_back({.from = hole, .edge = SheetEdge::left});
  placed.distances.push_back({.from = 0, .edge = SheetEdge::top});
  const auto before = sigmas_of(between);
  for (const auto& [effect, sigmas] : sigmas_of(placed)) {
    // Three readings determine the sheet's placement and no more; priors of 50 mm and 30 mrad are
    // nearly free.
    EXPECT_NEAR(sigmas, before.at(effect), 0.01 * std::max(1.0, sigmas)) << effect.first;
  }
}

TEST(HolesPlan, NumbersOutOfRangeThrow) {
  EXPECT_THROW((void)plan_holes(classic(), {.holes = 3}), std::invalid_argument);
  EXPECT_THROW((void)plan_holes(classic(), {.holes = 9, .distances = 7, .edges = true}),
               std::invalid_argument)
      << "fewer than the unknowns of machine and sheet";
  EXPECT_THROW((void)plan_holes(classic(), {.holes = 9, .margin_mm = 700.0}),
               std::invalid_argument);
}

}  // namespace
}  // namespace chaintrue::grid
