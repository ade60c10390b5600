// SPDX-License-Identifier: GPL-3.0-or-later
#include "generator/hidden/effects.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace chaintrue::generator {
namespace {

constexpr double kPi = std::numbers::pi;

std::array<CauseCard, kCauses> make_cards() {
  using enum Cause;
  using enum Where;
  const std::vector<Where> one{left, right};
  const std::vector<Where> any{left, right, both};
  const std::vector<Where> none{nowhere};
  return {{
      {tape_scale,
       "tape_scale",
       "scale",
       -0.05,
       0.05,
       0.0005,
       "",
       Place::none,
       false,
       false,
       false,
       {x, y, both}},
      {axes_skew,
       "axes_skew",
       "angle_rad",
       -0.05,
       0.05,
       0.001,
       "",
       Place::none,
       false,
       false,
       false,
       none},
      {ring_radius,
       "ring_radius",
       "offset_mm",
       -50,
       50,
       1,
       "",
       Place::none,
       false,
       true,
       false,
       none},
      {sprocket_radius,
       "sprocket_radius",
       "offset_mm",
       -3,
       3,
       0.17,
       "",
       Place::none,
       false,
       true,
       false,
       none},
      {chain_sag,
       "chain_sag",
       "relative_weight",
       -0.95,
       5,
       0.3,
       "",
       Place::none,
       false,
       true,
       false,
       none},
      {chain_stretch,
       "chain_stretch",
       "compliance_per_n",
       0,
       1e-4,
       6e-6,
       "",
       Place::none,
       false,
       true,
       false,
       none},
      {beam_flex,
       "beam_flex",
       "flexibility_mm_per_n",
       0,
       0.1,
       0.01,
       "",
       Place::none,
       false,
       true,
       false,
       none},
      {side_pull, "side_pull", "force_n", -10, 10, 3, "", Place::none, false, true, false, none},
      {chain_plane_offset,
       "chain_plane_offset",
       "distance_mm",
       0,
       300,
       30,
       "",
       Place::none,
       false,
       false,
       false,
       none},
      {sprocket_eccentricity,
       "sprocket_eccentricity",
       "amplitude_mm",
       0,
       5,
       0.3,
       "phase_rad",
       Place::phase,
       false,
       false,
       false,
       one},
      {angular_kink,
       "angular_kink",
       "slope_mm_per_rad",
       -60,
       60,
       4.5,
       "knee_rad",
       Place::angle,
       false,
       false,
       false,
       one},
      {direction_hysteresis,
       "direction_hysteresis",
       "half_width_mm",
       0,
       5,
       0.35,
       "",
       Place::none,
       false,
       false,
       true,
       any},
      {chain_pitch_error,
       "chain_pitch_error",
       "elongation",
       -0.05,
       0.05,
       0.001,
       "",
       Place::none,
       false,
       false,
       false,
       any},
      {drift, "drift", "rate_mm_per_visit", -1, 1, 0.03, "", Place::none, false, false, true, any},
      {tooth_skip,
       "tooth_skip",
       "links",
       -20,
       20,
       1,
       "first_visit",
       Place::visit,
       true,
       false,
       true,
       one},
      {link_miscount,
       "link_miscount",
       "links",
       -20,
       20,
       1,
       "visit",
       Place::visit,
       true,
       false,
       true,
       one},
  }};
}

bool on_chain(Where where, std::size_t chain) {
  if (where == Where::left) return chain == 0;
  if (where == Where::right) return chain == 1;
  return true;
}

}  // namespace

std::string_view word(Where where) {
  switch (where) {
    case Where::left:
      return "left";
    case Where::right:
      return "right";
    case Where::both:
      return "both";
    case Where::x:
      return "x";
    case Where::y:
      return "y";
    case Where::nowhere:
      break;
  }
  return "";
}

const std::array<CauseCard, kCauses>& cards() {
  static const std::array<CauseCard, kCauses> all = make_cards();
  return all;
}

const CauseCard& card(Cause cause) { return cards()[static_cast<std::size_t>(cause)]; }

