// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Where two chains of links and the sled between them come to rest: a second, finer account of the
/// machine for tests that hide something in it. It shares no line with the product, and its include
/// path cannot reach one.
///
/// A chain is what it is: links of one pitch, each straight, stretched by its own tension, half its
/// weight on either pin (pieces_per_link parts them further; the error against an even cable falls
/// with its square, 7e-5 mm for whole links). Links sit on the sprocket's teeth, the corners of a
/// polygon; only a whole number of them hangs free. WheelShape::round puts an ideal drum in its
/// place, as the product has it.
///
/// Notation, per chain, frame at the sled, u towards the sprocket, y up, both in the bed's plane
///   H, V    horizontal and vertical pull of the chain on the ring [N]
///   w       weight [N/mm]
///   S       free unstretched chain [mm]
///   c       strain per newton
///   rho     ring radius [mm]
///   psi     turn of the point where the chain leaves the sprocket, from 12 o'clock [rad]
///
/// Thread safe: nothing is shared.
#pragma once

#include <array>
#include <optional>

namespace chaintrue::generator {

struct Vec2 {
  double x = 0.0;
  double y = 0.0;
};

enum class WheelShape { teeth, round };

/// The machine as it truly is; mm, N, kg.
struct TrueMachine {
  std::array<Vec2, 2> axis{{{-1489.2, 1072.6}, {1489.2, 1072.6}}};  ///< left, right
  std::array<double, 2> chain_zero_mm{};
  int teeth = 10;
  double pitch_mm = 6.35;
  /// Added to pitch * teeth / (2 pi), tangent and wrap alike.
  double wheel_radius_offset_mm = 0.0;
  bool over_top = true;
  double ring_radius_mm = 139.1;
  double chain_mass_kg_per_m = 0.14;
  double compliance_per_n = 5.17e-6;
  double sled_mass_kg = 11.6;
  double tilt_from_vertical_deg = 15.0;
  /// Each axis moves towards the sled along its chain by so much per newton.
  double beam_give_mm_per_n = 0.0;
  /// Towards +x, on the sled.
  double side_force_n = 0.0;
  WheelShape wheel = WheelShape::teeth;
  int pieces_per_link = 1;
};

struct ChainRest {
  double free_mm = 0.0;    ///< S
  double angle_rad = 0.0;  ///< below the horizontal at the sprocket
  double tension_n = 0.0;  ///< there
  double length_mm = 0.0;  ///< free chain and what lies on the wheel past 12 o'clock
};

struct Rest {
  std::array<ChainRest, 2> chain;
  /// The drum's solution, from which a neighbour's search begins.
  double horizontal_right_n = 0.0;
  double vertical_left_n = 0.0;
  std::array<double, 2> drum_free_mm{};
};

/// Nothing where no rest exists within reach of Newton's method. `near` may be the rest of a
/// neighbouring place or machine.
[[nodiscard]] std::optional<Rest> come_to_rest(const TrueMachine& machine,
                                               Vec2 bit,
                                               const Rest* near = nullptr);

}  // namespace chaintrue::generator
