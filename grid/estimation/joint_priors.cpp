// SPDX-License-Identifier: GPL-3.0-or-later
/// The problem of a fit: weighted rows and priors.
#include <cmath>

#include "grid/containers.hpp"
#include "grid/estimation/joint_problem.hpp"
#include "grid/estimation/unknowns.hpp"
#include "interp/linear_algebra.hpp"
#include "model/calibration/setting.hpp"

namespace chaintrue::grid::estimation {

using model::Side;
using observation::Observation;

void JointProblem::add_rows(interp::PenalisedProblem& problem,
                            const Eigen::VectorXd& weights) const {
  if (local_) {
    local_->add_rows(response_, weights, problem);
    return;
  }
  Eigen::MatrixXd design(design_.rows(), design_.cols());
  Eigen::VectorXd response(design_.rows());
  Eigen::Index rows = 0;
  for (std::size_t u = 0; u < units_.size(); ++u) {
    const double weight = weights[as_index(u)];
    if (weight == 0.0) continue;
    const double root = std::sqrt(weight);
    const SystemUnit& unit = units_[u];
    if (!rejected(u).empty()) {
      const Eigen::MatrixXd left = root * without_readings(unit, rejected(u)).transpose();
      design.middleRows(rows, left.rows()) = left * design_.middleRows(unit.first_row, unit.rows);
      response.segment(rows, left.rows()) = left * response_.segment(unit.first_row, unit.rows);
      rows += left.rows();
      continue;
    }
    design.middleRows(rows, unit.rows) = root * design_.middleRows(unit.first_row, unit.rows);
    response.segment(rows, unit.rows) = root * response_.segment(unit.first_row, unit.rows);
    rows += unit.rows;
  }
  problem.add_rows(design.topRows(rows), response.head(rows));
}

/// Priors of settings and scales, and readings of the machine itself: data of known sigma, which
/// the noise factor does not scale.
void JointProblem::add_settings_prior(interp::PenalisedProblem& problem) const {
  const Eigen::Index count = unknowns_->settings() + unknowns_->scales();
  Eigen::MatrixXd precision = Eigen::MatrixXd::Zero(count, count);
  Eigen::VectorXd pull = Eigen::VectorXd::Zero(count);
  for (Eigen::Index i = 0; i < unknowns_->settings(); ++i)
    precision(i, i) = 1.0 / (unknowns_->sigma(i) * unknowns_->sigma(i));
  precision.diagonal().tail(unknowns_->scales()).setConstant(1.0 / (kScaleSigma * kScaleSigma));
  // Zero if the mechanism starts at the stated values.
  const Eigen::VectorXd stated = unknowns_->stated_deviations();
  pull.head(stated.size()) = precision.diagonal().head(stated.size()).cwiseProduct(stated);
  for (Eigen::Index i = 0; i < sure_design_.rows(); ++i) {
    const Eigen::RowVectorXd row = sure_design_.row(i).head(count);
    precision += row.transpose() * row;
    pull += row.transpose() * sure_response_[i];
  }
  problem.prior_precision.topLeftCorner(count, count) = precision;
  // No reading of the machine depends on the scales.
  const Eigen::Index coupled = unknowns_->settings();
  problem.prior_mean.head(coupled) =
      linear::PivotedCholesky(precision.topLeftCorner(coupled, coupled)).solve(pull.head(coupled));
}

/// Sheets other than the first, zeros of other sessions, and nuisances. Those of the noise are rows
/// of data, which the noise factor scales.
void JointProblem::add_nuisance_prior(interp::PenalisedProblem& problem) const {
  Eigen::Index of_noise = 0;
  for (const auto& observation : input_.observations) of_noise += observation->nuisances_of_noise();
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(of_noise, unknowns_->total());
  Eigen::Index row = 0;
  for (std::size_t k = 0; k < input_.observations.size(); ++k) {
    const Observation& observation = *input_.observations[k];
    for (Eigen::Index i = 0; k > 0 && unknowns_->sheet(k) >= 0 && i < 3; ++i) {
      const Eigen::Index column = unknowns_->sheet(k) + i;
      problem.prior_precision(column, column) =
          1.0 / (unknowns_->sigma(column) * unknowns_->sigma(column));
    }
    for (Eigen::Index i = 0; unknowns_->zeros(k) >= 0 && i < 2; ++i) {
      const Eigen::Index column = unknowns_->zeros(k) + i;
      problem.prior_precision(column, column) =
          1.0 / (unknowns_->sigma(column) * unknowns_->sigma(column));
    }
    const Eigen::VectorXd& sigma = observation.nuisance_sigma();
    const Eigen::Index known = sigma.size() - observation.nuisances_of_noise();
    for (Eigen::Index i = 0; i < sigma.size(); ++i) {
      const Eigen::Index column = unknowns_->nuisance(k) + i;
      if (i < known) {
        problem.prior_precision(column, column) = 1.0 / (sigma[i] * sigma[i]);
      } else {
        rows(row++, column) = 1.0 / sigma[i];
      }
    }
  }
  if (of_noise > 0) problem.add_rows(rows, Eigen::VectorXd::Zero(of_noise));
}

void JointProblem::add_surface_prior(interp::PenalisedProblem& problem,
                                     const Eigen::VectorXd& weights) const {
  const SurfaceColumns& surface = unknowns_->surface();
  problem.prior_precision.diagonal()
      .segment(unknowns_->polynomial(Side::left), 2 * surface.polynomials)
      .setConstant(1.0 / (kFreePartSigmaMm * kFreePartSigmaMm));
  // One smoothness for both chains: the same causes act on both surfaces.
  problem.ridge = {unknowns_->first_penalised_of(Side::left), 2 * surface.penalised};
  // The lambda at which the splines' penalty weighs as much as the data.
  for (std::size_t u = 0; u < units_.size(); ++u) {
    const double weight = weights[as_index(u)];
    for (const observation::PlaceColumns& place : units_[u].places) {
      const double square = observed_->squares()[as_index(place.place)];
      problem.ridge.balance +=
          weight * square * place.by_chain.squaredNorm() / (2.0 * observed_->penalty_trace());
    }
  }
}

interp::PenalisedProblem JointProblem::weighted(const Eigen::VectorXd& weights) const {
  interp::PenalisedProblem problem(unknowns_->total());
  problem.keeps_rows = !local_;
  problem.noise = input_.noise;
  add_rows(problem, weights);
  add_settings_prior(problem);
  add_nuisance_prior(problem);
  if (has_surface_) add_surface_prior(problem, weights);
  return problem;
}

}  // namespace chaintrue::grid::estimation
