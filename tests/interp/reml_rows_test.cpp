// SPDX-License-Identifier: GPL-3.0-or-later
// A ridge with kept rows, compared with the results from X'X and from the responses' own
// covariance.
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "interp/reml.hpp"

namespace chaintrue::interp {
namespace {

constexpr std::uint64_t kRowsSeed = 77;
constexpr Eigen::Index kRows = 20;
constexpr Eigen::Index kRidge = 24;
constexpr Eigen::Index kShared = 3;

// y = F u + Z s + sigma e with graded F, as for smooth functions at scattered points.
PenalisedProblem problem_of(double sigma, bool keeps_rows) {
  std::mt19937_64 random(kRowsSeed);
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  const auto normal = [&] {
    return std::sqrt(-2.0 * std::log(1.0 - uniform())) * std::cos(6.283185307179586 * uniform());
  };
  Eigen::MatrixXd design(kRows, kRidge + kShared);
  Eigen::VectorXd b(kRidge + kShared);
  for (double& value : b) value = normal();
  for (double& value : design.reshaped()) value = normal();
  for (Eigen::Index j = 0; j < kRidge; ++j)
    design.col(j) *= std::pow(10.0, -0.15 * static_cast<double>(j));
  Eigen::VectorXd response = design * b;
  for (double& value : response) value += sigma * normal();
  PenalisedProblem problem(kRidge + kShared);
  problem.keeps_rows = keeps_rows;
  problem.add_rows(design.topRows(7), response.head(7));
  problem.add_rows(design.bottomRows(kRows - 7), response.tail(kRows - 7));
  problem.penalties.push_back({0, Eigen::MatrixXd::Identity(kRidge, kRidge), kRidge});
  problem.prior_precision = Eigen::MatrixXd::Zero(kRidge + kShared, kRidge + kShared);
  problem.prior_precision.diagonal().tail(kShared) << 1.0, 0.5, 0.25;
  problem.prior_mean = Eigen::VectorXd::Zero(kRidge + kShared);
  problem.prior_mean.tail(kShared) << 0.2, -0.1, 0.4;
  problem.noise = {NoiseKnowledge::unknown, 0.0};
  return problem;
}

TEST(RemlRows, AgreeWithTheGramMatrixWhereThatHasTheDigits) {
  SCOPED_TRACE(kRowsSeed);
  const auto rows = fit_penalised(problem_of(0.3, true)).value();
  const auto gram = fit_penalised(problem_of(0.3, false)).value();
  // Both minima are found to a gradient of 1e-7.
  EXPECT_NEAR(std::log(rows.lambda(0)), std::log(gram.lambda(0)), 1e-6);
  EXPECT_NEAR(std::log(rows.sigma2), std::log(gram.sigma2), 1e-6);
  EXPECT_LT((rows.coefficients - gram.coefficients).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT((rows.covariance - gram.covariance).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT((rows.corrected_covariance - gram.corrected_covariance).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_NEAR(rows.minus_two_log_reml, gram.minus_two_log_reml, 1e-6);
  EXPECT_NEAR(rows.inverse_lambda(0) / gram.inverse_lambda(0), 1.0, 1e-6);
}

// The coefficients by M = sigma2 I + F F' / lambda + Z S0^-1 Z', the covariance of the responses,
// and an LU of it.
TEST(RemlRows, AreTheMixedModel) {
  SCOPED_TRACE(kRowsSeed);
  const PenalisedProblem problem = problem_of(1e-7, true);
  const Eigen::MatrixXd f = problem.design.leftCols(kRidge);
  const Eigen::MatrixXd z = problem.design.rightCols(kShared);
  const Eigen::MatrixXd prior =
      problem.prior_precision.bottomRightCorner(kShared, kShared).inverse();
  const Eigen::VectorXd r = problem.response - problem.design * problem.prior_mean;
  const auto fit = fit_penalised(problem);
  ASSERT_TRUE(fit.has_value());
  const Eigen::MatrixXd m = fit->sigma2 * Eigen::MatrixXd::Identity(kRows, kRows) +
                            f * f.transpose() / fit->lambda(0) + z * prior * z.transpose();
  const Eigen::VectorXd solved = m.fullPivLu().solve(r);
  const Eigen::VectorXd u = f.transpose() * solved / fit->lambda(0);
  const Eigen::VectorXd s = problem.prior_mean.tail(kShared) + prior * z.transpose() * solved;
  // M's condition number, 1e8 and more, halves the digits of the comparison.
  EXPECT_LT((fit->coefficients.head(kRidge) - u).cwiseAbs().maxCoeff(), 1e-5);
  EXPECT_LT((fit->coefficients.tail(kShared) - s).cwiseAbs().maxCoeff(), 1e-5);
}

TEST(RemlRows, ASparseRowCannotBeKept) {
  PenalisedProblem problem(3);
  problem.keeps_rows = true;
  EXPECT_THROW(problem.add_sparse_row({0, 1}, {1.0, 2.0}, 0.5), std::invalid_argument);
}

}  // namespace
}  // namespace chaintrue::interp
