// SPDX-License-Identifier: GPL-3.0-or-later
#include "generator/hidden/effects.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace chaintrue::generator {
namespace {

std::array<CauseCard, kCauses> make_cards() {
  using enum Nature;
  using enum Place;
  const std::vector<Where> one{Where::left, Where::right};
  const std::vector<Where> any{Where::left, Where::right, Where::both};
  const std::vector<Where> no_side{Where::nowhere};
  const std::vector<Where> axes{Where::x, Where::y, Where::both};
  std::array<CauseCard, kCauses> all = {{
      {"tape_scale", "scale", -0.05, 0.05, 0.0005, axes},
      {"axes_skew", "angle_rad", -0.05, 0.05, 0.001, no_side},
      {"ring_radius", "offset_mm", -50, 50, 1, no_side, of_machine},
      {"sprocket_radius", "offset_mm", -3, 3, 0.17, no_side, of_machine},
      {"chain_sag", "relative_weight", -0.95, 5, 0.3, no_side, of_machine},
      {"chain_stretch", "compliance_per_n", 0, 1e-4, 6e-6, no_side, of_machine},
      {"beam_flex", "flexibility_mm_per_n", 0, 0.1, 0.01, no_side, of_machine},
      {"side_pull", "force_n", -10, 10, 3, no_side, of_machine},
      {"chain_plane_offset", "distance_mm", 0, 300, 30, no_side},
      {"sprocket_eccentricity", "amplitude_mm", 0, 5, 0.3, one, of_place, phase, "phase_rad"},
      {"angular_kink", "slope_mm_per_rad", -60, 60, 4.5, one, of_place, angle, "knee_rad"},
      {"direction_hysteresis", "half_width_mm", 0, 5, 0.35, any, of_order},
      {"chain_pitch_error", "elongation", -0.05, 0.05, 0.001, any},
      {"drift", "rate_mm_per_visit", -1, 1, 0.03, any, of_order},
      {"tooth_skip", "links", -20, 20, 1, one, of_order, visit, "first_visit"},
      {"link_miscount", "links", -20, 20, 1, one, of_order, visit, "visit"},
      {"zero_shift", "shift_mm", -130, 130, 3, one, of_order, visit, "first_visit"},
  }};
  for (std::size_t i = 0; i < all.size(); ++i) all[i].cause = static_cast<Cause>(i);
  return all;
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

std::optional<std::vector<Rest>> rests(const TrueMachine& machine, std::span<const Visit> visits,
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

std::vector<Lengths> readings(const TrueMachine& machine, std::span<const Hidden> effects,
                              std::span<const Visit> visits, const std::vector<Rest>& at_rest) {
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
          length += e.size * std::sin(2.0 * std::numbers::pi * rest.length_mm / turn_mm + e.place);
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
        if (e.cause == Cause::zero_shift && n >= e.place) reading += e.size;
      }
      all[i][chain] = reading;
    }
  }
  return all;
}

}  // namespace chaintrue::generator
