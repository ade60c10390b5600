// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/declared_answers.hpp"

#include <cmath>

#include "grid/containers.hpp"
#include "grid/diagnosis/best_model.hpp"
#include "grid/diagnosis/findings.hpp"
#include "grid/diagnosis/law_model.hpp"
#include "grid/diagnosis/regressors.hpp"
#include "model/effects/catalogue.hpp"
#include "model/effects/declared_effect.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

using Says = DeclaredAnswer::Says;

template <class T>
const T* find_of(const std::vector<T>& all, const CauseId& cause) {
  return find_where(all, [&](const T& one) { return one.cause == cause; });
}

/// The leading model without this cause.
std::vector<int> others_than(const Analysis& a, const CauseId& cause) {
  std::vector<int> others;
  for (const int k : a.decision.regressors) {
    if (regressor(a, k).cause != cause) others.push_back(k);
  }
  return others;
}

/// Whether the readings are more probable without it than with its values in the file.
bool is_refuted(const Analysis& a, const CauseId& cause) {
  const auto g = signature(
      a.session, a.state, a.system, cause, model::effects::nominal_values(*cause.effect));
  if (!g) return false;
  const LawModel model(
      a, marginalised_system(a), others_than(a, cause), a.decision.best_discrepancy);
  const double odds = kLawClaimed / (1.0 - kLawClaimed);
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(g->size());
  return model.log_density(none) - model.log_density(*g) > std::log(odds);
}

Says said_of(const Analysis& a, const Diagnosis& found, const CauseId& cause, double probability) {
  if (find_of(found.causes, cause) != nullptr && probability >= kLawClaimed) return Says::confirmed;
  if (probability > 1.0 - kLawClaimed) return Says::open;
  const Bound* bound = find_of(found.bounds, cause);
  const double usual = std::abs(cause.effect->parameters.front().nominal);
  if ((bound != nullptr && bound->upper_95 < usual) || is_refuted(a, cause)) return Says::denied;
  return find_of(found.not_testable, cause) != nullptr ? Says::not_testable : Says::open;
}

}  // namespace

std::string_view name(Says says) {
  constexpr std::string_view kNames[] = {"confirmed", "denied", "open", "not_testable"};
  return kNames[static_cast<std::size_t>(says)];
}

std::vector<DeclaredAnswer> declared_answers(const Analysis& a, const Diagnosis& found) {
  std::vector<DeclaredAnswer> answers;
  const auto is_declared = [](const CauseId& cause) {
    return model::effects::declaration_of(*cause.effect) != nullptr;
  };
  for (const CauseId& cause : a.candidates.testable) {
    if (!is_declared(cause)) continue;
    const double probability = probability_of(a, cause);
    answers.push_back({cause, said_of(a, found, cause, probability), probability});
  }
  for (const NotTestable& one : a.candidates.not_testable) {
    if (is_declared(one.cause)) answers.push_back({one.cause, Says::not_testable, 0.0});
  }
  return answers;
}

}  // namespace chaintrue::grid::diagnosis
