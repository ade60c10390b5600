// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The displacement of the tool from where its upper two belts put it: a smooth field over the
/// sheet, known at some places and predicted between them.
///
///   k(r) = (1 + u + u^2 / 3) exp(-u),   u = sqrt(5) r / reach                               (1)
///   d(q) = sum_i k(|q - q_i|) w_i,      K w = d at the places                               (2)
///
/// Each axis is independent; far from all places the field tends to zero, and size^2 (1 - k' K^-1
/// k) is the remaining variance given the values at the places.
///
/// Source: C. Rasmussen and C. Williams, Gaussian Processes for Machine Learning (2006), equations
/// 4.17 for (1) and 2.25 for (2).
///
/// \code
///   const ToolDisplacement displacement({.size_mm = 0.8, .reach_mm = 900.0, .places = holes, .at = d});
///   const Eigen::Vector2d off = displacement.at({100.0, -200.0});
/// \endcode
#pragma once

#include <vector>

#include "interp/eigen.hpp"
#include "model/coordinates.hpp"

namespace chaintrue::grid {

struct DisplacementParts {
  double size_mm = 0.0;   ///< one sigma beforehand, on each axis
  double reach_mm = 1.0;  ///< over which it changes
  std::vector<MarkPoint> places;
  VectorXd at_mm;  ///< x and y at each place, 2 N
};

/// (1) between all of two lists.
MatrixXd displacement_kernel(const std::vector<MarkPoint>& from, const std::vector<MarkPoint>& to,
                             double reach_mm);

/// Immutable, thread safe.
class ToolDisplacement {
 public:
  /// \throws std::invalid_argument if `at_mm` does not fit the places.
  explicit ToolDisplacement(DisplacementParts parts);

  Vector2d at(MarkPoint mark) const;

  /// For each axis, in addition to the uncertainty at the places.
  double own_variance_mm2(MarkPoint mark) const;

  const DisplacementParts& parts() const { return parts_; }

 private:
  DisplacementParts parts_;
  Eigen::MatrixX2d weights_mm_;
  MatrixXd inverse_;  ///< of K
};

}  // namespace chaintrue::grid
