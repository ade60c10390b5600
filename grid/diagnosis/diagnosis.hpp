// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the simulation gets wrong and why: the answer of a diagnosis, as files and reports show it.
///
/// Three statements are kept apart throughout: a cause is present (causes), it was looked for and
/// is smaller than a bound (bounds), or these data cannot show it (not_testable).
///
///   signal_to_noise  length of an effect's whitened signature after the settings have taken their
///                    share: its strength in units of noise; "delta" in files
///   collinearity     |cosine| of two such signatures; "rho" in files
///
/// What was measured may be points, distances between holes, both, or belts (diagnose.hpp makes the
/// answer; pictures.hpp what is drawn of it). Indices count the points, the holes and the distances
/// of all files in their order.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "grid/diagnosis/belts_findings.hpp"
#include "grid/diagnosis/cause_id.hpp"
#include "grid/diagnosis/law.hpp"
#include "grid/diagnosis/pictures.hpp"
#include "grid/diagnosis/visiting_order_found.hpp"
#include "grid/map/error_summary.hpp"
#include "model/calibration/setting.hpp"

namespace chaintrue::grid::diagnosis {

enum class Verdict {
  named,              ///< one cause, or one class that no data of this kind can separate
  named_set,          ///< one cause, but these data leave two or more
  several_causes,     ///< two or more act together
  model_discrepancy,  ///< "unknown_pattern" in words
  noise_larger_than_stated,
  outliers,  ///< "bad_points" in words
  nothing_found,
};
[[nodiscard]] std::string_view name(Verdict verdict);

/// What was read: chains at points, a tape between holes, both, four belts, or a test drawing.
enum class Observations { points, distances, both, belts, drawing };
/// "points", "distances", "readings", "belts", "measures".
[[nodiscard]] std::string_view name(Observations observations);

/// A member of the same class, with what its own parameters would be.
struct SameCause {
  CauseId cause;
  std::vector<ParameterEstimate> parameters;
};

struct Cause {
  CauseId cause;
  double probability = 0.0;
  double signal_to_noise = 0.0;
  double share_left = 0.0;  ///< of its signature, after the settings have taken theirs
  std::vector<ParameterEstimate> parameters;
  std::vector<SameCause> same_as;
  /// The effect that these data tell from it least, |cosine| of the two.
  std::optional<CauseId> rival;
  double rival_collinearity = 0.0;
  /// It needs the visiting order, which nobody measured.
  bool order_assumed = false;
};

/// One line of the comparison: an effect's id and side, or nothing, unknown, noise, bad_points.
struct Hypothesis {
  std::string effect;
  std::string side;
  double probability = 0.0;
  /// Its class, the cause that gives the name first; empty of those that are none, and of a file.
  std::vector<CauseId> causes{};
};

/// What is left once the causes named are in the model.
struct LeftOver {
  double signal_to_noise = 0.0;
  /// The coordinate it follows best: angle_left, length_right, tension_left, order, x, y, ...;
  /// empty where nothing stands out.
  std::string follows;
  double share = 0.0;  ///< of its square that a smooth curve along that coordinate explains
  /// Chance to see as much from noise alone.
  double p_value = 1.0;
};

/// A cause that is named once a claimed law is known and not without it, or the other way round.
struct CauseGivenLaw {
  CauseId cause;
  double probability = 0.0;  ///< given the law
  double without_law = 0.0;
  std::vector<ParameterEstimate> parameters;  ///< given the law; empty where it is not named then
  std::vector<CauseId> same_as{};             ///< those that no readings of this kind can tell from it
};

/// What remains besides the causes named, with any verdict: a smooth pattern that no cause of
/// the catalogue makes.
struct Unexplained {
  double probability = 0.0;
  double signal_to_noise = 0.0;  ///< of the pattern as it is estimated
  double rms_mm = 0.0;           ///< of the tool, at the points (or of the distances)
  double share = 0.0;            ///< of the mean square of what the settings leave
  /// The coordinate that it is a function of, as LeftOver has it; empty where it is of the place.
  std::string follows;
  double length_mm = 0.0;  ///< over which it changes; of an angle or a pull what that is on the bed
  Enters enters = Enters::mixed;
  /// What it may be a function of, likeliest first; empty unless some law is likelier than none.
  std::vector<Law> laws;
  /// What the likeliest law, where it is claimed, changes of what is named.
  std::vector<CauseGivenLaw> causes_given_law;
};

/// One part of the tool's error as delivered.
struct BudgetLine {
  enum class What { settings, cause, unexplained, noise, inseparable } what = What::noise;
  std::optional<CauseId> cause{};
  double mean_square_mm2 = 0.0;  ///< of what cannot be split it may be negative
  double share = 0.0;            ///< of the whole
  /// Rms of the tool's error as delivered with this part alone taken away. Empty of what cannot be
  /// split.
  std::optional<double> without_mm{};
  /// The largest change of the tool's error over 100 mm at the corners of the marked area: what a
  /// part of that size gets wrong there. Empty where it is not of the place, or not the tool's.
  std::optional<double> part_mm{};
  enum class ChangesWith { nothing, place, order, direction } changes_with = ChangesWith::place;
};
[[nodiscard]] std::string_view name(BudgetLine::What what);
[[nodiscard]] std::string_view name(BudgetLine::ChangesWith changes);

/// The mean square of the tool's error as the machine was delivered, split into what makes it:
/// largest first, what cannot be split last. The lines add up to the whole.
struct ErrorBudget {
  double uncalibrated_mm = 0.0;  ///< rms at the good points (or of the good distances)
  std::vector<BudgetLine> lines;
};

struct Outlier {
  Observations of = Observations::points;  ///< points, distances or belts
  std::size_t index = 0;                   ///< of a belt's reading that of its place
  std::optional<model::Belt> belt{};       ///< empty of belts: all that was read at the place
  /// The belt of the same place that may be off instead, where the lengths do not tell which.
  std::optional<model::Belt> or_belt{};
  /// Where the tool would have to have been, less where the mark is.
  Eigen::Vector2d shift_mm = Eigen::Vector2d::Zero();
  double distance = 0.0;  ///< in sigmas
  /// Of a distance or a belt: read less what all the others make of it.
  double residual_mm = 0.0;
};

struct NotTestable {
  CauseId cause;
  std::string reason;
};

/// Looked for and not found: larger than this it would have shown.
struct Bound {
  CauseId cause;
  std::string parameter;
  double upper_95 = 0.0;  ///< of the absolute value
};

/// What these readings say of an effect that the user declared (declared_answers.hpp).
struct DeclaredAnswer {
  enum class Says { confirmed, denied, open, not_testable };
  CauseId cause;
  Says says = Says::open;
  double probability = 0.0;
};
[[nodiscard]] std::string_view name(DeclaredAnswer::Says says);

struct CalibratedSetting {
  model::Setting setting = model::Setting::motor_left_x_mm;
  double stated = 0.0;
  double stated_sigma = 0.0;
  double calibrated = 0.0;
  double sigma = 0.0;
  bool off = false;  ///< further away than what was stated allows
};

/// Held-out error of the tool [mm] for one way of modelling.
struct HeldOut {
  double rms_mm = 0.0;
  double percentile_95_mm = 0.0;
  double low_mm = 0.0;  ///< 90 % interval of the rms, blocks drawn anew
  double high_mm = 0.0;
};

struct HeldOutImprovement {
  std::string scheme;  ///< how points were held out, in words
  HeldOut uncalibrated;
  std::optional<HeldOut> placed;  ///< the sheet's placement alone; where it was placed by hand
  HeldOut calibrated;
  HeldOut extended;
  HeldOut extended_and_surface;
  HeldOut surface_only;
  double noise_floor_mm = 0.0;
  /// By how much the mean square of the tool's error falls over the measured area, as the points
  /// have it (expected_improvement.hpp). Blocks held out say more, since there both models extrapolate and
  /// the poorer one farther.
  double drop_mm2 = 0.0;
  /// That drop over the mean square before it, the noise of the readings in neither.
  double drop_share = 0.0;
  /// In so many of the folds the same cause was named.
  int folds = 0;
  int folds_agree = 0;
};

enum class MeasurementKind { point, revisit, reading, distance };

struct NextMeasurement {
  MeasurementKind kind = MeasurementKind::point;
  std::string words;                     ///< point, revisit and distance: what to do, for a person
  std::string side;                      ///< of a reading, where it has one
  std::optional<model::MarkPoint> mark;  ///< of a point or a revisit, and of a hole to be cut
  double sigma = 0.0;                    ///< of a reading: how well it has to be read
  /// Probability that the right cause is then named alone, this and all above it done.
  double raises_probability_to = 0.0;
  /// Of a distance: its ends, as in the holes' file. A hole to be cut has no name yet and is left
  /// out; to several holes the distances are measured one by one.
  std::string from{};
  std::vector<std::string> to{};
  /// Of a place that four belts read: those that a motor pulls there, by name. Empty: as the
  /// frame's orientation has it.
  std::vector<model::Belt> pulled{};
  std::optional<ReadingOf> reading{};  ///< of a reading: what to read
};

/// The noise of holes and a tape, as stated.
struct StatedTape {
  double tape_sigma_mm = 0.0;
  double hole_sigma_mm = 0.0;
  double dof = 0.0;
};

/// How well a model, calibrated elsewhere, predicts another grid: nothing is fitted but, where the
/// other's sheet was placed by hand, the placement.
struct Transfer {
  std::string to;  ///< the other grid's name
  std::size_t points = 0;
  HeldOut uncalibrated;
  HeldOut calibrated;
  HeldOut extended;
  HeldOut extended_and_surface;
  double noise_floor_mm = 0.0;
};

/// What the verdict would be without a point, a whole column or row of marks, a distance, or a hole
/// with all distances that end there.
struct Removal {
  enum class What { point, column, row, distance, hole } what = What::point;
  std::size_t index = 0;   ///< of a point, a distance or a hole
  double at_mm = 0.0;      ///< of a column its x, of a row its y
  std::size_t points = 1;  ///< or distances, that go
  Verdict verdict = Verdict::nothing_found;
  std::vector<CauseId> causes;  ///< that would be named
  /// What all points name is named without these too.
  bool stands = true;
  /// That what is named acts.
  double probability = 0.0;
  /// Fall of the logarithm of its odds: how much of the name rests on these points; negative where
  /// they speak against it.
  double support = 0.0;
};

/// Whether what is named hangs on a few of the points.
struct Stability {
  double probability = 0.0;       ///< with all points: that every cause named acts, or one of a set
  std::vector<Removal> removals;  ///< points by index, then columns and rows by place
};

/// What the readings say without a quarter of the bed, or one session by itself.
struct PartFinding {
  double towards_rad = 0.0;  ///< where the quarter lies, from the middle; from x towards y
  std::string session;       ///< of one session its name; of a quarter empty
  std::size_t units = 0;     ///< of a quarter those left out, of a session its own
  Hypothesis likeliest;      ///< the likeliest cause, or "nothing" where none is likelier than not
  std::vector<Hypothesis> named;  ///< what is named, with its probability here
};

/// A parameter of the plotter's mechanism, in its own unit.
struct DrawnSetting {
  std::string name;  ///< "zero_left_mm"
  double set = 0.0;
  double found = 0.0;  ///< with the causes of the verdict at work
  double sigma = 0.0;
  bool off = false;  ///< further away than its own sigma and chance allow
};

/// A length or a bow, mm.
struct DrawnValue {
  std::string name;  ///< "the bow of A-B at E"
  double measured_mm = 0.0;
  double explained_mm = 0.0;  ///< by the settings found and the causes of the verdict
  bool rejected = false;
};

/// What a diagnosis of a V-plotter's test drawing has of its own: the settings with the causes at work, and each
/// measure.
struct DrawingFindings {
  std::string plotter;  ///< its name
  std::vector<DrawnSetting> settings;
  /// In the order of the drawing's measures.
  std::vector<DrawnValue> measures;
};

struct Diagnosis {
  Verdict verdict = Verdict::nothing_found;
  std::string sentence;
  std::vector<std::string> what_to_do;  ///< at most three
  std::string not_proved;
  /// Found from the readings, where nobody wrote it down.
  std::optional<VisitingOrderFound> visiting_order;
  std::vector<std::string> notes;  ///< assumed order, unstated noise, swapped columns, ...
  std::vector<Cause> causes;
  std::vector<Hypothesis> hypotheses;
  LeftOver left_over;
  /// How far the machine misses as it is used today: error_in_use() of the plain map of these readings,
  /// the number that a fit begins with; no less than what a claimed law makes at the points. Empty of drawings, of belts but where chaintrue diagnose adds it,
  /// where the readings make no map, and where held-out errors were not asked for.
  std::optional<ErrorSummary> tool_today;
  /// Empty for drawings, as the budget is.
  std::optional<Unexplained> unexplained;
  std::optional<ErrorBudget> budget;
  std::vector<Outlier> outliers;
  std::vector<NotTestable> not_testable;
  std::vector<Bound> bounds;
  std::vector<DeclaredAnswer> declared;
  std::vector<CalibratedSetting> settings;
  std::optional<HeldOutImprovement> improvement;
  std::vector<NextMeasurement> next_measurements;
  /// The machine with its settings calibrated and every named cause that belongs into it; never an
  /// effect of the paper or of the visit. Of belts it says nothing: `belts` has theirs.
  model::Machine extended_machine;
  /// Named causes that do not belong into the machine: what the data are corrected by.
  std::vector<model::AppliedEffect> data_corrections;

  double noise_factor = 1.0;   ///< noise found, as a multiple of what was stated
  double family_wise_p = 1.0;  ///< of the first cause
  std::vector<PointPicture> points;
  Observations observations = Observations::points;
  std::vector<HolePicture> holes;          ///< of distances
  std::vector<DistancePicture> distances;  ///< in the order of the set
  std::optional<BeltsFindings> belts;      ///< of belts alone
  std::optional<DrawingFindings> drawing;  ///< of a test drawing alone
  std::uint64_t seed = 1;
  std::string grid_name;
  std::optional<StatedNoise> stated_noise;
  std::optional<StatedTape> stated_tape;
  /// Empty where no cause is named or too few points would be left.
  std::optional<Stability> stability;
  /// Quarters of the bed over which the probabilities are averaged; empty where no pattern stands.
  std::vector<PartFinding> bed_parts;
  /// Each session by itself, where causes are named and there is more than one.
  std::vector<PartFinding> sessions;
  /// Another grid predicted; empty where none was asked for.
  std::optional<Transfer> transferred;
};

}  // namespace chaintrue::grid::diagnosis
