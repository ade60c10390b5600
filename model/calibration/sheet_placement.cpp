// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/calibration/sheet_placement.hpp"

#include <cmath>

namespace chaintrue::model {

Eigen::Matrix2d SheetPlacement::rotation() const {
  const double c = std::cos(rotation_rad);
  const double s = std::sin(rotation_rad);
  Eigen::Matrix2d result;
  result << c, -s, s, c;
  return result;
}

BedPoint SheetPlacement::to_bed(MarkPoint mark) const {
  const Eigen::Vector2d bed = rotation() * Eigen::Vector2d(mark.x_mm, mark.y_mm);
  return {bed.x() + x_mm, bed.y() + y_mm};
}

MarkPoint SheetPlacement::to_mark(BedPoint bed) const {
  const Eigen::Vector2d mark =
      rotation().transpose() * Eigen::Vector2d(bed.x_mm - x_mm, bed.y_mm - y_mm);
  return {mark.x(), mark.y()};
}

Eigen::Matrix<double, 2, 3> SheetPlacement::sensitivity(MarkPoint mark) const {
  const Eigen::Vector2d turned = rotation() * Eigen::Vector2d(mark.x_mm, mark.y_mm);
  Eigen::Matrix<double, 2, 3> result;
  result << 1.0, 0.0, -turned.y(), 0.0, 1.0, turned.x();
  return result;
}

}  // namespace chaintrue::model
