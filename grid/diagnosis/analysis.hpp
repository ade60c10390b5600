// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The steps from a session to a decision: calibrate, linearise, compare models, linearise anew
/// about what was found, compare again.
#pragma once

#include <string_view>
#include <tl/expected.hpp>

#include "grid/diagnosis/bed_parts.hpp"
#include "grid/diagnosis/decision.hpp"
#include "grid/diagnosis/estimate.hpp"
#include "grid/diagnosis/null_distribution.hpp"
#include "grid/diagnosis/regressors.hpp"

namespace chaintrue::grid::diagnosis {

/// Everything that the parts of an answer look at.
struct Analysis {
  ObservationSet session;
  DiagnosisOptions options;
  bool converged = true;  ///< calibrating came to rest
  State state;          ///< settings about which the system is linear; no effect named is in it
  Candidates candidates;
  RegressorSystem system;
  ModelComparison comparison;
  NullDistribution null;
  double score = 0.0;          ///< of the strongest single effect, log Bayes factor against nothing
  double family_wise_p = 1.0;  ///< chance that noise alone scores as high
  /// What quarters of the bed make of it; empty where there is no pattern, or no such parts.
  std::vector<PartPosterior> parts;
  /// What each session makes of it by itself; empty of a single one.
  std::vector<SessionPosterior> sessions;
  Decision decision;
  /// Of the discrepancy that the decision leaves; null where it leaves none.
  std::shared_ptr<const DiscrepancyNoise> noise;
  Estimate estimate;  ///< of the decision's causes
};

/// decide() from the comparison at hand, what is fitted being the member that gives its class the name. `detected`: the
/// strongest effect is beyond what noise does.
void decide_for_leaders(bool detected, Analysis& analysis);
/// The same with its estimate.
void decide_for(bool detected, Analysis& analysis);
/// Noise and estimate of the decision at hand.
void estimate_decided(Analysis& analysis);

/// Takes causes out that could not show at any size that they may have, the settings free, for this reason.
void drop_hidden(const MarginalisedSystem& marginalised,
                 std::string_view reason,
                 Analysis& analysis);

/// How often noise alone lets some cause look as strong as the strongest does: sets `null`, `score` and
/// `family_wise_p`, without what the best model rejects.
///
/// `causes` holds the regressors that are tried, about what does not hang on the readings' noise. Where
/// nothing is stated of the noise, what is left of it lies equally in every direction, however large it
/// is, so that the strongest score has one distribution for all residuals of one length (E. Lehmann and
/// J. Romano, Testing Statistical Hypotheses (2005), section 5.2: an unknown scale is conditioned out).
enum class NoiseSize { stated, unknown };
void test_significance(const RegressorSystem& causes, NoiseSize noise, Analysis& analysis);

/// Fails in words where the machine cannot be where it was measured.
[[nodiscard]] tl::expected<Analysis, DiagnosisFailure> analyse(ObservationSet session,
                                                               const DiagnosisOptions& options);

/// The causes compared and decided once more about the same state, with `rows` (whitened, one each of the
/// system) taken out of the readings.
[[nodiscard]] Analysis analyse_without(Analysis analysis, const Eigen::VectorXd& rows);

}  // namespace chaintrue::grid::diagnosis
