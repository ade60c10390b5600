// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/map_parts.hpp"

#include <fmt/format.h>

#include <cmath>

#include "grid/containers.hpp"
#include "grid/map/controller_error.hpp"
#include "interp/linear_algebra.hpp"
#include "model/calibration/setting.hpp"

namespace chaintrue::grid {
MatrixXd lower_factor(const MatrixXd& covariance) {
  constexpr double kJitter = 1e-12;
  MatrixXd lifted = 0.5 * (covariance + covariance.transpose());
  lifted.diagonal() *= 1.0 + kJitter;
  lifted.diagonal().array() += 1e-18;
  return linear::Cholesky(std::move(lifted)).lower();
}

ModelSurface model_surface(const estimation::Estimate& estimate) {
  return {estimate.machine,
          estimate.observations.front().sheet,
          estimate.surface,
          estimate.columns,
          estimate.settings,
          lower_factor(estimate.covariance),
          {}};
}

std::vector<SettingResult> setting_results(const Machine& stated,
                                           const estimation::Estimate& estimate,
                                           const std::optional<SheetUncertainty>& sheet) {
  constexpr double kOffSigmas = 3.0;
  const SheetPlacement& placed = estimate.observations.front().sheet;
  const double placement[] = {placed.x_mm, placed.y_mm, placed.rotation_rad};
  std::vector<SettingResult> results;
  for (const auto i : each_index(estimate.settings)) {
    const auto at = as_index(i);
    SettingResult& result = results.emplace_back();
    result.setting = estimate.settings[i];
    result.sigma = std::sqrt(estimate.covariance(at, at));
    double usual = kInfinity;
    if (i < kMachineSettings.size()) {
      result.stated = model::stated_value(stated, result.setting);
      result.calibrated = model::stated_value(estimate.machine, result.setting);
      usual = model::stated_sigma(stated, result.setting);
    } else {
      const std::size_t which = i - kMachineSettings.size();
      result.calibrated = placement[which];
      if (sheet) usual = which < 2 ? sheet->shift_mm : 1e-3 * sheet->rotation_mrad;
    }
    result.off = std::abs(result.calibrated - result.stated) > kOffSigmas * usual;
  }
  return results;
}

void note_settings_off(const std::vector<SettingResult>& settings,
                       std::vector<std::string>& notes) {
  for (const SettingResult& setting : settings) {
    if (!setting.off) continue;
    notes.push_back(
        fmt::format("{} differs by {:+.3f} from your file, more than three times its uncertainty. "
                    "Measure it again; if it is right, something else imitates it.",
                    model::name(setting.setting), setting.calibrated - setting.stated));
  }
}

CompensationMap with_expected_error(MapContents contents) {
  measure_expected_error(CompensationMap(contents), contents.accuracy);
  return CompensationMap(std::move(contents));
}

}  // namespace chaintrue::grid
