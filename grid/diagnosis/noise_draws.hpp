// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a fit leaves of noise: residuals have passed through the fit that made them, so the noise
/// that they are held against has to pass through it too.
///
///   y = B diag(s) u + z,  u and z standard normal;   r = y - X (X'X + P)^-1 X' y
///
/// X, the columns of settings, nuisances (B, with their sigmas s) and named causes; P, their
/// precision beforehand.
#pragma once

#include "grid/diagnosis/analysis.hpp"

namespace chaintrue::grid::diagnosis {

enum class Nuisances {
  taken_out,  ///< as Estimate::left
  put_back,   ///< as left_of_machine()
};

/// r, a column a draw, of the rows kept by the decision's marginalised system; in units of noise.
/// The same seed and stream give the same draws.
[[nodiscard]] Eigen::MatrixXd left_of_noise(const Analysis& analysis,
                                            Nuisances nuisances,
                                            int draws,
                                            std::uint64_t stream);

}  // namespace chaintrue::grid::diagnosis
