// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/held_out_fold.hpp"

#include "grid/diagnosis/expected_improvement.hpp"
#include "grid/diagnosis/best_model.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// Errors at the units of a fold, of models fitted without them.
class FoldErrors {
 public:
  FoldErrors(const Analysis& analysis, const Downdating::Without& without, const Decision& decision)
      : a_(analysis),
        comparison_(without.comparison),
        decision_(decision),
        marginalised_(marginalise(
            a_.system, comparison_.marginalised_systems[decision.marginalised].outliers)) {}

  [[nodiscard]] Errors at(const std::vector<std::size_t>& units) const {
    const std::vector<int>& all = a_.decision.regressors;
    Errors errors;
    errors.calibrated = left_at(units, fit(without_slips(a_, marginalised_), {}));
    errors.surface_only = left_at(units, given_surface({}));
    errors.extended = left_at(units, fit(marginalised_, decision_.regressors));
    errors.extended_and_surface = left_at(units, given_surface(decision_.regressors));
    errors.fixed_naming = left_at(units, fit(marginalised_, all));
    errors.fixed_naming_and_surface = left_at(units, given_surface(all));
    return errors;
  }

 private:
  [[nodiscard]] Estimate fit(const MarginalisedSystem& marginalised,
                             const std::vector<int>& regressors,
                             int discrepancy = -1) const {
    return estimate(a_.system, marginalised, regressors, discrepancy);
  }

  [[nodiscard]] Estimate given_surface(const std::vector<int>& regressors) const {
    return fit(marginalised_, regressors, preferred_discrepancy(regressors));
  }

  /// The discrepancy that the readings prefer given these causes, none where they would rather
  /// have none. Causes that the comparison does not hold at all are far from the best: what is left
  /// given them is taken as given the best.
  [[nodiscard]] int preferred_discrepancy(const std::vector<int>& regressors) const {
    for (const CandidateModel& model : comparison_.models) {
      if (model.regressors == regressors && model.marginalised == decision_.marginalised)
        return model.discrepancy;
    }
    return comparison_.best().discrepancy;
  }

  /// What the model leaves, the discrepancy that it may have taken out.
  [[nodiscard]] std::vector<Eigen::Vector2d> left_at(const std::vector<std::size_t>& units,
                                                     const Estimate& model) const {
    const Eigen::VectorXd left = left_of_machine(a_.system, model, model.left_given_discrepancy);
    std::vector<Eigen::Vector2d> result;
    for (const std::size_t u : units) result.push_back(error_of_unit(a_.system, left, u));
    return result;
  }

  const Analysis& a_;
  const ModelComparison& comparison_;
  const Decision& decision_;
  MarginalisedSystem marginalised_;
};

}  // namespace

DecidedWithout decided_without(const Analysis& a,
                               const Downdating& downdating,
                               const std::vector<std::size_t>& units) {
  DecidedWithout result{downdating.without(units), {}};
  std::vector<bool> excluded(a.session.units.size(), false);
  for (const std::size_t u : units) excluded[u] = true;
  const bool detected =
      a.options.given_cause.has_value() || a.null.p_value(result.models.score) < kFalseAlarm;
  result.decision =
      decide(a.system, result.models.comparison, excluded, detected, a.decision.classes);
  return result;
}

HeldOutFolds::HeldOutFolds(const Analysis& analysis)
    : analysis_(analysis), downdating_(analysis.system, analysis.comparison) {}

Fold HeldOutFolds::without(const std::vector<std::size_t>& units) const {
  const Analysis& a = analysis_;
  const auto [without, decision] = decided_without(a, downdating_, units);
  // A reading wrong at its own visit alone says nothing of any other.
  std::vector<bool> out = marginalised_system(a).outliers;
  reject_slips(a, out);
  Fold fold;
  for (const std::size_t u : units) {
    if (!out[u]) fold.units.push_back(u);
  }
  for (const std::size_t index : decision.listed) fold.named.push_back(decision.classes[index]);
  fold.errors = FoldErrors(a, without, decision).at(fold.units);
  return fold;
}

}  // namespace chaintrue::grid::diagnosis
