// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Vectors and matrices under Eigen's names. Vectors are columns.

#include <Eigen/Core>

namespace chaintrue {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::Matrix2Xd;
using Eigen::Matrix4d;
using Eigen::MatrixXd;
using Eigen::RowVector2d;
using Eigen::RowVectorXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector4d;
using Eigen::VectorXd;

}  // namespace chaintrue
