// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The result of a diagnosis, as files and reports show it: what the simulation gets wrong and why.
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

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "grid/diagnosis/belts_findings.hpp"
#include "grid/diagnosis/law.hpp"
#include "grid/diagnosis/options.hpp"
#include "grid/diagnosis/pictures.hpp"
#include "grid/map/error_summary.hpp"
#include "grid/observation/visiting_order.hpp"
#include "interp/eigen.hpp"
#include "model/calibration/setting.hpp"

namespace chaintrue::grid::diagnosis {

struct VisitingOrderFound {
  VisitingOrder order;  ///< the likeliest
  /// Probability of this order; if the corner is unknown, of its lines and direction from any
  /// corner.
  double probability = 0.0;
  bool corner_known = true;
};

/// "Nobody wrote down in which order the marks were visited. The readings say it: ... (99.8 %). ..." With the name of
/// a session "the marks of C.json".
std::string in_words(const VisitingOrderFound& found, const std::string& session = {});

enum class Verdict {
  named,              ///< one cause, or one class that no data of this kind can separate
  named_set,          ///< one cause, but these data leave two or more
  several_causes,     ///< two or more act together
  model_discrepancy,  ///< "unknown_pattern" in words
  noise_larger_than_stated,
  outliers,  ///< "bad_points" in words
  nothing_found,
};
std::string_view name(Verdict verdict);

/// What was read: chains at points, a tape between holes, both, four belts, or a test drawing.
enum class Observations { points, distances, both, belts, drawing };
/// "points", "distances", "readings", "belts", "measures".
std::string_view name(Observations observations);

/// A member of the same class, with the parameters it would have.
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
  /// The effect that these data distinguish from it least, |cosine| of the two.
  std::optional<CauseId> rival;
  double rival_collinearity = 0.0;
  /// It needs the visiting order, which was not recorded.
  bool order_assumed = false;
};

/// One line of the comparison: an effect's id and side, or nothing, unknown, noise, bad_points.
struct Hypothesis {
  std::string effect;
  std::string side;
  double probability = 0.0;
  /// Its class, the naming cause first; empty for hypotheses without causes, and when read from a
  /// file.
  std::vector<CauseId> causes{};
};

/// The residual with the named causes in the model.
struct LeftOver {
  double signal_to_noise = 0.0;
  /// The coordinate that it follows best: angle_left, length_right, tension_left, order, x, y, ...;
  /// empty if none stands out.
  std::string follows;
  double share = 0.0;  ///< of its square that a smooth curve along that coordinate explains
  /// Probability of as much from noise alone.
  double p_value = 1.0;
};

/// A cause that is named only with, or only without, a claimed law.
struct CauseGivenLaw {
  CauseId cause;
  double probability = 0.0;  ///< given the law
  double without_law = 0.0;
  std::vector<ParameterEstimate> parameters;  ///< given the law; empty if it is not named then
  std::vector<CauseId> same_as{};             ///< indistinguishable by such readings
};

/// A smooth pattern besides the named causes that no cause of the catalogue explains, with any
/// verdict.
struct Unexplained {
  double probability = 0.0;
  double signal_to_noise = 0.0;  ///< of the estimated pattern
  double rms_mm = 0.0;           ///< of the tool, at the points (or of the distances)
  double share = 0.0;            ///< of the mean square of what the settings leave
  /// The coordinate that it is a function of, as in LeftOver; empty for a function of the place.
  std::string follows;
  double length_mm = 0.0;  ///< over which it changes; of an angle or a pull what that is on the bed
  Enters enters = Enters::mixed;
  /// Its possible arguments, likeliest first; empty unless some law is likelier than none.
  std::vector<Law> laws;
  /// Changes of names by the likeliest law, if it is claimed.
  std::vector<CauseGivenLaw> causes_given_law;
};

