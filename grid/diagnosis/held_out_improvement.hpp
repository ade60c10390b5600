// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The gain of naming: held-out error of the tool with the whole naming repeated in every fold.
/// Blocks of the bed are held out in turn; in each fold models are compared and causes estimated on
/// the remaining points, and the held-out readings are compared with the prediction. Settings and
/// causes are never fitted to held-out points. The surface is the model discrepancy's expectation
/// at the length and size that the fold's points prefer.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "grid/diagnosis/analysis.hpp"
#include "grid/diagnosis/downdating.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::diagnosis {

// Folds for the gain of a name: naming and fits are repeated without some units, which gives each
// model's error at them.
//
// \code
//   const Downdating downdating(analysis.system, analysis.comparison);
//   const Fold fold = fold_without(analysis, downdating, block);   // fold.errors[kExtended]: mm at the units of the block
// \endcode

struct ExpectedImprovement {
  /// The reduction of the tool's mean square error. The causes' estimate is the posterior mean, so
  /// the mean square shift of the tool by naming is the expected reduction.
  double drop_mm2 = 0.0;
  /// Share of the mean square before; the rest is the uncertainty of settings and sizes.
  double share = 0.0;
};

/// Over the measured area with equal weights; over the measured distances; or at the points
/// themselves if a cause depends on the visits.
ExpectedImprovement expected_improvement(const Analysis& analysis);

/// The decision's marginalised system without the points that only causes at one visit explain: a
/// calibration without these causes would reject them too.
[[nodiscard]] MarginalisedSystem without_slips(const Analysis& analysis,
                                               const MarginalisedSystem& marginalised);

/// The models without some units (positions in the session) and their decision, with the gate and
/// classes of all units.
struct DecidedWithout {
  Downdating::Without models;
  Decision decision;
};
DecidedWithout decided_without(const Analysis& analysis, const Downdating& downdating,
                               const Indices& units);

/// Errors of the tool in mm with some causes, without a surface and with one.
struct ErrorsWith {
  std::vector<Vector2d> machine, and_surface;
};
/// None, those that the fold itself names, and those that all units name, their sizes fitted without the
/// fold.
enum CausesOfFold { kCalibrated, kExtended, kFixedNaming };
using Errors = std::array<ErrorsWith, 3>;  ///< by CausesOfFold

/// Held-out units of one fold.
struct Fold {
  Indices units;
  Errors errors;
  std::vector<CauseId> named;
};

/// \param units of the analysis' session, left out of everything. The gate and the decision are
/// those for all units; the models are those of the whole comparison, weighed without these units
/// (downdating.hpp). Outliers and slips of the whole session are not among the fold's units.
Fold fold_without(const Analysis& analysis, const Downdating& downdating, const Indices& units);

/// Groups of units that are held out together.
struct HeldOutBlocks {
  std::vector<Indices> units;  ///< empty if there are too few units
  bool of_the_bed = false;     ///< or each hole with all distances that end there
};

/// The held-out errors are those of the tool if chains were read at enough marks, else of
/// distances.
HeldOutBlocks held_out_blocks(const ObservationSet& session);

/// Empty if there are too few points to hold any out.
std::optional<HeldOutImprovement> measure_improvement(const Analysis& analysis);

/// Whether a machine with the causes predicts held-out readings better than one without, with the
/// surface in both: only the comparison of measure_improvement().
bool naming_improves_the_map(const Analysis& analysis);
bool naming_improves_the_map(const std::optional<HeldOutImprovement>& improvement);

/// Root mean square and 95th percentile of tool errors, and the interval of the first over
/// resampled blocks. `block` numbers the block of each error.
HeldOut summarise(const std::vector<Vector2d>& tool_mm, const Indices& block, std::uint64_t seed);

/// The errors of the machine as it was delivered. For a place with a command they are commanded
/// minus measured, regardless of the stated machine. Whitened like `stated.e`; `stated` is the
/// session linearised about the stated values.
VectorXd uncalibrated(const ObservationSet& session, const RegressorSystem& stated);

}  // namespace chaintrue::grid::diagnosis
