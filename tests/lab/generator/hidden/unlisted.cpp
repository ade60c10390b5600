// SPDX-License-Identifier: GPL-3.0-or-later
#include "generator/hidden/unlisted.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace chaintrue::generator {
namespace {

constexpr double kHalfWidth = 1219.2;
constexpr double kHalfHeight = 609.6;

}  // namespace

Vec2 shift(const Unlisted& what, Vec2 place) {
  const double c = std::cos(what.direction_rad), s = std::sin(what.direction_rad);
  const Vec2 from{place.x - what.centre.x, place.y - what.centre.y};
  const double across = c * from.x + s * from.y;
  switch (what.oddity) {
    case Oddity::dent: {
      // The sled tips towards the hollow.
      const double r2 = (from.x * from.x + from.y * from.y) / (what.extent_mm * what.extent_mm);
      const double k = -what.size_mm * std::exp(0.5 - 0.5 * r2) / what.extent_mm;
      return {k * from.x, k * from.y};
    }
    case Oddity::wavy_board: {
      const double d =
          what.size_mm * std::sin(2.0 * std::numbers::pi * across / what.extent_mm + what.phase_rad);
      return {d * c, d * s};
    }
    case Oddity::fold: {
      const double d = what.size_mm * std::max(0.0, across) / 500.0;
      return {d * c, d * s};
    }
    case Oddity::edge: {
      // The sled's rim drops over the sheet's edge.
      const double x = std::exp((std::abs(place.x) - kHalfWidth) / what.extent_mm);
      const double y = std::exp((std::abs(place.y) - kHalfHeight) / what.extent_mm);
      return {std::copysign(what.size_mm * x, place.x), std::copysign(what.size_mm * y, place.y)};
    }
    case Oddity::periodic_in_x:
      return {what.size_mm * std::sin(2.0 * std::numbers::pi * place.x / what.extent_mm + what.phase_rad), 0.0};
  }
  return {};
}

Unlisted draw_oddity(Oddity oddity, Dice& dice) {
  Unlisted u;
  u.oddity = oddity;
  u.size_mm = 1.0;
  u.centre = {dice.uniform(-800.0, 800.0), dice.uniform(-350.0, 350.0)};
  u.direction_rad = dice.uniform(-std::numbers::pi, std::numbers::pi);
  u.phase_rad = dice.uniform(-std::numbers::pi, std::numbers::pi);
  switch (oddity) {
    case Oddity::dent:
      u.extent_mm = dice.uniform(200.0, 400.0);
      break;
    case Oddity::wavy_board:
      u.extent_mm = dice.uniform(700.0, 1400.0);
      break;
    case Oddity::fold:
      break;
    case Oddity::edge:
      u.extent_mm = dice.uniform(120.0, 250.0);
      break;
    case Oddity::periodic_in_x:
      u.extent_mm = dice.uniform(900.0, 1500.0);
      break;
  }
  return u;
}

}  // namespace chaintrue::generator
