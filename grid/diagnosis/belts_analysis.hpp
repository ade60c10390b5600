// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The rules for four belts (AnalysisRules): the frame is fitted again between comparisons,
/// the noise is not stated, and yielding under the pull is expected. Private to grid/diagnosis.
#pragma once

#include <optional>
#include <tl/expected.hpp>
#include <vector>

#include "grid/belts/anchor_estimate.hpp"
#include "grid/belts/belts_fit.hpp"
#include "grid/belts/fit_diagnostics.hpp"
#include "grid/belts/measured_belts.hpp"
#include "grid/diagnosis/analysis.hpp"
#include "grid/diagnosis/regressors.hpp"
#include "interp/eigen.hpp"
#include "model/belts/belt_readings.hpp"

namespace chaintrue::grid::diagnosis {

// Four belts as a linearised system, and their anchors and places with causes.
//
// A place leaves two checks of its four readings, a unit of two rows (observation/belt_lengths.hpp). A
// single reading spoils one direction of them, an outlier group each; two readings of a place take
// both. The five anchor coordinates are the settings, without priors.
//
// With causes, the frame is fitted to corrected readings, and the causes' sizes given the frame, until
// both converge:
//
//   e, A  rows of the readings that count, places projected out, and what anchors do to them (1 of
//         linearised_system.hpp)
//   D     what a millimetre of each reading adds to them
//   g_j   d(read)/d(size of cause j), a secant about the size at hand
//
//   min |e - A da - sum_j D g_j ds_j|^2                                                     (1)
//
// Source: G. Golub and V. Pereyra, SIAM J. Numer. Anal. 10 (1973) 413, for unknowns that are
// projected out.

/// As effects of the belts' table.
std::vector<model::effects::ActingEffect> resolved(const std::vector<SizedCause>& causes);

/// What the causes add to the printed lengths, 4 N numbers in mm in the order of row_of(); 0 for
/// readings that such a machine cannot give.
VectorXd added_by(const MeasuredBelts& belts, const std::vector<SizedCause>& causes,
                  const FrameState& state);

/// The readings minus the causes' effects.
[[nodiscard]] MeasuredBelts without_effects(const MeasuredBelts& belts,
                                            const std::vector<SizedCause>& causes,
                                            const FrameState& state);

/// The readings that count, by default all, about a state; units are points of which three or four
/// count. A point that the machine cannot reach there (a gross error) is linearised about the frame's
/// middle. \pre no distances.
ObservationSet observations_of(const MeasuredBelts& belts, const FrameState& state, double sigma_mm,
                               const Counting& counting = {});

/// Converged anchors, places and sizes; `belts` are the readings corrected for the causes.
struct FitGivenCauses : belts::Refitted {
  std::vector<SizedCause> causes;
};
/// From a nearby state; whole-number sizes are fixed, others stay in their ranges. Empty if it does
/// not converge. \pre no distances.
std::optional<FitGivenCauses> fit_given_causes(const MeasuredBelts& belts,
                                               std::vector<SizedCause> causes,
                                               const AnchorFit& from);

/// What would reveal the causes that these data cannot show.
Candidates candidates(const MeasuredBelts& belts);

/// The system of readings that all count, about this state, with a regressor for each of `causes`
/// at every place where it may set in. Regressors of known causes are secants at their values.
RegressorSystem system_of(const MeasuredBelts& belts, const FrameState& state,
                          const ObservationSet& session, const std::vector<CauseId>& causes = {},
                          const std::vector<SizedCause>& known = {});

/// What a cause adds to the checks of a system of these belts about this state, whitened.
VectorXd column_of(const MeasuredBelts& belts, const FrameState& state,
                   const RegressorSystem& system, const SizedCause& cause);

// Anchors of four belts averaged over the models of a comparison, weighted by probability:
// each cause of yielding under the pull, with every other cause and sets of causes, with and
// without a smooth pattern. Private to grid/diagnosis.
//
// With anchors a_m, covariance C_m and weight w_m of model m, together 1:
//
//   a = sum_r w_r a_r / sum_r w_r,   C = sum_m w_m (C_m + (a_m - a)(a_m - a)')              (1)
//
// where r are the models of exactly the causes that are reported: anchors are used with these, and a mean over all would
// fit the readings with none of them. C is the expected square of the anchors' error.
//
// w_m is the evidence of the comparison with another prior. A diagnosis treats each cause as rare;
// a sigma has to hold if one acts at its usual size, so each gets the weight that gives 95 %
// intervals their coverage then (kWeights, found by tests/lab/sealed/command/anchor_coverage).
// Causes about which the state is linear keep their fitted sizes, however unusual; all others have
// their usual spread.
//
// Source: J. Hoeting, D. Madigan, A. Raftery and C. Volinsky, Bayesian Model Averaging, Statist.
// Sci. 14 (1999) 382, equations 1 and 2.

/// A cause with its values, the sigma of the first, and its probability.
struct AveragedCause : SizedCause {
  double sigma = 0.0;
  double probability = 0.0;
};

struct AveragedAnchors {
  AnchorVector anchors = AnchorVector::Zero();
  Eigen::Matrix<double, kAnchorUnknowns, kAnchorUnknowns> covariance_mm2 =
      Eigen::Matrix<double, kAnchorUnknowns, kAnchorUnknowns>::Zero();
  /// The likeliest cause of yielding under the pull, and all others that are more likely than not;
  /// sizes averaged over the models that contain them.
  std::vector<AveragedCause> causes;
};

/// \pre the system is linear about these anchors. \throws std::invalid_argument for a comparison without a
/// model.
AveragedAnchors averaged_anchors(const AnchorVector& about, const Analysis& analysis);

struct BeltsAnalysis : Analysis {
  MeasuredBelts measured;
  BeltsFit before;           ///< the anchors alone, by fit_belts()
  MeasuredBelts belts;       ///< without distances, which carry no information about a cause
  AnchorFit alone;           ///< anchors and places without a cause
  AnchorFit frame;           ///< about which the system is linear, with the known causes
  double sigma_mm = 0.0;     ///< of one belt's reading, as used for whitening
  AveragedAnchors averaged;  ///< the same for a fit and a diagnosis of the same belts
};

class BeltRules final : public AnalysisRules {
 public:
  explicit BeltRules(BeltsAnalysis& belts);
  [[nodiscard]] tl::expected<void, DiagnosisFailure> linearise(Analysis& a) const override;
  ComparisonOptions compared(const Analysis& a, bool last) const override;
  /// The state is unchanged if that does not converge.
  bool refit(Analysis& a) const override;
  [[nodiscard]] std::optional<RegressorSystem> tried_with_noise(const Analysis& a) const override;
  void restrain(bool detected, Analysis& a) const override;

