// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Which holes to cut and which distances to measure, so that the map from them errs least over the
/// bed.
///
/// The criterion is the tool's expected variance, averaged over the bed: trace(C S), S the
/// unknowns' covariance after the measurement, C their mean squared effect on the tool. Without
/// distances to the sheet's edges the sheet is laid as well as it can be; with them its place is
/// one of the unknowns, nothing is known of it beforehand, and the tool's whole error on the sheet
/// counts. Distances are taken one by one, each time the one that lowers it most; then holes are
/// moved and distances exchanged as long as that helps. Source: A. Atkinson, A. Donev and R.
/// Tobias, Optimum Experimental Designs, with SAS (2007), sections 10.6 (I-optimality) and 12.3
/// (exchange). The model is linear about the machine as stated.
///
/// \code
///   const auto plan = plan_holes(machine, {.holes = 9, .distances = 20});
///   if (plan) cut(plan->set.holes);   // plan->set.distances: what to measure, by the commands
/// \endcode
#pragma once

#include <Eigen/Core>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "grid/map/fitted_distances.hpp"
#include "grid/planning/measurement_plan.hpp"
#include "grid/progress.hpp"

namespace chaintrue::grid {

inline constexpr int kFewestPlannedHoles = 4;
inline constexpr int kMostPlannedHoles = 24;

struct HolesPlanRequest {
  int holes = 9;
  /// 0: twice the holes and two more, with edges six more, or all there are.
  int distances = 0;
  /// To the sheet's edges as well: where the sheet lies counts.
  bool edges = false;
  double tape_sigma_mm = 0.5;
  double hole_sigma_mm = 0.3;
  /// From the bed's edge to the outermost holes.
  double margin_mm = 50.0;
  /// The tape's length.
  double longest_mm = 5000.0;
  Progress progress{};
};
[[nodiscard]] int distances_of(const HolesPlanRequest& request);
/// As many as there are unknowns that they tell of: the machine's, and the sheet's place.
[[nodiscard]] int fewest_distances(bool edges);
/// Between so many holes, and of each to one edge.
[[nodiscard]] int most_distances(int holes, bool edges);

/// One thing that the set tells: a combination of settings and scales, before and after.
struct PlannedKnowledge {
  std::string what;     ///< "motor spacing", "left chain scale"
  std::string unit;     ///< "mm", "%" or "mm per metre"
  double before = 0.0;  ///< one sigma as stated
  double after = 0.0;
};

/// An effect of the catalogue at its nominal strength, as this set sees it.
struct SeenEffect {
  std::string effect;
  std::string side;
  /// Length of what it does to the distances beyond what settings and scales can imitate, in
  /// sigmas.
  double sigmas = 0.0;
  /// Effects whose pattern is the same to within 5 degrees, as indices.
  std::vector<std::size_t> same_as;
};

struct HolesPlan {
  /// With commanded distances where readings will stand.
  MeasuredHoles set;
  /// Of the tool over the bed, one sigma; without edges, the sheet laid as well as it can be.
  double expected_rms_mm = 0.0;
  /// With nothing measured and the sheet laid as well as it can be.
  double expected_before_mm = 0.0;
  std::vector<PlannedKnowledge> knowledge;
  /// Of those effects that can act without drift, skips and hysteresis.
  std::vector<SeenEffect> effects;
};

/// \throws std::invalid_argument for numbers out of range.
[[nodiscard]] tl::expected<HolesPlan, PlanFailure> plan_holes(const model::Machine& machine,
                                                              const HolesPlanRequest& request);

/// One sigma of the tool over the bed that a covariance of the machine's unknowns amounts to, the
/// sheet laid as well as it can be; root mean square.
[[nodiscard]] double tool_sigma_mm(const model::Machine& machine,
                                   const Eigen::MatrixXd& covariance);

}  // namespace chaintrue::grid
