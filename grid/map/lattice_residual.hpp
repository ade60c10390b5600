// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The residual of the calibrated machine and its chains' scales at the nodes of a lattice,
/// interpolated by a spline through every measured node.
///
///   correction_i(q) = e_i f_i(q) + t_i(q)                                                   (1)
///
///   e_i, f_i   as in residual_surface.hpp
///   t_i        quintic on axes of six nodes or more, else not-a-knot cubic
///
/// For readings without noise this errs less between the nodes than a penalised surface, which has
/// to balance smoothness against fidelity. Nodes that were not measured are filled from the line
/// through them (interp/missing_nodes.hpp).
#pragma once

#include <array>
#include <vector>

#include "interp/eigen.hpp"
#include "model/coordinates.hpp"

namespace chaintrue::grid {

struct LatticeResidual {
  std::vector<double> x_nodes_mm;
  std::vector<double> y_nodes_mm;
  PerSide<MatrixXd> values_mm;  ///< (ix, iy)
  /// One sigma of a node's value beyond the readings' noise; zero if it was measured.
  MatrixXd doubt_mm;
  /// One sigma between the nodes, from predictions of left-out nodes by their lines.
  double interpolation_sigma_mm = 0.0;
};

/// The rows and columns that marks form, and the node of each. Marks within 0.01 mm of a line, the
/// rounding of written coordinates, lie on it.
struct LatticeNodes {
  std::vector<double> x_nodes_mm;  ///< rising
  std::vector<double> y_nodes_mm;
  std::vector<std::array<Index, 2>> of_mark;
  Eigen::MatrixXi visits;  ///< marks at each node, (ix, iy)
};
LatticeNodes lattice_nodes(const std::vector<MarkPoint>& marks);

}  // namespace chaintrue::grid
