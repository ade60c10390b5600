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

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "interp/surface.hpp"
#include "interp/tensor_spline.hpp"
#include "model/coordinates.hpp"

namespace chaintrue::grid {

struct PointsFit;

struct LatticeResidual {
  std::vector<double> x_nodes_mm;
  std::vector<double> y_nodes_mm;
  model::PerSide<Eigen::MatrixXd> values_mm;  ///< (ix, iy)
  /// One sigma of a node's value beyond the readings' noise; zero if it was measured.
  Eigen::MatrixXd doubt_mm;
  /// One sigma between the nodes, from predictions of left-out nodes by their lines.
  double interpolation_sigma_mm = 0.0;
};

/// Answers for a LatticeResidual. Immutable, thread safe.
class LatticeSplines {
 public:
  /// \throws std::invalid_argument if the shapes do not fit the nodes or the nodes do not rise.
  explicit LatticeSplines(const LatticeResidual& residual);

  [[nodiscard]] model::PerSide<interp::ValueGradient> at(model::MarkPoint mark) const;
  [[nodiscard]] model::PerSide<const interp::Surface*> surfaces() const {
    return {left_.get(), right_.get()};
  }
  /// For both corrections, two columns a node, `node` being the covariance of one measured node. The
  /// bicubic's weights approximate the quintic's. Inside the lattice the interpolation's own error
  /// counts in full; beyond it, it grows with the weights.
  [[nodiscard]] Eigen::Matrix2Xd spread(model::MarkPoint mark, const Eigen::Matrix2d& node) const;

 private:
  std::shared_ptr<const interp::Surface> left_;
  std::shared_ptr<const interp::Surface> right_;
  interp::TensorSpline weights_;
  Eigen::MatrixXd doubt_mm_;
  double interpolation_sigma_mm_;
};

/// Two columns a node: the root of `node` and, on either chain, of that node's `own_mm2`, times its weight.
[[nodiscard]] Eigen::Matrix2Xd spread_of_nodes(const Eigen::MatrixXd& weights,
                                               const Eigen::Matrix2d& node,
                                               const Eigen::MatrixXd& own_mm2);

struct LatticeFit {
  LatticeResidual residual;
  /// Measured minus predicted by the lines through the point, in the order of the fit's points.
  std::vector<Eigen::Vector2d> left_out_residual_mm;
};

/// Interpolates the residuals of `fit` without its penalised surface. Empty unless the points are
/// single nodes of a lattice of at least 4 x 4 lines with at most a tenth of the nodes empty, the
/// readings are free of noise (with noise the fit has clearly fewer effective parameters than
/// readings), and the lines predict left-out points nearly as well.
[[nodiscard]] std::optional<LatticeFit> fit_lattice(const PointsFit& fit);

/// Points nearer than this to a line of the lattice lie on it: the rounding of written
/// coordinates.
inline constexpr double kOnLineMm = 0.01;

/// The distinct coordinates, rising; of those within kOnLineMm of each other the least.
[[nodiscard]] std::vector<double> lines_of(std::vector<double> coordinates_mm);

/// The line of a coordinate, which must be one of those used to form the lines.
[[nodiscard]] Eigen::Index line_of(const std::vector<double>& lines_mm, double coordinate_mm);

}  // namespace chaintrue::grid
