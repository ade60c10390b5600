// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// New points of one file for the check of a map: without repeats and effects of the paper and the
/// visit, and placed on the map. Private to grid/map.
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

/// More would take over some ten seconds (docs/reliability.md).
inline constexpr std::size_t kMostCheckedPoints = 20000;
inline constexpr std::size_t kMostCheckedDistances = 20000;
inline constexpr std::size_t kMostCheckedHoles = 500;

/// No workshop reading is more accurate.
inline constexpr double kLeastVarianceMm2 =
    observation::kKnownNuisanceMm * observation::kKnownNuisanceMm;

/// Readings at one mark are replaced by their mean.
struct Repeated {
  LengthPoint point;  ///< the first of them, with the mean of all lengths
  double count = 0.0;
};

/// The new points of one file: their positions on the map, and their readings.
struct CheckedPart {
  std::vector<model::MarkPoint> marks;  ///< on the map
  /// For a newly placed sheet: the accuracy of its placement, and where the readings put it in the
  /// map's frame. Everything is linearised there.
  std::optional<observation::SheetPrior> sheet;
  model::SheetPlacement placement;
  std::vector<std::string> notes;
  std::vector<Repeated> points;  ///< of a grid
  StatedNoise noise;
  std::optional<observation::TapeDistances> distances;
};

[[nodiscard]] tl::expected<CheckedPart, CheckFailure> checked_part(const CompensationMap& map,
                                                                   const MeasuredGrid& grid);
/// Holes are where the map puts the lengths that their controller paid out.
[[nodiscard]] tl::expected<CheckedPart, CheckFailure> checked_part(const CompensationMap& map,
                                                                   const MeasuredHoles& set);

/// The map at N places of new readings: d(lengths)/d(mark), and the covariance F F' of its lengths,
/// jointly or place by place.
struct MapAt {
  std::vector<model::ChainLengths> lengths;
  std::vector<Eigen::Matrix2d> by_mark;
  Eigen::MatrixXd factor;                   ///< F, 2 N x any
  std::vector<Eigen::Matrix2d> covariance;  ///< for each place; empty if F contains it
  /// 2 N x p, by the settings of the machine; no columns for a map without one.
  Eigen::MatrixXd by_parameter;
};

/// Fails if the map has no answer at a mark, or its machine no pose.
[[nodiscard]] tl::expected<MapAt, CheckFailure> map_at(const CompensationMap& map,
                                                       const std::vector<model::MarkPoint>& marks,
                                                       const Progress& progress = {});

}  // namespace chaintrue::grid
