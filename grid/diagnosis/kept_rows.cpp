// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/kept_rows.hpp"

#include "grid/diagnosis/regressor_system.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// The rejected part of a unit.
struct Rejected {
  bool whole = false;
  std::optional<Vector2d> direction{};  ///< of length one
};

void reject(const OutlierGroup& group, Rejected& unit) {
  // Two directions this near are one: the sine of the angle between them.
  constexpr double kOneDirection = 1e-9;
  if (!group.direction) {
    unit.whole = true;
    return;
  }
  const Vector2d own = group.direction->normalized();
  if (!unit.direction) {
    unit.direction = own;
    return;
  }
  const double sine = own.x() * unit.direction->y() - own.y() * unit.direction->x();
  unit.whole = unit.whole || std::abs(sine) > kOneDirection;
}

std::vector<Rejected> rejected_units(const RegressorSystem& system, const Flags& rejected) {
  std::vector<Rejected> units(system.units.size());
  for (const auto k : each_index(system.groups)) {
    if (rejected[k]) reject(system.groups[k], units[system.unit_of(system.groups[k])]);
  }
  return units;
}

}  // namespace

KeptRows::KeptRows(const RegressorSystem& system, const Flags& rejected) : all_(system.e.size()) {
  const std::vector<Rejected> of_unit = rejected_units(system, rejected);
  for (const Index row : each_below(system.e.size())) {
    const int number = system.unit_of_row[index(row)];
    if (number < 0) {
      rows_.push_back(row);
      continue;
    }
    const auto unit = as_size(number);
    const Rejected& own = of_unit[unit];
    if (own.whole) continue;
    const bool first = system.units[unit].first_row == row;
    if (own.direction && !first) continue;
    if (first) {
      Unit kept{size(), own.direction ? 1 : system.units[unit].rows, unit};
      if (own.direction) kept.across = RowVector2d(-own.direction->y(), own.direction->x());
      units_.push_back(kept);
    }
    rows_.push_back(row);
  }
}

Rows KeptRows::positions(const Indices& units) const {
  Rows result;
  for (const Unit& unit : units_) {
    if (!contains(units, unit.unit)) continue;
    for (const Index k : each_below(unit.rows)) result.push_back(unit.at + k);
  }
  return result;
}

}  // namespace chaintrue::grid::diagnosis
