// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/law_variables.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "grid/diagnosis/discrepancy.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

std::vector<LawEntrance> entrances_of_chains(LawOf of) {
  switch (of) {
    case LawOf::x:
    case LawOf::y:
      return {{Enters::left, 0.25}, {Enters::right, 0.25}, {Enters::x, 0.25}, {Enters::y, 0.25}};
    case LawOf::across:
      return {{Enters::left, 0.2},
              {Enters::right, 0.2},
              {Enters::x, 0.2},
              {Enters::y, 0.2},
              {Enters::along, 0.2}};
    case LawOf::border:
      return {{Enters::outwards, 0.4},
              {Enters::left, 0.15},
              {Enters::right, 0.15},
              {Enters::x, 0.15},
              {Enters::y, 0.15}};
    case LawOf::length_left:
    case LawOf::angle_left:
    case LawOf::tension_left:
      return {{Enters::left, 0.55}, {Enters::right, 0.15}, {Enters::x, 0.15}, {Enters::y, 0.15}};
    case LawOf::length_right:
    case LawOf::angle_right:
    case LawOf::tension_right:
      return {{Enters::left, 0.15}, {Enters::right, 0.55}, {Enters::x, 0.15}, {Enters::y, 0.15}};
    default:
      break;
  }
  return {{Enters::left, 0.35}, {Enters::right, 0.35}, {Enters::equal, 0.3}};
}

std::vector<LawEntrance> entrances_of_belts(LawOf of) {
  const auto own = belt_of(of);
  std::vector<LawEntrance> entrances;
  for (const Enters enters : {Enters::tl, Enters::tr, Enters::bl, Enters::br})
    entrances.push_back({enters, !own ? 0.25 : belt_of(enters) == own ? 0.7 : 0.1});
  return entrances;
}

/// From the nearest border inwards.
double from_border(const SystemPlace& place) {
  return std::min(0.5 * place.bed.width_mm - std::abs(place.mark.x_mm),
                  0.5 * place.bed.height_mm - std::abs(place.mark.y_mm));
}

/// From the border that a component crosses.
double from_border(const SystemPlace& place, bool along_x) {
  return along_x ? 0.5 * place.bed.width_mm - std::abs(place.mark.x_mm)
                 : 0.5 * place.bed.height_mm - std::abs(place.mark.y_mm);
}

double variable_at(const LengthEntry& entry, LawOf of, double direction_rad) {
  switch (of) {
    case LawOf::x:
      return entry.x_mm;
    case LawOf::y:
      return entry.y_mm;
    case LawOf::across:
      return entry.x_mm * std::cos(direction_rad) + entry.y_mm * std::sin(direction_rad);
    case LawOf::visit:
      return entry.visit;
    default:
      break;
  }
  const auto belt = static_cast<std::size_t>(belt_of(of).value());
  return of >= LawOf::angle_tl ? entry.angle_rad[belt] : entry.length_mm[belt];
}

/// What one millimetre of a law makes of the chains at a place, with what the law is a function of.
std::vector<std::pair<double, Eigen::Vector2d>> chains_at(const SystemPlace& place, const LawTerm& term) {
  if (term.of == LawOf::visit && !place.ordered) return {};
  const Eigen::Matrix2d& by_mark = place.state.by_mark;
  const auto at = [&](const Eigen::Vector2d& chains_mm) {
    return std::vector{std::pair(variable_at(place, term.of, term.direction_rad), chains_mm)};
  };
  switch (term.enters) {
    case Enters::left:
      return at({1.0, 0.0});
    case Enters::right:
      return at({0.0, 1.0});
    case Enters::equal:
      return at({1.0, 1.0});
    case Enters::opposite:
      return at({1.0, -1.0});
    case Enters::x:
      return at(by_mark.col(0));
    case Enters::y:
      return at(by_mark.col(1));
    case Enters::along:
      return at(by_mark * Eigen::Vector2d(std::cos(term.direction_rad), std::sin(term.direction_rad)));
    case Enters::outwards:
      return {{from_border(place, true), by_mark.col(0) * std::copysign(1.0, place.mark.x_mm)},
              {from_border(place, false), by_mark.col(1) * std::copysign(1.0, place.mark.y_mm)}};
    default:
      break;
  }
  return {};
}

}  // namespace

