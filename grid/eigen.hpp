// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The vectors and matrices of grid, under Eigen's names. Vectors are columns; lengths are in
/// millimetres unless a name says otherwise.

#include <Eigen/Core>

namespace chaintrue::grid {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::Matrix2Xd;
using Eigen::MatrixXd;
using Eigen::RowVector2d;
using Eigen::RowVectorXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

}  // namespace chaintrue::grid
