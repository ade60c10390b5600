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
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

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

/// Two columns a node: the root of `node` and, on either chain, of that node's `own_mm2`, times its weight.
[[nodiscard]] Eigen::Matrix2Xd spread_of_nodes(const Eigen::MatrixXd& weights,
                                               const Eigen::Matrix2d& node,
                                               const Eigen::MatrixXd& own_mm2);

/// Answers for a LatticeResidual. Immutable, thread safe.
class LatticeSplines {
 public:
  /// \throws std::invalid_argument if the shapes do not fit the nodes or the nodes do not rise.
  explicit LatticeSplines(const LatticeResidual& residual)
      : quintic_(std::make_shared<const interp::TensorAxes>(
            residual.x_nodes_mm, residual.y_nodes_mm, interp::TensorEnds{}, 5)),
        left_(quintic_, residual.values_mm.left),
        right_(quintic_, residual.values_mm.right),
        weights_(residual.x_nodes_mm, residual.y_nodes_mm, residual.doubt_mm),
        doubt_mm_(residual.doubt_mm),
        interpolation_sigma_mm_(residual.interpolation_sigma_mm) {}

  [[nodiscard]] model::PerSide<interp::ValueGradient> at(model::MarkPoint mark) const {
    return {left_.at(mark.x_mm, mark.y_mm), right_.at(mark.x_mm, mark.y_mm)};
  }
  [[nodiscard]] model::PerSide<const interp::Surface*> surfaces() const {
    return {&left_, &right_};
  }
  /// For both corrections, two columns a node, `node` being the covariance of one measured node. The
  /// bicubic's weights approximate the quintic's. Inside the lattice the interpolation's own error
  /// counts in full; beyond it, it grows with the weights.
  [[nodiscard]] Eigen::Matrix2Xd spread(model::MarkPoint mark, const Eigen::Matrix2d& node) const {
    const Eigen::MatrixXd weights = weights_.cardinal_weights(mark.x_mm, mark.y_mm);
    const double between =
        std::pow(interpolation_sigma_mm_, 2) * std::max(1.0, 1.0 / weights.squaredNorm());
    return spread_of_nodes(weights, node, (doubt_mm_.array().square() + between).matrix());
  }

 private:
  std::shared_ptr<const interp::TensorAxes> quintic_;
  interp::TensorSpline left_;
  interp::TensorSpline right_;
  interp::TensorSpline weights_;
  Eigen::MatrixXd doubt_mm_;
  double interpolation_sigma_mm_;
};

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

/// The rows and columns that marks form, and the node of each. Marks within 0.01 mm of a line, the
/// rounding of written coordinates, lie on it.
struct LatticeNodes {
  std::vector<double> x_nodes_mm;  ///< rising
  std::vector<double> y_nodes_mm;
  std::vector<std::array<Eigen::Index, 2>> of_mark;
  Eigen::MatrixXi visits;  ///< marks at each node, (ix, iy)
};
[[nodiscard]] LatticeNodes lattice_nodes(const std::vector<model::MarkPoint>& marks);

}  // namespace chaintrue::grid
