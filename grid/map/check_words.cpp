// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/check_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grid/containers.hpp"
#include "grid/eigen.hpp"

namespace chaintrue::grid {
namespace {

using Quantity = model::ChangedQuantity;

/// Probabilities of the verdicts, the likeliest of these, and the hypotheses likeliest first.
void decide(Check& check) {
  for (const CheckHypothesis& h : check.hypotheses)
    check.probability[static_cast<std::size_t>(h.verdict)] += h.probability;
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
  const double percent = 100.0 * check.probability[static_cast<std::size_t>(check.verdict)];
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
  return kNames[static_cast<std::size_t>(verdict)];
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
  for (std::size_t i = 0; i < readings.zero_mm.size(); ++i)
    check.new_zero_mm.push_back(readings.zero_mm[i] + check.hypotheses.front().added(i).value);
  const VectorXd variance = readings.covariance.diagonal();
  for (Index k = 0; k < readings.residual_mm.size(); ++k) {
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