 private:
  BeltsAnalysis& belts_;
};

/// To the averaged anchors, with the decision of the comparison alone; judge() makes it a verdict.
/// Fails where fit_belts() fails.
[[nodiscard]] tl::expected<BeltsAnalysis, BeltsFitFailure> analyse(const MeasuredBelts& belts,
                                                                   const DiagnosisOptions& options);

/// The frame with the readings and the causes that the decision keeps; empty if that does not
/// converge.
std::optional<FitGivenCauses> fit_as_decided(const BeltsAnalysis& belts, const Analysis& decided);

/// For each reading, whether the decision keeps it.
Counting decided_counting(const Analysis& analysis);

/// The analysis with patterns of single belts added, for weighing laws.
Analysis analysis_of_laws(const BeltsAnalysis& analysis);

// Turns an analysis of four belts into the answer. Private to grid/diagnosis.

/// fit_with_causes() with an analysis of the same belts that is not judged yet.
[[nodiscard]] tl::expected<BeltsFit, BeltsFitFailure> fit_with_causes(
    const BeltsAnalysis& analysis);

/// Prediction of the lower belts of each half of the places by a fit to the other, including the
/// causes' sizes; empty with too few places.
std::optional<BeltPrediction> prediction_by_halves(const MeasuredBelts& belts,
                                                   const AnchorFit& frame,
                                                   const std::vector<SizedCause>& causes);

/// Rejected readings (a place with more than one is listed as a whole), the unexplained pattern if the
/// decision has one, else only its probability, and `belts` without a second pass.
void take_belts_findings(const BeltsAnalysis& analysis, Diagnosis& diagnosis);

/// Measurements are proposed if they succeed with a probability of a quarter: eight that reach a
/// sixth would be wasted effort.
inline constexpr double kWorthMeasuring = 0.25;
/// A gain in probability that is worth a second session.
inline constexpr double kWorthASession = 0.05;

/// What to measure next to discriminate between the leading causes: further places and repeated
/// places, chosen as next_measurements.hpp chooses points. Each gives two checks, predicted by each
/// alternative (expected_discrimination.hpp) with its anchors, causes and pattern.
struct BeltsNext {
  /// `mark` is a command, `pulled` where the frame's orientation leaves a choice.
  std::vector<NextMeasurement> measurements;
  /// Probability that only the right explanation remains once every place is measured again, the
  /// last one first. Empty if nothing is open, or for more places than this is computed for.
  std::optional<double> all_once_more;
  /// The same with belts pulled harder, if all were measured with one pull and this reaches more
  /// than measurements at the same setting.
  std::optional<SecondPass> second_pass;
  bool is_open = false;  ///< two explanations or more remain
};
/// `indices`: positions of the points in their file.
BeltsNext next_measurements(const BeltsAnalysis& analysis, const PointIndices& indices);

/// What to measure next; last, if no tape determines the scale, the distance that would.
std::vector<NextMeasurement> measurements_of(const BeltsAnalysis& analysis, const BeltsNext& next,
                                             const PointIndices& indices);

/// verdict, sentence, what_to_do, not_proved and notes from everything else.
void put_into_words(const BeltsAnalysis& analysis, const BeltsNext& next, Diagnosis& diagnosis);

}  // namespace chaintrue::grid::diagnosis
