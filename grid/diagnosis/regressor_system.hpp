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

#include <algorithm>
#include <limits>
#include <optional>
#include <tl/expected.hpp>
#include <vector>

#include "grid/containers.hpp"
#include "grid/diagnosis/constants.hpp"
#include "grid/diagnosis/options.hpp"
#include "grid/estimation/linearised_system.hpp"
#include "grid/estimation/observation_set.hpp"
#include "grid/observation/measured.hpp"
#include "grid/precondition.hpp"
#include "interp/eigen.hpp"
#include "interp/linear_algebra.hpp"
#include "model/effects/declared_effect.hpp"

namespace chaintrue::grid::diagnosis {

using estimation::FollowUp;
using estimation::NumberedPlace;
using estimation::NumberedUnit;
using estimation::ObservationPart;
using estimation::ObservationSet;
using observation::ChainLengthReadings;
using observation::Place;
using observation::PlaceColumns;
using observation::TapeDistances;
using State = estimation::MachineState;

/// With fewer points no residual remains after fitting the settings.
inline constexpr std::size_t kFewestPoints = 8;
/// Distances determine four of the six settings; two more are needed for a cause, and two to check
/// it.
inline constexpr std::size_t kFewestDistances = 8;
/// This many must remain after rejection.
inline constexpr std::size_t kFewestGoodDistances = 6;

/// Whether the distance between these holes, or to this edge, was measured.
bool is_measured(const MeasuredHoles& set, const HoleDistance& wanted);

/// The machine is that of the first file; observations in the order of the files, points first, the
/// readings of the machine itself last. Fails with a sentence if there is no machine, too little
/// was measured, or a command is out of reach.
[[nodiscard]] tl::expected<ObservationSet, DiagnosisFailure> observations_of(
    const Measured& measured);

// A matrix whose columns are multiples of fewer: two lost links have twice the effect of one, at
// each of hundreds of visits. Only distinct columns are stored, so time and memory depend on their
// number.
//
// \code
//   RegressorColumns g(rows);
//   g.add(one_link, -1.0);        // column 0
//   g.add_multiple(2.0);          // column 1: 2 one_link
//   const double c = g.col(1).dot(e);
// \endcode

/// Some of a system's regressors, by number.
using RegressorSet = std::vector<int>;

class RegressorColumns {
 public:
  RegressorColumns() = default;
  explicit RegressorColumns(Index rows) : distinct_(rows, 0) {}

  /// factor times this.
  void add(const VectorXd& column, double factor = 1.0) {
    if (column.size() != rows()) {
      throw precondition("a column of {} rows among columns of {}", column.size(), rows());
    }
    if (count_ == distinct_.cols()) {
      distinct_.conservativeResize(Eigen::NoChange, std::max<Index>(16, 2 * count_));
    }
    distinct_.col(count_) = column;
    of_.push_back({count_, factor});
    ++count_;
  }

  /// Gives back the room for more: with hundreds of visits as much as all columns.
  void fit() { distinct_.conservativeResize(Eigen::NoChange, count_); }

  /// factor times the last added column.
  void add_multiple(double factor) {
    if (count_ == 0) throw precondition("{} times the last of no columns", factor);
    of_.push_back({count_ - 1, factor});
  }

  /// Column k is factor(k) times column index(k) of these.
  auto distinct() const { return distinct_.leftCols(count_); }
  Index index(Index k) const { return of_[as_size(k)].index; }
  double factor(Index k) const { return of_[as_size(k)].factor; }
  Index rows() const { return distinct_.rows(); }
  Index cols() const { return std::ssize(of_); }
  auto col(Index k) const { return distinct_.col(index(k)) * factor(k); }

  /// rows() x columns.size()
  MatrixXd dense(const RegressorSet& columns) const {
    MatrixXd result(rows(), std::ssize(columns));
    for (const Index k : each_below(result.cols())) {
      result.col(k) = col(columns[as_size(k)]);
    }
    return result;
  }