/// One part of the tool's error as delivered.
struct BudgetLine {
  enum class What { settings, cause, unexplained, noise, inseparable } what = What::noise;
  std::optional<CauseId> cause{};
  double mean_square_mm2 = 0.0;  ///< of what cannot be split it may be negative
  double share = 0.0;            ///< of the whole
  /// Rms of the tool's error as delivered with this part alone taken away. Empty if it cannot be
  /// split.
  std::optional<double> without_mm{};
  /// The largest change of the tool's error over 100 mm at the corners of the marked area: the
  /// error of a part of that size there. Empty if it does not depend on the place, or is not the
  /// tool's.
  std::optional<double> part_mm{};
  enum class ChangesWith { nothing, place, order, direction } changes_with = ChangesWith::place;
};
std::string_view name(BudgetLine::What what);
std::string_view name(BudgetLine::ChangesWith changes);

/// The mean square of the tool's error as delivered, split into its sources: largest first, what
/// cannot be split last. The lines add up to the whole.
struct ErrorBudget {
  double uncalibrated_mm = 0.0;  ///< rms at the good points (or of the good distances)
  std::vector<BudgetLine> lines;
};

struct Outlier {
  Observations of = Observations::points;  ///< points, distances or belts
  std::size_t index = 0;                   ///< for a belt's reading, the index of its place
  std::optional<Belt> belt{};              ///< empty for belts: all readings at the place
  /// The belt at the same place that may be wrong instead, if the lengths do not show which.
  std::optional<Belt> or_belt{};
  /// Implied position of the tool minus the mark.
  Vector2d shift_mm = Vector2d::Zero();
  double distance = 0.0;  ///< in sigmas
  /// For a distance or a belt: read minus the prediction by all others.
  double residual_mm = 0.0;
};

struct NotTestable {
  CauseId cause;
  std::string reason;
};

/// Looked for and not found; a larger one would have shown.
struct Bound {
  CauseId cause;
  std::string parameter;
  double upper_95 = 0.0;  ///< of the absolute value
};

/// The result for an effect that the user declared.
///
///   confirmed     named, at kLawClaimed and more
///   denied        no more than 1 - kLawClaimed, and it would have been detected with the file's size: its size
///                 lies below the usual one at 95 %, or the readings are likelier without it than with its
///                 usual values, by the odds of kLawClaimed
///   open          neither
///   not testable  these readings do not show it, whatever its size
struct DeclaredAnswer {
  enum class Says { confirmed, denied, open, not_testable };
  CauseId cause;
  Says says = Says::open;
  double probability = 0.0;
};
std::string_view name(DeclaredAnswer::Says says);

struct CalibratedSetting {
  Setting setting = Setting::motor_left_x_mm;
  double stated = 0.0;
  double stated_sigma = 0.0;
  double calibrated = 0.0;
  double sigma = 0.0;
  bool off = false;  ///< farther away than the stated sigma allows
};

/// Held-out error of the tool [mm] for one way of modelling.
struct HeldOut {
  double rms_mm = 0.0;
  double percentile_95_mm = 0.0;
  double low_mm = 0.0;  ///< 90 % interval of the rms, by resampling blocks
  double high_mm = 0.0;
};

struct HeldOutImprovement {
  std::string scheme;  ///< a sentence on how points were held out
  HeldOut uncalibrated;
  std::optional<HeldOut> placed;  ///< the sheet's placement alone; where it was placed by hand
  HeldOut calibrated;
  HeldOut extended;
  HeldOut extended_and_surface;
  HeldOut surface_only;
  double noise_floor_mm = 0.0;
  /// The reduction of the tool's mean square error over the measured area
  /// (held_out_improvement.hpp). Held-out blocks show a larger reduction, since both models
  /// extrapolate there.
  double drop_mm2 = 0.0;
  /// That drop relative to the mean square before it, both without the noise of the readings.
  double drop_share = 0.0;
  /// The number of folds in which the same cause was named.
  int folds = 0;
  int folds_agree = 0;
};

enum class MeasurementKind { point, revisit, reading, distance };

