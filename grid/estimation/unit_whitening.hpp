// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// From the readings of a unit to units of noise.
///
///   W C W' = I,   W lower triangular                                                          (1)
///
/// for readings with covariance C. Source: G. Golub and C. Van Loan, Matrix Computations (2013), section 6.1.
#pragma once

#include "interp/eigen.hpp"

namespace chaintrue::grid::estimation {

/// Most readings of one unit: four belts at a place.
inline constexpr int kMostUnitReadings = 4;

/// W of (1), of at most kMostUnitReadings readings. \throws std::invalid_argument with more.
MatrixXd unit_whitening(const MatrixXd& covariance);

}  // namespace chaintrue::grid::estimation
