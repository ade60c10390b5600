// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The observations as linear equations about a state of the machine
/// (estimation/linearised_system.hpp) with what a diagnosis adds: a regressor for every effect of
/// the catalogue at every place where it may set in. Everything from here on knows units and places,
/// and not how they were measured.
///
/// Notation, in addition
///   g_k  W (prediction with the effect less without it)
///   q    columns: settings (those of a sheet once for each sheet), then nuisances
///
/// A regressor is a secant: exact at the size at which it was taken, and proportional to
/// size^power. Coefficient b of a regressor is (size / that size)^power; a power of about one goes
/// on through zero as a straight line.
#pragma once

#include <Eigen/Core>
#include <tl/expected.hpp>
#include <vector>

#include "grid/diagnosis/regressor_columns.hpp"
#include "grid/diagnosis/observations.hpp"
#include "grid/estimation/linearised_system.hpp"

namespace chaintrue::grid::diagnosis {

using estimation::SystemPlace;
using estimation::SystemUnit;

/// An effect at one side, one place and one size.
struct Regressor {
  CauseId cause;
  std::vector<double> values;  ///< sizes and places, in the effect's order
  double power = 1.0;          ///< of a refined one: as it is about its size
  /// The size is a whole number: the coefficient is 1 and `values` hold it.
  bool fixed = false;
  /// It acts at one visit alone.
  bool slip = false;
  /// The secant was taken at a size that was found: its coefficient can be held against its bounds.
  bool refined = false;
  /// What the coefficient may be.
  double lowest = 0.0;
  double highest = 0.0;
  /// Of a cause with whole numbers: visits at which it may be.
  double visits = 0.0;
  /// Share of this side, place and whole number within the effect (whole numbers: link_priors.hpp).
  double log_prior = 0.0;
};

/// A linearised system with its regressors, and what is known of its unknowns beforehand.
struct RegressorSystem : estimation::LinearisedSystem {
  RegressorColumns g;  ///< n x a column a regressor
  std::vector<Regressor> regressors;
  Eigen::VectorXd setting;          ///< q, value in the state
  Eigen::VectorXd expected_change;  ///< q, stated less that
  Eigen::VectorXd sigma;            ///< q, one sigma as stated
  double noise_dof = 15.0;          ///< how well the noise is known, degrees of freedom
  std::size_t fewest_units = 0;     ///< with fewer left, none is set aside
};

/// Without regressors. Fails with the first place that the machine cannot reach.
[[nodiscard]] tl::expected<RegressorSystem, observation::Unreachable> linearise(
    const ObservationSet& set, const State& state, const Steps& steps);

}  // namespace chaintrue::grid::diagnosis
