// SPDX-License-Identifier: GPL-3.0-or-later
/// Notation as in the header; q are the changed quantities of a hypothesis.
#include "grid/map/check_evidence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "grid/containers.hpp"
#include "grid/map/check_readings.hpp"
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
  Indices quantity_of_q;
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
  for (const auto u : each_index(readings.units)) {
    const CheckUnit& unit = readings.units[u];
    Proposal& bad = all.emplace_back(plain(model::Change::bad_point, CheckVerdict::measure_again,
                                           prior.bad_point / as_double(readings.units.size())));
    bad.hypothesis.count = as_int(unit.index);
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
    const VectorXd by_y = linear::inner(u, y);
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
    for (const auto k : each_index(proposal.quantity_of_q)) {
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

namespace {

using Quantity = model::ChangedQuantity;

/// Probabilities of the verdicts, the likeliest of these, and the hypotheses likeliest first.
void decide(Check& check) {
  for (const CheckHypothesis& h : check.hypotheses)
    check.probability[as_size(h.verdict)] += h.probability;
  stable_sort(check.hypotheses, descending(&CheckHypothesis::probability));
  const auto best = max_element(check.probability);
  check.verdict = static_cast<CheckVerdict>(best - check.probability.begin());
  check.decided = *best >= kDecided;
  // Reports the strongest support for the verdict first.
  const auto first = std::find_if(check.hypotheses.begin(), check.hypotheses.end(),
                                  [&](const auto& h) { return h.verdict == check.verdict; });
  std::rotate(check.hypotheses.begin(), first, first + 1);
}

std::string clause_of(const CheckHypothesis& h, const CheckWords& words) {
  if (h.what == model::Change::nothing) return "nothing has changed";
  if (h.what == model::Change::bad_point) return fmt::format("only {} is wrong", h.name);
  if (h.what == model::Change::unknown) return "something has changed that has no known pattern";
  return words.change(h);
}

std::string sentence_of(const Check& check, const CheckWords& words) {
  const CheckHypothesis& first = check.hypotheses.front();
  const double percent = 100.0 * check.probability[as_size(check.verdict)];
  if (first.what == model::Change::bad_point) {
    return fmt::format(
        "Measure {} again ({:.0f} %): only this reading is wrong, and it does not show whether {} "
        "is valid.",
        first.name, percent, words.subject);
  }
  const bool rezero = check.verdict == CheckVerdict::valid_after_rezeroing;
  const std::string& head = check.verdict == CheckVerdict::valid ? words.valid
                            : rezero                             ? words.rezero
                                                                 : words.again;
  std::string sentence = fmt::format("{} ({:.0f} %): {}.", head, percent, clause_of(first, words));
  if (rezero && words.what_to_set) sentence += " " + words.what_to_set(check);
  return sentence;
}

std::string not_separable_of(const Check& check, const CheckWords& words) {
  if (check.hypotheses.front().probability >= kDecided) return {};
  constexpr double kWorthNaming = 0.05;
  std::vector<std::string> others;
  for (const CheckHypothesis& h : check.hypotheses) {
    if (h.probability >= kWorthNaming)
      others.push_back(fmt::format("{} ({:.0f} %)", clause_of(h, words), 100.0 * h.probability));
  }
  std::string text =
      fmt::format("These {} do not distinguish: {}.", words.readings, fmt::join(others, "; "));
  if (!check.decided) {
    text += fmt::format(" Measure more {}, far from each other, before you rely on either.",
                        words.readings);
  }
  return text;
}

QuantityFound found_of(const CheckHypothesis& h, Quantity::Kind kind, std::size_t length) {
  for (const QuantityFound& one : h.found) {
    if (one.of.kind == kind && contains(one.of.lengths, length)) return one;
  }
  return {};
}

/// Root of the mean square of some of the residuals' numbers.
double rms_over(const CheckUnit& unit, const std::vector<CheckResidual>& residuals,
                double CheckResidual::*number) {
  double square = 0.0;
  for (std::size_t k = unit.first_row; k < unit.first_row + unit.rows; ++k)
    square += residuals[k].*number * residuals[k].*number;
  return std::sqrt(square / as_double(unit.rows));
}

}  // namespace

std::string_view name(CheckVerdict verdict) {
  constexpr std::string_view kNames[] = {"valid", "valid_after_rezeroing", "measure_again"};
  return kNames[as_size(verdict)];
}

QuantityFound CheckHypothesis::added(std::size_t length) const {
  return found_of(*this, Quantity::Kind::added, length);
}

QuantityFound CheckHypothesis::elongation(std::size_t length) const {
  return found_of(*this, Quantity::Kind::elongation, length);
}

double CheckHypothesis::size() const {
  if (found.size() == 1) return found.front().value;
  double square = 0.0;
  for (const QuantityFound& one : found) square += one.value * one.value;
  return std::sqrt(square);
}

double CheckUnit::rms_mm(const std::vector<CheckResidual>& residuals) const {
  return rms_over(*this, residuals, &CheckResidual::residual_mm);
}

double CheckUnit::sigma_mm(const std::vector<CheckResidual>& residuals) const {
  return rms_over(*this, residuals, &CheckResidual::sigma_mm);
}

Check judged(const CheckReadings& readings, const CheckWords& words) {
  Check check;
  check.hypotheses = weighed_hypotheses(readings);
  decide(check);
  for (const auto i : each_index(readings.zero_mm))
    check.new_zero_mm.push_back(readings.zero_mm[i] + check.hypotheses.front().added(i).value);
  const VectorXd variance = readings.covariance.diagonal();
  for (const Index k : each_below(readings.residual_mm.size())) {
    check.residuals.push_back(
        {readings.names[as_size(k)], readings.residual_mm[k], std::sqrt(variance[k])});
  }
  check.units = readings.units;
  stable_sort(check.units, ascending(&CheckUnit::index));
  check.sentence = sentence_of(check, words);
  check.not_separable = not_separable_of(check, words);
  check.notes = readings.notes;
  return check;
}

}  // namespace chaintrue::grid
