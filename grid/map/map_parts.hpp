// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Assembles a map from an estimate. Nothing is fitted here.
#pragma once

#include <vector>

#include "grid/estimation/estimate.hpp"
#include "grid/map/compensation_map.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid {

/// F of C = F F', lower triangular; rounding may leave C not quite semidefinite, so jitter on the diagonal lets it
/// be factorised.
MatrixXd lower_factor(const MatrixXd& covariance);
/// The estimate's machine, its surface and their covariance.
ModelSurface model_surface(const estimation::Estimate& estimate);
/// `stated` is the machine that the estimate started from, `sheet` the prior of the first sheet:
/// without one its placement is exact.
[[nodiscard]] std::vector<SettingResult> setting_results(
    const Machine& stated, const estimation::Estimate& estimate,
    const std::optional<SheetUncertainty>& sheet);
/// A sentence for each setting that is off.
void note_settings_off(const std::vector<SettingResult>& settings, std::vector<std::string>& notes);
/// The map with its statements of its error, computed from the map.
[[nodiscard]] CompensationMap with_expected_error(MapContents contents);

/// A noise that the readings contradict by this much is reported.
inline constexpr double kNoiseDisagreement = 1.5;

}  // namespace chaintrue::grid
