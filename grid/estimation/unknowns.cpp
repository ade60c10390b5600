// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/estimation/unknowns.hpp"

#include <algorithm>

#include "model/calibration/setting.hpp"

namespace chaintrue::grid::estimation {
namespace {

constexpr auto kSheet = static_cast<Eigen::Index>(model::kSheetSettings.size());

}  // namespace

std::vector<model::Setting> settings_of(const observation::Observation& observation) {
  std::vector<model::Setting> settings(model::kMachineSettings.begin(),
                                       model::kMachineSettings.end());
  if (observation.sheet()) {
    settings.insert(settings.end(), model::kSheetSettings.begin(), model::kSheetSettings.end());
  }
  return settings;
}

Unknowns::Unknowns(const model::Machine& stated,
                   const observation::Observations& observations,
                   SurfaceColumns surface)
    : stated_(stated), surface_(surface) {
  const bool frame_is_laid = !observations.empty() && observations.front()->sheet().has_value();
  settings_ = kMachineSettingCount + (frame_is_laid ? kSheet : 0);
  total_ = settings_ + 2 + 2 * (surface.polynomials + surface.bends);
  for (std::size_t i = 0; i < observations.size(); ++i) {
    sheet_.push_back(-1);
    if (observations[i]->sheet()) {
      sheet_.back() = i == 0 ? kMachineSettingCount : total_;
      if (i > 0) total_ += kSheet;
    }
    nuisance_.push_back(total_);
    total_ += observations[i]->nuisance_sigma().size();
  }
  sigma_ = Eigen::VectorXd::Zero(total_);
  for (Eigen::Index i = 0; i < kMachineSettingCount; ++i) {
    sigma_[i] =
        std::max(model::stated_sigma(stated, model::kMachineSettings[static_cast<std::size_t>(i)]),
                 kKnownSigma);
  }
  for (std::size_t i = 0; i < observations.size(); ++i) {
    if (sheet_[i] < 0) continue;
    const observation::SheetPrior& prior = *observations[i]->sheet();
    sigma_.segment<2>(sheet_[i]).setConstant(std::max(prior.shift_sigma_mm, kKnownSigma));
    sigma_[sheet_[i] + 2] = std::max(prior.rotation_sigma_rad, kKnownSigma);
  }
}

std::vector<Eigen::Index> Unknowns::columns_of(std::size_t observation) const {
  std::vector<Eigen::Index> columns;
  for (Eigen::Index i = 0; i < kMachineSettingCount; ++i) columns.push_back(i);
  for (Eigen::Index i = 0; sheet_[observation] >= 0 && i < kSheet; ++i)
    columns.push_back(sheet_[observation] + i);
  return columns;
}

model::Machine Unknowns::machine_at(const Eigen::VectorXd& unknowns) const {
  model::Machine machine = stated_;
  for (Eigen::Index i = 0; i < kMachineSettingCount; ++i) {
    const model::Setting setting = model::kMachineSettings[static_cast<std::size_t>(i)];
    machine = model::with_setting(
        std::move(machine), setting, model::stated_value(stated_, setting) + unknowns[i]);
  }
  return machine;
}

model::SheetPlacement Unknowns::sheet_at(const Eigen::VectorXd& unknowns,
                                         std::size_t observation) const {
  const Eigen::Index first = sheet_[observation];
  if (first < 0) return {};
  return {unknowns[first], unknowns[first + 1], unknowns[first + 2]};
}

}  // namespace chaintrue::grid::estimation
