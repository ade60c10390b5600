// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/calibration/observation.hpp"

#include "model/calibration/setting.hpp"

namespace chaintrue::model {
namespace {

Eigen::Index column_of(const std::vector<Setting>& settings, Setting wanted) {
  for (std::size_t i = 0; i < settings.size(); ++i) {
    if (settings[i] == wanted) return static_cast<Eigen::Index>(i);
  }
  return -1;
}

/// value = plus - minus, both settings of the machine.
Linearisation difference(const Machine& machine,
                         const std::vector<Setting>& settings,
                         Setting plus,
                         Setting minus,
                         double value_mm,
                         double sigma_mm) {
  Linearisation line;
  const double predicted = stated_value(machine, plus) - stated_value(machine, minus);
  line.residual = Eigen::VectorXd::Constant(1, value_mm - predicted);
  line.setting_jacobian = Eigen::MatrixXd::Zero(1, static_cast<Eigen::Index>(settings.size()));
  if (const auto i = column_of(settings, plus); i >= 0) line.setting_jacobian(0, i) = 1.0;
  if (const auto i = column_of(settings, minus); i >= 0) line.setting_jacobian(0, i) = -1.0;
  line.covariance = Eigen::MatrixXd::Constant(1, 1, sigma_mm * sigma_mm);
  return line;
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
        in_sheet >= 0 ? Eigen::Vector2d(by_sheet.col(in_sheet))
                      : model.sensitivity(*reading, settings[i]);
  }
  const Eigen::Matrix2d by_mark = reading->position_jacobian * sheet.rotation();
  line.covariance = noise_.length_mm * noise_.length_mm * Eigen::Matrix2d::Identity() +
                    noise_.position_mm * noise_.position_mm * by_mark * by_mark.transpose();
  return line;
}

tl::expected<Linearisation, PoseFailure> MotorSpacing::linearise(
    const ReadingModel& model,
    const SheetPlacement& /*sheet*/,
    const std::vector<Setting>& settings) const {
  return difference(model.machine(),
                    settings,
                    Setting::motor_right_x_mm,
                    Setting::motor_left_x_mm,
                    value_mm_,
                    sigma_mm_);
}

tl::expected<Linearisation, PoseFailure> BeamRise::linearise(
    const ReadingModel& model,
    const SheetPlacement& /*sheet*/,
    const std::vector<Setting>& settings) const {
  return difference(model.machine(),
                    settings,
                    Setting::motor_right_y_mm,
                    Setting::motor_left_y_mm,
                    value_mm_,
                    sigma_mm_);
}

}  // namespace chaintrue::model
