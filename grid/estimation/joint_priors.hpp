// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The penalised problem of a fit: weighted rows and priors. Private to grid/estimation.
#pragma once

#include <cmath>

#include "grid/containers.hpp"
#include "grid/estimation/joint_problem.hpp"
#include "interp/eigen.hpp"
#include "interp/linear_algebra.hpp"

namespace chaintrue::grid::estimation {

inline void add_weighted_rows(const JointProblem& joint, const VectorXd& weights,
                              interp::PenalisedProblem& problem) {
  const Index unknowns = joint.design().cols();
  MatrixXd all(joint.design().rows(), unknowns + 1);  // design and response
  Index rows = 0;
  for (const auto u : each_index(joint.units())) {
    const double weight = weights[as_index(u)];
    if (weight == 0.0) continue;
    const SystemUnit& unit = joint.units()[u];
    const MatrixXd left = std::sqrt(weight) * without_readings(unit, joint.rejected(u)).transpose();
    auto own = all.middleRows(rows, left.rows());
    own.leftCols(unknowns) = left * joint.design().middleRows(unit.first_row, unit.rows);
    own.col(unknowns) = left * unit.segment(joint.response());
    rows += left.rows();
  }
  const auto counted = all.topRows(rows);
  // For many rows, products are cheaper than a QR factorisation. They lose half of the digits, which noisy
  // readings do not need.
  constexpr Index kRowsForEachUnknown = 4;
  if (joint.has_surface() && all.rows() > kRowsForEachUnknown * unknowns) {
    problem.add_products(rows, linear::gram(counted));
  } else {
    problem.add_rows(counted.leftCols(unknowns), counted.col(unknowns));
  }
}

/// Stated values, readings of the machine itself and scales: data of known sigma, which the noise
/// factor does not scale. Nuisances of the noise are rows of data, which it scales.
inline void add_stated_priors(const JointProblem& joint, interp::PenalisedProblem& problem) {
  const ObservationSet& set = joint.set();
  const Unknowns& unknowns = joint.unknowns();
  auto precision = problem.prior_precision.diagonal();
  precision.head(unknowns.of_set) = set.stated_sigma.cwiseAbs2().cwiseInverse();
  precision.segment(unknowns.of_set, unknowns.scales)
      .setConstant(1.0 / (kScaleSigma * kScaleSigma));
  Rows of_noise;
  for (const ObservationPart& part : set.parts) {
    const auto& columns = part.nuisance_columns;
    of_noise.insert(of_noise.end(), columns.end() - part.observation->nuisances_of_noise(),
                    columns.end());
  }
  MatrixXd rows = MatrixXd::Zero(std::ssize(of_noise), unknowns.total());
  for (const Index row : each_below(rows.rows())) {
    const Index column = of_noise[as_size(row)];
    rows(row, column) = 1.0 / set.stated_sigma[column];
    precision[column] = 0.0;
  }
  if (!of_noise.empty()) problem.add_rows(rows, VectorXd::Zero(rows.rows()));

  const Index parameters = set.parameters();
  auto of_machine = problem.prior_precision.topLeftCorner(parameters, parameters);
  // Zero if the mechanism starts at the stated values.
  VectorXd pull = VectorXd::Zero(parameters);
  for (const Index i : each_below(parameters)) {
    const auto& stated = set.mechanism->parameters()[as_size(i)].stated;
    if (stated) pull[i] = of_machine(i, i) * (*stated - set.mechanism->values()[i]);
  }
  for (const SystemUnit& unit : joint.certain()) {
    const MatrixXd own = joint.design().block(unit.first_row, 0, unit.rows, parameters);
    of_machine += own.transpose() * own;
    pull += own.transpose() * unit.segment(joint.response());
  }
  problem.prior_mean.head(parameters) = linear::PivotedCholesky(of_machine).solve(pull);
}

inline void add_surface_prior(const JointProblem& joint, const VectorXd& weights,
                              interp::PenalisedProblem& problem) {
  const Unknowns& unknowns = joint.unknowns();
  const ObservedSubspace& observed = *joint.observed();
  problem.prior_precision.diagonal()
      .segment(unknowns.polynomial(Side::left), 2 * unknowns.polynomials)
      .setConstant(1.0 / (kFreePartSigmaMm * kFreePartSigmaMm));
  // One smoothness for both chains: the same causes act on both surfaces.
  problem.ridge.count = 2 * unknowns.penalised;
  // The lambda at which the splines' penalty weighs as much as the data.
  for (const auto u : each_index(joint.units())) {
    for (const observation::PlaceColumns& place : joint.units()[u].places) {
      const double square = observed.squares[as_index(place.place)];
      problem.ridge.balance += weights[as_index(u)] * square * place.by_chain.squaredNorm() /
                               (2.0 * observed.penalty_trace);
    }
  }
}

/// With a weight for each unit; 0 rejects it.
[[nodiscard]] inline interp::PenalisedProblem weighted(const JointProblem& joint,
                                                       const VectorXd& weights) {
  interp::PenalisedProblem problem(joint.unknowns().total());
  problem.noise = joint.input().noise;
  add_weighted_rows(joint, weights, problem);
  add_stated_priors(joint, problem);
  if (joint.has_surface()) add_surface_prior(joint, weights, problem);
  return problem;
}

}  // namespace chaintrue::grid::estimation
