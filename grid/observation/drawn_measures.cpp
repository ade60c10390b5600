// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/observation/drawn_measures.hpp"

namespace chaintrue::grid::observation {

const Kind drawn_measures{"drawn_measures", "measure", "measures", "point", false};

MeasureRow measure_row(DrawnMeasure::Kind kind, const Vector2d& from, const Vector2d& to,
                       const Vector2d& middle) {
  const Vector2d way = to - from;
  const double length = way.norm();
  const Vector2d along = way / length;
  if (kind == DrawnMeasure::Kind::length)
    return {length, -along.transpose(), along.transpose(), RowVector2d::Zero()};
  const RowVector2d across(-along.y(), along.x());
  const double share = along.dot(middle - from) / length;
  return {across.dot(middle - from), (share - 1.0) * across, -share * across, across};
}

}  // namespace chaintrue::grid::observation
