// SPDX-License-Identifier: GPL-3.0-or-later
#include "generator/hidden/law.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace chaintrue::generator {
namespace {

constexpr double kMarksHalfWidth = 1200.0;
constexpr double kMarksHalfHeight = 600.0;
constexpr int kWavesOfField = 160;

/// A frequency of a field whose correlation falls over `length`: of the Gaussian covariance normal; of
/// Matern's of order nu = 3/2 that over the root of a gamma variable of shape nu.
double frequency(LawFamily family, double length, Dice& dice) {
  const double normal = dice.normal() / length;
  if (family != LawFamily::matern_field) return normal;
  // chi^2 of three degrees of freedom
  double square = 0.0;
  for (int k = 0; k < 3; ++k) square += std::pow(dice.normal(), 2);
  return normal / std::sqrt(square / 3.0);
}

HiddenLaw drawn(LawFamily family, Dice& dice) {
  HiddenLaw law;
  law.family = family;
  law.moves_tool = dice.uniform() < 0.5;
  law.component = dice.below(2);
  law.chain = dice.below(2);
  law.sign = dice.sign();
  law.phase = dice.uniform(-std::numbers::pi, std::numbers::pi);
  law.direction_rad = dice.uniform(0.0, std::numbers::pi);
  switch (family) {
    case LawFamily::step_along_x:
    case LawFamily::slope_from_x:
      law.place = dice.uniform(-0.6 * kMarksHalfWidth, 0.6 * kMarksHalfWidth);
      break;
    case LawFamily::step_along_y:
    case LawFamily::slope_from_y:
      law.place = dice.uniform(-0.6 * kMarksHalfHeight, 0.6 * kMarksHalfHeight);
      break;
    case LawFamily::slope_oblique:
      // Neither nearly along x nor along y.
      law.direction_rad =
          (dice.uniform() < 0.5 ? 0.0 : 0.5 * std::numbers::pi) + dice.uniform(0.35, 1.22);
      law.place = dice.uniform(-300.0, 300.0);
      break;
    case LawFamily::ripple_of_length:
      law.extent = dice.uniform() < 0.4 ? 63.5 : dice.log_uniform(150.0, 1200.0);
      law.moves_tool = false;
      law.component = law.chain;
      break;
    case LawFamily::ripple_of_angle:
      law.extent = dice.uniform(0.25, 0.6);
      law.moves_tool = false;
      law.component = law.chain;
      break;
    case LawFamily::ripple_along_x:
      law.extent = dice.log_uniform(900.0, 2400.0);
      break;
    case LawFamily::drop_at_edge:
      law.extent = dice.uniform(80.0, 250.0);
      law.chain = dice.below(2);  // along x or along y
      break;
    case LawFamily::product_of_two:
      law.extent = dice.uniform(900.0, 1800.0);
      break;
    default:
      law.extent = dice.log_uniform(180.0, 600.0);
      draw_waves(law, dice);
      break;
  }
  return law;
}

}  // namespace

void draw_waves(HiddenLaw& law, Dice& dice) {
  const bool stretched = law.family == LawFamily::stretched_field;
  const double c = std::cos(law.direction_rad);
  const double s = std::sin(law.direction_rad);
  for (int k = 0; k < kWavesOfField; ++k) {
    // Both components share the gamma variable of Matern's.
    const double longer = frequency(law.family, law.extent * (stretched ? 3.0 : 1.0), dice);
    const double other =
        law.family == LawFamily::matern_field ? longer * dice.normal() : dice.normal() / law.extent;
    const double along = law.family == LawFamily::matern_field ? longer * dice.normal() : longer;
    law.waves.push_back({c * along - s * other, s * along + c * other,
                         dice.uniform(-std::numbers::pi, std::numbers::pi),
                         std::sqrt(2.0 / kWavesOfField)});
  }
}

