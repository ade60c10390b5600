// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Chooses the holes to cut and the distances to measure that minimise the map's expected error
/// over the bed.
///
/// The criterion is the tool's expected variance, averaged over the bed: trace(C S), S the
/// unknowns' covariance after the measurement, C their mean squared effect on the tool. Without
/// distances to the sheet's edges the best placement of the sheet is assumed; with them its
/// placement is unknown, without a prior, and the tool's whole error on the sheet counts. Distances
/// are added one by one, each time the one that lowers the criterion most; then holes are moved and
/// distances exchanged as long as that is an improvement. Source: A. Atkinson, A. Donev and R.
/// Tobias, Optimum Experimental Designs, with SAS (2007), sections 10.6 (I-optimality) and 12.3
/// (exchange). The model is linear about the machine as stated.
///
/// \code
///   const auto plan = plan_holes(machine, {.holes = 9, .distances = 20});
///   if (plan) cut(plan->set.holes);   // plan->set.distances: what to measure, by the commands
/// \endcode
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "grid/map/fitted_points.hpp"
#include "grid/planning/measurement_plan.hpp"
#include "grid/progress.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid {

inline constexpr int kFewestPlannedHoles = 4;
inline constexpr int kMostPlannedHoles = 24;

struct HolesPlanRequest {
  int holes = 9;
  /// 0: twice the number of holes plus two (plus eight with edges), or all of them if there are
  /// fewer.
  int distances = 0;
  /// Distances to the sheet's edges are planned too, because the sheet's placement matters.
  bool edges = false;
  double tape_sigma_mm = 0.5;
  double hole_sigma_mm = 0.3;
  /// From the bed's edge to the outermost holes.
  double margin_mm = 50.0;
  /// The tape's length.
  double longest_mm = 5000.0;
  Progress progress{};
};
int distances_of(const HolesPlanRequest& request);
/// The number of unknowns that they determine: the machine's, and the sheet's placement.
int fewest_distances(bool edges);
/// Between that many holes, and from each to one edge.
int most_distances(int holes, bool edges);

/// One result of the set: a combination of settings and scales, before and after.
struct PlannedKnowledge {
  std::string name;     ///< "motor spacing", "left chain scale"
  std::string unit;     ///< "mm", "%" or "mm per metre"
  double before = 0.0;  ///< one sigma as stated
  double after = 0.0;
};

/// An effect of the catalogue at its nominal strength, as observed by this set.
struct DetectableEffect {
  std::string effect;
  std::string side;
  /// Norm of its change of the distances, in sigmas, after projection on settings and scales.
  double sigmas = 0.0;
  /// Effects whose pattern is the same to within 5 degrees, as indices.
  Indices same_as;
};

struct HolesPlan {
  /// With commanded distances in place of readings.
  MeasuredHoles set;
  /// For the tool over the bed, one sigma; without edges, for the best placement of the sheet.
  double expected_rms_mm = 0.0;
  /// Before any measurement, for the best placement of the sheet.
  double expected_before_mm = 0.0;
  std::vector<PlannedKnowledge> knowledge;
  /// For the effects that can act, except drift, skips and hysteresis.
  std::vector<DetectableEffect> effects;
};

/// \throws std::invalid_argument for numbers out of range.
[[nodiscard]] tl::expected<HolesPlan, PlanFailure> plan_holes(const Machine& machine,
                                                              const HolesPlanRequest& request);

/// Root mean square over the bed of the tool's sigma for a covariance of the machine's unknowns,
/// for the best placement of the sheet.
double tool_sigma_mm(const Machine& machine, const MatrixXd& covariance);

// The catalogue's effects as observed by a set of distances: the size of each after projection on
// the settings, and which of them are collinear. Secants at the nominal strength, whitened by K =
// V + A P A'.

/// Largest first. Effects of the paper, and those that depend on the visit, are left out: distances
/// between holes do not depend on either. \throws std::invalid_argument for a set without a
/// machine.
std::vector<DetectableEffect> detectable_effects(const MeasuredHoles& set);

}  // namespace chaintrue::grid
