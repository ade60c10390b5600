// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Calibration in passes: cut, measure, correct, and again. What one pass learnt is the next one's
/// prior, so that nothing is measured twice for the same knowledge; and a pass that would bring
/// less than it costs is not asked for.
///
/// The knowledge that one more pass like the last would bring is taken as that which the last one
/// brought (information adds up):
///
///   S' = (S^-1 + (S^-1 - S0^-1))^-1                                                         (1)
///
/// S0, S: covariance of the machine's unknowns before and after the last pass.
///
/// \code
///   HolesPasses passes(machine);
///   for (const MeasuredHoles& set : sets) {
///     const auto pass = passes.add(set);
///     if (!pass || !pass->next_pays) break;
///   }
/// \endcode
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "grid/map/joint_fit.hpp"
#include "grid/planning/holes_plan.hpp"

namespace chaintrue::grid {

struct HolesPass {
  int number = 0;
  /// How far distances between holes were from what was wanted, as cut; root mean square.
  double as_cut_rms_mm = 0.0;
  double left_out_rms_mm = 0.0;
  int rejected = 0;
  /// Of the tool over the bed with this pass's map, one sigma, and with one more pass.
  double expected_mm = 0.0;
  double expected_next_mm = 0.0;
  bool next_pays = true;
  /// Where the truth is known: the tool's error over the bed, rms, the sheet laid as well as it can
  /// be.
  std::optional<double> true_mm;
};

/// A pass that would take less than this off the expected error is not worth the holes.
inline constexpr double kWorthwhileMm = 0.03;

class HolesPasses {
 public:
  explicit HolesPasses(model::Machine stated, double worthwhile_mm = kWorthwhileMm);

  /// `wanted` are the places that the holes were meant for, where the commands had been corrected
  /// beforehand. Fails as joint_fit does, or where the set's machine is not the one of the passes
  /// (its controller's settings may change from pass to pass).
  [[nodiscard]] tl::expected<HolesPass, FitFailure> add(
      const MeasuredHoles& set, const std::vector<model::BedPoint>& wanted = {});
  [[nodiscard]] const std::optional<JointFit>& fit() const { return fit_; }
  [[nodiscard]] const model::Machine& stated() const { return stated_; }

 private:
  model::Machine stated_;
  double worthwhile_mm_;
  estimation::MachineKnowledge prior_;
  std::vector<ExtraReading> counted_;  ///< readings of settings that prior_ knows already
  std::optional<JointFit> fit_;
  int count_ = 0;
};

struct SimulatedPasses {
  double before_mm = 0.0;  ///< true error over the bed with nothing measured
  std::vector<HolesPass> passes;
  MeasuredHoles last_set;
  JointFit fit;
};

struct SimulatedPassesRequest {
  HolesPlanRequest plan;
  int most = 4;
  double worthwhile_mm = kWorthwhileMm;
  /// One sigma of each chain's elongation; motors and zeros are drawn from what is stated.
  double elongation_sigma = 0.001;
  std::uint64_t seed = 1;
  Progress progress{};
};

/// The whole loop on a machine that is drawn from what is stated. Each pass is cut through the map
/// of the one before.
[[nodiscard]] tl::expected<SimulatedPasses, FitFailure> simulate_passes(
    const model::Machine& stated, const SimulatedPassesRequest& request);

/// True error of a tool that pays out `map`'s lengths (the controller's where there is none) on the
/// true machine, rms over the bed, the sheet laid as well as it can be.
[[nodiscard]] double true_error_mm(const model::Machine& truth,
                                   const model::Machine& stated,
                                   const CompensationMap* map);

}  // namespace chaintrue::grid
