// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// New points as the check sees them: residuals against a map, their covariance, and what a change
/// of the chains' readings does to them. Private to grid/map.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "grid/map/map_check.hpp"
#include "grid/map/reading_covariance.hpp"

namespace chaintrue::grid {

struct CheckReadings {
  Eigen::VectorXd residual_mm;   ///< n
  ReadingCovariance covariance;  ///< K of map_check.hpp (1)
  /// n x 2 N: by a change of the readings at each of N places, left and right.
  Eigen::SparseMatrix<double> by_chain;
  Eigen::MatrixXd lengths_mm;           ///< 2 N x 2: the chain's length at its own rows, by side
  Eigen::MatrixXd by_motor;             ///< 2 N x 4, or no columns where the map has no machine
  std::vector<std::string> names;       ///< of the rows
  std::vector<std::string> unit_names;  ///< of what may be bad by itself: "point 3"
  std::vector<std::string> notes;       ///< what was taken out of the readings, and what could not be
  double pitch_mm = 6.35;
  model::ChainLengths zero;
};

/// A file of more would take more than some ten seconds, docs/reliability.md.
inline constexpr std::size_t kMostCheckedPoints = 20000;
inline constexpr std::size_t kMostCheckedDistances = 20000;
inline constexpr std::size_t kMostCheckedHoles = 500;

/// Of all files together: what the map does not know of itself they share. Readings at one and the
/// same mark, and of one and the same distance in one file, count as their mean: it says as much
/// of the map as they do. Fails where there are too many, before any work.
[[nodiscard]] tl::expected<CheckReadings, CheckFailure> check_readings(
    const CompensationMap& map, const Measured& measured, const Progress& progress = {});

}  // namespace chaintrue::grid
