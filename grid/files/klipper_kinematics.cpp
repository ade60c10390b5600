// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/klipper_kinematics.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "grid/files/klipper_source.hpp"

namespace chaintrue::grid::files {
namespace {

using model::BedPoint;

/// Where straight lines of these lengths from the anchors meet, below them.
std::optional<BedPoint> straight_place(const StraightChains& straight,
                                       model::ChainLengths lengths) {
  const model::PerSide<BedPoint>& anchors = straight.anchors;
  for (const model::Side side : model::kSides) lengths[side] += straight.longer_mm[side];
  const double dx = anchors.right.x_mm - anchors.left.x_mm;
  const double dy = anchors.right.y_mm - anchors.left.y_mm;
  const double apart = std::hypot(dx, dy);
  const double along =
      (lengths.left_mm * lengths.left_mm - lengths.right_mm * lengths.right_mm + apart * apart) /
      (2.0 * apart);
  const double square = (lengths.left_mm - along) * (lengths.left_mm + along);
  if (!(square > 0.0)) return std::nullopt;
  const double below = std::sqrt(square);
  return BedPoint{anchors.left.x_mm + (along * dx + below * dy) / apart,
                  anchors.left.y_mm + (along * dy - below * dx) / apart};
}

/// The largest second derivative of the straight place by x or y, in 1/mm, from the table's nodes.
std::optional<double> largest_bend(const LengthTable& table, const StraightChains& straight) {
  const auto place = [&](int row, int column) {
    return straight_place(straight, {table.node(row, column, 0), table.node(row, column, 1)});
  };
  double largest = 0.0;
  for (int row = 0; row < table.rows; ++row) {
    for (int column = 0; column < table.columns; ++column) {
      const auto here = place(row, column);
      if (!here) return std::nullopt;
      const auto bend =
          [&](const std::optional<BedPoint>& a, const std::optional<BedPoint>& b, double step_mm) {
            if (!a || !b) return 0.0;
            return std::hypot(a->x_mm - 2.0 * here->x_mm + b->x_mm,
                              a->y_mm - 2.0 * here->y_mm + b->y_mm) /
                   (step_mm * step_mm);
          };
      if (column > 0 && column + 1 < table.columns)
        largest =
            std::max(largest, bend(place(row, column - 1), place(row, column + 1), table.step_x()));
      if (row > 0 && row + 1 < table.rows)
        largest =
            std::max(largest, bend(place(row - 1, column), place(row + 1, column), table.step_y()));
    }
  }
  return largest;
}

/// A straight piece of the length s bows by s^2 / 8 of the bend, which may be twice what nodes show.
double piece_for(double bend_per_mm) {
  constexpr double kShortestMm = 1.0, kLongestMm = 20.0, kSafety = 2.0;
  const double longest = std::sqrt(8.0 * kTableErrorMm / std::max(kSafety * bend_per_mm, 1e-12));
  return std::clamp(std::floor(10.0 * longest) / 10.0, kShortestMm, kLongestMm);
}

}  // namespace

tl::expected<KlipperKinematics, MapFailure> klipper_kinematics(const LengthMap& map,
                                                               const StraightChains& straight,
                                                               const std::string& name) {
  const auto table = length_table(map);
  if (!table) return tl::unexpected(table.error());
  const auto bend = largest_bend(*table, straight);
  if (!bend) return tl::unexpected(MapReason::unreachable);
  const double piece_mm = piece_for(*bend);
  return KlipperKinematics{klipper_source(*table, straight, piece_mm, name),
                           table->columns,
                           table->rows,
                           table->spacing_mm(),
                           table->largest_error_mm,
                           piece_mm};
}

}  // namespace chaintrue::grid::files
