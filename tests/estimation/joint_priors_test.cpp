// SPDX-License-Identifier: GPL-3.0-or-later
// With many readings, a fit uses the products of their rows.
#include "grid/estimation/joint_priors.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "grid/observation/length_points.hpp"
#include "grid/synthetic/generator.hpp"

namespace chaintrue::grid::estimation {
namespace {

/// Random points on the bed, and a surface of few splines.
EstimationInput input_of(int points) {
  synthetic::SyntheticSpec spec;
  spec.design.kind = synthetic::DesignKind::random;
  spec.design.points = points;
  spec.draw_settings = true;
  spec.seed = 41;
  const MeasuredGrid grid = synthetic::generate(model::Machine{}, spec).value().grid;
  EstimationInput input;
  input.observations = {std::make_shared<observation::ChainLengthReadings>(
      chain_length_readings(length_points(grid).value(), {0.2, 0.3}, 15.0, std::nullopt))};
  input.noise = {interp::NoiseKnowledge::from_repeats, 15.0};
  input.domain = {-1300.0, 1300.0, -700.0, 700.0};
  input.intervals_x = 4;
  input.intervals_y = 3;
  return input;
}

constexpr double kRounding = 1e-13;

TEST(WeightedRows, OfManyReadingsHaveTheirProducts) {
  const EstimationInput input = input_of(300);
  JointProblem problem(input, true);
  ASSERT_TRUE(problem.linearise(problem.stated()));
  const auto units = static_cast<Eigen::Index>(problem.units().size());
  // Some rejected, some at half their weight.
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(units);
  for (Eigen::Index u = 0; u < units; u += 7) weights[u] = u % 2 == 0 ? 0.0 : 0.5;
  const interp::PenalisedProblem weighted = estimation::weighted(problem, weights);
  Eigen::VectorXd by_row(problem.design().rows());
  for (Eigen::Index u = 0; u < units; ++u) {
    const SystemUnit& unit = problem.units()[static_cast<std::size_t>(u)];
    by_row.segment(unit.first_row, unit.rows).setConstant(weights[u]);
  }
  const Eigen::MatrixXd& design = problem.design();
  const Eigen::MatrixXd gram = design.transpose() * by_row.asDiagonal() * design;
  const Eigen::VectorXd weighted_response = by_row.asDiagonal() * problem.response();
  const auto expect_near = [](const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
    // Sums of some hundred products of sixteen digits.
    EXPECT_LE((a - b).cwiseAbs().maxCoeff(), kRounding * b.cwiseAbs().maxCoeff());
  };
  expect_near(weighted.design.transpose() * weighted.design, gram);
  expect_near(weighted.design.transpose() * weighted.response,
              design.transpose() * weighted_response);
  EXPECT_NEAR(weighted.response.squaredNorm(), problem.response().dot(weighted_response),
              kRounding * weighted.response.squaredNorm());
  EXPECT_EQ(weighted.rows, (by_row.array() > 0.0).count());
  // The design's unknowns, and one column for the response.
  EXPECT_EQ(weighted.design.rows(), design.cols() + 1);
}

TEST(WeightedRows, OfFewReadingsAreThemselves) {
  const EstimationInput input = input_of(60);
  JointProblem problem(input, true);
  ASSERT_TRUE(problem.linearise(problem.stated()));
  const auto units = static_cast<Eigen::Index>(problem.units().size());
  const auto weighted = estimation::weighted(problem, Eigen::VectorXd::Ones(units));
  EXPECT_EQ(weighted.design.rows(), problem.design().rows());
}

}  // namespace
}  // namespace chaintrue::grid::estimation
