// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/tool_displacement.hpp"

#include <algorithm>
#include <cmath>

#include "grid/containers.hpp"
#include "grid/plane_vectors.hpp"
#include "grid/precondition.hpp"
#include "interp/linear_algebra.hpp"

namespace chaintrue::grid {

MatrixXd displacement_kernel(const std::vector<MarkPoint>& from, const std::vector<MarkPoint>& to,
                             double reach_mm) {
  MatrixXd kernel(std::ssize(from), std::ssize(to));
  for (const auto i : each_index(from)) {
    for (const auto j : each_index(to)) {
      const double u = std::sqrt(5.0) * distance_mm(from[i], to[j]) / reach_mm;
      kernel(as_index(i), as_index(j)) = (1.0 + u + u * u / 3.0) * std::exp(-u);
    }
  }
  return kernel;
}

ToolDisplacement::ToolDisplacement(DisplacementParts parts) : parts_(std::move(parts)) {
  const auto count = std::ssize(parts_.places);
  if (parts_.at_mm.size() != 2 * count || count == 0 || !(parts_.reach_mm > 0.0)) {
    throw precondition("{} displacements of {} places over {} mm", parts_.at_mm.size(), count,
                       parts_.reach_mm);
  }
  // Keeps K positive definite for two holes at one place; a ten-thousandth of the size is below any
  // tape.
  constexpr double kSamePlace = 1e-8;
  MatrixXd kernel = displacement_kernel(parts_.places, parts_.places, parts_.reach_mm);
  kernel.diagonal().array() += kSamePlace;
  inverse_ = linear::Cholesky(std::move(kernel)).inverse();
  Eigen::MatrixX2d at(count, 2);
  for (const Index i : each_below(count)) at.row(i) = parts_.at_mm.segment<2>(2 * i).transpose();
  weights_mm_ = inverse_ * at;
}

Vector2d ToolDisplacement::at(MarkPoint mark) const {
  return (displacement_kernel({mark}, parts_.places, parts_.reach_mm) * weights_mm_).transpose();
}

double ToolDisplacement::own_variance_mm2(MarkPoint mark) const {
  const RowVectorXd near = displacement_kernel({mark}, parts_.places, parts_.reach_mm);
  return parts_.size_mm * parts_.size_mm * std::max(0.0, 1.0 - near.dot(near * inverse_));
}

}  // namespace chaintrue::grid
