// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Where a sheet of marks lies on the bed: bed = R(rotation) mark + shift.
#pragma once

#include <Eigen/Core>

#include "model/coordinates.hpp"

namespace chaintrue::model {

struct SheetPlacement {
  double x_mm = 0.0;
  double y_mm = 0.0;
  /// Counter-clockwise, about the marks' origin.
  double rotation_rad = 0.0;

  BedPoint to_bed(MarkPoint mark) const;
  MarkPoint to_mark(BedPoint bed) const;
  /// d(bed)/d(mark): the rotation.
  Eigen::Matrix2d rotation() const;
  /// d(bed)/d(x_mm, y_mm, rotation_rad)
  Eigen::Matrix<double, 2, 3> sensitivity(MarkPoint mark) const;
};

}  // namespace chaintrue::model

/// Exported: this name is used throughout chaintrue.
namespace chaintrue {
using model::SheetPlacement;
}  // namespace chaintrue
