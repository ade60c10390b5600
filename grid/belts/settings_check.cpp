// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/belts/settings_check.hpp"

#include <array>
#include <cmath>

#include "grid/belts/commands_check.hpp"
#include "grid/belts/fit_diagnostics.hpp"
#include "grid/containers.hpp"

namespace chaintrue::grid {

std::optional<OtherFrame> suspected_other_frame(const MeasuredBelts& belts,
                                                const belts::AnchorFit& frame) {
  // Owners tape their frame to a decimetre or two before the first run; another frame is off by more.
  constexpr double kFarMm = 400.0;
  // Where the commands contradict the stated anchors as well.
  constexpr double kFarWithCommandsMm = 150.0;
  constexpr double kUpperMm = 100.0;
  constexpr double kSigmas = 5.0;
  constexpr std::array kNames = {"tl x", "tl y", "tr x", "tr y", "br x"};
  if (!belts.machine.anchors_known) return std::nullopt;
  const MeasuredBelts untaped = without_distances(belts);
  const belts::FitDiagnostics view(untaped, frame);
  const belts::AnchorVector stated = belts::anchors_of(belts.machine);
  const auto against = against_commands(belts);
  const double upper_mm = against && against->places >= kFewestBeltPoints ? against->upper_mm : 0.0;
  const double far_mm = upper_mm > kUpperMm ? kFarWithCommandsMm : kFarMm;
  std::optional<OtherFrame> found;
  for (Eigen::Index i = 0; i < belts::kAnchorUnknowns; ++i) {
    const double difference_mm = std::abs(frame.state.anchors[i] - stated[i]);
    const double variance = view.covariance()(i, i);
    if (!(variance > 0.0) || difference_mm < far_mm || difference_mm < kSigmas * std::sqrt(variance)) continue;
    if (found && difference_mm <= std::abs(found->fitted_mm - found->stated_mm)) continue;
    found = {kNames[as_size(i)], stated[i], frame.state.anchors[i], upper_mm};
  }
  return found;
}

}  // namespace chaintrue::grid
