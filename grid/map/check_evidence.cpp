// SPDX-License-Identifier: GPL-3.0-or-later
/// Notation as in the header; q are the changed quantities of a hypothesis.
#include "grid/map/check_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "grid/containers.hpp"
#include "grid/map/check_readings.hpp"
#include "grid/statistics.hpp"
#include "interp/linear_algebra.hpp"

namespace chaintrue::grid {
namespace {

using QuantityKind = model::ChangedQuantity::Kind;

/// A hypothesis before fitting.
struct Proposal {
  CheckHypothesis hypothesis;
  double prior = 0.0;
  VectorXd mean;   ///< of r; empty: nothing
  MatrixXd by_q;   ///< X
  VectorXd sigma;  ///< of q
  /// Which of the hypothesis' quantities each q is.
  std::vector<std::size_t> quantity_of_q;
  std::size_t unit = 0;  ///< of a bad point
};

/// The effect of a unit of a quantity on the residuals.
VectorXd column_of(const CheckReadings& readings, const model::ChangedQuantity& quantity) {
  if (quantity.kind == QuantityKind::parameter)
    return readings.by_parameter.col(as_index(quantity.parameter));
  VectorXd added = VectorXd::Zero(readings.lengths_mm.size());
  for (const std::size_t length : quantity.lengths) {
    for (auto i = as_index(length); i < added.size(); i += as_index(readings.lengths))
      added[i] = quantity.kind == QuantityKind::elongation ? -readings.lengths_mm[i] : 1.0;
  }
  return readings.by_length * added;
}

Proposal proposal_of(const CheckReadings& readings, const model::MechanismChange& change) {
  Proposal proposal;
  proposal.prior = change.prior;
  CheckHypothesis& hypothesis = proposal.hypothesis;
  hypothesis.what = change.what;
  hypothesis.side = change.side;
  hypothesis.verdict =
      change.zero_mends ? CheckVerdict::valid_after_rezeroing : CheckVerdict::measure_again;
  hypothesis.count = change.count;
  for (const model::ChangedQuantity& quantity : change.quantities) {
    hypothesis.found.push_back({quantity, quantity.mean, 0.0});
    const VectorXd column = column_of(readings, quantity);
    if (quantity.mean != 0.0) {
      if (proposal.mean.size() == 0) proposal.mean = VectorXd::Zero(column.size());
      proposal.mean += quantity.mean * column;
    }
    if (quantity.sigma == 0.0) continue;
    const Index at = proposal.by_q.cols();
    proposal.by_q.conservativeResize(column.size(), at + 1);
    proposal.by_q.col(at) = column;
    proposal.sigma.conservativeResize(at + 1);
    proposal.sigma[at] = quantity.sigma;
    proposal.quantity_of_q.push_back(hypothesis.found.size() - 1);
  }
  return proposal;
}

Proposal plain(model::Change what, CheckVerdict verdict, double prior) {
  Proposal proposal;
  proposal.hypothesis.what = what;
  proposal.hypothesis.verdict = verdict;
  proposal.prior = prior;
  return proposal;
}

/// All hypotheses for these readings.
std::vector<Proposal> proposals_of(const CheckReadings& readings) {
  const model::ChangePriors& prior = model::kChangePriors;
  std::vector<Proposal> all;
  all.push_back(plain(model::Change::nothing, CheckVerdict::valid, prior.nothing));
  for (const model::MechanismChange& change : readings.changes)
    all.push_back(proposal_of(readings, change));
  all.push_back(plain(model::Change::unknown, CheckVerdict::measure_again, prior.unknown));
  for (std::size_t u = 0; u < readings.units.size(); ++u) {
    const CheckUnit& unit = readings.units[u];
    Proposal& bad = all.emplace_back(plain(model::Change::bad_point, CheckVerdict::measure_again,
                                           prior.bad_point / as_double(readings.units.size())));
    bad.hypothesis.count = static_cast<int>(unit.index);
    bad.hypothesis.name = unit.name;
    bad.unit = u;
  }
  return all;
}

/// log of evidence times prior of each proposal, K being factored once. A hypothesis adds a few
/// directions U, or removes one unit's information:
///   x' (K + U U')^-1 x = x' K^-1 x - x' K^-1 U M^-1 U' K^-1 x,  |K + U U'| = |K| |M|,
///   M = I + U' K^-1 U     (W)
class Evidence {
 public:
  explicit Evidence(const CheckReadings& readings)
      : readings_(readings),
        nothing_(readings.covariance),
        residual_(nothing_.conditioned(readings.residual_mm)),
        pulled_(nothing_.pulled(residual_)),
        precision_(nothing_.precision_of_units()) {}

