// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/calibration/observation.hpp"

#include <fmt/format.h>

#include <optional>
#include <stdexcept>

#include "model/calibration/setting.hpp"

namespace chaintrue::model {
namespace {

std::optional<Eigen::Index> column_of(const std::vector<Setting>& settings, Setting wanted) {
  for (std::size_t i = 0; i < settings.size(); ++i) {
    if (settings[i] == wanted) return static_cast<Eigen::Index>(i);
  }
  return std::nullopt;
}

}  // namespace

tl::expected<Linearisation, PoseFailure> ChainReading::linearise(
    const ReadingModel& model,
    const SheetPlacement& sheet,
    const std::vector<Setting>& settings) const {
  const auto reading = model.at(sheet.to_bed(mark_));
  if (!reading) return tl::unexpected(reading.error());
  Linearisation line;
  line.residual = Eigen::Vector2d(lengths_.left_mm - reading->lengths.left_mm,
                                  lengths_.right_mm - reading->lengths.right_mm);
  line.setting_jacobian.resize(2, static_cast<Eigen::Index>(settings.size()));
  const Eigen::Matrix<double, 2, 3> by_sheet =
      reading->position_jacobian * sheet.sensitivity(mark_);
  for (std::size_t i = 0; i < settings.size(); ++i) {
    const auto in_sheet = column_of({kSheetSettings.begin(), kSheetSettings.end()}, settings[i]);
    line.setting_jacobian.col(static_cast<Eigen::Index>(i)) =
        in_sheet ? Eigen::Vector2d(by_sheet.col(*in_sheet))
                 : model.sensitivity(*reading, settings[i]);
  }
  const Eigen::Matrix2d by_mark = reading->position_jacobian * sheet.rotation();
  line.covariance = noise_.length_mm * noise_.length_mm * Eigen::Matrix2d::Identity() +
                    noise_.position_mm * noise_.position_mm * by_mark * by_mark.transpose();
  return line;
}

SettingDifference::SettingDifference(Setting plus, Setting minus, double value_mm, double sigma_mm)
    : plus_(plus), minus_(minus), value_mm_(value_mm), sigma_mm_(sigma_mm) {
  for (Setting setting : {plus, minus}) {
    if (!column_of({kMachineSettings.begin(), kMachineSettings.end()}, setting).has_value()) {
      throw std::invalid_argument(fmt::format("{} is no setting of a machine", name(setting)));
    }
  }
  if (!(sigma_mm > 0.0)) {
    throw std::invalid_argument(
        fmt::format("a measurement's sigma of {} mm; it must be positive", sigma_mm));
  }
}

tl::expected<Linearisation, PoseFailure> SettingDifference::linearise(
    const ReadingModel& model,
    const SheetPlacement& /*sheet*/,
    const std::vector<Setting>& settings) const {
  const double predicted_mm =
      stated_value(model.machine(), plus_) - stated_value(model.machine(), minus_);
  Linearisation line;
  line.residual = Eigen::VectorXd::Constant(1, value_mm_ - predicted_mm);
  line.setting_jacobian = Eigen::MatrixXd::Zero(1, static_cast<Eigen::Index>(settings.size()));
  if (const auto column = column_of(settings, plus_)) line.setting_jacobian(0, *column) = 1.0;
  if (const auto column = column_of(settings, minus_)) line.setting_jacobian(0, *column) = -1.0;
  line.covariance = Eigen::MatrixXd::Constant(1, 1, sigma_mm_ * sigma_mm_);
  return line;
}

}  // namespace chaintrue::model
