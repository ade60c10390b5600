// SPDX-License-Identifier: GPL-3.0-or-later
// The fit checked by brute force: the likelihood by its definition in the space of the responses,
// derivatives by differences, the optimum by a grid, held-out residuals by refitting.
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "interp/bspline_basis.hpp"
#include "interp/reml.hpp"
#include "interp/reml_marginal.hpp"

namespace chaintrue::interp {
namespace {

constexpr std::uint64_t kLikelihoodSeed = 20240611;

struct Joint {
  Eigen::MatrixXd design;
  Eigen::VectorXd response;
  PenalisedProblem problem{1};
};

// Two fields on the same points coupled by three shared columns with a prior, like the two chains
// of a machine by its settings.
Joint joint_problem(int points, bool overlapping_prior) {
  std::mt19937_64 random(kLikelihoodSeed);
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  const auto normal = [&] {
    return std::sqrt(-2.0 * std::log(1.0 - uniform())) * std::cos(6.283185307179586 * uniform());
  };
  const BsplineBasis basis({-1, 1, -1, 1}, 3, 2);
  const Eigen::Index m = basis.size();
  Joint joint;
  joint.design = Eigen::MatrixXd::Zero(2 * points, 2 * m + 3);
  joint.response.resize(2 * points);
  for (int i = 0; i < points; ++i) {
    const double x = 2 * uniform() - 1;
    const double y = 2 * uniform() - 1;
    const Eigen::VectorXd row = basis.row(x, y);
    joint.design.row(2 * i).head(m) = 5.0 * row;
    joint.design.row(2 * i + 1).segment(m, m) = 5.0 * row;
    for (int k = 0; k < 2; ++k) {
      joint.design.row(2 * i + k).tail(3) << 5.0 * std::sin(x + k), 5.0 * std::cos(2 * y - k),
          5.0 * x * y;
      joint.response(2 * i + k) = 5.0 * std::sin(3 * x + y * (k + 1)) + normal();
    }
  }
  joint.problem = PenalisedProblem(2 * m + 3);
  joint.problem.add_rows(joint.design, joint.response);
  joint.problem.penalties.push_back({0, basis.thin_plate_penalty(), basis.thin_plate_rank()});
  joint.problem.penalties.push_back({m, 2.0 * basis.thin_plate_penalty(), basis.thin_plate_rank()});
  joint.problem.prior_precision = Eigen::MatrixXd::Zero(2 * m + 3, 2 * m + 3);
  joint.problem.prior_precision.bottomRightCorner(3, 3).diagonal() << 4.0, 1.0, 0.25;
  joint.problem.prior_mean = Eigen::VectorXd::Zero(2 * m + 3);
  joint.problem.prior_mean.tail(3) << 0.3, -0.2, 0.1;
  if (overlapping_prior) {
    joint.problem.prior_precision.diagonal().head(m).array() += 1e-2;
  }
  return joint;
}

// V by its definition: Gaussian y with the penalised part of b integrated as a random effect and
// the null space of S as fixed effects (Patterson and Thompson 1971): log|W| + log|F'W^-1F| + r'Pr.
double response_space_v(
    const Joint& joint, double lambda1, double lambda2, double sigma2, Eigen::Index nullity) {
  const PenalisedProblem& p = joint.problem;
  Eigen::MatrixXd s = p.prior_precision;
  const Eigen::Index m = p.penalties[0].matrix.rows();
  s.block(0, 0, m, m) += lambda1 * p.penalties[0].matrix;
  s.block(m, m, m, m) += lambda2 * p.penalties[1].matrix;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(s);
  const Eigen::Index r = s.rows() - nullity;
  const Eigen::MatrixXd z = joint.design * solver.eigenvectors().rightCols(r);
  const Eigen::MatrixXd fixed = joint.design * solver.eigenvectors().leftCols(nullity);
  const Eigen::MatrixXd w =
      sigma2 * Eigen::MatrixXd::Identity(z.rows(), z.rows()) +
      z * solver.eigenvalues().tail(r).cwiseInverse().asDiagonal() * z.transpose();
  const Eigen::LLT<Eigen::MatrixXd> lw(w);
  const Eigen::VectorXd y = joint.response - joint.design * p.prior_mean;
  Eigen::MatrixXd fwf = fixed.transpose() * lw.solve(fixed);
  double v = 2.0 * lw.matrixLLT().diagonal().array().log().sum() + y.dot(lw.solve(y));
  if (nullity > 0) {
    const Eigen::LLT<Eigen::MatrixXd> lf(fwf);
    const Eigen::VectorXd fwy = fixed.transpose() * lw.solve(y);
    v += 2.0 * lf.matrixLLT().diagonal().array().log().sum() - fwy.dot(lf.solve(fwy));
  }
  return v;
}

class RemlLikelihood : public testing::TestWithParam<bool> {};

TEST_P(RemlLikelihood, IsThatOfTheMixedModelUpToAConstant) {
  SCOPED_TRACE(kLikelihoodSeed);
  const Joint joint = joint_problem(30, GetParam());
  const Eigen::Index nullity = GetParam() ? 3 : 6;
  const auto ours = [&](double a, double b, double s2) {
    return minus_two_log_reml(joint.problem, Eigen::Vector2d(a, b), s2).value();
  };
  const double constant = ours(1, 1, 1) - response_space_v(joint, 1, 1, 1, nullity);
  for (const double a : {1e-3, 0.5, 300.0}) {
    for (const double b : {1e-2, 2.0, 1e3}) {
      for (const double s2 : {0.3, 4.0}) {
        // Both sides are of order 1e3 and lose about six digits by the condition of S.
        EXPECT_NEAR(ours(a, b, s2) - response_space_v(joint, a, b, s2, nullity), constant, 1e-6)
            << a << " " << b << " " << s2;
      }
    }
  }
}

TEST_P(RemlLikelihood, DerivativesAgreeWithDifferences) {
  SCOPED_TRACE(kLikelihoodSeed);
  Joint joint = joint_problem(30, GetParam());
  joint.problem.noise = {NoiseKnowledge::from_repeats, 7.0};
  const reml::Marginal marginal(joint.problem, std::nullopt);
  const Eigen::Vector3d theta(0.4, -1.1, 0.3);
  const auto state = marginal.evaluate(theta, reml::Order::hessian).value();
  for (Eigen::Index i = 0; i < 3; ++i) {
    constexpr double kStep = 1e-4;
    Eigen::VectorXd up = theta;
    Eigen::VectorXd down = theta;
    up(i) += kStep;
    down(i) -= kStep;
    const auto high = marginal.evaluate(up, reml::Order::hessian).value();
    const auto low = marginal.evaluate(down, reml::Order::hessian).value();
    // Central differences: third derivatives of order ten times 1e-8, rounding 1e-13 * 1e3 / 1e-4.
    EXPECT_NEAR(state.gradient(i), (high.value - low.value) / (2 * kStep), 1e-5) << i;
    for (Eigen::Index j = 0; j < 3; ++j) {
      EXPECT_NEAR(state.hessian(i, j), (high.gradient(j) - low.gradient(j)) / (2 * kStep), 1e-5)
          << i << " " << j;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(BorderedAndDense, RemlLikelihood, testing::Bool());

TEST(Reml, BorderedAndDenseAgree) {
  const Joint joint = joint_problem(40, false);
  ASSERT_TRUE(reml::is_bordered(joint.problem));
  Joint reordered = joint;
  // A coupling of 1e-300 is negligible but forces the dense form.
  reordered.problem.gram(0, joint.problem.penalties[1].first_column) = 1e-300;
  ASSERT_FALSE(reml::is_bordered(reordered.problem));
  const auto bordered = fit_penalised(joint.problem).value();
  const auto dense = fit_penalised(reordered.problem).value();
  // The optimum is found to a gradient of 1e-7 in V.
  EXPECT_LT((bordered.lambda.array().log() - dense.lambda.array().log()).cwiseAbs().maxCoeff(),
            1e-5);
  EXPECT_NEAR(bordered.minus_two_log_reml, dense.minus_two_log_reml, 1e-8);
  EXPECT_LT((bordered.coefficients - dense.coefficients).cwiseAbs().maxCoeff(), 1e-5);
  EXPECT_LT((bordered.covariance - dense.covariance).cwiseAbs().maxCoeff(), 1e-5);
  EXPECT_LT((bordered.corrected_covariance - dense.corrected_covariance).cwiseAbs().maxCoeff(),
            1e-4);
  EXPECT_NEAR(bordered.edf, dense.edf, 1e-5);
}

TEST(Reml, FindsTheMinimumAGridFinds) {
  const Joint joint = joint_problem(30, false);
  FitOptions plain;
  plain.prior = SmoothingPrior::none;
  const auto fit = fit_penalised(joint.problem, plain).value();
  double best = 1e300;
  for (double a = -12; a <= 12; a += 1.0) {
    for (double b = -12; b <= 12; b += 1.0) {
      const Eigen::Vector2d lambda(std::exp(a), std::exp(b));
      best = std::min(best, minus_two_log_reml(joint.problem, lambda, 1.0).value());
    }
  }
  EXPECT_LE(fit.minus_two_log_reml, best + 1e-9);  // rounding of V
}

TEST(Reml, HeldOutResidualsAreThoseOfARefit) {
  SCOPED_TRACE(kLikelihoodSeed);
  const Joint joint = joint_problem(30, false);
  const auto fit = fit_penalised(joint.problem).value();
  for (const Eigen::Index group : {0, 7, 29}) {
    const Eigen::MatrixXd rows = joint.design.middleRows(2 * group, 2);
    const Eigen::VectorXd response = joint.response.segment(2 * group, 2);
    PenalisedProblem rest = joint.problem;
    rest.gram -= rows.transpose() * rows;
    rest.moment -= rows.transpose() * response;
    rest.response_square -= response.squaredNorm();
    rest.rows -= 2;
    const auto refit = fit_with_smoothing(rest, fit.lambda, fit.sigma2).value();
    const auto held = fit.held_out(rows, response).value();
    const Eigen::VectorXd direct = response - rows * refit.coefficients;
    const Eigen::MatrixXd spread =
        rows * refit.covariance * rows.transpose() + Eigen::MatrixXd::Identity(2, 2) * fit.sigma2;
    // Exact algebra; 1e-8 is the rounding of two solves of condition about 1e7.
    EXPECT_LT((held.residual - direct).cwiseAbs().maxCoeff(), 1e-8);
    EXPECT_LT((held.covariance - spread).cwiseAbs().maxCoeff(), 1e-8);
  }
}

TEST(Reml, PointsOnALineAreRefused) {
  const BsplineBasis basis({-1, 1, -1, 1}, 3, 3);
  PenalisedProblem problem(basis.size());
  Eigen::MatrixXd design(30, basis.size());
  for (int i = 0; i < 30; ++i) {
    const double t = -0.9 + 1.8 * i / 29.0;
    design.row(i) = basis.row(t, 0.5 * t).transpose();
  }
  problem.add_rows(design, Eigen::VectorXd::LinSpaced(30, 0, 1));
  problem.penalties.push_back({0, basis.thin_plate_penalty(), basis.thin_plate_rank()});
  const auto fit = fit_penalised(problem);
  ASSERT_FALSE(fit.has_value());
  EXPECT_EQ(fit.error().reason, FitFailure::Reason::rank_deficient);
  EXPECT_EQ(fit.error().sentence(),
            "the points do not determine the fit: some combination of its unknowns is left free");
}

TEST(Reml, APlaneIsLeftToTheNullSpace) {
  const BsplineBasis basis({-1, 1, -1, 1}, 4, 4);
  PenalisedProblem problem(basis.size());
  Eigen::MatrixXd design(25, basis.size());
  Eigen::VectorXd response(25);
  for (int i = 0; i < 25; ++i) {
    const double x = -1 + 0.5 * (i % 5);
    const double y = -1 + 0.5 * static_cast<double>(i / 5);
    design.row(i) = basis.row(x, y).transpose() / 0.1;
    // A checkered 0.05 is rougher than any field of the basis: it is noise, and less than stated.
    response(i) = (2 + 3 * x - y + (i % 2 == 0 ? 0.05 : -0.05)) / 0.1;
  }
  problem.add_rows(design, response);
  problem.penalties.push_back({0, basis.thin_plate_penalty(), basis.thin_plate_rank()});
  FitOptions plain;
  plain.prior = SmoothingPrior::none;
  const auto fit = fit_penalised(problem, plain);
  ASSERT_TRUE(fit.has_value());
  EXPECT_EQ(fit->ends[0], SmoothingEnd::stiff);
  EXPECT_NEAR(fit->edf, 3.0, 0.01);  // lambda stops ten decades above balance
  // Even so the estimated field is not zero: averaging over lambda keeps some of its variance.
  EXPECT_GT(fit->corrected_covariance.trace(), 1.05 * fit->covariance.trace());
  // The prior that avoids the boundary keeps some of the field itself.
  const auto kept = fit_penalised(problem);
  ASSERT_TRUE(kept.has_value());
  EXPECT_EQ(kept->ends[0], SmoothingEnd::inside);
  EXPECT_GT(kept->edf, 3.05);
}

}  // namespace
}  // namespace chaintrue::interp