  /// Stores the posterior of q.
  double weigh(Proposal& proposal) const {
    const model::Change what = proposal.hypothesis.what;
    return std::log(proposal.prior) + (what == model::Change::unknown ? of_unknown()
                                       : what == model::Change::bad_point
                                           ? of_bad_unit(proposal.unit)
                                           : of_change(proposal));
  }

 private:
  /// The log evidence (2) or (3), from log|V|^1/2 and r' V^-1 r.
  double log_density(double log_root, double square) const {
    const double nu = readings_.noise_dof;
    if (!std::isfinite(nu)) return -log_root - 0.5 * square;
    const auto n = as_double(readings_.residual_mm.size());
    return -log_root - 0.5 * (n + nu) * std::log1p(square / nu);
  }

  /// Every place may have changed independently, by kUnknownSigmaMm in each length.
  double of_unknown() const {
    ReadingCovariance covariance = readings_.covariance;
    add_errors(kUnknownSigmaMm * readings_.by_length, covariance);
    const FactoredCovariance all(covariance);
    return log_density(all.log_root_det(), all.conditioned(readings_.residual_mm).squaredNorm());
  }

  /// A bad unit: kOutlierSigmaMm is added to its noise.
  double of_bad_unit(std::size_t unit) const {
    const MatrixXd& precision = precision_[unit];
    MatrixXd m = kOutlierSigmaMm * kOutlierSigmaMm * precision;
    m.diagonal().array() += 1.0;
    const linear::Cholesky factor(std::move(m));
    const VectorXd conditioned =
        kOutlierSigmaMm *
        pulled_.segment(as_index(readings_.units[unit].first_row), precision.rows());
    return log_density(nothing_.log_root_det() + 0.5 * factor.log_det(),
                       residual_.squaredNorm() - conditioned.dot(factor.solve(conditioned)));
  }

  double of_change(Proposal& proposal) const {
    const VectorXd y = proposal.mean.size() == 0
                           ? residual_
                           : VectorXd(residual_ - nothing_.conditioned(proposal.mean));
    if (proposal.by_q.cols() == 0) return log_density(nothing_.log_root_det(), y.squaredNorm());
    const MatrixXd u = nothing_.conditioned(proposal.by_q * proposal.sigma.asDiagonal());
    const linear::Cholesky factor(linear::one_plus_gram(u));
    const VectorXd by_y = linear::product(linear::transposed(u), y);
    const VectorXd taken = factor.solve(by_y);
    const double value = log_density(nothing_.log_root_det() + 0.5 * factor.log_det(),
                                     y.squaredNorm() - by_y.dot(taken));
    const VectorXd q = proposal.sigma.cwiseProduct(taken);
    const MatrixXd covariance =
        proposal.sigma.asDiagonal() * factor.inverse() * proposal.sigma.asDiagonal();
    return value + take_posterior(proposal, q, covariance);
  }

  /// Fills the hypothesis; returns the addition to the evidence for a quantity that can only grow.
  static double take_posterior(Proposal& proposal, const VectorXd& q, const MatrixXd& covariance) {
    double added = 0.0;
    for (std::size_t k = 0; k < proposal.quantity_of_q.size(); ++k) {
      const auto at = as_index(k);
      QuantityFound& found = proposal.hypothesis.found[proposal.quantity_of_q[k]];
      found.value += q[at];
      found.sigma = std::sqrt(covariance(at, at));
      if (found.of.only_grows)
        added += std::log(std::max(1e-300, 2.0 * normal_upper(-q[at] / found.sigma)));
    }
    return added;
  }

  const CheckReadings& readings_;
  FactoredCovariance nothing_;
  VectorXd residual_;  ///< Y of reading_covariance.hpp (2)
  VectorXd pulled_;    ///< K^-1 r
  std::vector<MatrixXd> precision_;
};

}  // namespace

std::vector<CheckHypothesis> weighed_hypotheses(const CheckReadings& readings) {
  std::vector<Proposal> proposals = proposals_of(readings);
  std::vector<double> weights;
  const Evidence evidence(readings);
  for (Proposal& proposal : proposals) weights.push_back(evidence.weigh(proposal));
  const double of_all = log_sum(weights);
  std::vector<CheckHypothesis> hypotheses;
  for (std::size_t i = 0; i < proposals.size(); ++i) {
    proposals[i].hypothesis.probability = std::exp(weights[i] - of_all);
    hypotheses.push_back(std::move(proposals[i].hypothesis));
  }
  return hypotheses;
}

}  // namespace chaintrue::grid