std::string_view word(LawFamily family) {
  constexpr std::string_view kWords[] = {
      "step_along_x",     "step_along_y",    "slope_from_x",    "slope_from_y", "slope_oblique",
      "ripple_of_length", "ripple_of_angle", "ripple_along_x",  "drop_at_edge", "product_of_two",
      "gaussian_field",   "matern_field",    "stretched_field", "uneven_field"};
  return kWords[static_cast<std::size_t>(family)];
}

bool is_slope(LawFamily family) {
  return family == LawFamily::slope_from_x || family == LawFamily::slope_from_y ||
         family == LawFamily::slope_oblique;
}

double law_value(const HiddenLaw& law, const Site& site) {
  const Vec2 p = site.place;
  const auto slope = [&](double along) {
    return std::max(0.0, law.sign * (along - law.place)) / 1000.0;
  };
  switch (law.family) {
    case LawFamily::step_along_x:
      return p.x >= law.place ? 1.0 : 0.0;
    case LawFamily::step_along_y:
      return p.y >= law.place ? 1.0 : 0.0;
    case LawFamily::slope_from_x:
      return slope(p.x);
    case LawFamily::slope_from_y:
      return slope(p.y);
    case LawFamily::slope_oblique:
      return slope(p.x * std::cos(law.direction_rad) + p.y * std::sin(law.direction_rad));
    case LawFamily::ripple_of_length:
      return std::sin(2.0 * std::numbers::pi * site.length_mm[law.chain] / law.extent + law.phase);
    case LawFamily::ripple_of_angle:
      return std::sin(2.0 * std::numbers::pi * site.angle_rad[law.chain] / law.extent + law.phase);
    case LawFamily::ripple_along_x:
      return std::sin(2.0 * std::numbers::pi * p.x / law.extent + law.phase);
    case LawFamily::drop_at_edge: {
      const double inside =
          law.chain == 0 ? kMarksHalfWidth - law.sign * p.x : kMarksHalfHeight - law.sign * p.y;
      return std::exp(-inside / law.extent);
    }
    case LawFamily::product_of_two:
      return std::sin(2.0 * std::numbers::pi * p.x / law.extent + law.phase) *
             std::cos(2.0 * std::numbers::pi * p.y / law.extent + 2.0 * law.phase);
    default:
      break;
  }
  // The rough side has waves of two fifths of the length.
  const double share =
      law.family == LawFamily::uneven_field ? 0.5 + 0.5 * std::tanh(law.sign * p.x / 400.0) : 0.0;
  double smooth = 0.0;
  double rough = 0.0;
  for (const HiddenWave& wave : law.waves) {
    smooth += wave.height * std::cos(wave.by_x * p.x + wave.by_y * p.y + wave.phase);
    if (share > 0.0)
      rough += wave.height * std::cos(2.5 * (wave.by_x * p.x + wave.by_y * p.y) + wave.phase);
  }
  return (1.0 - share) * smooth + share * rough;
}

double drawn_law_strength(Dice& dice) { return dice.log_uniform(12.0, 40.0); }

Disturbance disturbance_of(const HiddenLaw& law) {
  return {law.moves_tool, [law](const Site& site) {
            const double own = law.size_mm * law_value(law, site);
            return law.component == 0 ? Vec2{own, 0.0} : Vec2{0.0, own};
          }};
}

SizedLaw draw_law(const Yardstick& yardstick, LawFamily family, Dice& dice) {
  const auto rivals = yardstick.rivals();
  for (int n = 0; n < 2000; ++n) {
    HiddenLaw law = drawn(family, dice);
    const Signature s = yardstick.signature_of(disturbance_of(law));
    const double left = unexplained(s, rivals);
    if (!(left > 1e-3)) continue;
    const double delta = drawn_law_strength(dice);
    const double size = delta / left;
    const double usual = is_slope(family) ? 12.0 : 6.0;
    if (size > usual) continue;
    law.size_mm = size * dice.sign();
    return {std::move(law), delta};
  }
  throw std::runtime_error("draw_law: nothing fits");
}

}  // namespace chaintrue::generator
