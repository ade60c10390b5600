// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Every effect of the catalogue as columns of a linearised system, at every place where it may set
/// in.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "grid/diagnosis/diagnosis.hpp"
#include "grid/diagnosis/regressor_system.hpp"
#include "interp/eigen.hpp"
#include "model/effects/declared_effect.hpp"

namespace chaintrue::grid::diagnosis {

/// Effects that these data can never show, each with its reason.
struct Candidates {
  std::vector<CauseId> testable;
  std::vector<NotTestable> not_testable;
};
/// An effect that one of the observations can show is testable.
Candidates candidates(const ObservationSet& session);

/// Appends the regressors of all these causes. Known causes get secants at their sizes, and also at
/// their places.
void add_regressors(const ObservationSet& session, const State& state,
                    const std::vector<CauseId>& causes, const std::vector<SizedCause>& known,
                    RegressorSystem& system);

/// Recomputes regressors about another state, at their values. False if such a machine is invalid.
bool renew_regressors(const ObservationSet& session, const State& state,
                      const std::vector<Regressor>& regressors, RegressorSystem& system);

/// The whitened column of a cause; empty if such a machine is invalid.
std::optional<VectorXd> signature(const ObservationSet& session, const State& state,
                                  const RegressorSystem& system, const SizedCause& cause);
using ColumnOf = std::function<std::optional<VectorXd>(const SizedCause&)>;

/// Appends a regressor with its power and range, from its column and one at a smaller size: nearby if
/// it is refined, else half. False if it has none.
bool add_regressor(Regressor regressor, const ColumnOf& column, RegressorSystem& system);

/// Size of a cause at a coefficient of its regressor.
double size_at(const Regressor& regressor, double coefficient);
/// d(size)/d(coefficient) there.
double size_slope(const Regressor& regressor, double coefficient);

}  // namespace chaintrue::grid::diagnosis
