// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The observations as linear equations about a state of the machine
/// (estimation/linearised_system.hpp) with what a diagnosis adds: a regressor for every effect of
/// the catalogue at every place where it may set in. From here on only units and places matter, not
/// how they were measured.
///
/// Notation, in addition
///   g_k  W (prediction with the effect less without it)
///   q    columns: settings (those of a sheet once for each sheet), then nuisances
///
/// A regressor is a secant: exact at the size at which it was taken, and proportional to
/// size^power. Coefficient b of a regressor is (size / that size)^power; a power of about one
/// continues through zero as a straight line.
#pragma once

#include <limits>
#include <optional>
#include <tl/expected.hpp>
#include <vector>

#include "grid/diagnosis/constants.hpp"
#include "grid/diagnosis/observations.hpp"
#include "grid/diagnosis/regressor_columns.hpp"
#include "grid/eigen.hpp"
#include "grid/estimation/linearised_system.hpp"

namespace chaintrue::grid::diagnosis {

using estimation::SystemPlace;
using estimation::SystemUnit;

/// A cause with its values: sizes and places, in the effect's order.
struct SizedCause {
  CauseId cause;
  std::vector<double> values;
};

/// A cause at one place and one size.
struct Regressor : SizedCause {
  double power = 1.0;  ///< for a refined one: about its size
  /// The size is a whole number: the coefficient is 1 and `values` hold it.
  bool fixed = false;
  /// It acts at a single visit.
  bool slip = false;
  /// Sound machines have it as often as not, so it does not count as a cause in the prior
  /// (CausePrior).
  bool expected = false;
  /// The secant was taken at a fitted size, so its coefficient can be compared with its bounds.
  bool refined = false;
  /// Prior sigma of the coefficient; 0: the prior of its strength in evidence.hpp.
  double coefficient_sigma = 0.0;
  /// Range of the coefficient.
  double lowest = 0.0;
  double highest = 0.0;
  /// For a cause with whole numbers: the number of visits at which it may act.
  double visits = 0.0;
  /// Share of this side, place and whole number within the effect (whole numbers: analysis.cpp).
  double log_prior = 0.0;
};

/// Readings that one slip spoils together, as a direction of one or two consecutive rows. Groups of
/// the same rows follow one another.
struct OutlierGroup {
  Index first_row = 0;
  Index rows = 1;
  /// A direction between two rows, not zero; absent: all rows.
  std::optional<Vector2d> direction{};
};

/// Limits of a search for outliers, besides kMostOutlierShare of the groups.
struct OutlierLimits {
  std::size_t fewest_groups = 0;  ///< number that remains
  Index fewest_rows = 0;          ///< number that remains
  /// Groups tried beyond the best set so far: several bad ones can mask one another.
  std::size_t beyond_the_best = std::numeric_limits<std::size_t>::max();
};

struct DiscrepancyFamily;
const DiscrepancyFamily& chain_discrepancies();

/// Prior probabilities of causes, by the mechanism's catalogue.
///
/// Each of n causes together has a share of kPriorOfOne, kPriorOfTwo, ... by exp(log_prior) / shares.
/// Expected causes are not among the n: every set is as likely with one as without it, so that it
/// alone is as likely as nothing and all other odds are unchanged. Each further expected cause is
/// rarer by the ratio of two causes to one.
struct CausePrior {
  /// If this is the sum of exp(log_prior) over the catalogue's unexpected causes, single causes
  /// together have kPriorOfOne; larger if causes are rarer.
  double shares = 1.0;
  /// Factor on the odds of causes given an unlisted smooth pattern.
  double odds_given_discrepancy = kCauseOddsGivenDiscrepancy;
};

/// A linearised system with its regressors and priors.
struct RegressorSystem : estimation::LinearisedSystem {
  RegressorColumns g;  ///< n x a column a regressor
  std::vector<Regressor> regressors;
  const Regressor& regressor(Index k) const { return regressors[as_size(k)]; }
  RegressorSet regressors_of(const CauseId& cause) const {
    auto all = numbers_below<int>(regressors.size());
    std::erase_if(all, [&](int k) { return regressor(k).cause != cause; });
    return all;
  }
  /// Of a mechanism whose lengths are not those of two chains: a place for each unit, whose by_reading has
  /// the lengths' effect on its rows.
  bool is_of_lengths() const { return !places.empty() && !places.front().length_mm.empty(); }
  VectorXd setting;          ///< q, value in the state
  VectorXd expected_change;  ///< q, stated value minus that
  VectorXd sigma;            ///< q, one sigma as stated
  CausePrior prior;
  double noise_dof = 15.0;  ///< degrees of freedom of the noise
  /// The readings that one slip spoils; of linearise() each unit.
  std::vector<OutlierGroup> groups;
  std::size_t unit_of(const OutlierGroup& group) const {
    return as_size(unit_of_row[as_size(group.first_row)]);
  }
  OutlierLimits limits;
  const DiscrepancyFamily* discrepancies = &chain_discrepancies();
};

/// A flag for each outlier group, all false.
inline Flags nothing_rejected(const RegressorSystem& system) {
  return Flags(system.groups.size(), false);
}

/// Without regressors. Fails with the first place that the machine cannot reach.
[[nodiscard]] tl::expected<RegressorSystem, observation::Unreachable> linearise(
    const ObservationSet& set, const State& state);

}  // namespace chaintrue::grid::diagnosis
