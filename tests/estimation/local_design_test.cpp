// SPDX-License-Identifier: GPL-3.0-or-later
// The local design of many readings equals the dense one.
#include "grid/estimation/local_design.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "grid/estimation/joint_priors.hpp"
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

TEST(LocalDesign, EqualsTheDenseDesign) {
  const EstimationInput input = input_of(300);
  JointProblem problem(input, true);
  ASSERT_TRUE(problem.linearise(problem.stated()));
  ASSERT_NE(problem.local(), nullptr);
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
  // Any covariance will do.
  const Eigen::MatrixXd covariance =
      (gram / gram.trace() + Eigen::MatrixXd::Identity(gram.rows(), gram.rows())).inverse();
  const auto spreads = problem.local()->spreads(covariance);
  ASSERT_EQ(spreads.size(), problem.units().size());
  for (std::size_t u = 0; u < spreads.size(); ++u) {
    const SystemUnit& unit = problem.units()[u];
    const auto rows = design.middleRows(unit.first_row, unit.rows);
    const Eigen::MatrixXd dense = rows * covariance * rows.transpose();
    const Eigen::MatrixXd terms =
        rows.cwiseAbs() * covariance.cwiseAbs() * rows.cwiseAbs().transpose();
    ASSERT_LE((spreads[u] - dense).cwiseAbs().maxCoeff(), kRounding * terms.maxCoeff()) << u;
  }
}

TEST(LocalDesign, IsForManyReadingsOnly) {
  const EstimationInput input = input_of(60);
  JointProblem problem(input, true);
  ASSERT_TRUE(problem.linearise(problem.stated()));
  EXPECT_EQ(problem.local(), nullptr);
}

}  // namespace
}  // namespace chaintrue::grid::estimation
