// SPDX-License-Identifier: GPL-3.0-or-later
#include "generator/hidden/belt_law.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace chaintrue::generator {
namespace {

/// Belt for one turn of the motor's 22 teeth.
constexpr double kTurnMm = 43.975;

}  // namespace

Site site_of(const BeltFrame& frame, std::size_t belt, const std::array<double, 2>& place,
             double length_mm) {
  const auto& anchor = frame.anchors[belt];
  Site site{{place[0], place[1]}, {}, {}};
  site.angle_rad[belt] = std::atan2(std::abs(place[1] - anchor[1]), std::abs(place[0] - anchor[0]));
  site.length_mm[belt] = length_mm;
  return site;
}

HiddenLaw drawn_belt_law(LawFamily family, const std::vector<std::array<double, 2>>& places,
                         Dice& dice) {
  HiddenLaw law;
  law.family = family;
  law.chain = law.component = dice.below(4);
  law.sign = dice.sign();
  law.phase = dice.uniform(-std::numbers::pi, std::numbers::pi);
  const bool along_y = family == LawFamily::slope_from_y;
  const std::size_t axis = along_y ? 1 : 0;
  const auto [low, high] =
      std::minmax_element(places.begin(), places.end(),
                          [&](const auto& a, const auto& b) { return a[axis] < b[axis]; });
  // In the middle three fifths of what was measured.
  law.place = (*low)[axis] + dice.uniform(0.2, 0.8) * ((*high)[axis] - (*low)[axis]);
  switch (family) {
    case LawFamily::ripple_of_length:
      law.extent = dice.uniform() < 0.4 ? kTurnMm : dice.log_uniform(150.0, 900.0);
      break;
    case LawFamily::ripple_of_angle:
      law.extent = dice.uniform(0.25, 0.6);
      break;
    case LawFamily::ripple_along_x:
    case LawFamily::product_of_two:
      law.extent = dice.log_uniform(700.0, 1600.0);
      break;
    case LawFamily::gaussian_field:
      law.extent = dice.log_uniform(180.0, 600.0);
      draw_waves(law, dice);
      break;
    default:
      break;
  }
  return law;
}

}  // namespace chaintrue::generator
