// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/fit_unknowns.hpp"

#include <algorithm>

namespace chaintrue::grid {

using model::Setting;

FitUnknowns::FitUnknowns(const model::Machine& stated, const std::optional<SheetUncertainty>& sheet)
    : stated_(stated) {
  for (Setting setting : model::kMachineSettings) {
    settings_.push_back(setting);
    sigmas_.push_back(std::max(model::stated_sigma(stated, setting), kKnownSigma));
  }
  if (sheet) {
    settings_.insert(settings_.end(), model::kSheetSettings.begin(), model::kSheetSettings.end());
    const double shift_mm = std::max(sheet->shift_mm, kKnownSigma);
    const double rotation_rad = std::max(1e-3 * sheet->rotation_mrad, kKnownSigma);
    sigmas_.insert(sigmas_.end(), {shift_mm, shift_mm, rotation_rad});
  }
}

model::Machine FitUnknowns::machine_at(const Eigen::VectorXd& theta) const {
  model::Machine machine = stated_;
  for (std::size_t i = 0; i < model::kMachineSettings.size(); ++i) {
    machine = model::with_setting(
        std::move(machine),
        settings_[i],
        model::stated_value(stated_, settings_[i]) + theta[static_cast<Eigen::Index>(i)]);
  }
  return machine;
}

model::SheetPlacement FitUnknowns::sheet_at(const Eigen::VectorXd& theta) const {
  const auto first = static_cast<Eigen::Index>(model::kMachineSettings.size());
  if (theta.size() == first) return {};
  return {theta[first], theta[first + 1], theta[first + 2]};
}

Eigen::VectorXd FitUnknowns::theta_of(const model::Machine& machine,
                                      const model::SheetPlacement& sheet) const {
  Eigen::VectorXd theta(size());
  const auto first = static_cast<Eigen::Index>(model::kMachineSettings.size());
  for (Eigen::Index i = 0; i < first; ++i) {
    const Setting setting = settings_[static_cast<std::size_t>(i)];
    theta[i] = model::stated_value(machine, setting) - model::stated_value(stated_, setting);
  }
  if (size() > first) theta.tail(3) << sheet.x_mm, sheet.y_mm, sheet.rotation_rad;
  return theta;
}

}  // namespace chaintrue::grid
