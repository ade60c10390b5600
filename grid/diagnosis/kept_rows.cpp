// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/kept_rows.hpp"

#include "grid/diagnosis/regressor_system.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// The rejected part of a unit.
struct Rejected {
  bool whole = false;
  std::optional<Eigen::Vector2d> direction{};  ///< of length one
};

void reject(const OutlierGroup& group, Rejected& unit) {
  // Two directions this near are one: the sine of the angle between them.
  constexpr double kOneDirection = 1e-9;
  if (!group.direction) {
    unit.whole = true;
    return;
  }
  const Eigen::Vector2d own = group.direction->normalized();
  if (!unit.direction) {
    unit.direction = own;
    return;
  }
  const double sine = own.x() * unit.direction->y() - own.y() * unit.direction->x();
  unit.whole = unit.whole || std::abs(sine) > kOneDirection;
}

std::vector<Rejected> rejected_units(const RegressorSystem& system, const Flags& rejected) {
  std::vector<Rejected> units(system.units.size());
  if (system.groups.empty()) {
    for (std::size_t u = 0; u < units.size(); ++u) units[u].whole = rejected[u];
    return units;
  }
  for (std::size_t k = 0; k < system.groups.size(); ++k) {
    if (!rejected[k]) continue;
    const auto row = as_size(system.groups[k].first_row);
    reject(system.groups[k], units[as_size(system.unit_of_row[row])]);
  }
  return units;
}

}  // namespace

KeptRows::KeptRows(const RegressorSystem& system, const Flags& rejected) {
  const std::vector<Rejected> of_unit = rejected_units(system, rejected);
  for (Eigen::Index row = 0; row < system.e.size(); ++row) {
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
      if (own.direction) kept.across = Eigen::RowVector2d(-own.direction->y(), own.direction->x());
      units_.push_back(kept);
    }
    rows_.push_back(row);
  }
}

KeptRows KeptRows::all(const RegressorSystem& system) { return {system, nothing_rejected(system)}; }

Rows KeptRows::positions(const Indices& units) const {
  Rows result;
  for (const Unit& unit : units_) {
    if (!contains(units, unit.unit)) continue;
    for (Eigen::Index k = 0; k < unit.rows; ++k) result.push_back(unit.at + k);
  }
  return result;
}

Eigen::VectorXd KeptRows::operator()(const Eigen::VectorXd& all) const {
  Eigen::VectorXd kept = all(rows_);
  for (const Unit& unit : units_) {
    if (unit.across) kept(unit.at) = *unit.across * all.segment<2>(rows_[index(unit.at)]);
  }
  return kept;
}

Eigen::MatrixXd KeptRows::of(const Eigen::Ref<const Eigen::MatrixXd>& all) const {
  if (size() == all.rows()) return all;
  Eigen::MatrixXd kept(size(), all.cols());
  for (Eigen::Index column = 0; column < all.cols(); ++column) {
    const auto from = all.col(column);
    for (Eigen::Index k = 0; k < kept.rows(); ++k) kept(k, column) = from[rows_[index(k)]];
    for (const Unit& unit : units_) {
      if (unit.across)
        kept(unit.at, column) = *unit.across * from.segment<2>(rows_[index(unit.at)]);
    }
  }
  return kept;
}

}  // namespace chaintrue::grid::diagnosis
