// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/joint_problem.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "grid/map/measured_area.hpp"

namespace chaintrue::grid {
namespace {

/// Intervals a little wider than the square that each point has to itself: three more coefficients
/// than intervals on each axis still let noise-free points be met; the penalty makes what is too
/// many of them harmless, and beyond some 200 a surface more would only cost time. The smoother
/// surface is for points that are met closely, and closer ones show.
interp::BsplineBasis basis_for(const interp::Rectangle& domain,
                               const std::vector<model::BedPoint>& marks,
                               int bending_order) {
  const double widening = bending_order == 2 ? 1.2 : 0.8;
  const double spacing_mm = widening * 2.0 * MeasuredArea(marks, domain).edge_mm();
  const auto intervals = [spacing_mm](double length_mm, int most) {
    return std::clamp(static_cast<int>(std::ceil(length_mm / spacing_mm)), 3, most);
  };
  return {domain, intervals(domain.width(), 12), intervals(domain.height(), 8)};
}

std::vector<model::BedPoint> marks_of(const std::vector<LengthPoint>& points) {
  std::vector<model::BedPoint> marks;
  for (const LengthPoint& point : points) marks.push_back(point.mark);
  return marks;
}

}  // namespace

JointFitFailure unreachable(const LengthPoint& point, model::PoseFailure failure) {
  return {JointFitFailure::Reason::point_unreachable,
          fmt::format("point {} at ({:.1f}, {:.1f}): {}",
                      point.index + 1,
                      point.mark.x_mm,
                      point.mark.y_mm,
                      model::explain(failure))};
}

JointProblem::JointProblem(const JointFitInput& input)
    : input_(input),
      unknowns_(input.machine, input.sheet),
      basis_(basis_for(input.domain, marks_of(input.points), input.bending_order)),
      observed_(basis_, input.bending_order, marks_of(input.points)),
      columns_{unknowns_.size(), observed_.polynomials(), observed_.bends()} {}

/// The two rows of the design at a point: d(corrected lengths)/d(unknowns).
Eigen::MatrixXd JointProblem::design_of(Eigen::Index point,
                                        model::ChainLengths lengths,
                                        const Eigen::MatrixXd& settings_jacobian) const {
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(2, columns_.total());
  rows.leftCols(columns_.settings) = settings_jacobian;
  for (const model::Side side : model::kSides) {
    const Eigen::Index row = side == model::Side::left ? 0 : 1;
    rows(row, columns_.scale(side)) =
        side == model::Side::left ? lengths.left_mm : lengths.right_mm;
    rows.row(row).segment(columns_.polynomial(side), columns_.polynomials) =
        observed_.polynomial_rows().row(point);
    rows.row(row).segment(columns_.bend(side), columns_.bends) = observed_.bend_rows().row(point);
  }
  return rows;
}

tl::expected<void, JointFitFailure> JointProblem::linearise(const Eigen::VectorXd& theta) {
  const model::ReadingModel model(unknowns_.machine_at(theta));
  const model::SheetPlacement sheet = unknowns_.sheet_at(theta);
  white_.clear();
  for (const LengthPoint& point : input_.points) {
    const model::ChainReading reading(point.mark, point.lengths, input_.noise);
    const auto line = reading.linearise(model, sheet, unknowns_.settings());
    if (!line) return tl::unexpected(unreachable(point, line.error()));
    WhitePoint white;
    const Eigen::Matrix2d lower = Eigen::Matrix2d(line->covariance).llt().matrixL();
    white.whitening = lower.inverse();
    const model::ChainLengths predicted{point.lengths.left_mm - line->residual[0],
                                        point.lengths.right_mm - line->residual[1]};
    white.design =
        white.whitening *
        design_of(static_cast<Eigen::Index>(white_.size()), predicted, line->setting_jacobian);
    white.response = white.whitening * (line->residual + line->setting_jacobian * theta);
    white_.push_back(std::move(white));
  }
  extra_.clear();
  for (const auto& observation : input_.extra) {
    const auto line = observation->linearise(model, sheet, unknowns_.settings());
    if (!line) continue;  // readings of the machine itself have no pose that could fail
    const double scale = 1.0 / std::sqrt(line->covariance(0, 0));
    extra_.push_back({scale * line->setting_jacobian.row(0),
                      scale * (line->residual + line->setting_jacobian * theta)[0]});
  }
  return {};
}

void JointProblem::add_points(interp::PenalisedProblem& problem,
                              const Eigen::VectorXd& weights) const {
  const auto points = static_cast<Eigen::Index>(white_.size());
  Eigen::MatrixXd design(2 * points, columns_.total());
  Eigen::VectorXd response(2 * points);
  Eigen::Index rows = 0;
  for (Eigen::Index i = 0; i < points; ++i) {
    if (weights[i] == 0.0) continue;
    const double root = std::sqrt(weights[i]);
    const WhitePoint& white = white_[static_cast<std::size_t>(i)];
    design.middleRows(rows, 2) = root * white.design;
    response.segment(rows, 2) = root * white.response;
    rows += 2;
  }
  problem.add_rows(design.topRows(rows), response.head(rows));
}

/// What was stated, and readings of the machine itself: data of known sigma, which the points'
/// noise factor does not scale.
void JointProblem::add_settings_prior(interp::PenalisedProblem& problem) const {
  const Eigen::Index settings = columns_.settings;
  Eigen::MatrixXd precision = Eigen::MatrixXd::Zero(settings, settings);
  Eigen::VectorXd pull = Eigen::VectorXd::Zero(settings);
  for (Eigen::Index i = 0; i < settings; ++i) {
    precision(i, i) = 1.0 / (unknowns_.sigma(i) * unknowns_.sigma(i));
  }
  for (const WhiteReading& reading : extra_) {
    precision += reading.row.transpose() * reading.row;
    pull += reading.row.transpose() * reading.response;
  }
  problem.prior_precision.topLeftCorner(settings, settings) = precision;
  problem.prior_mean.head(settings) = precision.ldlt().solve(pull);
}

void JointProblem::add_surface_prior(interp::PenalisedProblem& problem,
                                     const Eigen::VectorXd& weights) const {
  problem.prior_precision.diagonal()
      .segment(columns_.settings, 2)
      .setConstant(1.0 / (kScaleSigma * kScaleSigma));
  problem.prior_precision.diagonal()
      .segment(columns_.polynomial(model::Side::left), 2 * columns_.polynomials)
      .setConstant(1.0 / (kFreePartSigmaMm * kFreePartSigmaMm));
  // One smoothness for both chains: what bends one surface bends the other.
  interp::Penalty penalty;
  penalty.first_column = columns_.bend(model::Side::left);
  penalty.matrix = Eigen::MatrixXd::Identity(2 * columns_.bends, 2 * columns_.bends);
  penalty.rank = 2 * columns_.bends;
  // Where the splines' own penalty would weigh as much as the data.
  for (std::size_t i = 0; i < white_.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    penalty.balance += weights[at] * observed_.squares()[at] * white_[i].whitening.squaredNorm() /
                       (2.0 * observed_.penalty_trace());
  }
  problem.penalties = {std::move(penalty)};
}

interp::PenalisedProblem JointProblem::weighted(const Eigen::VectorXd& weights) const {
  interp::PenalisedProblem problem(columns_.total());
  problem.keeps_rows = true;
  problem.prior_precision = Eigen::MatrixXd::Zero(columns_.total(), columns_.total());
  problem.prior_mean = Eigen::VectorXd::Zero(columns_.total());
  problem.noise = input_.noise_scale;
  add_points(problem, weights);
  add_settings_prior(problem);
  add_surface_prior(problem, weights);
  return problem;
}

Eigen::VectorXd JointProblem::spline_coefficients(const interp::PenalisedFit& fit,
                                                  model::Side side) const {
  return observed_.polynomial_coefficients() *
             fit.coefficients.segment(columns_.polynomial(side), columns_.polynomials) +
         observed_.bend_coefficients() *
             fit.coefficients.segment(columns_.bend(side), columns_.bends);
}

/// Of the splines' own coefficients: what the points see, and what keeps its prior.
Eigen::MatrixXd JointProblem::covariance(const interp::PenalisedFit& fit,
                                         const FitColumns& columns) const {
  Eigen::MatrixXd to_splines = Eigen::MatrixXd::Zero(columns.total(), columns_.total());
  const Eigen::Index plain = columns_.settings + 2;
  to_splines.topLeftCorner(plain, plain).setIdentity();
  for (const model::Side side : model::kSides) {
    to_splines.block(
        columns.spline(side), columns_.polynomial(side), columns.basis, columns_.polynomials) =
        observed_.polynomial_coefficients();
    to_splines.block(columns.spline(side), columns_.bend(side), columns.basis, columns_.bends) =
        observed_.bend_coefficients();
  }
  Eigen::MatrixXd result = to_splines * fit.corrected_covariance * to_splines.transpose();
  const Eigen::MatrixXd null_space = fit.inverse_lambda[0] * observed_.null_space_coefficients() *
                                     observed_.null_space_coefficients().transpose();
  for (const model::Side side : model::kSides) {
    result.block(columns.spline(side), columns.spline(side), columns.basis, columns.basis) +=
        null_space;
  }
  return result;
}

}  // namespace chaintrue::grid
