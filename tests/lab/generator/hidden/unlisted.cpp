// SPDX-License-Identifier: GPL-3.0-or-later
#include "generator/hidden/unlisted.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace chaintrue::generator {

std::function<Vec2(Vec2)> draw_oddity(Dice& dice) {
  const std::size_t oddity = dice.below(5);
  const Vec2 centre{dice.uniform(-800.0, 800.0), dice.uniform(-350.0, 350.0)};
  const double direction = dice.uniform(-std::numbers::pi, std::numbers::pi);
  const double phase = dice.uniform(-std::numbers::pi, std::numbers::pi);
  const double c = std::cos(direction), s = std::sin(direction);
  const auto across = [=](Vec2 place) {
    return c * (place.x - centre.x) + s * (place.y - centre.y);
  };
  switch (oddity) {
    case 0: {
      const double extent = dice.uniform(200.0, 400.0);
      return [=](Vec2 place) -> Vec2 {
        const Vec2 from{place.x - centre.x, place.y - centre.y};
        const double r2 = (from.x * from.x + from.y * from.y) / (extent * extent);
        const double k = -std::exp(0.5 - 0.5 * r2) / extent;
        return {k * from.x, k * from.y};
      };
    }
    case 1: {
      const double extent = dice.uniform(700.0, 1400.0);
      return [=](Vec2 place) -> Vec2 {
        const double d = std::sin(2.0 * std::numbers::pi * across(place) / extent + phase);
        return {d * c, d * s};
      };
    }
    case 2:
      return [=](Vec2 place) -> Vec2 {
        const double d = std::max(0.0, across(place)) / 500.0;
        return {d * c, d * s};
      };
    case 3: {
      const double extent = dice.uniform(120.0, 250.0);
      return [=](Vec2 place) -> Vec2 {
        return {std::copysign(std::exp((std::abs(place.x) - 1219.2) / extent), place.x),
                std::copysign(std::exp((std::abs(place.y) - 609.6) / extent), place.y)};
      };
    }
    default: {
      const double extent = dice.uniform(900.0, 1500.0);
      return [=](Vec2 place) -> Vec2 {
        return {std::sin(2.0 * std::numbers::pi * place.x / extent + phase), 0.0};
      };
    }
  }
}

}  // namespace chaintrue::generator
