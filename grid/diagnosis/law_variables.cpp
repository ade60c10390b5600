// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/law_variables.hpp"

#include <cmath>
#include <utility>

#include "grid/diagnosis/discrepancy.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

std::vector<LawEntrance> entrances_of_chains(Coordinate of) {
  if (const auto chain = chain_of(of)) {
    const bool is_left = *chain == model::Side::left;
    return {{Enters::left, is_left ? 0.55 : 0.15},
            {Enters::right, is_left ? 0.15 : 0.55},
            {Enters::x, 0.15},
            {Enters::y, 0.15}};
  }
  switch (of) {
    case Coordinate::x:
    case Coordinate::y:
      return {{Enters::left, 0.25}, {Enters::right, 0.25}, {Enters::x, 0.25}, {Enters::y, 0.25}};
    case Coordinate::across:
      return {{Enters::left, 0.2},
              {Enters::right, 0.2},
              {Enters::x, 0.2},
              {Enters::y, 0.2},
              {Enters::along, 0.2}};
    case Coordinate::border:
      return {{Enters::outwards, 0.4},
              {Enters::left, 0.15},
              {Enters::right, 0.15},
              {Enters::x, 0.15},
              {Enters::y, 0.15}};
    default:
      break;
  }
  return {{Enters::left, 0.35}, {Enters::right, 0.35}, {Enters::equal, 0.3}};
}

std::vector<LawEntrance> entrances_of_belts(Coordinate of) {
  const auto own = belt_of(of);
  std::vector<LawEntrance> entrances;
  for (const Enters enters : {Enters::tl, Enters::tr, Enters::bl, Enters::br})
    entrances.push_back({enters, !own ? 0.25 : belt_of(enters) == own ? 0.7 : 0.1});
  return entrances;
}

/// Distance from the border that a component crosses.
double from_border(const SystemPlace& place, bool along_x) {
  return along_x ? 0.5 * place.bed.width_mm - std::abs(place.mark.x_mm)
                 : 0.5 * place.bed.height_mm - std::abs(place.mark.y_mm);
}

/// The effect of one millimetre of a law on the chains at a place, with the law's argument.
std::vector<std::pair<double, Eigen::Vector2d>> chains_at(const SystemPlace& place,
                                                          const LawTerm& term) {
  if (term.of == Coordinate::visit && !place.ordered) return {};
  const Eigen::Matrix2d& by_mark = place.state.by_mark;
  const auto at = [&](const Eigen::Vector2d& chains_mm) {
    return std::vector{std::pair(value_at(place, term.of, term.direction_rad), chains_mm)};
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
      return at(by_mark *
                Eigen::Vector2d(std::cos(term.direction_rad), std::sin(term.direction_rad)));
    case Enters::outwards:
      return {{from_border(place, true), by_mark.col(0) * std::copysign(1.0, place.mark.x_mm)},
              {from_border(place, false), by_mark.col(1) * std::copysign(1.0, place.mark.y_mm)}};
    default:
      break;
  }
  return {};
}

}  // namespace

std::vector<Coordinate> law_variables(const RegressorSystem& system) {
  if (system.is_of_lengths()) {
    return {Coordinate::x,
            Coordinate::y,
            Coordinate::length_tl,
            Coordinate::length_tr,
            Coordinate::length_bl,
            Coordinate::length_br,
            Coordinate::angle_tl,
            Coordinate::angle_tr,
            Coordinate::angle_bl,
            Coordinate::angle_br,
            Coordinate::visit};
  }
  return {Coordinate::x,
          Coordinate::y,
          Coordinate::border,
          Coordinate::length_left,
          Coordinate::length_right,
          Coordinate::angle_left,
          Coordinate::angle_right,
          Coordinate::tension_left,
          Coordinate::tension_right,
          Coordinate::visit};
}

std::vector<LawEntrance> law_entrances(const RegressorSystem& system, Coordinate of) {
  return system.is_of_lengths() ? entrances_of_belts(of) : entrances_of_chains(of);
}

double shortest_wave(Coordinate of, Enters enters, double span) {
  if (of == Coordinate::x || of == Coordinate::y) return 100.0;
  if (of == Coordinate::across) return 400.0;
  const bool of_length = (chain_of(of) || belt_of(of)) && unit_of(of) == "mm";
  if (!of_length) return span / 6.0;
  return may_repeat(of, enters) ? 25.0 : 200.0;
}

bool may_repeat(Coordinate of, Enters enters) {
  if (of == Coordinate::x || of == Coordinate::y) return true;
  if (unit_of(of) != "mm") return false;
  if (const auto belt = belt_of(of)) return belt_of(enters) == belt;
  const auto chain = chain_of(of);
  return chain && enters == (*chain == model::Side::left ? Enters::left : Enters::right);
}

std::vector<double> values_of_variable(const RegressorSystem& system,
                                       Coordinate of,
                                       double direction_rad) {
  std::vector<double> values;
  for (const SystemPlace& place : system.places) {
    if (of != Coordinate::visit || place.ordered)
      values.push_back(value_at(place, of, direction_rad));
  }
  return values;
}

std::vector<LawRows> law_rows(const RegressorSystem& system,
                              std::size_t unit,
                              const LawTerm& term) {
  std::vector<LawRows> all;
  for (const observation::PlaceColumns& own : system.units[unit].places) {
    const SystemPlace& place = system.places[own.place];
    if (const auto belt = belt_of(term.enters)) {
      all.push_back({value_at(place, term.of, term.direction_rad),
                     system.units[unit].by_reading.col(static_cast<Eigen::Index>(*belt))});
      continue;
    }
    for (const auto& [v, chains_mm] : chains_at(place, term))
      all.push_back({v, own.by_chain * chains_mm});
  }
  return all;
}

}  // namespace chaintrue::grid::diagnosis
