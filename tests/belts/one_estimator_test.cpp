// SPDX-License-Identifier: GPL-3.0-or-later
/// Anchors by the one estimator: at the minimum of the sum of squares, wherever it begins, and where
/// another solver found it (fixtures/belts/fits.tsv).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "grid/belts/anchor_estimate.hpp"
#include "model/belts/belt_kinematics.hpp"
#include "tests/belts/golden_sets.hpp"

namespace chaintrue::grid {
namespace {

using model::Belt;
using model::kBelts;

std::vector<GoldenSet> every_set() {
  std::vector<GoldenSet> all = simulated_golden_sets();
  for (auto* sets : {&file_golden_sets, &real_golden_sets}) {
    for (GoldenSet& set : sets()) all.push_back(std::move(set));
  }
  return all;
}

/// Slopes of half the sum of squares by each anchor coordinate, and the steepest by a place.
struct Slopes {
  Eigen::Matrix<double, 5, 1> by_anchor = Eigen::Matrix<double, 5, 1>::Zero();
  double by_place = 0.0;
};

/// By formulas of their own: a belt's print moves with its anchor as with its place, the other way.
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

bool ends_at_a_hole(const MeasuredBelts& belts) {
  return std::any_of(belts.distances.begin(), belts.distances.end(), [](const auto& distance) {
    return std::holds_alternative<CutHole>(distance.from);
  });
}

TEST(OneEstimator, EndsWhereNoAnchorAndNoPlaceLowersTheSumOfSquares) {
  for (const GoldenSet& set : every_set()) {
    if (!set.holes.empty() || ends_at_a_hole(set.belts)) continue;
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

TEST(OneEstimator, FindsTheSameFromACentimetreAside) {
  for (const GoldenSet& set : every_set()) {
    if (!set.holes.empty() || !set.belts.distances.empty()) continue;
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
    const auto estimate = belts::estimate_anchors(set.belts, counting, start);
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

/// Names and numbers of each stored set, in their order.
std::map<std::string, GoldenNumbers> stored_numbers() {
  std::map<std::string, GoldenNumbers> stored;
  std::ifstream file(std::string(CHAINTRUE_FIXTURES) + "/belts/fits.tsv");
  std::string line;
  while (std::getline(file, line)) {
    std::istringstream words(line);
    std::string set;
    std::string name;
    std::string value;
    std::getline(words, set, '\t');
    std::getline(words, name, '\t');
    std::getline(words, value, '\t');
    stored[set].emplace_back(name, std::stod(value));
  }
  return stored;
}

/// A point of which fewer than three readings agree: which two are right nothing tells, and what is
/// said of its place depends on it.
bool depends_on_a_tie(const GoldenNumbers& numbers, const std::string& name) {
  return std::any_of(numbers.begin(), numbers.end(), [&](const auto& own) {
    if (own.first != "bad point") return false;
    const std::string point = fmt::format(" of {}", own.second);
    return name == "rms_mm" || name.ends_with(point) || name.ends_with(point + " br");
  });
}

TEST(OneEstimator, AgreesWithASolverThatKeptThePlacesAsUnknowns) {
  const auto stored = stored_numbers();
  ASSERT_FALSE(stored.empty());
  for (const GoldenSet& set : every_set()) {
    SCOPED_TRACE(set.name);
    const GoldenNumbers numbers = numbers_of(set);
    ASSERT_TRUE(stored.contains(set.name));
    const GoldenNumbers& other = stored.at(set.name);
    ASSERT_EQ(numbers.size(), other.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      ASSERT_EQ(numbers[i].first, other[i].first);
      if (depends_on_a_tie(other, other[i].first)) continue;
      // The other solver stopped where a step lowered the cost by less than 1e-9 of itself: of real
      // machines up to 1.2e-5 mm before the minimum.
      EXPECT_NEAR(numbers[i].second, other[i].second, 2e-5) << numbers[i].first;
    }
  }
}

// The estimator's loop for units rejects a place, whose two rows are one unit, and weights down what
// lies beyond 95 of 100; the search for single readings keeps the other three of the place.
TEST(OneEstimator, TheLoopForUnitsRejectsThePlacesOfWhichAReadingIsRejected) {
  for (const std::uint64_t seed : {11, 12}) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    SimulatedBelts set = simulate({.seed = seed});
    set.belts.points[3].lengths_mm.tl += 44.0;
    set.belts.points[30].lengths_mm.br -= 44.0;
    set.belts.points[31].lengths_mm.br -= 12.0;
    set.belts.points[60].lengths_mm.tr += 150.0;
    const auto fit = fit_belts(set.belts);
    ASSERT_TRUE(fit);
    const belts::Counting all(set.belts.points.size(), {true, true, true, true});
    estimation::EstimationInput input =
        belts::anchor_input(set.belts, all, belts::anchors_of(fit->machine));
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
                  fit->coordinates[i].fitted_mm,
                  0.5 * fit->coordinates[i].sigma_mm);
    }
  }
}

}  // namespace
}  // namespace chaintrue::grid
