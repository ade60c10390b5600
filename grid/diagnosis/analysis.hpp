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

/// The input of all parts of an answer.
struct Analysis {
  ObservationSet session;
  DiagnosisOptions options;
  bool converged = true;  ///< calibrating came to rest
  State state;          ///< settings about which the system is linear; no effect named is in it
  std::vector<SizedCause> known;  ///< secants of these are taken at their values
  Candidates candidates;
  RegressorSystem system;
  Eigen::VectorXd taken_out;  ///< of the system's rows, as analyse_without() has it; else empty
  ModelComparison comparison;
  NullDistribution null;
  double score = 0.0;          ///< of the strongest single effect, log Bayes factor against nothing
  double family_wise_p = 1.0;  ///< chance that noise alone scores as high
  /// Results by quarters of the bed; empty without a pattern or such parts.
  std::vector<PartPosterior> parts;
  /// Results of each session alone; empty for a single one.
  std::vector<SessionPosterior> sessions;
  Decision decision;
  /// Kernel of the decision's discrepancy; null if it has none.
  std::shared_ptr<const DiscrepancyNoise> noise;
  Estimate estimate;  ///< of the decision's causes
};

/// What is stated of the noise. Where nothing is, what is left of it lies equally in every direction, however
/// large it is, so that the strongest score has one distribution for all residuals of one length (E. Lehmann
/// and J. Romano, Testing Statistical Hypotheses (2005), section 5.2: an unknown scale is conditioned out).
enum class NoiseSize { stated, unknown };

/// What differs between machines on the way from a session to a decision.
class AnalysisRules {
 public:
  virtual ~AnalysisRules() = default;

  /// Comparisons, each about what the one before found.
  int rounds = 2;
  NoiseSize noise = NoiseSize::stated;
  /// Chance of noise to make some cause look as strong, below which causes are spoken of.
  double false_alarm = kFalseAlarm;
  /// Of causes that could not show at any size that they may have, the settings free.
  std::string_view hidden = "whatever its size, calibrating the settings would hide it";

  /// The system about the state, with the regressors of all that is testable.
  [[nodiscard]] virtual tl::expected<void, DiagnosisFailure> linearise(Analysis& a) const = 0;
  [[nodiscard]] virtual ComparisonOptions compared(const Analysis& a, bool last) const = 0;
  /// Moves state and known causes to where the decision has them; false where another round finds the same.
  [[nodiscard]] virtual bool refit(Analysis& a) const = 0;
  /// Regressors that noise is tried with, about what does not hang on it.
  [[nodiscard]] virtual RegressorSystem tried_with_noise(const Analysis& a) const { return a.system; }
  /// What a decision has to leave out. `detected`: the strongest effect is beyond what noise does.
  virtual void restrain(bool /*detected*/, Analysis& /*a*/) const {}
};

/// To the last comparison, from a session and its candidates.
[[nodiscard]] tl::expected<void, DiagnosisFailure> compare_in_rounds(const AnalysisRules& rules,
                                                                     Analysis& a);
/// A decision from the comparison at hand, what is fitted being the member that gives its class the name, and its
/// estimate.
void decide_by(const AnalysisRules& rules, bool detected, Analysis& a);
/// The same with all that a verdict needs: how often noise alone lets some cause look as strong as the strongest
/// does, without what the best model rejects; what quarters of the bed and each session make of it.
void judge(const AnalysisRules& rules, Analysis& a);
/// The causes compared and judged once more about the same state, with `rows` (whitened, one each of the
/// system) taken out of the readings.
[[nodiscard]] Analysis analyse_without(Analysis analysis,
                                       const Eigen::VectorXd& rows,
                                       const AnalysisRules& rules);

/// Of every machine but four belts.
[[nodiscard]] const AnalysisRules& calibrated_rules();

/// Fails in words where the machine cannot be where it was measured.
[[nodiscard]] tl::expected<Analysis, DiagnosisFailure> analyse(ObservationSet session,
                                                               const DiagnosisOptions& options);

/// The decided causes refitted without linearisation: sizes, places and settings moved until the secants taken
/// at them fit as they are, with the units set aside that the decision leaves out. Sets the state, and of the
/// causes whose size is no whole number the values.
///
/// A secant is exact at its own size alone. Half a chain's weight gone, a pull of several newtons or the phase
/// of a wave along a chain whose zero moves by a millimetre need several rounds; about where they end the
/// models are compared again.
void relinearise(Analysis& analysis);

/// Noise and estimate of the decision at hand.
void estimate_decided(Analysis& analysis);

}  // namespace chaintrue::grid::diagnosis
