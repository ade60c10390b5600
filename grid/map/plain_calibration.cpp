// SPDX-License-Identifier: GPL-3.0-or-later
// Notation: b, deviations of the settings from what was stated, then the two scales.
#include "grid/map/plain_calibration.hpp"

#include <Eigen/Cholesky>
#include <optional>

#include "grid/map/fit_unknowns.hpp"

namespace chaintrue::grid {
namespace {

using model::Side;

constexpr int kMostSteps = 12;
/// In stated sigmas; far below what the readings tell.
constexpr double kSettled = 1e-6;

void add_prior(const JointFitInput& input,
               const FitUnknowns& unknowns,
               const Eigen::VectorXd& b,
               interp::PenalisedProblem& problem) {
  const Eigen::Index settings = unknowns.size();
  problem.prior_precision = Eigen::MatrixXd::Zero(b.size(), b.size());
  for (Eigen::Index i = 0; i < settings; ++i)
    problem.prior_precision(i, i) = 1.0 / (unknowns.sigma(i) * unknowns.sigma(i));
  problem.prior_precision.diagonal().tail(2).setConstant(1.0 / (kScaleSigma * kScaleSigma));
  Eigen::VectorXd pull = Eigen::VectorXd::Zero(b.size());
  const model::ReadingModel model(unknowns.machine_at(b.head(settings)));
  const model::SheetPlacement sheet = unknowns.sheet_at(b.head(settings));
  for (const auto& reading : input.extra) {
    const auto line = reading->linearise(model, sheet, unknowns.settings());
    if (!line) continue;  // readings of the machine itself have no pose that could fail
    const Eigen::RowVectorXd row = line->setting_jacobian.row(0);
    const double weight = 1.0 / line->covariance(0, 0);
    problem.prior_precision.topLeftCorner(settings, settings) += weight * row.transpose() * row;
    pull.head(settings) +=
        weight * row.transpose() * (line->residual[0] + row.dot(b.head(settings)));
  }
  problem.prior_mean = problem.prior_precision.ldlt().solve(pull);
}

/// One step of Gauss and Newton; nothing where a point cannot be reached or nothing is determined.
std::optional<Eigen::VectorXd> step(const JointFitInput& input,
                                    const JointFit& fit,
                                    const FitUnknowns& unknowns,
                                    const Eigen::VectorXd& b) {
  const Eigen::Index settings = unknowns.size();
  const model::ReadingModel model(unknowns.machine_at(b.head(settings)));
  const model::SheetPlacement sheet = unknowns.sheet_at(b.head(settings));
  interp::PenalisedProblem problem(b.size());
  problem.noise = {interp::NoiseKnowledge::kUnknown, 0.0};
  add_prior(input, unknowns, b, problem);
  for (const FittedPoint& point : fit.points) {
    if (point.bad) continue;
    const model::ChainLengths read = point.point.lengths;
    const model::ChainReading reading(point.point.mark, read, {1.0, 0.0});
    const auto line = reading.linearise(model, sheet, unknowns.settings());
    if (!line) return std::nullopt;
    const Eigen::Vector2d f(read.left_mm - line->residual[0], read.right_mm - line->residual[1]);
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(2, b.size());
    const Eigen::Vector2d factor = 1.0 + b.tail(2).array();
    rows.leftCols(settings) = factor.asDiagonal() * line->setting_jacobian;
    rows.rightCols(2) = Eigen::Matrix2d(f.asDiagonal());
    const Eigen::Vector2d left = line->residual - b.tail(2).cwiseProduct(f);
    problem.add_rows(rows, left + rows * b);
  }
  interp::FitOptions options;
  options.correct_covariance = false;
  const auto solved = interp::fit_penalised(problem, options);
  if (!solved) return std::nullopt;
  return solved->coefficients;
}

}  // namespace

JointFit with_plain_calibration(const JointFitInput& input, JointFit fit) {
  const FitUnknowns unknowns(input.machine, input.sheet);
  const Eigen::Index settings = unknowns.size();
  Eigen::VectorXd start(settings + 2);
  start << unknowns.theta_of(fit.machine, fit.sheet), fit.surface.scale.left,
      fit.surface.scale.right;
  Eigen::VectorXd scale = Eigen::VectorXd::Constant(start.size(), kScaleSigma);
  for (Eigen::Index i = 0; i < settings; ++i) scale[i] = unknowns.sigma(i);
  Eigen::VectorXd b = start;
  double moved = 1.0;
  for (int n = 0; n < kMostSteps && moved > kSettled; ++n) {
    const auto next = step(input, fit, unknowns, b);
    if (!next) return fit;
    moved = (*next - b).cwiseQuotient(scale).cwiseAbs().maxCoeff();
    b = *next;
  }
  if (moved > kSettled) return fit;
  fit.machine = unknowns.machine_at(b.head(settings));
  fit.sheet = unknowns.sheet_at(b.head(settings));
  fit.surface.scale = {b[settings], b[settings + 1]};
  const Eigen::VectorXd change = b - start;
  fit.covariance.topLeftCorner(b.size(), b.size()) += change * change.transpose();
  return fit;
}

}  // namespace chaintrue::grid
