// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Calibration rounds: cut, measure, correct, repeat. The posterior of one round is the prior of
/// the next, so that nothing is measured twice; a round whose expected improvement is too small is
/// not requested.
///
/// The information of one more round like the last is taken to be that of the last one (information
/// adds up):
///
///   S' = (S^-1 + (S^-1 - S0^-1))^-1                                                         (1)
///
/// S0, S: covariance of the machine's unknowns before and after the last round.
///
/// \code
///   HolesRounds passes(machine);
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
  /// Rms difference of the distances between holes, as cut, from the intended ones.
  double as_cut_rms_mm = 0.0;
  double left_out_rms_mm = 0.0;
  int rejected = 0;
  /// Expected sigma of the tool over the bed with this round's map, and with one more round.
  double expected_mm = 0.0;
  double expected_next_mm = 0.0;
  bool next_pays = true;
  /// If the truth is known: the tool's rms error over the bed, for the best placement of the sheet.
  std::optional<double> true_mm;
};

/// A round that lowers the expected error by less than this is not worth its holes.
inline constexpr double kWorthwhileMm = 0.03;

class HolesRounds {
 public:
  explicit HolesRounds(model::Machine stated, double worthwhile_mm = kWorthwhileMm);

  /// `wanted` are the intended positions of the holes, if the commands had been corrected
  /// beforehand. Fails as joint_fit does, or if the set's machine is not that of the rounds (its
  /// controller's settings may change from round to round).
  [[nodiscard]] tl::expected<HolesPass, FitFailure> add(
      const MeasuredHoles& set, const std::vector<model::BedPoint>& wanted = {});
  [[nodiscard]] const std::optional<JointFit>& fit() const { return fit_; }
  [[nodiscard]] const model::Machine& stated() const { return stated_; }

 private:
  model::Machine stated_;
  double worthwhile_mm_;
  estimation::ParameterKnowledge prior_;
  std::vector<ExtraReading> counted_;  ///< readings of settings that are already in prior_
  std::optional<JointFit> fit_;
  int count_ = 0;
};

struct SimulatedRounds {
  double before_mm = 0.0;  ///< true error over the bed before any measurement
  std::vector<HolesPass> passes;
  MeasuredHoles last_set;
  JointFit fit;
};

struct SimulatedRoundsRequest {
  HolesPlanRequest plan;
  int most = 4;
  double worthwhile_mm = kWorthwhileMm;
  /// Sigma of each chain's elongation; motors and zeros are drawn from the stated uncertainties.
  double elongation_sigma = 0.001;
  std::uint64_t seed = 1;
  Progress progress{};
};

/// The whole loop on a machine drawn from the stated uncertainties. Each round is cut through the
/// map of the previous one.
[[nodiscard]] tl::expected<SimulatedRounds, FitFailure> simulate_rounds(
    const model::Machine& stated, const SimulatedRoundsRequest& request);

/// True rms error over the bed of a tool that pays out the lengths of `map` (the controller's if
/// there is none) on the true machine, for the best placement of the sheet.
[[nodiscard]] double true_error_mm(const model::Machine& truth,
                                   const model::Machine& stated,
                                   const CompensationMap* map);

}  // namespace chaintrue::grid
