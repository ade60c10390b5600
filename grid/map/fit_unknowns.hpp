// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The settings as unknowns of a fit: how well each is known beforehand, and the machine and sheet
/// that a set of deviations stands for. Internal to grid/map.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "grid/measured_grid.hpp"
#include "model/calibration/setting.hpp"
#include "model/calibration/sheet_placement.hpp"

namespace chaintrue::grid {

/// What is stated without any uncertainty is taken as known this well, in mm or rad.
inline constexpr double kKnownSigma = 1e-7;

/// Deviations theta from what was stated, in the order of settings().
class FitUnknowns {
 public:
  FitUnknowns(const model::Machine& stated, const std::optional<SheetUncertainty>& sheet);
  [[nodiscard]] const std::vector<model::Setting>& settings() const { return settings_; }
  [[nodiscard]] double sigma(Eigen::Index i) const { return sigmas_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] Eigen::Index size() const { return static_cast<Eigen::Index>(settings_.size()); }
  [[nodiscard]] model::Machine machine_at(const Eigen::VectorXd& theta) const;
  [[nodiscard]] model::SheetPlacement sheet_at(const Eigen::VectorXd& theta) const;
  /// The deviations that lead to this machine and sheet.
  [[nodiscard]] Eigen::VectorXd theta_of(const model::Machine& machine,
                                         const model::SheetPlacement& sheet) const;

 private:
  model::Machine stated_;
  std::vector<model::Setting> settings_;
  std::vector<double> sigmas_;
};

}  // namespace chaintrue::grid
