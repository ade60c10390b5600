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

using Quantity = model::ChangedQuantity;

/// The effect of a unit of a quantity on the residuals.
VectorXd column_of(const CheckReadings& readings, const Quantity& quantity) {
  if (quantity.kind == Quantity::Kind::parameter)
    return readings.by_parameter.col(as_index(quantity.parameter));
  VectorXd added = VectorXd::Zero(readings.lengths_mm.size());
  for (const std::size_t length : quantity.lengths) {
    for (auto i = as_index(length); i < added.size(); i += as_index(readings.lengths))
      added[i] = quantity.kind == Quantity::Kind::elongation ? -readings.lengths_mm[i] : 1.0;
  }
  return readings.by_length * added;
}

/// log of the evidence of hypotheses, K being factored once. A hypothesis adds a few directions U, or
/// removes one unit's information:
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

  /// Quantities have changed; stores their posterior.
  double of_change(std::vector<QuantityFound>& quantities) const {
    const auto count = std::ssize(quantities);
    MatrixXd by_q(readings_.residual_mm.size(), count);
    VectorXd mean(count), sigma(count);
    for (const Index k : each_below(count)) {
      const Quantity& quantity = quantities[as_size(k)].of;
      by_q.col(k) = column_of(readings_, quantity);
      mean[k] = quantity.mean;
      sigma[k] = quantity.sigma;
    }
    const VectorXd y = residual_ - nothing_.conditioned(by_q * mean);
    const MatrixXd u = nothing_.conditioned(by_q * sigma.asDiagonal());
    const linear::Cholesky factor(linear::one_plus_gram(u));
    const VectorXd by_y = linear::inner(u, y);
    const VectorXd taken = factor.solve(by_y);
    double value = log_density(nothing_.log_root_det() + 0.5 * factor.log_det(),
                               y.squaredNorm() - by_y.dot(taken));
    const MatrixXd covariance = factor.inverse();
    for (const Index k : each_below(count)) {
      QuantityFound& found = quantities[as_size(k)];
      const double q = sigma[k] * taken[k];
      found.value = mean[k] + q;
      found.sigma = sigma[k] * std::sqrt(covariance(k, k));
      if (found.of.only_grows)
        value += std::log(std::max(1e-300, 2.0 * normal_upper(-q / found.sigma)));
    }
    return value;
  }

 private:
  /// The log evidence (2) or (3), from log|V|^1/2 and r' V^-1 r.
  double log_density(double log_root, double square) const {
    const double nu = readings_.noise_dof;
    if (!std::isfinite(nu)) return -log_root - 0.5 * square;
    const auto n = as_double(readings_.residual_mm.size());
    return -log_root - 0.5 * (n + nu) * std::log1p(square / nu);
  }

  const CheckReadings& readings_;
  FactoredCovariance nothing_;
  VectorXd residual_;  ///< Y of reading_covariance.hpp (2)
  VectorXd pulled_;    ///< K^-1 r
  std::vector<MatrixXd> precision_;
};

}  // namespace

std::vector<CheckHypothesis> weighed_hypotheses(const CheckReadings& readings) {
  const Evidence evidence(readings);
  const model::ChangePriors& prior = model::kChangePriors;
  std::vector<CheckHypothesis> hypotheses;
  std::vector<double> weights;
  const auto add = [&](CheckHypothesis hypothesis, double own_prior, double log_evidence) {
    hypotheses.push_back(std::move(hypothesis));
    weights.push_back(std::log(own_prior) + log_evidence);
  };
  std::vector<QuantityFound> none;
  add({Change::nothing, {}}, prior.nothing, evidence.of_change(none));
  for (const model::MechanismChange& change : readings.changes) {
    std::vector<QuantityFound> found;
    for (const Quantity& quantity : change.quantities) found.push_back({quantity});
    const double own = evidence.of_change(found);
    const CheckVerdict verdict =
        change.zero_mends ? CheckVerdict::valid_after_rezeroing : CheckVerdict::measure_again;
    add({change.what, change.side, verdict, 0.0, change.count, {}, std::move(found)}, change.prior,
        own);
  }
  add({Change::unknown, {}, CheckVerdict::measure_again}, prior.unknown, evidence.of_unknown());
  for (const auto u : each_index(readings.units)) {
    const CheckUnit& unit = readings.units[u];
    add({Change::bad_point, {}, CheckVerdict::measure_again, 0.0, as_int(unit.index), unit.name},
        prior.bad_point / as_double(readings.units.size()), evidence.of_bad_unit(u));
  }
  const double of_all = log_sum(weights);
  for (const auto i : each_index(hypotheses))
    hypotheses[i].probability = std::exp(weights[i] - of_all);
  return hypotheses;
}

namespace {

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
  if (h.what == Change::nothing) return "nothing has changed";
  if (h.what == Change::bad_point) return fmt::format("only {} is wrong", h.name);
  if (h.what == Change::unknown) return "something has changed that has no known pattern";
  return words.change(h);
}

std::string sentence_of(const Check& check, const CheckWords& words) {
  const CheckHypothesis& first = check.hypotheses.front();
  const double percent = 100.0 * check.probability[as_size(check.verdict)];
  if (first.what == Change::bad_point) {
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
  return word_of(verdict, {"valid", "valid_after_rezeroing", "measure_again"});
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
