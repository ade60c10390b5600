// SPDX-License-Identifier: GPL-3.0-or-later
/// Anchors by the estimator: at the minimum of the sum of squares, from any start.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "grid/belts/anchor_estimate.hpp"
#include "grid/belts/belts_fit.hpp"
#include "grid/files/belts_file.hpp"
#include "grid/files/whole_file.hpp"
#include "model/belts/belt_kinematics.hpp"
#include "tests/belts/published_readings.hpp"
#include "tests/belts/simulated_belts.hpp"

namespace chaintrue::grid {
namespace {

using model::Belt;
using model::kBelts;

struct NamedSet {
  std::string name;
  MeasuredBelts belts;
};

std::vector<NamedSet> simulated_sets() {
  std::vector<NamedSet> sets;
  for (const auto lengths :
       {model::BeltLengths::belt, model::BeltLengths::belt_and_arm, model::BeltLengths::span}) {
    for (const bool known : {true, false}) {
      sets.push_back({fmt::format("{}_{}", name(lengths), known ? "known" : "unknown"),
                      simulate({.seed = 41, .anchors_known = known, .lengths = lengths}).belts});
    }
  }
  sets.push_back({"few_places", simulate({.seed = 7, .columns = 3, .rows = 2}).belts});
  NamedSet bad{"bad_readings", with_four_bad_readings(11).belts};
  bad.belts.points[40].lengths_mm.tl += 60.0;
  bad.belts.points[40].lengths_mm.bl += 35.0;
  sets.push_back(bad);
  NamedSet gross{"gross_point", simulate({.seed = 12, .columns = 5, .rows = 5}).belts};
  gross.belts.points[7].lengths_mm.tl += 300.0;
  gross.belts.points[7].lengths_mm.tr += 250.0;
  gross.belts.points[7].lengths_mm.bl -= 200.0;
  sets.push_back(gross);
  NamedSet taped{"taped", simulate({.seed = 14}).belts};
  const auto tape = [](BeltEnd from, BeltEnd to, double mm, double sigma) {
    return BeltDistance{from, to, mm, sigma};
  };
  const auto places = fit_belts(taped.belts).value().places;
  const auto apart = [&](std::size_t a, std::size_t b) {
    return std::hypot(places[a].at.x_mm - places[b].at.x_mm, places[a].at.y_mm - places[b].at.y_mm);
  };
  taped.belts.distances.push_back(tape(std::size_t{0}, std::size_t{80}, 1.004 * apart(0, 80), 1.0));
  sets.push_back(taped);
  taped.name = "taped_chain";
  taped.belts.distances.push_back(
      tape(std::size_t{8}, std::size_t{80}, 1.004 * apart(8, 80) + 0.7, 0.5));
  taped.belts.distances.push_back(
      tape(std::size_t{20}, std::size_t{60}, 1.004 * apart(20, 60) - 0.6, 0.8));
  taped.belts.distances.push_back(
      tape(model::Belt::bl, std::size_t{60},
           1.004 * std::hypot(places[60].at.x_mm, places[60].at.y_mm) + 0.3, 1.0));
  sets.push_back(taped);
  return sets;
}

std::vector<NamedSet> every_set() {
  std::vector<NamedSet> all = simulated_sets();
  all.push_back({"thirty_one", files::read(files::parse_belts, std::string(CHAINTRUE_FIXTURES) +
                                                                   "/belts/lower_belts_short.json")
                                   .belts});
  for (const auto& [file, runs] : {std::pair("concrete_anchors.txt", 1),
                                   {"frame_rebuilt.txt", 1},
                                   {"mini_frame.txt", 1},
                                   {"ten_runs_1_to_5.txt", 5},
                                   {"clbm_2026-01.txt", 1}}) {
    for (int run = 1; run <= runs; ++run) {
      if (const auto read = testing_support::published_readings(file, run))
        all.push_back({fmt::format("{}_{}", file, run), read->belts});
    }
  }
  return all;
}

/// Slopes of half the sum of squares by each anchor coordinate, and the steepest by a place.
struct Slopes {
  Eigen::Matrix<double, 5, 1> by_anchor = Eigen::Matrix<double, 5, 1>::Zero();
  double by_place = 0.0;
};

/// By independent formulas: the derivative of a printed length by its anchor is minus that by its
/// place.
Slopes slopes_at(const MeasuredBelts& measured, const BeltsFit& fit) {
  const auto column_of = [](Belt belt) -> Eigen::Index {
    return belt == Belt::tl ? 0 : belt == Belt::tr ? 2 : belt == Belt::br ? 4 : -1;
  };
  Slopes slopes;
  std::vector<Eigen::Vector2d> by_place(measured.points.size(), Eigen::Vector2d::Zero());
  const auto add = [&](Belt belt, const Eigen::Vector2d& slope) {
    const Eigen::Index column = column_of(belt);
    if (column < 0) return;
    slopes.by_anchor[column] += slope.x();
    if (belt != Belt::br) slopes.by_anchor[column + 1] += slope.y();
  };
  const double variance = fit.residual_sigma_mm * fit.residual_sigma_mm;
  for (std::size_t k = 0; k < measured.points.size(); ++k) {
    for (const Belt belt : kBelts) {
      if (!fit.places[k].belts[belt].counts) continue;
      const auto read = model::reading_at(fit.machine, belt, fit.places[k].at);
      const double left = (measured.points[k].lengths_mm[belt] - read->length_mm) / variance;
      by_place[k] += left * read->by_place.transpose();
      add(belt, -left * read->by_place.transpose());
    }
  }
  for (const BeltDistance& distance : measured.distances) {
    const auto at = [&](const BeltEnd& end) -> Eigen::Vector2d {
      if (const auto* point = std::get_if<std::size_t>(&end))
        return {fit.places[*point].at.x_mm, fit.places[*point].at.y_mm};
      const model::Anchor& anchor = fit.machine.anchors[std::get<Belt>(end)];
      return {anchor.x_mm, anchor.y_mm};
    };
    const Eigen::Vector2d way = at(distance.to) - at(distance.from);
    const double left = (distance.distance_mm - fit.scale->factor * way.norm()) /
                        (distance.sigma_mm * distance.sigma_mm);
    const Eigen::Vector2d slope = left * fit.scale->factor * way.normalized();
    for (const auto& [end, sign] : {std::pair(distance.to, 1.0), std::pair(distance.from, -1.0)}) {
      if (const auto* point = std::get_if<std::size_t>(&end)) {
        by_place[*point] += sign * slope;
      } else {
        add(std::get<Belt>(end), sign * slope);
      }
    }
  }
  for (const Eigen::Vector2d& slope : by_place)
    slopes.by_place = std::max(slopes.by_place, slope.norm());
  return slopes;
}

TEST(OneEstimator, EndsWhereNoAnchorAndNoPlaceLowersTheSumOfSquares) {
  for (const NamedSet& set : every_set()) {
    SCOPED_TRACE(set.name);
    const auto fit = fit_belts(set.belts);
    ASSERT_TRUE(fit) << fit.error().sentence();
    const Slopes slopes = slopes_at(set.belts, *fit);
    for (Eigen::Index i = 0; i < 5; ++i) {
      // A slope times the coordinate's sigma is the distance from the minimum in sigmas: passes end
      // at 1e-6, of a strongly correlated coordinate some tens of that.
      EXPECT_LT(
          std::abs(slopes.by_anchor[i]) * fit->coordinates[static_cast<std::size_t>(i)].sigma_mm,
          1e-4);
    }
    // A place is found to 1e-9 mm, about the next to last state of the anchors.
    EXPECT_LT(slopes.by_place * fit->residual_sigma_mm, 1e-5);
  }
}

TEST(OneEstimator, ConvergesFromACentimetreAway) {
  for (const NamedSet& set : every_set()) {
    if (!set.belts.distances.empty()) continue;
    SCOPED_TRACE(set.name);
    const auto fit = fit_belts(set.belts);
    ASSERT_TRUE(fit) << fit.error().sentence();
    belts::Counting counting;
    for (const FittedPlace& place : fit->places) {
      model::PerBelt<bool> counts;
      for (const Belt belt : kBelts) counts[belt] = place.belts[belt].counts;
      counting.push_back(counts);
    }
    belts::AnchorVector start = belts::anchors_of(fit->machine);
    start += (belts::AnchorVector() << 9.0, -11.0, -8.0, 10.0, 12.0).finished();
    const auto estimate = estimation::estimate(belts::anchor_input(
        set.belts, {.state = {start, 0.0, {}}, .counting = counting, .residual_sigma_mm = 1.0}));
    ASSERT_TRUE(estimate) << estimate.error().sentence();
    EXPECT_TRUE(estimate->converged);
    for (std::size_t i = 0; i < fit->coordinates.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const double sigma = std::sqrt(estimate->covariance(row, row));
      // Passes end at 1e-6 of a sigma: of six places that is more than 1e-6 mm.
      const double tolerance_mm = 1e-6 * std::max(1.0, sigma);
      EXPECT_NEAR(estimate->mechanism->values()[row], fit->coordinates[i].fitted_mm, tolerance_mm);
      EXPECT_NEAR(sigma, fit->coordinates[i].sigma_mm, tolerance_mm);
    }
    EXPECT_NEAR(estimate->noise_factor, fit->residual_sigma_mm, 1e-6);
  }
}

// The estimator's loop for units rejects a place, whose two rows are one unit, and reduces the
// weight of those beyond 95 of 100; the search for single readings keeps the other three of the
// place.
TEST(OneEstimator, RejectsPlacesWithARejectedReading) {
  for (const std::uint64_t seed : {11, 12}) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const SimulatedBelts set = with_four_bad_readings(seed);
    const auto fit = fit_belts(set.belts);
    ASSERT_TRUE(fit);
    const belts::Counting all(set.belts.points.size(), {true, true, true, true});
    estimation::EstimationInput input =
        belts::anchor_input(set.belts, {.state = {belts::anchors_of(fit->machine), 0.0, {}},
                                        .counting = all,
                                        .residual_sigma_mm = 1.0});
    input.fixed_weights.reset();
    const auto estimate = estimation::estimate(input);
    ASSERT_TRUE(estimate && estimate->converged);
    std::vector<std::size_t> rejected;
    for (const estimation::UnitEstimate& unit : estimate->units) {
      if (unit.is_rejected())
        rejected.push_back(input.observations.front()->units()[unit.unit].index);
    }
    EXPECT_EQ(rejected, (std::vector<std::size_t>{3, 30, 31, 60}));
    for (std::size_t i = 0; i < fit->coordinates.size(); ++i) {
      // Twelve readings fewer of 324, and weights of a few: 0.2 of a sigma in both sets.
      EXPECT_NEAR(estimate->mechanism->values()[static_cast<Eigen::Index>(i)],
                  fit->coordinates[i].fitted_mm, 0.5 * fit->coordinates[i].sigma_mm);
    }
  }
}

}  // namespace
}  // namespace chaintrue::grid
