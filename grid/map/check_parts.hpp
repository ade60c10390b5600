// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// New points of one file as a check of a map takes them: without repeats, without what belongs to the
/// paper and to the visit, and laid on the map. Private to grid/map.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "grid/map/check.hpp"
#include "grid/map/compensation_map.hpp"
#include "grid/observation/length_points.hpp"
#include "grid/observation/tape_distances.hpp"
#include "grid/progress.hpp"

namespace chaintrue::grid {

/// A file of more would take more than some ten seconds, docs/reliability.md.
inline constexpr std::size_t kMostCheckedPoints = 20000;
inline constexpr std::size_t kMostCheckedDistances = 20000;
inline constexpr std::size_t kMostCheckedHoles = 500;

/// No reading of a workshop is nearer.
inline constexpr double kLeastVarianceMm2 =
    observation::kKnownNuisanceMm * observation::kKnownNuisanceMm;

/// Readings at one mark are as good as their mean.
struct Repeated {
  LengthPoint point;  ///< the first of them, with the mean of all lengths
  double count = 0.0;
};

/// The new points of one file: where they are on the map, and what they say there.
struct CheckedPart {
  std::vector<model::MarkPoint> marks;  ///< on the map
  /// Of a sheet that was laid anew: how well, and where the readings put it in the map's frame. All
  /// is linearised there.
  std::optional<observation::SheetPrior> sheet;
  model::SheetPlacement placement;
  std::vector<std::string> notes;
  std::vector<Repeated> points;  ///< of a grid
  StatedNoise noise;
  std::optional<observation::TapeDistances> distances;
};

[[nodiscard]] tl::expected<CheckedPart, CheckFailure> checked_part(const CompensationMap& map,
                                                                   const MeasuredGrid& grid);
/// Holes lie where the map puts what their controller paid out.
[[nodiscard]] tl::expected<CheckedPart, CheckFailure> checked_part(const CompensationMap& map,
                                                                   const MeasuredHoles& set);

/// The map at N places of new readings: d(lengths)/d(mark), and what it does not know of its lengths there: F F',
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
