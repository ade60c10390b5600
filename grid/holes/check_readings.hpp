// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// New points as the check sees them: residuals against a map, their covariance, and what a change
/// of the chains' readings does to them. Private to grid/holes.
#pragma once

#include <Eigen/Core>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "grid/holes/map_check.hpp"

namespace chaintrue::grid {

struct CheckReadings {
  Eigen::VectorXd residual_mm;  ///< n
  Eigen::MatrixXd covariance;   ///< n x n: K of map_check.hpp (1)
  /// n x 2 N: by a change of the readings at each of N places, left and right.
  Eigen::MatrixXd by_chain;
  Eigen::MatrixXd lengths_mm;  ///< 2 N x 2: the chain's length at its own rows, by side
  Eigen::MatrixXd by_motor;    ///< 2 N x 4, or no columns where the map has no machine
  /// Rows of each point or reading that may be bad by itself.
  std::vector<std::vector<Eigen::Index>> groups;
  std::vector<std::string> names;        ///< of the rows
  std::vector<std::string> group_names;  ///< "point 3"
  double pitch_mm = 6.35;
  model::ChainLengths zero;
};

/// More than these would take a minute and more: the cost is the cube of the number,
/// docs/reliability.md.
inline constexpr std::size_t kMostCheckedPoints = 1000;
inline constexpr std::size_t kMostCheckedDistances = 2000;

/// Of all files together: what the map does not know of itself they share. Readings at one and the
/// same mark count as their mean. Fails where there are too many before any work.
[[nodiscard]] tl::expected<CheckReadings, CheckFailure> check_readings(const CompensationMap& map,
                                                                       const Measured& measured);

}  // namespace chaintrue::grid
