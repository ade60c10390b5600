// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// ALGLIB's spline2d as a surface: bicubic, parabolic ends; the cubic of the edge cell continues
/// outside. Slower and, at few points, less accurate than TensorSpline with not-a-knot ends; used
/// as an independent check.

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "interp/surface.hpp"

namespace chaintrue::interp {

/// Immutable; spline2ddiff on a constant interpolant is thread safe (ALGLIB reference manual,
/// "thread safety"). Copies share the interpolant.
class AlglibSpline final : public Surface {
 public:
  /// `values(ix, iy)`; throws std::invalid_argument as TensorSpline does.
  AlglibSpline(const std::vector<double>& x_nodes,
               const std::vector<double>& y_nodes,
               const Eigen::Ref<const Eigen::MatrixXd>& values);

  [[nodiscard]] ValueGradient at(double x, double y) const override;
  [[nodiscard]] Rectangle domain() const override { return domain_; }

 private:
  struct Interpolant;
  std::shared_ptr<const Interpolant> interpolant_;
  Rectangle domain_;
};

}  // namespace chaintrue::interp
