// SPDX-License-Identifier: GPL-3.0-or-later
#include "generator/hidden/belt_law.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace chaintrue::generator {
namespace {

/// Belt for one turn of the motor's 22 teeth.
constexpr double kTurnMm = 43.975;
constexpr int kWavesOfBeltField = 160;

}  // namespace

std::string_view word(BeltLawFamily family) {
  constexpr std::string_view kWords[] = {"step_along_x",
                                         "slope_from_x",
                                         "slope_from_y",
                                         "ripple_of_length",
                                         "ripple_of_angle",
                                         "ripple_along_x",
                                         "product_of_two",
                                         "gaussian_field"};
  return kWords[static_cast<std::size_t>(family)];
}

double value_of(const BeltLaw& law, const BeltFrame& frame, double x, double y, double length_mm) {
  const auto slope = [&](double along) {
    return std::max(0.0, law.sign * (along - law.place)) / 1000.0;
  };
  switch (law.family) {
    case BeltLawFamily::step_along_x:
      return x >= law.place ? 1.0 : 0.0;
    case BeltLawFamily::slope_from_x:
      return slope(x);
    case BeltLawFamily::slope_from_y:
      return slope(y);
    case BeltLawFamily::ripple_of_length:
      return std::sin(2.0 * std::numbers::pi * length_mm / law.extent + law.phase);
    case BeltLawFamily::ripple_of_angle: {
      const auto& anchor = frame.anchors[law.belt];
      const double angle = std::atan2(std::abs(y - anchor[1]), std::abs(x - anchor[0]));
      return std::sin(2.0 * std::numbers::pi * angle / law.extent + law.phase);
    }
    case BeltLawFamily::ripple_along_x:
      return std::sin(2.0 * std::numbers::pi * x / law.extent + law.phase);
    case BeltLawFamily::product_of_two:
      return std::sin(2.0 * std::numbers::pi * x / law.extent + law.phase) *
             std::cos(2.0 * std::numbers::pi * y / law.extent + 2.0 * law.phase);
    case BeltLawFamily::gaussian_field:
      break;
  }
  double sum = 0.0;
  for (const HiddenWave& wave : law.waves)
    sum += wave.height * std::cos(wave.by_x * x + wave.by_y * y + wave.phase);
  return sum;
}

BeltLaw drawn_belt_law(BeltLawFamily family,
                       const std::vector<std::array<double, 2>>& places,
                       Dice& dice) {
  BeltLaw law;
  law.family = family;
  law.belt = dice.below(4);
  law.sign = dice.sign();
  law.phase = dice.uniform(-std::numbers::pi, std::numbers::pi);
  const bool along_y = family == BeltLawFamily::slope_from_y;
  const std::size_t axis = along_y ? 1 : 0;
  const auto [low, high] = std::minmax_element(
      places.begin(), places.end(), [&](const auto& a, const auto& b) { return a[axis] < b[axis]; });
  // In the middle three fifths of what was measured.
  law.place = (*low)[axis] + dice.uniform(0.2, 0.8) * ((*high)[axis] - (*low)[axis]);
  switch (family) {
    case BeltLawFamily::ripple_of_length:
      law.extent = dice.uniform() < 0.4 ? kTurnMm : dice.log_uniform(150.0, 900.0);
      break;
    case BeltLawFamily::ripple_of_angle:
      law.extent = dice.uniform(0.25, 0.6);
      break;
    case BeltLawFamily::ripple_along_x:
    case BeltLawFamily::product_of_two:
      law.extent = dice.log_uniform(700.0, 1600.0);
      break;
    case BeltLawFamily::gaussian_field:
      law.extent = dice.log_uniform(180.0, 600.0);
      for (int k = 0; k < kWavesOfBeltField; ++k) {
        law.waves.push_back({dice.normal() / law.extent,
                             dice.normal() / law.extent,
                             dice.uniform(-std::numbers::pi, std::numbers::pi),
                             std::sqrt(2.0 / kWavesOfBeltField)});
      }
      break;
    default:
      break;
  }
  return law;
}

}  // namespace chaintrue::generator
