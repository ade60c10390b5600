// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/held_out_fold.hpp"

#include "grid/diagnosis/expected_improvement.hpp"
#include "grid/diagnosis/best_model.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

class Folds {
 public:
  explicit Folds(const Analysis& analysis) : a_(analysis) {}

  [[nodiscard]] Fold without(const std::vector<std::size_t>& units) const {
    std::vector<bool> excluded(a_.session.units.size(), false);
    for (const std::size_t u : units) excluded[u] = true;
    const DiagnosisOptions& options = a_.options;
    ModelComparison comparison =
        compare_models(a_.system,
                       excluded,
                       {.steps = options.steps,
                        .kernels = best_kernels(a_.comparison),
                        .given_cause = options.given_cause});
    // The same gate as for all units: the strongest score against what noise does.
    const MarginalisedSystem& first =
        comparison.marginalised_systems[comparison.best().marginalised];
    const SingleScore score(a_.system, first, a_.session.noise_dof);
    if (!a_.parts.empty()) {
      (void)average_over_parts(
          a_.system, noise_dof(a_), excluded, a_.session.fewest_units, comparison);
    }
    const bool detected = options.given_cause.has_value() ||
                      a_.null.p_value(score.largest(first.e)) < kFalseAlarm;
    const Decision decision = decide_for_leaders(a_.system, comparison, excluded, detected);
    const MarginalisedSystem& marginalised =
        comparison.marginalised_systems[decision.marginalised];
    // A reading wrong at its own visit alone says nothing of any other.
    std::vector<bool> out = marginalised_system(a_).outliers;
    reject_slips(a_, out);
    Fold fold;
    for (const std::size_t u : units) {
      if (!out[u]) fold.units.push_back(u);
    }
    for (const std::size_t index : decision.listed) fold.named.push_back(decision.classes[index]);
    measure(comparison, decision, marginalised, fold);
    return fold;
  }

 private:
  void measure(const ModelComparison& comparison,
               const Decision& decision,
               const MarginalisedSystem& marginalised,
               Fold& fold) const {
    const std::vector<int>& all = a_.decision.regressors;
    const auto without = [&](const std::vector<int>& regressors) {
      return errors(fit(marginalised, regressors), fold.units);
    };
    const auto given = [&](const std::vector<int>& regressors) {
      const int discrepancy =
          preferred_discrepancy(comparison, decision.marginalised, regressors);
      return errors(fit(marginalised, regressors, discrepancy), fold.units);
    };
    fold.errors.calibrated = errors(fit(without_slips(a_, marginalised), {}), fold.units);
    fold.errors.surface_only = given({});
    fold.errors.extended = without(decision.regressors);
    fold.errors.extended_and_surface = given(decision.regressors);
    fold.errors.fixed_naming = without(all);
    fold.errors.fixed_naming_and_surface = given(all);
  }

  [[nodiscard]] Estimate fit(const MarginalisedSystem& marginalised,
                             const std::vector<int>& regressors,
                             int discrepancy = -1) const {
    return estimate(a_.system, marginalised, regressors, discrepancy);
  }

  /// The discrepancy that the readings prefer given these causes, none where they would rather
  /// have none. Causes that the comparison does not hold at all are far from the best: what is left
  /// given them is taken as given the best.
  static int preferred_discrepancy(const ModelComparison& comparison,
                                   std::size_t marginalised,
                                   const std::vector<int>& regressors) {
    for (const CandidateModel& model : comparison.models) {
      if (model.regressors == regressors && model.marginalised == marginalised)
        return model.discrepancy;
    }
    return comparison.best().discrepancy;
  }

  /// What the model leaves, the discrepancy that it may have taken out.
  [[nodiscard]] std::vector<Eigen::Vector2d> errors(const Estimate& model,
                                                    const std::vector<std::size_t>& units) const {
    const Eigen::VectorXd left = left_of_machine(a_.system, model, model.left_given_discrepancy);
    std::vector<Eigen::Vector2d> result;
    for (const std::size_t u : units) result.push_back(error_of_unit(a_.system, left, u));
    return result;
  }

  const Analysis& a_;
};

}  // namespace

Fold hold_out(const Analysis& analysis, const std::vector<std::size_t>& units) {
  return Folds(analysis).without(units);
}

}  // namespace chaintrue::grid::diagnosis
