// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The equilibrium of two chains of links and the sled between them: a second, finer model of the
/// machine for tests with hidden effects. It shares no code with the product, and its include path
/// does not contain the product.
///
/// A chain consists of links of one pitch, each straight, stretched by its own tension, with half
/// its weight on either pin (pieces_per_link divides them further; the error against an even cable
/// falls with its square, 7e-5 mm for whole links). Links sit on the sprocket's teeth, the corners
/// of a polygon; only a whole number of them hangs free. WheelShape::round replaces it by an ideal
/// drum, as in the product.
///
/// Notation, per chain, frame at the sled, u towards the sprocket, y up, both in the bed's plane
///   H, V    horizontal and vertical pull of the chain on the ring [N]
///   w       weight [N/mm]
///   S       free unstretched chain [mm]
///   c       strain per newton
///   rho     ring radius [mm]
///   psi     turn of the point where the chain leaves the sprocket, from 12 o'clock [rad]
///
/// Thread safe: no shared state.
#pragma once

#include <array>
#include <optional>

namespace chaintrue::generator {

struct Vec2 {
  double x = 0.0;
  double y = 0.0;
};

enum class WheelShape { teeth, round };

/// The true machine; mm, N, kg.
struct TrueMachine {
  std::array<Vec2, 2> axis{{{-1489.2, 1072.6}, {1489.2, 1072.6}}};  ///< left, right
  std::array<double, 2> chain_zero_mm{};
  int teeth = 10;
  double pitch_mm = 6.35;
  /// Added to pitch * teeth / (2 pi), for tangent and wrap.
  double wheel_radius_offset_mm = 0.0;
  bool over_top = true;
  double ring_radius_mm = 139.1;
  double chain_mass_kg_per_m = 0.14;
  double compliance_per_n = 5.17e-6;
  double sled_mass_kg = 11.6;
  double tilt_from_vertical_deg = 15.0;
  /// Each axis moves towards the sled along its chain by this per newton.
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
  double length_mm = 0.0;  ///< free chain plus the chain on the wheel past 12 o'clock
};

struct Rest {
  std::array<ChainRest, 2> chain;
  /// The drum's solution, the starting point for neighbours.
  double horizontal_right_n = 0.0;
  double vertical_left_n = 0.0;
  std::array<double, 2> drum_free_mm{};
};

/// Empty if Newton's method finds no equilibrium. `near` may be the equilibrium of a neighbouring
/// position or machine.
std::optional<Rest> come_to_rest(const TrueMachine& machine, Vec2 bit, const Rest* near = nullptr);

}  // namespace chaintrue::generator