struct NextMeasurement {
  MeasurementKind kind = MeasurementKind::point;
  std::string words;              ///< point, revisit and distance: what to do, for a person
  std::string side;               ///< of a reading, if it has one
  std::optional<MarkPoint> mark;  ///< of a point or a revisit, and of a hole to be cut
  double sigma = 0.0;             ///< of a reading: required accuracy
  /// Probability that the right cause is then named alone, this and all above it done.
  double raises_probability_to = 0.0;
  /// For a distance: its ends, as in the holes' file. A hole to be cut has no name yet and is
  /// omitted; distances to several holes are measured one by one.
  std::string from{};
  std::vector<std::string> to{};
  /// For a place read by four belts: the names of the pulled belts. Empty: those of the frame's
  /// orientation.
  std::vector<Belt> pulled{};
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
  std::size_t points = 1;  ///< or distances, that are left out
  Verdict verdict = Verdict::nothing_found;
  std::vector<CauseId> causes{};  ///< that would be named
  /// Whether the names are the same without these.
  bool stands = true;
  /// Probability of the named causes.
  double probability = 0.0;
  /// Drop of its log odds without these points; negative if they contradict it.
  double support = 0.0;
};

/// Whether the names depend on a few of the points.
struct Stability {
  double probability = 0.0;       ///< with all points: that every cause named acts, or one of a set
  std::vector<Removal> removals;  ///< points by index, then columns and rows by place
};

/// The result without a quarter of the bed, or of one session alone.
struct PartFinding {
  double towards_rad = 0.0;  ///< direction of the quarter from the middle; from x towards y
  std::string session;       ///< the session's name; empty for a quarter
  std::size_t units = 0;     ///< those left out with a quarter, or those of the session
  Hypothesis likeliest;      ///< the likeliest cause, or "nothing" where none is likelier than not
  std::vector<Hypothesis> named;  ///< what is named, with its probability here
};

/// A parameter of the plotter's mechanism, in its unit.
struct DrawnSetting {
  std::string name;  ///< "zero_left_mm"
  double set = 0.0;
  double found = 0.0;  ///< with the causes of the verdict acting
  double sigma = 0.0;
  bool off = false;  ///< further away than its own sigma and chance allow
};

/// A length or a bow, mm.
struct DrawnValue {
  std::string name;  ///< "the bow of A-B at E"
  double measured_mm = 0.0;
  double explained_mm = 0.0;  ///< predicted from the settings found and the causes of the verdict
  bool rejected = false;
};

/// The part of a diagnosis that only a V-plotter's test drawing has: the settings with the causes
/// acting, and each measure.
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
  /// Estimated from the readings if it was not recorded.
  std::optional<VisitingOrderFound> visiting_order;
  std::vector<std::string> notes;  ///< assumed order, unstated noise, swapped columns, ...
  std::vector<Cause> causes;
  std::vector<Hypothesis> hypotheses;
  LeftOver left_over;
  /// How far the machine misses as it is used today: error_in_use() of the plain map of these readings,
  /// the number that a fit begins with; at least the effect of a claimed law at the points. Empty
  /// for drawings, if the readings give no map, and, except for belts, if held-out errors were not requested.
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
  /// The calibrated machine with every named cause that belongs in it, which never includes an
  /// effect of the paper or of the visit. Not for belts: see `belts`.
  Machine extended_machine;
  /// Named causes that do not belong in the machine: the corrections of the data.
  std::vector<AppliedEffect> data_corrections;

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
  /// Empty if no cause is named or too few points would remain.
  std::optional<Stability> stability;
  /// Quarters of the bed over which the probabilities are averaged; empty without a pattern.
  std::vector<PartFinding> bed_parts;
  /// Each session alone, if causes are named and there is more than one session.
  std::vector<PartFinding> sessions;
  /// Prediction of another grid; empty if none was requested.
  std::optional<Transfer> transferred;
};

}  // namespace chaintrue::grid::diagnosis
