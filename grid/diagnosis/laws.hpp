// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The laws that a diagnosis reports: possible variables of a pattern that no listed cause
/// explains, from the evidence for each.
///
/// Laws of one variable and one way to enter are one answer, with the likeliest of their shapes. The
/// probability is that of the answer whatever its shape; values are those of the likeliest point, sigmas
/// those of the posterior over its curve.
#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "grid/diagnosis/analysis.hpp"
#include "grid/diagnosis/constants.hpp"
#include "grid/diagnosis/law_curves.hpp"
#include "grid/statistics.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::diagnosis {

// The evidence for laws: how probable the readings are if one of them acts, whatever its amplitudes,
// place or period, together with the causes that lead the comparison and with each smooth discrepancy
// or none; against the same without a law.
//
//   P(law l | y) = sum_{theta, S, D} W(l, theta, S, D) / (W0 + sum of all W)
//   W = prior(S, D) kLawPrior share_l mass_theta p(y | l, theta, S, D),  W0 = sum prior(S, D) p(y | S, D)
//
// p is set_evidence() (evidence.hpp) with a law's amplitudes as further columns: their prior is that of
// a cause's strength. theta lies on the grid of the curve (law_curves.hpp), refined about the
// leading points (trapezoids). Two passes: all laws in the few leading contexts (S, D) without a
// law; then the leading laws in every context with a share given one of them.

/// What acts besides a law.
struct ActsBesides {
  RegressorSet causes;
  int discrepancy = -1;
};

/// A curve at one place, period or scale.
struct LawPoint {
  std::shared_ptr<const LawCurve> curve;  ///< one for all its points
  double at = 0.0;                        ///< as LawCurve::grid
  double mass = 0.0;                      ///< prior, among the points of the curve
  double log_weight = kMinusInfinity;     ///< without its prior, in the first contexts
  /// Prior among all hypotheses.
  double log_prior() const { return std::log(kLawPrior * curve->share * mass); }
};
/// A point weighed over all contexts; the weight includes its prior.
struct WeighedLaw : LawPoint {
  std::size_t marginalised = 0;  ///< of the comparison's systems, in which it was weighed
  ActsBesides with{};            ///< in the best context
  ActsBesides without{};         ///< in the best context if no law acts
  VectorXd amplitude{};          ///< given the best context
  MatrixXd covariance{};         ///< of these

  /// There is one column for each amplitude, in all rows.
  MatrixXd columns(const RegressorSystem& system) const {
    return law_columns(system, *curve, {at});
  }
  /// What it adds to all rows.
  VectorXd rows(const RegressorSystem& system) const { return columns(system) * amplitude; }
};

/// Refers to one of the comparison's marginalised systems.
struct LawEvidence {
  double log_without = 0.0;      ///< no law acts
  std::vector<WeighedLaw> laws;  ///< those with a share, heaviest first
};

/// `curves` with their shares.
LawEvidence weigh_laws(const Analysis& analysis, std::size_t marginalised,
                       std::vector<LawCurve> curves);

struct LawsFound {
  std::vector<Law> laws;
  std::vector<WeighedLaw> heaviest;  ///< the likeliest point of each
};

/// Likeliest first, at most three; empty unless all laws together are at least kLawLikely, and if
/// only one cause is requested.
LawsFound laws_found(const Analysis& analysis);

/// Adds them to a complete diagnosis: to its hypotheses and, if no cause is named, its verdict.
void take_laws(std::vector<Law> laws, Diagnosis& diagnosis);
/// The likeliest, if at least kLawClaimed; else null.
const Law* claimed_law(const Diagnosis& diagnosis);
/// Probability that some law acts, from evidence in one or more of the comparison's systems, each with the same
/// laws.
double probability_of_any(const std::vector<LawEvidence>& evidence);

// The causes that readings name once a law is known: the law, as estimated in its best
// context, is subtracted and the causes are compared again (analysis.hpp).
//
// To a comparison that does not include it, an unlisted law is noise: it hides causes that act
// alongside it and sometimes looks like one. The estimate is treated as exact: of a law of
// strength 12 a twelfth is left in the readings, less than their noise at any one of them.

/// The likeliest law's contribution to the readings, whitened; empty if none is claimed, or if
/// removing it cannot change a name.
std::optional<VectorXd> rows_of_claimed_law(const Analysis& analysis, const LawsFound& laws);

/// Causes that only one of two comparisons names: first those named given the law, the likeliest
/// first.
std::vector<CauseGivenLaw> changed_causes(const Analysis& without_law, const Analysis& given_law);

/// Withdraws the names that are less likely than not given the law. Probabilities become those
/// given the law.
void take_names_back(const Analysis& given_law, Analysis& analysis);

/// The changes of names once a claimed law is known; causes that are no longer named are withdrawn.
std::vector<CauseGivenLaw> name_given_law(const LawsFound& laws, const AnalysisRules& rules,
                                          Analysis& analysis);

}  // namespace chaintrue::grid::diagnosis
