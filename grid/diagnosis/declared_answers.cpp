// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/declared_answers.hpp"

#include <algorithm>
#include <cmath>

#include "grid/diagnosis/best_model.hpp"
#include "grid/diagnosis/findings.hpp"
#include "model/effects/declared_effect.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

using Says = DeclaredAnswer::Says;

template <class T>
const T* find_of(const std::vector<T>& all, const CauseId& cause) {
  const auto at = std::find_if(
      all.begin(), all.end(), [&](const T& one) { return one.cause == cause; });
  return at == all.end() ? nullptr : &*at;
}

Says said_of(const Diagnosis& found, const CauseId& cause, double probability) {
  if (find_of(found.causes, cause) != nullptr && probability >= kLawClaimed) return Says::confirmed;
  if (find_of(found.not_testable, cause) != nullptr) return Says::not_testable;
  const Bound* bound = find_of(found.bounds, cause);
  const double usual = std::abs(cause.effect->parameters.front().nominal);
  const bool would_show = bound != nullptr && bound->upper_95 < usual;
  return would_show && probability <= 1.0 - kLawClaimed ? Says::denied : Says::open;
}

}  // namespace

std::string_view name(Says says) {
  constexpr std::string_view kNames[] = {"confirmed", "denied", "open", "not_testable"};
  return kNames[static_cast<std::size_t>(says)];
}

std::vector<DeclaredAnswer> declared_answers(const Analysis& a, const Diagnosis& found) {
  std::vector<DeclaredAnswer> answers;
  const auto add = [&](const CauseId& cause, double probability) {
    if (model::effects::declaration_of(*cause.effect) == nullptr) return;
    answers.push_back({cause, said_of(found, cause, probability), probability});
  };
  for (const CauseId& cause : a.candidates.testable) add(cause, probability_of(a, cause));
  for (const NotTestable& one : a.candidates.not_testable) add(one.cause, 0.0);
  return answers;
}

}  // namespace chaintrue::grid::diagnosis
