// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A compensation map at the places of new readings, as a check needs it. Private to grid/map.
#pragma once

#include <Eigen/Core>
#include <tl/expected.hpp>
#include <vector>

#include "grid/map/check.hpp"
#include "grid/map/compensation_map.hpp"
#include "grid/progress.hpp"

namespace chaintrue::grid {

/// The map at N places: d(lengths)/d(mark), and what it does not know of its lengths there: F F',
/// all places together, or each for itself.
struct MapAt {
  std::vector<model::ChainLengths> lengths;
  std::vector<Eigen::Matrix2d> by_mark;
  Eigen::MatrixXd factor;                   ///< F, 2 N x any
  std::vector<Eigen::Matrix2d> covariance;  ///< of each place; empty where F has it
  /// 2 N x p, by the settings of the machine; no columns of a map without one.
  Eigen::MatrixXd by_parameter;
};

/// Fails where the map has no answer at a mark, or its machine no pose.
[[nodiscard]] tl::expected<MapAt, CheckFailure> map_at(const CompensationMap& map,
                                                       const std::vector<model::MarkPoint>& marks,
                                                       const Progress& progress = {});

}  // namespace chaintrue::grid