std::vector<LawOf> law_variables(const RegressorSystem& system) {
  if (!system.entries.empty()) {
    return {LawOf::x,
            LawOf::y,
            LawOf::length_tl,
            LawOf::length_tr,
            LawOf::length_bl,
            LawOf::length_br,
            LawOf::angle_tl,
            LawOf::angle_tr,
            LawOf::angle_bl,
            LawOf::angle_br,
            LawOf::visit};
  }
  return {LawOf::x,
          LawOf::y,
          LawOf::border,
          LawOf::length_left,
          LawOf::length_right,
          LawOf::angle_left,
          LawOf::angle_right,
          LawOf::tension_left,
          LawOf::tension_right,
          LawOf::visit};
}

std::vector<LawEntrance> law_entrances(const RegressorSystem& system, LawOf of) {
  return system.entries.empty() ? entrances_of_chains(of) : entrances_of_belts(of);
}

double shortest_wave(LawOf of, Enters enters, double span) {
  switch (of) {
    case LawOf::x:
    case LawOf::y:
      return 100.0;
    case LawOf::across:
      return 400.0;
    case LawOf::length_left:
    case LawOf::length_right:
    case LawOf::length_tl:
    case LawOf::length_tr:
    case LawOf::length_bl:
    case LawOf::length_br:
      return may_repeat(of, enters) ? 25.0 : 200.0;
    default:
      return span / 6.0;
  }
}

bool may_repeat(LawOf of, Enters enters) {
  switch (of) {
    case LawOf::x:
    case LawOf::y:
      return true;
    case LawOf::length_left:
      return enters == Enters::left;
    case LawOf::length_right:
      return enters == Enters::right;
    case LawOf::length_tl:
    case LawOf::length_tr:
    case LawOf::length_bl:
    case LawOf::length_br:
      return belt_of(enters) == belt_of(of);
    default:
      return false;
  }
}

double variable_at(const SystemPlace& place, LawOf of, double direction_rad) {
  switch (of) {
    case LawOf::x:
      return place.mark.x_mm;
    case LawOf::y:
      return place.mark.y_mm;
    case LawOf::across:
      return place.mark.x_mm * std::cos(direction_rad) + place.mark.y_mm * std::sin(direction_rad);
    case LawOf::border:
      return from_border(place);
    case LawOf::visit:
      return place.order;
    default:
      break;
  }
  const auto first = static_cast<std::size_t>(FieldOf::length_left);
  const auto own = static_cast<std::size_t>(of) - static_cast<std::size_t>(LawOf::length_left);
  return discrepancy_place(place).at[first + own];
}

std::vector<double> values_of_variable(const RegressorSystem& system, LawOf of, double direction_rad) {
  std::vector<double> values;
  for (const LengthEntry& entry : system.entries) values.push_back(variable_at(entry, of, direction_rad));
  if (!system.entries.empty()) return values;
  for (const SystemPlace& place : system.places) {
    if (of != LawOf::visit || place.ordered) values.push_back(variable_at(place, of, direction_rad));
  }
  return values;
}

std::vector<LawRows> law_rows(const RegressorSystem& system, std::size_t unit, const LawTerm& term) {
  if (!system.entries.empty()) {
    const LengthEntry& entry = system.entries[unit];
    const auto belt = static_cast<Eigen::Index>(belt_of(term.enters).value());
    return {{variable_at(entry, term.of, term.direction_rad),
             system.units[unit].by_reading.col(belt)}};
  }
  std::vector<LawRows> all;
  for (const observation::PlaceColumns& own : system.units[unit].places) {
    for (const auto& [v, chains_mm] : chains_at(system.places[own.place], term))
      all.push_back({v, own.by_chain * chains_mm});
  }
  return all;
}

}  // namespace chaintrue::grid::diagnosis
