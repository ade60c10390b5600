// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The evidence of the data for each of: nothing, every cause, causes together, outliers, noise
/// larger than stated, a model discrepancy, and causes given a model discrepancy.
///
/// Every hypothesis looks for its own outliers, by mean shifts added one after the other without
/// stopping at the first that does not pay, so that several outliers cannot mask each other; the
/// few sets of outliers so found are each given the whole comparison. Causes are searched
/// exhaustively one and two at a time, three and four at a time from the best of those.
#pragma once

#include <optional>
#include <vector>

#include "grid/diagnosis/evidence.hpp"

namespace chaintrue::grid::diagnosis {

/// A set of regressors, with or without a model discrepancy, and the points set aside.
struct CandidateModel {
  std::vector<int> regressors;   ///< ascending
  int discrepancy = -1;          ///< number of the model discrepancy, or none
  std::size_t marginalised = 0;  ///< into ModelComparison::marginalised_systems
  /// Natural logarithm of prior times evidence, or of a probability averaged over parts (bed_parts.hpp).
  double log_weight = 0.0;
  double larger_noise = 0.0;     ///< share of it from noise larger than stated
  double quadratic = 0.0;        ///< what the set leaves of e'e
};

struct ModelComparison {
  std::vector<MarginalisedSystem> marginalised_systems;
  std::vector<CandidateModel> models;  ///< those that matter, best first
  double log_total = 0.0;              ///< logarithm of the sum of weights
  /// Kernels of the model discrepancy that were tried, the weightiest first.
  std::vector<std::size_t> kernels;
  /// \throws std::invalid_argument where no model is finite: there is none to name.
  [[nodiscard]] const CandidateModel& best() const;
  [[nodiscard]] double probability(const CandidateModel& model) const;
};

/// Best first, and `log_total`.
void sort_by_weight(ModelComparison& comparison);

/// How far sets of causes are searched, by what a mechanism's regressors are like.
struct SearchLimits {
  /// Regressors of each cause that are weighed, the best of its places: alone, and once one of what
  /// leads has taken its share; sets of them are grown by a beam from nothing, given every discrepancy
  /// anew. 0: all regressors, and of whole numbers the best; sets that lead without a discrepancy are
  /// tried given the likeliest of these too.
  std::size_t of_a_cause = 0;
  /// With a beam: sets of outliers that are tried given discrepancies, the likeliest, and every so
  /// many of the strengths, the last among them.
  std::size_t sets_given = 1;
  std::size_t strength_step = 1;
  /// What sets in within so many visits is one event, whatever it is called. 0: nothing is.
  double one_event_visits = 0.0;
};

struct ComparisonOptions {
  bool discrepancies = true;
  /// Kernels of the discrepancy to try (numbers in the system's family); empty: all.
  std::vector<std::size_t> kernels{};
  /// Nothing but this cause acts.
  std::optional<CauseId> given_cause{};
  SearchLimits search{};
  /// Sets of regressors that look for outliers besides nothing and each cause alone.
  std::vector<std::vector<int>> hypotheses{};
};

/// Points already known not to count (held out) are `excluded`.
[[nodiscard]] ModelComparison compare_models(const RegressorSystem& system,
                                             const std::vector<bool>& excluded,
                                             const ComparisonOptions& options);

/// The weightiest kernels of a comparison, for others of the same session: as many as hold the
/// weight of a discrepancy at any of its causes.
[[nodiscard]] std::vector<std::size_t> best_kernels(const ModelComparison& comparison);

/// Most causes in one set.
inline constexpr std::size_t kMostCauses = 4;

/// Prior of a set of regressors, of its outliers not.
[[nodiscard]] double log_prior(const RegressorSystem& system,
                               const std::vector<int>& set,
                               bool discrepancy);

/// Prior odds of a lasting cause more, its share in the catalogue (exp of its log_prior) not counted, as a
/// natural logarithm; minus infinity beyond kMostCauses.
[[nodiscard]] double log_odds_of_another(const RegressorSystem& system,
                                         const std::vector<int>& set,
                                         bool discrepancy);

/// log BF of one cause against nothing, its places averaged: by position in `causes`.
struct SingleScores {
  std::vector<CauseId> causes;
  std::vector<double> log_factor;
  std::vector<int> best_regressor;
};
[[nodiscard]] SingleScores single_scores(const RegressorSystem& system,
                                         const MarginalisedSystem& marginalised,
                                         const NoiseDensity& noise,
                                         const Eigen::VectorXd& e);

}  // namespace chaintrue::grid::diagnosis
