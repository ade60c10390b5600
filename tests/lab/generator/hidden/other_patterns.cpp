// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <numbers>

#include "generator/hidden/pattern.hpp"

namespace chaintrue::generator {
namespace {

constexpr double kHalfWidthMm = 1219.2;
constexpr double kHalfHeightMm = 609.6;
constexpr double kLeastAngleRad = 0.1;
constexpr double kMostAngleRad = 1.4;

/// From 0 to 1 over a slope centred at `beyond` 0, constant on either side.
double rise(double beyond, double slope) {
  const double t = std::clamp(beyond / slope + 0.5, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// A frame with x along a direction, and y to the left of it.
struct Turned {
  Vec2 centre;
  double direction_rad = 0.0;

  Vec2 operator()(Vec2 place) const {
    const Vec2 from{place.x - centre.x, place.y - centre.y};
    const double c = std::cos(direction_rad);
    const double s = std::sin(direction_rad);
    return {c * from.x + s * from.y, c * from.y - s * from.x};
  }
};

void scale_to_one(std::vector<double>& values) {
  double most = 0.0;
  for (const double v : values) most = std::max(most, std::abs(v));
  for (double& v : values) v /= most;
}

/// Linear on either side of a line, bent along it.
Field draw_fold(Dice& dice) {
  Turned turned;
  turned.centre = {dice.uniform(-900.0, 900.0), dice.uniform(-420.0, 420.0)};
  // Oblique: at least 8 degrees from either axis.
  const auto quarter = static_cast<double>(dice.below(4));
  turned.direction_rad =
      0.5 * std::numbers::pi * (quarter + dice.uniform(8.0, 82.0) / 90.0) - std::numbers::pi;
  const double radius = dice.log_uniform(10.0, 120.0);
  // -1 would be a plane without a fold.
  const bool both_sides = dice.sign() > 0.0;
  const double ahead = 1.0, behind = both_sides ? dice.uniform(-0.5, 1.0) : 0.0;
  const auto height = [=](Vec2 place, double by_ahead, double by_behind) {
    const double across = turned(place).x;
    // A board bends over a radius rather than at a corner.
    const double away = std::hypot(across, radius) - radius;
    return 0.5 * (by_ahead * (away + across) + by_behind * (away - across));
  };
  // Linear on either side, so largest at a corner.
  double largest = 0.0;
  for (const double x : {-kHalfWidthMm, kHalfWidthMm}) {
    for (const double y : {-kHalfHeightMm, kHalfHeightMm})
      largest = std::max(largest, std::abs(height({x, y}, ahead, behind)));
  }
  return [=](const Site& site) { return height(site.place, ahead / largest, behind / largest); };
}

/// One upright strip of the bed.
Field draw_band(Dice& dice) {
  const double middle = dice.uniform(-1150.0, 1150.0);
  const double half = 0.5 * dice.uniform(100.0, 450.0);
  const double left_edge = dice.uniform(15.0, 60.0);
  const double right_edge = dice.uniform(15.0, 60.0);
  return [=](const Site& site) {
    const double from = site.place.x - middle;
    return rise(half + from, left_edge) * rise(half - from, right_edge);
  };
}

/// A function of one chain's angle: Catmull and Rom's spline through evenly spaced values, the outermost counted twice.
Field draw_angle_function(Dice& dice) {
  const std::size_t chain = dice.below(2);
  std::vector<double> values(4 + dice.below(4));
  for (double& v : values) v = dice.uniform(-1.0, 1.0);
  scale_to_one(values);
  return [=](const Site& site) {
    const std::size_t last = values.size() - 1;
    const double share =
        (site.angle_rad[chain] - kLeastAngleRad) / (kMostAngleRad - kLeastAngleRad);
    const double along = std::clamp(share, 0.0, 1.0) * static_cast<double>(last);
    const std::size_t i = std::min(static_cast<std::size_t>(along), last - 1);
    const double t = along - static_cast<double>(i);
    const double before = values[i > 0 ? i - 1 : 0];
    const double from = values[i];
    const double to = values[i + 1];
    const double after = values[std::min(i + 2, last)];
    const double linear = to - before;
    const double square = 2.0 * before - 5.0 * from + 4.0 * to - after;
    const double cubic = 3.0 * (from - to) + after - before;
    return from + 0.5 * t * (linear + t * (square + t * cubic));
  };
}

/// Rises towards one edge of the bed.
Field draw_heave(Dice& dice) {
  constexpr Vec2 kEdgeMiddles[] = {
      {kHalfWidthMm, 0.0}, {0.0, kHalfHeightMm}, {-kHalfWidthMm, 0.0}, {0.0, -kHalfHeightMm}};
  const std::size_t edge = dice.below(4);
  // Outwards across the edge.
  const Turned turned{kEdgeMiddles[edge], 0.5 * std::numbers::pi * static_cast<double>(edge)};
  const double extent = dice.log_uniform(150.0, 600.0);
  const bool exponential = dice.sign() > 0.0;
  const double power = exponential ? 0.0 : dice.uniform(1.0, 4.0);
  const double lean = dice.uniform(-0.6, 0.6);
  const double length = edge % 2 == 0 ? kHalfHeightMm : kHalfWidthMm;
  return [=](const Site& site) {
    const Vec2 from_edge = turned(site.place);
    const double depth = std::max(0.0, -from_edge.x) / extent;
    // Both fall off equally steeply at the edge; the power has the longer tail.
    const double decay = power > 0.0 ? std::pow(1.0 + depth / power, -power) : std::exp(-depth);
    return decay * (1.0 + lean * (from_edge.y / length)) / (1.0 + std::abs(lean));
  };
}

/// Constant over an ellipse or a half plane and outside it, a short slope between.
Field draw_patch(Dice& dice) {
  const bool ellipse = dice.sign() > 0.0;
  Turned turned;
  double radius = 0.0, other_radius = 0.0;
  if (ellipse) {
    turned.centre = {dice.uniform(-1050.0, 1050.0), dice.uniform(-480.0, 480.0)};
    radius = dice.uniform(200.0, 600.0);
    other_radius = dice.uniform(200.0, 600.0);
  } else {
    turned.centre = {dice.uniform(-850.0, 850.0), dice.uniform(-400.0, 400.0)};
  }
  turned.direction_rad = dice.uniform(-std::numbers::pi, std::numbers::pi);
  const double slope = dice.uniform(30.0, 150.0);
  return [=](const Site& site) {
    const Vec2 own = turned(site.place);
    double beyond_rim = own.x;
    if (ellipse) {
      const double u = own.x / radius;
      const double v = own.y / other_radius;
      const double reach = std::hypot(u, v);
      // To first order: the residual of the ellipse's equation over its gradient.
      const double gradient = std::hypot(u / radius, v / other_radius);
      beyond_rim =
          gradient > 0.0 ? reach * (reach - 1.0) / gradient : -std::min(radius, other_radius);
    }
    return rise(-beyond_rim, slope);
  };
}

/// Along one chain's length: a few levels with slopes between.
Field draw_steps(Dice& dice) {
  constexpr std::size_t kMostSteps = 3;
  const std::size_t chain = dice.below(2);
  const double slope = dice.log_uniform(30.0, 200.0);
  const std::size_t steps = 1 + dice.below(kMostSteps);
  // One step in each of as many equal parts of the length, so that steps do not coincide.
  const double first_mm = 1100.0;
  const double part_mm = (2750.0 - first_mm) / static_cast<double>(steps);
  std::vector<double> levels = {dice.uniform(-0.5, 0.5)}, places;
  for (std::size_t i = 0; i < steps; ++i) {
    levels.push_back(levels.back() + dice.sign() * dice.uniform(0.4, 1.0));
    places.push_back(first_mm + part_mm * (static_cast<double>(i) + dice.uniform(0.1, 0.9)));
  }
  scale_to_one(levels);
  return [=](const Site& site) {
    double level = levels[0];
    for (std::size_t i = 0; i < places.size(); ++i)
      level += (levels[i + 1] - levels[i]) * rise(site.length_mm[chain] - places[i], slope);
    return level;
  };
}

}  // namespace

Field draw_other_family(Dice& dice) {
  constexpr Field (*kFamilies[])(Dice&) = {draw_fold,  draw_band,  draw_angle_function,
                                           draw_heave, draw_patch, draw_steps};
  return kFamilies[dice.below(std::size(kFamilies))](dice);
}

}  // namespace chaintrue::generator
