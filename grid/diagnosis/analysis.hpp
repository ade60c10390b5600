// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The steps from a session to a decision: calibrate, linearise, compare models, linearise
/// again about the causes found, compare again.
#pragma once

#include <functional>
#include <optional>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "grid/diagnosis/bed_parts.hpp"
#include "grid/diagnosis/decision.hpp"
#include "grid/diagnosis/estimate.hpp"
#include "grid/diagnosis/null_distribution.hpp"
#include "grid/diagnosis/regressors.hpp"
#include "interp/eigen.hpp"
#include "interp/surface.hpp"

namespace chaintrue::grid::diagnosis {

/// The input of all parts of an answer.
struct Analysis {
  ObservationSet session;
  DiagnosisOptions options;
  bool converged = true;  ///< the calibration converged
  State state;            ///< settings about which the system is linear, without any named effect
  std::vector<SizedCause> known;  ///< secants of these are taken at their values
  Candidates candidates;
  RegressorSystem system;
  VectorXd taken_out;  ///< of the system's rows, for analyse_without(); else empty
  ModelComparison comparison;
  NullDistribution null;
  double score = 0.0;          ///< of the strongest single effect: log Bayes factor against nothing
  double family_wise_p = 1.0;  ///< chance that noise alone scores as high
  /// Results by quarters of the bed; empty without a pattern or such parts.
  std::vector<PartPosterior> parts;
  /// Results of each session alone; empty for a single one.
  std::vector<PartPosterior> sessions;
  Decision decision;
  DiscrepancyNoise noise;  ///< of the decision's discrepancy, or none
  Estimate estimate;       ///< of the decision's causes
};

/// The steps from a session to a decision that differ between machines.
class AnalysisRules {
 public:
  virtual ~AnalysisRules() = default;

  /// Comparisons, each linearised about the result of the one before.
  int rounds = 2;
  NoiseSize noise = NoiseSize::stated;
  /// Causes are reported if the probability that noise makes some cause look as strong is below
  /// this.
  double false_alarm = kFalseAlarm;
  /// For causes that could not show at any size in their range, with the settings free.
  std::string_view hidden = "calibrating the settings would hide it, whatever its size";

  /// The system linearised about the state, with the regressors of all testable causes.
  [[nodiscard]] virtual tl::expected<void, DiagnosisFailure> linearise(Analysis& a) const = 0;
  virtual ComparisonOptions compared(const Analysis& a, bool last) const = 0;
  /// Moves state and known causes to their values in the decision; false if another round would
  /// find the same.
  virtual bool refit(Analysis& a) const = 0;
  /// The regressors against which noise is drawn, about a state that does not depend on it; empty: those compared.
  [[nodiscard]] virtual std::optional<RegressorSystem> tried_with_noise(
      const Analysis& /*a*/) const {
    return std::nullopt;
  }
  /// The units that a decision leaves out. `detected`: the strongest effect exceeds what noise
  /// produces.
  virtual void restrain(bool /*detected*/, Analysis& /*a*/) const {}
};

/// To the last comparison, from a session and its candidates.
[[nodiscard]] tl::expected<void, DiagnosisFailure> compare_in_rounds(const AnalysisRules& rules,
                                                                     Analysis& a);
/// A decision from the current comparison, and its estimate. The member that names its class is
/// fitted.
void decide_by(const AnalysisRules& rules, bool detected, Analysis& a);
/// The same with all that a verdict needs: how often noise alone makes some cause look as strong as
/// the strongest, without the readings that the best model rejects, and the results of quarters of
/// the bed and of each session.
void judge(const AnalysisRules& rules, Analysis& a);
/// Compares and judges the causes again about the same state, after subtracting `rows` (whitened,
/// one for each row of the system) from the readings.
Analysis analyse_without(Analysis analysis, const VectorXd& rows, const AnalysisRules& rules);

/// For every machine except four belts.
const AnalysisRules& calibrated_rules();

/// Fails with a sentence if the machine cannot reach a place where it was measured.
[[nodiscard]] tl::expected<Analysis, DiagnosisFailure> analyse(ObservationSet session,
                                                               const DiagnosisOptions& options);

/// The decided causes refitted without linearisation: sizes, places and settings moved until the
/// secants taken at them fit as they are, without the units that the decision leaves out. Sets the
/// state, and the values of causes whose size is not a whole number.
///
/// A secant is exact at its own size alone. Half a chain's weight gone, a pull of several newtons or the phase
/// of a wave along a chain whose zero moves by a millimetre need several rounds; about where they end the
/// models are compared again.
void relinearise(Analysis& analysis);

/// Noise and estimate of the current decision.
void estimate_decided(Analysis& analysis);

// The leading explanation of an analysis: its columns, and estimates with them.

/// Column k of the analysis' system.
const Regressor& regressor(const Analysis& analysis, int k);

/// The marginalised system in which the decision was made.
const MarginalisedSystem& marginalised_system(const Analysis& analysis);

/// The most probable column of a cause over the comparison's models, or its best-scoring one; -1 if
/// it has none.
int best_regressor(const Analysis& analysis, const CauseId& cause);

/// Flags the units whose readings are explained only by a cause at one visit.
void reject_slips(const Analysis& analysis, Flags& outliers);

/// Whether no points distinguish the two.
bool same_class(const Analysis& analysis, const CauseId& x, const CauseId& y);

/// The column most similar to another, among causes that are neither of its class nor named; -1 if
/// there is none.
struct Nearest {
  int column = -1;
  double collinearity = 0.0;  ///< |cosine| of the two
};
Nearest nearest_other(const Analysis& analysis, int column);

/// The named causes, or else the leading ones, and the cause most similar to the first, for
/// pictures side by side.
struct Shown {
  RegressorSet best;
  RegressorSet rival;
};
Shown shown(const Analysis& analysis);

/// Estimate with these columns, given the decision's discrepancy, if any.
Estimate estimate_with(const Analysis& analysis, RegressorSet columns);

/// Estimate with these columns and no discrepancy.
Estimate estimate_of(const Analysis& analysis, const RegressorSet& columns);

// The machine of an analysis at unmeasured places.

/// The rectangle spanned by the marks at which chains were read. Precondition: the session reads
/// chains.
interp::Rectangle marked_area(const ObservationSet& session);

/// Chain lengths still to be read at these places, one after the other and without an order of visits. Frame and
/// noise are those of a part that reads chains.
FollowUp readings_at(const ObservationSet& session, std::size_t part, std::vector<Place> places);

/// A session with a point at each reachable mark, without an order of visits. Precondition: as
/// above.
ObservationSet session_at(const Analysis& analysis, const std::vector<MarkPoint>& marks);

/// What a model expects of rows: their mean, and how they depend on its settings and free sizes, whose
/// covariance is Estimate::covariance.
struct ExpectedRows {
  VectorXd mean;
  MatrixXd by_unknown;
};
/// Predicts other rows with the same settings; `column` gives a regressor's column there, or none.
ExpectedRows expected_rows(const Analysis& analysis, const Estimate& fitted,
                           const RegressorSystem& there,
                           const std::function<std::optional<VectorXd>(const Regressor&)>& column);

/// The estimate's discrepancy in all rows of other places.
VectorXd pattern_at(const Analysis& analysis, const Estimate& fitted, const RegressorSystem& there);

}  // namespace chaintrue::grid::diagnosis
