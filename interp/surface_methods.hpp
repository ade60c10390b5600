// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The table of methods to interpolate a full grid. To add one: its class, its build function in
/// surface_methods.cpp, one line in surface_methods.def; the contract tests run over the table.

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "interp/surface.hpp"

namespace chaintrue::interp {

/// One method. `build` throws std::invalid_argument as TensorSpline does.
struct SurfaceMethod {
  std::string_view id;
  int exact_degree;  ///< polynomials of this degree in x times the same in y are reproduced
  std::string_view description;
  std::unique_ptr<Surface> (*build)(const std::vector<double>& x_nodes,
                                    const std::vector<double>& y_nodes,
                                    const Eigen::MatrixXd& values);
};

[[nodiscard]] std::span<const SurfaceMethod> surface_methods();
/// Null where no method has this id.
[[nodiscard]] const SurfaceMethod* find_surface_method(std::string_view id);

}  // namespace chaintrue::interp
