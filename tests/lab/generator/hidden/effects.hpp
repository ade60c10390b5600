// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A second implementation of the catalogue, from its description alone: the change of a reading by
/// each effect, and their order. The bounds are those of the product's catalogue (a test compares
/// them), everything else is the hidden side's own.
///
///   reading = (L0 + plane + eccentricity + kink + hysteresis) / (1 + e) + zero + drift + links + shift
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "generator/hidden/rest.hpp"

namespace chaintrue::generator {

enum class Cause {
  tape_scale,
  axes_skew,
  ring_radius,
  sprocket_radius,
  chain_sag,
  chain_stretch,
  beam_flex,
  side_pull,
  chain_plane_offset,
  sprocket_eccentricity,
  angular_kink,
  direction_hysteresis,
  chain_pitch_error,
  drift,
  tooth_skip,
  link_miscount,
  zero_shift,
};
inline constexpr std::size_t kCauses = 17;

enum class Where { nowhere, left, right, both, x, y };
std::string_view word(Where where);

/// The kind of an effect's second parameter.
enum class Place { none, phase, angle, visit };

/// What an effect depends on: the tool's position, the machine itself, or the visit.
enum class Nature { of_place, of_machine, of_order };

struct CauseCard {
  std::string_view id;
  std::string_view size_name;
  double lower, upper;
  double usual;
  std::vector<Where> sides;
  Nature nature = Nature::of_place;
  Place place = Place::none;
  std::string_view place_name = "";
  Cause cause = Cause::tape_scale;

  /// In links.
  bool whole() const { return size_name == "links"; }
  bool alters_machine() const { return nature == Nature::of_machine; }
  bool needs_order() const { return nature == Nature::of_order; }
};
/// In the order of Cause.
const std::array<CauseCard, kCauses>& cards();
const CauseCard& card(Cause cause);

/// An acting effect; `place` if its card has one.
struct Hidden {
  Cause cause = Cause::tape_scale;
  Where where = Where::nowhere;
  double size = 0.0;
  double place = 0.0;
};

/// The tool's position at a visit, and the visit's number.
struct Visit {
  Vec2 place;
  int number = 0;
};

using Lengths = std::array<double, 2>;

TrueMachine altered(TrueMachine machine, std::span<const Hidden> effects);
/// The written coordinates of a mark whose true position is `place`.
Vec2 written(Vec2 place, std::span<const Hidden> effects);
/// The true position of the mark with these written coordinates.
Vec2 place_of(Vec2 written_mark, std::span<const Hidden> effects);

/// The equilibrium at every visit; empty if one cannot be reached. `near` are equilibria of
/// neighbours.
std::optional<std::vector<Rest>> rests(const TrueMachine& machine, std::span<const Visit> visits,
                                       const std::vector<Rest>* near = nullptr);
/// Readings of a session with known equilibria (with every machine effect on). The visits are in
/// increasing order of their numbers.
std::vector<Lengths> readings(const TrueMachine& machine, std::span<const Hidden> effects,
                              std::span<const Visit> visits, const std::vector<Rest>& at_rest);

}  // namespace chaintrue::generator
