// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The evidence of the data for each hypothesis: no cause, every cause, several causes,
/// outliers, noise larger than stated, a model discrepancy, and causes given a model discrepancy.
///
/// Every hypothesis searches for its own outliers, by adding mean shifts without stopping at the
/// first that gains nothing, so that several outliers cannot mask each other; the whole comparison
/// is made for each of the few sets found. Causes are searched exhaustively one and two at a time,
/// three and four at a time from the best of those.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "grid/containers.hpp"
#include "grid/diagnosis/evidence.hpp"
#include "grid/statistics.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::diagnosis {

/// A set of regressors, with or without a model discrepancy, and the rejected points.
struct CandidateModel {
  RegressorSet regressors;       ///< ascending
  int discrepancy = -1;          ///< number of the model discrepancy, or none
  std::size_t marginalised = 0;  ///< into ModelComparison::marginalised_systems
  /// Natural logarithm of prior times evidence, or of a probability averaged over parts (bed_parts.hpp).
  double log_weight = 0.0;
  double larger_noise = 0.0;  ///< share of it from noise larger than stated
};

struct ModelComparison {
  std::vector<MarginalisedSystem> marginalised_systems;
  std::vector<CandidateModel> models;  ///< those that matter, best first
  double log_total = 0.0;              ///< logarithm of the sum of weights
  /// Kernels of the model discrepancy that were tried, the heaviest first.
  Indices kernels;
  /// \throws std::invalid_argument if no model has a finite weight.
  const CandidateModel& best() const;
  /// The marginalised system of the best model.
  const MarginalisedSystem& best_system() const {
    return marginalised_systems[best().marginalised];
  }
  double probability(const CandidateModel& model) const;
};

/// Best first, and `log_total`.
void sort_by_weight(ModelComparison& comparison);

/// Limits of the search for sets of causes, depending on a mechanism's regressors.
struct SearchLimits {
  /// The number of best places of each cause to compare: alone, and after projection on a leading
  /// cause; sets of them are grown by a beam search from nothing, for every discrepancy. 0: all
  /// regressors, and the best whole numbers; sets that lead without a discrepancy are also tried
  /// given the likeliest discrepancies.
  std::size_t of_a_cause = 0;
  /// With a beam search: the number of likeliest sets of outliers to try given discrepancies, and
  /// the stride over strengths, which includes the last.
  std::size_t sets_given = 1;
  std::size_t strength_step = 1;
  /// Effects that set in within this many visits are one event. 0: none are.
  double one_event_visits = 0.0;
};

struct ComparisonOptions {
  bool discrepancies = true;
  /// Kernels of the discrepancy to try (numbers in the system's family); empty: all.
  Indices kernels{};
  SearchLimits search{};
  /// Further sets of regressors that search for outliers, besides nothing and each cause alone.
  std::vector<RegressorSet> hypotheses{};
};

/// Points that are known not to count (held out) are `excluded`.
ModelComparison compare_models(const RegressorSystem& system, const Flags& excluded,
                               const ComparisonOptions& options);

/// The heaviest kernels of a comparison, for others of the same session: enough to hold the weight
/// of a discrepancy for each of its causes.
Indices best_kernels(const ModelComparison& comparison);

/// Most causes in one set.
inline constexpr std::size_t kMostCauses = 4;

/// Prior of a set of regressors, without its outliers.
double log_prior(const RegressorSystem& system, const RegressorSet& set, bool discrepancy);

/// Log prior odds of one more lasting cause, without its share in the catalogue (exp of its
/// log_prior); minus infinity beyond kMostCauses.
double log_odds_of_another(const RegressorSystem& system, const RegressorSet& set,
                           bool discrepancy);

/// One cause against none, averaged over its places.
struct CauseScore {
  CauseId cause;
  double log_factor = kMinusInfinity;  ///< log Bayes factor
  int best_regressor = -1;             ///< -1: it shows nowhere
};
/// Computed from the inner products of every regressor's column with the residual, and their squares; `ee`: the
/// residual's square.
std::vector<CauseScore> single_scores(const std::vector<Regressor>& regressors, const VectorXd& c,
                                      const VectorXd& square, double ee, const NoiseDensity& noise);
/// Those of a residual in a marginalised system.
std::vector<CauseScore> single_scores(const RegressorSystem& system,
                                      const MarginalisedSystem& marginalised, const VectorXd& e);

/// Sets of readings that some hypothesis would reject, by mean shifts (outlier_search.cpp).
/// Returns a flag for each outlier group of the system, the most probable set first; groups of units that
/// are excluded beforehand are flagged in all of them. Where a set takes all directions of some
/// rows, all groups of these rows are flagged. `hypotheses` are sets of regressors.
std::vector<Flags> outlier_sets(const RegressorSystem& system, const Flags& excluded,
                                const std::vector<RegressorSet>& hypotheses);

// Sorted lists are cut without splitting ties. Two phases of a wave half a turn apart have the same
// column up to its sign and score equally up to rounding; a cut between them would depend on the
// last bit of a sine.

/// Scores are squares of sigmas or logarithms of odds: rounding changes them by 1e-10, and a
/// difference of a millionth is irrelevant.
inline constexpr double kTied = 1e-6;

inline bool tied(double a, double b) { return std::abs(a - b) < kTied; }

/// The `most` best of a list by a score, best first, and those that tie with the last.
template <typename List, typename Score>
void keep_best(List& list, std::size_t most, const Score& score) {
  stable_sort(list, descending(score));
  std::size_t count = std::min(most, list.size());
  while (count > 0 && count < list.size() &&
         tied(std::invoke(score, list[count]), std::invoke(score, list[most - 1])))
    ++count;
  list.resize(count);
}
/// Regressors with a score.
using ScoredRegressors = std::vector<std::pair<double, int>>;
/// By the first of each pair.
template <typename Other>
void keep_best(std::vector<std::pair<double, Other>>& scored, std::size_t most) {
  keep_best(scored, most, &std::pair<double, Other>::first);
}

}  // namespace chaintrue::grid::diagnosis
