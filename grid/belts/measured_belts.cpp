// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/belts/measured_belts.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace chaintrue::grid {

bool is_pulled(const BeltPoint& point, model::Belt belt) {
  if (!point.pulled) return !model::is_upper(belt);
  return std::find(point.pulled->begin(), point.pulled->end(), belt) != point.pulled->end();
}

std::string words_of(const BeltEnd& end) {
  if (const auto* index = std::get_if<std::size_t>(&end)) return fmt::format("point {}", *index);
  if (const auto* belt = std::get_if<model::Belt>(&end)) {
    return fmt::format("the {} anchor", model::words(*belt));
  }
  const model::BedPoint at = std::get<CutHole>(end).commanded;
  return fmt::format("the hole at ({:g}, {:g})", at.x_mm, at.y_mm);
}

}  // namespace chaintrue::grid
