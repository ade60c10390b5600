// SPDX-License-Identifier: GPL-3.0-or-later
// The fit checked by brute force: the likelihood by its definition in the space of the responses,
// derivatives by differences, the optimum and the average by a grid, held-out residuals by refitting.
#include "interp/reml.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "interp/reml_likelihood.hpp"
#include "tests/interp/truths.hpp"

namespace chaintrue::interp {
namespace {

constexpr std::uint64_t kRemlSeed = 77;
constexpr Eigen::Index kRidge = 24;
constexpr Eigen::Index kShared = 3;

struct Sample {
  Eigen::MatrixXd design;
  Eigen::VectorXd response;
  PenalisedProblem problem{1};
};

// y = Z s + F u + sigma e with graded F, as for smooth functions at scattered points, after two shared
// columns with a prior and one of which nothing is known.
Sample sample_of(Eigen::Index rows, double sigma) {
  truths::Random random(kRemlSeed);
  Sample sample{Eigen::MatrixXd(rows, kRidge + kShared), {}, PenalisedProblem(kRidge + kShared)};
  Eigen::VectorXd b(kRidge + kShared);
  for (double& value : b) value = random.normal();
  for (double& value : sample.design.reshaped()) value = random.normal();
  for (Eigen::Index j = 0; j < kRidge; ++j) {
    sample.design.col(kShared + j) *= std::pow(10.0, -0.15 * static_cast<double>(j));
  }
  sample.response = sample.design * b;
  for (double& value : sample.response) value += sigma * random.normal();
  PenalisedProblem& problem = sample.problem;
  problem.add_rows(sample.design.topRows(7), sample.response.head(7));
  problem.add_rows(sample.design.bottomRows(rows - 7), sample.response.tail(rows - 7));
  problem.ridge = {kRidge, sample.design.rightCols(kRidge).squaredNorm() / kRidge};
  problem.prior_precision.diagonal().head(2) << 1.0, 0.5;
  problem.prior_mean.head(2) << 0.2, -0.1;
  problem.noise = {NoiseKnowledge::unknown, 0.0};
  return sample;
}

// There are more rows than columns, which are then reduced, or fewer rows than ridge columns.
class RemlForm : public testing::TestWithParam<Eigen::Index> {
 protected:
  void SetUp() override { RecordProperty("seed", static_cast<int>(kRemlSeed)); }
  const Sample sample = sample_of(GetParam(), 0.3);
};

// The mixed model: y has the covariance W = sigma2 I + F F' / lambda + what the priors add, and the
// column without a prior is a fixed effect (Patterson and Thompson 1971).
struct MixedModel {
  double v;
  Eigen::VectorXd coefficients;
};

MixedModel mixed_model(const Sample& sample, double lambda, double sigma2) {
  const PenalisedProblem& p = sample.problem;
  const Eigen::MatrixXd f = sample.design.rightCols(kRidge);
  const Eigen::MatrixXd z = sample.design.leftCols(2);
  const Eigen::VectorXd fixed = sample.design.col(2);
  const Eigen::Vector2d variance = p.prior_precision.diagonal().head(2).cwiseInverse();
  const Eigen::Index n = f.rows();
  const Eigen::MatrixXd w = sigma2 * Eigen::MatrixXd::Identity(n, n) + f * f.transpose() / lambda +
                            z * variance.asDiagonal() * z.transpose();
  const Eigen::PartialPivLU<Eigen::MatrixXd> lu(w);
  const Eigen::VectorXd y = sample.response - z * p.prior_mean.head(2);
  const double information = fixed.dot(lu.solve(fixed));
  const double effect = fixed.dot(lu.solve(y)) / information;
  const Eigen::VectorXd solved = lu.solve(y - effect * fixed);
  MixedModel model{
      std::log(lu.determinant()) + std::log(information) + (y - effect * fixed).dot(solved),
      Eigen::VectorXd(kRidge + kShared)};
  model.coefficients << p.prior_mean.head(2) + variance.asDiagonal() * (z.transpose() * solved),
      effect, f.transpose() * solved / lambda;
  return model;
}

TEST_P(RemlForm, LikelihoodAndCoefficientsAreThoseOfTheMixedModel) {
  double constant = NAN;
  for (const double lambda : {1e-2, 0.5, 300.0}) {
    for (const double sigma2 : {0.03, 4.0}) {
      const MixedModel expected = mixed_model(sample, lambda, sigma2);
      const auto fit = fit_with_smoothing(sample.problem, lambda, sigma2).value();
      if (std::isnan(constant)) constant = fit.minus_two_log_reml - expected.v;
      // W's condition number is below 1e6, V below 1e3.
      EXPECT_NEAR(fit.minus_two_log_reml - expected.v, constant, 1e-8) << lambda << " " << sigma2;
      EXPECT_LT((fit.coefficients - expected.coefficients).cwiseAbs().maxCoeff(), 1e-8);
    }
  }
}

TEST_P(RemlForm, DerivativesAgreeWithDifferences) {
  Sample repeated = sample;
  repeated.problem.noise = {NoiseKnowledge::from_repeats, 7.0};
  const reml::Likelihood likelihood(repeated.problem, SmoothingPrior::avoids_boundary);
  const reml::Theta theta(0.4, -1.1);
  const auto here = likelihood.derivatives(likelihood.at(theta).value());
  for (Eigen::Index i = 0; i < 2; ++i) {
    constexpr double kStep = 1e-4;
    const reml::Theta step = kStep * reml::Theta::Unit(i);
    const auto high = likelihood.at(theta + step).value();
    const auto low = likelihood.at(theta - step).value();
    // Central differences: third derivatives of order ten times 1e-8, rounding 1e-13 * 1e3 / 1e-4.
    EXPECT_NEAR(here.gradient[i], (high.value - low.value) / (2 * kStep), 1e-5) << i;
    const reml::Theta row =
        (likelihood.derivatives(high).gradient - likelihood.derivatives(low).gradient) /
        (2 * kStep);
    EXPECT_LT((here.hessian.row(i).transpose() - row).cwiseAbs().maxCoeff(), 1e-5) << i;
  }
}

TEST_P(RemlForm, FindsTheMinimumAndTheAverageOfAGrid) {
  FitOptions plain;
  plain.prior = SmoothingPrior::none;
  const auto fit = fit_penalised(sample.problem, plain).value();
  double least = 1e300;
  double weight = 0.0;
  double inverse_lambda = 0.0;
  double first_variance = 0.0;
  for (double a = -10.0; a <= 14.0; a += 0.25) {
    for (double b = -8.0; b <= 4.0; b += 0.25) {
      const auto there = fit_with_smoothing(sample.problem, std::exp(a), std::exp(b)).value();
      least = std::min(least, there.minus_two_log_reml);
      // The prior is flat in the standard deviations.
      const double w = std::exp(-0.5 * (there.minus_two_log_reml - fit.minus_two_log_reml + a - b));
      const double off = there.coefficients[kShared] - fit.coefficients[kShared];
      weight += w;
      inverse_lambda += w * std::exp(-a);
      first_variance += w * (there.covariance(kShared, kShared) + off * off);
    }
  }
  EXPECT_LE(fit.minus_two_log_reml, least + 1e-9);  // rounding of V
  // Steps of one sigma down to e^-4 of the peak against a quarter down to nothing: the tails that
  // they leave out hold 2 % of a normal posterior, more of a skew one.
  EXPECT_NEAR(fit.inverse_lambda / (inverse_lambda / weight), 1.0, 0.15);
  EXPECT_NEAR(fit.corrected_covariance(kShared, kShared) / (first_variance / weight), 1.0, 0.15);
}

TEST_P(RemlForm, HeldOutResidualsAreThoseOfARefit) {
  const auto fit = fit_penalised(sample.problem).value();
  for (const Eigen::Index first : {0, 5, 16}) {
    const Eigen::MatrixXd rows = sample.design.middleRows(first, 2);
    const Eigen::VectorXd response = sample.response.segment(first, 2);
    PenalisedProblem rest = sample.problem;
    rest.design.middleRows(first, 2).setZero();
    rest.response.segment(first, 2).setZero();
    const auto refit = fit_with_smoothing(rest, fit.lambda, fit.sigma2).value();
    const Eigen::VectorXd residual = response - rows * fit.coefficients;
    const auto held =
        held_out_residual(residual, rows * fit.covariance * rows.transpose(), fit.sigma2).value();
    // Exact algebra; 1e-8 is the rounding of two solves of condition about 1e7.
    EXPECT_LT((held - response + rows * refit.coefficients).cwiseAbs().maxCoeff(), 1e-8);
  }
}

INSTANTIATE_TEST_SUITE_P(Forms, RemlForm, testing::Values(40, 20),
                         [](const testing::TestParamInfo<Eigen::Index>& rows) {
                           return std::to_string(rows.param) + "Rows";
                         });

TEST(Reml, RowsAgreeWithTheirProductsWhereThoseHaveTheDigits) {
  SCOPED_TRACE(kRemlSeed);
  const Sample sample = sample_of(20, 0.3);
  PenalisedProblem squared = sample.problem;
  Eigen::MatrixXd all(20, kRidge + kShared + 1);
  all << sample.design, sample.response;
  squared.design.resize(0, Eigen::NoChange);
  squared.response.resize(0);
  squared.rows = 0;
  squared.add_products(20, all.transpose() * all);
  EXPECT_EQ(squared.rows, 20);
  const auto rows = fit_penalised(sample.problem).value();
  const auto products = fit_penalised(squared).value();
  // Both minima are found to a gradient of 1e-7.
  EXPECT_NEAR(std::log(rows.lambda), std::log(products.lambda), 1e-6);
  EXPECT_NEAR(std::log(rows.sigma2), std::log(products.sigma2), 1e-6);
  EXPECT_LT((rows.coefficients - products.coefficients).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT((rows.covariance - products.covariance).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT((rows.corrected_covariance - products.corrected_covariance).cwiseAbs().maxCoeff(),
            1e-6);
  EXPECT_NEAR(rows.minus_two_log_reml, products.minus_two_log_reml, 1e-6);
  EXPECT_NEAR(rows.edf, products.edf, 1e-6);
}

TEST(Reml, RowsKeepTheirDigitsWithoutNoise) {
  SCOPED_TRACE(kRemlSeed);
  const Sample sample = sample_of(20, 1e-7);
  const auto fit = fit_penalised(sample.problem).value();
  const MixedModel expected = mixed_model(sample, fit.lambda, fit.sigma2);
  // W's condition number, 1e8 and more, halves the digits of the comparison.
  EXPECT_LT((fit.coefficients - expected.coefficients).cwiseAbs().maxCoeff(), 1e-5);
}

TEST(Reml, RefusesAnEmptyColumn) {
  Sample sample = sample_of(20, 0.3);
  sample.problem.design.col(2).setZero();
  const auto fit = fit_penalised(sample.problem);
  ASSERT_FALSE(fit.has_value());
  EXPECT_EQ(fit.error().reason, FitFailure::Reason::rank_deficient);
  EXPECT_FALSE(fit_with_smoothing(sample.problem, 1.0, 1.0).has_value());
}

TEST(Reml, PriorKnowledgeOfARidgeColumnThrows) {
  Sample sample = sample_of(20, 0.3);
  sample.problem.prior_precision(kShared, kShared) = 1.0;
  EXPECT_THROW((void)fit_penalised(sample.problem), std::invalid_argument);
}

// A plane and a checkered part that is rougher than the ridge's waves and less than the stated
// noise.
TEST(Reml, AnAbsentFieldStaysUncertain) {
  Eigen::MatrixXd design(25, 3 + 4);
  Eigen::VectorXd response(25);
  for (int i = 0; i < 25; ++i) {
    const double x = -1 + 0.5 * (i % 5);
    const double y = -1 + 0.5 * static_cast<double>(i / 5);
    design.row(i) << 1, x, y, std::sin(2 * x), std::cos(2 * x), std::sin(2 * y), std::cos(2 * y);
    response(i) = 2 + 3 * x - y + (i % 2 == 0 ? 0.05 : -0.05);
  }
  PenalisedProblem problem(7);
  problem.add_rows(design / 0.1, response / 0.1);
  problem.ridge = {4, problem.design.rightCols(4).squaredNorm() / 4};
  FitOptions plain;
  plain.prior = SmoothingPrior::none;
  const auto fit = fit_penalised(problem, plain).value();
  EXPECT_NEAR(fit.edf, 3.0, 0.01);  // lambda stops ten decades above balance
  // The estimated field is not zero: averaging over lambda keeps some of its variance.
  EXPECT_GT(fit.corrected_covariance.trace(), 1.05 * fit.covariance.trace());
  // The prior that avoids the boundary keeps some of the field itself.
  EXPECT_GT(fit_penalised(problem).value().edf, 3.05);
}

TEST(Reml, EqualsLeastSquaresWithAPriorWithoutARidge) {
  const Sample sample = sample_of(40, 0.3);
  PenalisedProblem problem = sample.problem;
  problem.ridge = {};
  problem.noise = {NoiseKnowledge::exact, 0.0};
  const auto fit = fit_penalised(problem).value();
  const Eigen::MatrixXd a = sample.design.transpose() * sample.design + problem.prior_precision;
  const Eigen::VectorXd b = a.fullPivLu().solve(sample.design.transpose() * sample.response +
                                                problem.prior_precision * problem.prior_mean);
  // The condition number of X'X is below 1e8.
  EXPECT_LT((fit.coefficients - b).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT((fit.covariance * a - Eigen::MatrixXd::Identity(27, 27)).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_EQ(fit.corrected_covariance, fit.covariance);
}

}  // namespace
}  // namespace chaintrue::interp
