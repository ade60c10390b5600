// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The model discrepancy: what repeats over the bed and no cause explains, as a Gaussian process
/// (M. Kennedy and A. O'Hagan, J. R. Stat. Soc. B 63 (2001), 425).
///
/// Two kinds, each at some lengths: either chain by itself, smooth in both directions of the bed;
/// or the tool displaced by functions of x alone and of y alone, as edges, boards and folds do it.
///
///   chains      cov(r_i, r_j) = s^2 k(|p_i - p_j|) I
///   along_axes  cov(r_i, r_j) = s^2 (k(x_i - x_j) + k(y_i - y_j)) / 2 J_i J_j'
///   k(d) = exp(-d^2 / (2 length^2)), J = d(L, R)/d(mark)
#pragma once

#include <Eigen/Core>
#include <vector>

#include "grid/diagnosis/constants.hpp"
#include "grid/diagnosis/linearised_system.hpp"

namespace chaintrue::grid::diagnosis {

enum class DiscrepancyKind { chains, along_axes };

struct DiscrepancyKernel {
  DiscrepancyKind kind = DiscrepancyKind::chains;
  double length_mm = 0.0;
};

inline constexpr DiscrepancyKernel kDiscrepancyKernels[] = {
    {DiscrepancyKind::chains, 250.0},
    {DiscrepancyKind::chains, 450.0},
    {DiscrepancyKind::chains, 800.0},
    {DiscrepancyKind::along_axes, 180.0},
};
inline constexpr int kDiscrepancies =
    static_cast<int>(std::size(kDiscrepancyKernels) * std::size(kDiscrepancyStrengths));

/// Of discrepancy number `index` among all: kernels alike, strengths as a half-Cauchy of scale 10
/// has them, so that a huge discrepancy is rarer than one that is just seen (A. Gelman, Bayesian
/// Analysis 1 (2006), 515, section 4.3).
[[nodiscard]] double log_share_of_discrepancy(int index);

struct Discrepancy {
  DiscrepancyKernel kernel;
  double sigma_mm = 0.0;  ///< s
};

struct DiscrepancyPlace {
  model::BedPoint mark;
  Eigen::Matrix2d by_mark;  ///< J
};

/// Covariance of the two chains at two places, for s = 1.
[[nodiscard]] Eigen::Matrix2d discrepancy_block(const DiscrepancyKernel& kernel,
                                                const DiscrepancyPlace& a,
                                                const DiscrepancyPlace& b);

[[nodiscard]] DiscrepancyPlace discrepancy_place(const SystemPlace& place);

/// Covariance of two units' whitened rows, for s = 1; of units of one row the first line, or column.
[[nodiscard]] Eigen::Matrix2d discrepancy_between(const LinearisedSystem& system,
                                                  const DiscrepancyKernel& kernel,
                                                  const SystemUnit& a,
                                                  const SystemUnit& b);

/// Covariance of these whitened rows, for s = 1.
[[nodiscard]] Eigen::MatrixXd discrepancy_covariance(const LinearisedSystem& system,
                                                     const std::vector<Eigen::Index>& kept,
                                                     const DiscrepancyKernel& kernel);

}  // namespace chaintrue::grid::diagnosis
