// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/trend.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grid/diagnosis/normal.hpp"
#include "grid/diagnosis/workshop_units.hpp"
#include "model/effects/effect.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// From this chance on a change is spoken of as one: one in twenty otherwise.
constexpr double kSaid = 0.95;

const std::vector<ParameterEstimate>* named(const Diagnosis& d, const CauseId& id) {
  for (const Cause& cause : d.causes) {
    if (cause.cause == id) return &cause.parameters;
    for (const SameCause& same : cause.same_as) {
      if (same.cause == id) return &same.parameters;
    }
  }
  return nullptr;
}

/// Size of a cause, named or not; empty where it was not tested.
std::optional<ParameterEstimate> size_in(const Diagnosis& d, const CauseId& id) {
  if (const auto* parameters = named(d, id)) return parameters->front();
  for (const Term& term : d.terms) {
    if (term.cause == id) return ParameterEstimate{term.parameter, term.value, term.sigma};
  }
  return std::nullopt;
}

}  // namespace

Trend trend(const Diagnosis& before, const Diagnosis& now, std::string since) {
  Trend result;
  result.since = std::move(since);
  std::vector<CauseId> all;
  for (const Diagnosis* d : {&now, &before}) {
    for (const Cause& cause : d->causes) {
      if (std::find(all.begin(), all.end(), cause.cause) == all.end()) all.push_back(cause.cause);
    }
  }
  for (const CauseId& id : all) {
    const auto first = size_in(before, id);
    const auto second = size_in(now, id);
    if (!first || !second) continue;
    Change change{id, *first, *second, named(before, id) != nullptr, named(now, id) != nullptr};
    const double sigma = std::hypot(first->sigma, second->sigma);
    const double difference = std::abs(second->value) - std::abs(first->value);
    // Whole numbers have no sigma: they changed or they did not.
    change.probability = sigma > 0.0         ? 1.0 - normal_upper(std::abs(difference) / sigma)
                         : difference != 0.0 ? 1.0
                                             : 0.5;
    result.changes.push_back(change);
  }
  if (before.tool_today && now.tool_today) {
    result.uncalibrated_before_mm = before.tool_today->rms_mm;
    result.uncalibrated_mm = now.tool_today->rms_mm;
  } else if (before.budget && now.budget) {
    result.uncalibrated_before_mm = before.budget->uncalibrated_mm;
    result.uncalibrated_mm = now.budget->uncalibrated_mm;
  }
  return result;
}

std::string change_in_words(const Change& change) {
  const double difference = std::abs(change.after.value) - std::abs(change.before.value);
  const std::string sizes = fmt::format("{}, before {}",
                                        in_workshop_units(change.cause, change.after),
                                        in_workshop_units(change.cause, change.before));
  const std::string what =
      fmt::format("{}{}", change.cause.effect->cause, side_words(change.cause));
  if (change.probability < kSaid) {
    return fmt::format("{}: no change that these readings show ({})", what, sizes);
  }
  return fmt::format("{}: {}, {} sure ({})",
                     what,
                     difference > 0.0 ? "grew" : "became less",
                     percent(change.probability),
                     sizes);
}

}  // namespace chaintrue::grid::diagnosis