  RegressorColumns subset(const ColumnSet& columns) const {
    ColumnSet kept;  // for the distinct columns, in their order
    RegressorColumns result;
    for (const Index k : columns) {
      if (kept.empty() || kept.back() != index(k)) kept.push_back(index(k));
      result.of_.push_back({std::ssize(kept) - 1, factor(k)});
    }
    result.distinct_ = distinct_(Eigen::all, kept);
    result.count_ = result.distinct_.cols();
    return result;
  }

  /// cols() x columns of m: inner products of every column with those of a matrix, or with a vector.
  template <class M>
  linear::Like<M> transpose_times(const M& m) const {
    const linear::Like<M> products = linear::inner(distinct(), m);
    linear::Like<M> result(cols(), m.cols());
    for (const Index column : each_below(m.cols())) {
      for (const Index k : each_below(cols()))
        result(k, column) = factor(k) * products(index(k), column);
    }
    return result;
  }

  /// cols(): squared lengths of a map of every column.
  template <class Map>
  VectorXd squared_norms(const Map& map) const {
    VectorXd squares(count_);
    for (const Index k : each_below(count_))
      squares(k) = map(VectorXd(distinct_.col(k))).squaredNorm();
    VectorXd result(cols());
    for (const Index k : each_below(cols())) result(k) = factor(k) * factor(k) * squares(index(k));
    return result;
  }

 private:
  struct Multiple {
    Index index = 0;
    double factor = 1.0;
  };
  MatrixXd distinct_;  ///< with room for more
  Index count_ = 0;
  std::vector<Multiple> of_;
};

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

  /// It sets in at one of the visits.
  bool sets_in() const {
    const auto& parameters = cause.effect->parameters;
    return parameters.size() > 1 && parameters.back().integer;
  }
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

/// A linearised system with its priors.
struct PriorSystem : estimation::LinearisedSystem {
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

/// The same with its regressors, which take as much memory as all else together.
struct RegressorSystem : PriorSystem {
  RegressorColumns g;  ///< n x a column a regressor
  std::vector<Regressor> regressors;
  const Regressor& regressor(Index k) const { return regressors[as_size(k)]; }
  RegressorSet regressors_of(const CauseId& cause) const {
    auto all = numbers_below<int>(regressors.size());
    std::erase_if(all, [&](int k) { return regressor(k).cause != cause; });
    return all;
  }
};

/// A flag for each outlier group, all false.
inline Flags nothing_rejected(const RegressorSystem& system) {
  return Flags(system.groups.size(), false);
}

/// Without regressors. Fails with the first place that the machine cannot reach.
[[nodiscard]] tl::expected<RegressorSystem, observation::Unreachable> linearise(
    const ObservationSet& set, const State& state);

// Where or when an effect may set in, by the variable of its place at the places of the tool.
// Private to grid/diagnosis.

/// The parameter for where or when an effect sets in; null if it has none.
const EffectParameter* place_parameter(const Effect& effect);

/// The variable that this place is compared with.
PlaceVariable variable_of_place(const Effect& effect, const EffectParameter& place);
/// Between the nearest places of the tool to either side of it, in that variable: a step at one place between them
/// is the same at all readings as one at another. Empty if a side has none, and for phases.
struct PlaceGap {
  double below = 0.0;
  double above = 0.0;
};
std::optional<PlaceGap> gap_about(const RegressorSystem& system, CauseId cause, double place);

/// The variable's value at every place of the tool, for the chain of this side or of either.
std::vector<double> compared_at_places(const RegressorSystem& system, PlaceVariable variable,
                                       EffectSide side);

/// Places where an effect may set in: visits, phases of a turn, angles (or another variable of the
/// place) between those of the places of the tool.
std::vector<double> places_to_set_in(const RegressorSystem& system, CauseId cause);

/// Whether its formula has a step where it sets in, and so no derivative by its place.
bool has_step(const Effect& effect);

}  // namespace chaintrue::grid::diagnosis