TrueMachine altered(TrueMachine machine, std::span<const Hidden> effects) {
  for (const Hidden& e : effects) {
    switch (e.cause) {
      case Cause::ring_radius:
        machine.ring_radius_mm += e.size;
        break;
      case Cause::sprocket_radius:
        machine.wheel_radius_offset_mm += e.size;
        break;
      case Cause::chain_sag:
        machine.chain_mass_kg_per_m *= 1.0 + e.size;
        break;
      case Cause::chain_stretch:
        machine.compliance_per_n += e.size;
        break;
      case Cause::beam_flex:
        machine.beam_give_mm_per_n += e.size;
        break;
      case Cause::side_pull:
        machine.side_force_n += e.size;
        break;
      default:
        break;
    }
  }
  return machine;
}

Vec2 written(Vec2 place, std::span<const Hidden> effects) {
  Vec2 mark = place;
  for (const Hidden& e : effects) {
    if (e.cause != Cause::tape_scale) continue;
    if (e.where != Where::y) mark.x *= 1.0 + e.size;
    if (e.where != Where::x) mark.y *= 1.0 + e.size;
  }
  for (const Hidden& e : effects) {
    if (e.cause == Cause::axes_skew) mark.x += mark.y * e.size;
  }
  return mark;
}

Vec2 place_of(Vec2 written_mark, std::span<const Hidden> effects) {
  Vec2 place = written_mark;
  for (const Hidden& e : effects) {
    if (e.cause == Cause::axes_skew) place.x -= place.y * e.size;
  }
  for (const Hidden& e : effects) {
    if (e.cause != Cause::tape_scale) continue;
    if (e.where != Where::y) place.x /= 1.0 + e.size;
    if (e.where != Where::x) place.y /= 1.0 + e.size;
  }
  return place;
}

std::optional<std::vector<Rest>> rests(const TrueMachine& machine,
                                       std::span<const Visit> visits,
                                       const std::vector<Rest>* near) {
  std::vector<Rest> all;
  all.reserve(visits.size());
  for (std::size_t i = 0; i < visits.size(); ++i) {
    const Rest* neighbour = near != nullptr ? &(*near)[i] : nullptr;
    auto rest = come_to_rest(machine, visits[i].place, neighbour);
    if (!rest && neighbour != nullptr) rest = come_to_rest(machine, visits[i].place);
    if (!rest) return std::nullopt;
    all.push_back(*rest);
  }
  return all;
}

std::vector<Lengths> readings(const TrueMachine& machine,
                              std::span<const Hidden> effects,
                              std::span<const Visit> visits,
                              const std::vector<Rest>& at_rest) {
  const double turn_mm = machine.teeth * machine.pitch_mm;
  std::vector<Lengths> all(visits.size());
  for (std::size_t chain = 0; chain < 2; ++chain) {
    double elongation = 0.0;
    for (const Hidden& e : effects) {
      if (e.cause == Cause::chain_pitch_error && on_chain(e.where, chain)) elongation += e.size;
    }
    double before = 0.0;
    double sign = 1.0;
    for (std::size_t i = 0; i < visits.size(); ++i) {
      const ChainRest& rest = at_rest[i].chain[chain];
      double length = rest.length_mm;
      for (const Hidden& e : effects) {
        if (!on_chain(e.where, chain)) continue;
        if (e.cause == Cause::chain_plane_offset) {
          length += std::hypot(rest.free_mm, e.size) - rest.free_mm;
        } else if (e.cause == Cause::sprocket_eccentricity) {
          length += e.size * std::sin(2.0 * kPi * rest.length_mm / turn_mm + e.place);
        } else if (e.cause == Cause::angular_kink) {
          length += e.size * std::max(0.0, rest.angle_rad - e.place);
        }
      }
      if (i > 0 && length != before) sign = length > before ? 1.0 : -1.0;
      before = length;
      for (const Hidden& e : effects) {
        if (e.cause == Cause::direction_hysteresis && on_chain(e.where, chain)) {
          length += e.size * sign;
        }
      }
      double reading = length / (1.0 + elongation) + machine.chain_zero_mm[chain];
      const int n = visits[i].number;
      for (const Hidden& e : effects) {
        if (!on_chain(e.where, chain)) continue;
        if (e.cause == Cause::drift) reading += e.size * n;
        const bool from = e.cause == Cause::tooth_skip && n >= e.place;
        const bool at = e.cause == Cause::link_miscount && n == static_cast<int>(e.place);
        if (from || at) reading += machine.pitch_mm * e.size;
      }
      all[i][chain] = reading;
    }
  }
  return all;
}

}  // namespace chaintrue::generator
