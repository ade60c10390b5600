// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numbers>
#include <span>
#include <stdexcept>

#include "generator/hidden/pattern.hpp"

namespace chaintrue::generator {
namespace {

constexpr double kHalfWidthMm = 1219.2;
constexpr double kHalfHeightMm = 609.6;
constexpr double kLeastAngleRad = 0.1;
constexpr double kMostAngleRad = 1.4;

constexpr PatternFamily kFamilies[] = {PatternFamily::fold,
                                       PatternFamily::column_band,
                                       PatternFamily::chain_angle,
                                       PatternFamily::edge_heave,
                                       PatternFamily::patch,
                                       PatternFamily::length_steps};

// The entries of Pattern::knots for each family.
namespace fold_knot {
constexpr std::size_t kBehind = 0, kAhead = 1;  // slopes per mm, counted away from the line
}
namespace band_knot {
constexpr std::size_t kLeftEdgeMm = 0, kRightEdgeMm = 1;
}
namespace angle_knot {
constexpr std::size_t kCount = 7;  // stored after the values
}
namespace heave_knot {
constexpr std::size_t kPower = 0;  // 0: exponential
constexpr std::size_t kLean = 1;   // more at one end of the edge than at the other
}  // namespace heave_knot
namespace patch_knot {
constexpr std::size_t kOtherRadiusMm = 0;  // 0: a half plane
constexpr std::size_t kSlopeMm = 1;
}  // namespace patch_knot
namespace steps_knot {
constexpr std::size_t kLevels = 0, kPlacesMm = 4, kMostSteps = 3;
}

/// From 0 to 1 over a slope centred at `beyond` 0, constant on either side.
double rise(double beyond, double slope) {
  const double t = std::clamp(beyond / slope + 0.5, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// Relative to the centre: x along the direction, y to the left of it.
Vec2 turned(const Pattern& p, Vec2 place) {
  const Vec2 from{place.x - p.centre.x, place.y - p.centre.y};
  const double c = std::cos(p.direction_rad);
  const double s = std::sin(p.direction_rad);
  return {c * from.x + s * from.y, c * from.y - s * from.x};
}

double largest_size(std::span<const double> values) {
  double most = 0.0;
  for (const double v : values) most = std::max(most, std::abs(v));
  return most;
}

double fold_at(const Pattern& p, Vec2 place) {
  const double across = turned(p, place).x;
  // A board bends over a radius rather than at a corner.
  const double away = std::hypot(across, p.extent_mm) - p.extent_mm;
  return 0.5 * (p.knots[fold_knot::kAhead] * (away + across) +
                p.knots[fold_knot::kBehind] * (away - across));
}

double band_at(const Pattern& p, Vec2 place) {
  const double from = place.x - p.centre.x;
  const double half = 0.5 * p.extent_mm;
  return rise(half + from, p.knots[band_knot::kLeftEdgeMm]) *
         rise(half - from, p.knots[band_knot::kRightEdgeMm]);
}

/// Catmull and Rom's spline through evenly spaced values, the outermost counted twice.
double angle_function_at(const Pattern& p, double angle_rad) {
  const auto last = static_cast<std::size_t>(p.knots[angle_knot::kCount]) - 1;
  const double share = (angle_rad - kLeastAngleRad) / (kMostAngleRad - kLeastAngleRad);
  const double along = std::clamp(share, 0.0, 1.0) * static_cast<double>(last);
  const std::size_t i = std::min(static_cast<std::size_t>(along), last - 1);
  const double t = along - static_cast<double>(i);
  const double before = p.knots[i > 0 ? i - 1 : 0];
  const double from = p.knots[i];
  const double to = p.knots[i + 1];
  const double after = p.knots[std::min(i + 2, last)];
  const double linear = to - before;
  const double square = 2.0 * before - 5.0 * from + 4.0 * to - after;
  const double cubic = 3.0 * (from - to) + after - before;
  return from + 0.5 * t * (linear + t * (square + t * cubic));
}

double heave_at(const Pattern& p, Vec2 place) {
  // The centre is the middle of the edge, the direction points outwards across it.
  const Vec2 from_edge = turned(p, place);
  const double depth = std::max(0.0, -from_edge.x) / p.extent_mm;
  const double power = p.knots[heave_knot::kPower];
  // Both fall off equally steeply at the edge; the power has the longer tail.
  const double decay = power > 0.0 ? std::pow(1.0 + depth / power, -power) : std::exp(-depth);
  const bool upright = std::abs(p.centre.x) > std::abs(p.centre.y);
  const double along = from_edge.y / (upright ? kHalfHeightMm : kHalfWidthMm);
  const double lean = p.knots[heave_knot::kLean];
  return decay * (1.0 + lean * along) / (1.0 + std::abs(lean));
}

/// Distance outside the rim; below 0 inside.
double beyond_rim(const Pattern& p, Vec2 place) {
  const Vec2 own = turned(p, place);
  const double other_radius = p.knots[patch_knot::kOtherRadiusMm];
  if (other_radius <= 0.0) return own.x;
  const double u = own.x / p.extent_mm;
  const double v = own.y / other_radius;
  const double reach = std::hypot(u, v);
  // To first order: the residual of the ellipse's equation over its gradient.
  const double gradient = std::hypot(u / p.extent_mm, v / other_radius);
  if (gradient <= 0.0) return -std::min(p.extent_mm, other_radius);
  return reach * (reach - 1.0) / gradient;
}

double patch_at(const Pattern& p, Vec2 place) {
  return rise(-beyond_rim(p, place), p.knots[patch_knot::kSlopeMm]);
}

double steps_at(const Pattern& p, double length_mm) {
  double level = p.knots[steps_knot::kLevels];
  for (std::size_t i = 0; i < steps_knot::kMostSteps; ++i) {
    const std::size_t at = steps_knot::kLevels + i;
    const double step = p.knots[at + 1] - p.knots[at];
    level += step * rise(length_mm - p.knots[steps_knot::kPlacesMm + i], p.extent_mm);
  }
  return level;
}

void draw_fold(Pattern& p, Dice& dice) {
  p.centre = {dice.uniform(-900.0, 900.0), dice.uniform(-420.0, 420.0)};
  // Oblique: at least 8 degrees from either axis.
  const auto quarter = static_cast<double>(dice.below(4));
  p.direction_rad = 0.5 * std::numbers::pi * (quarter + dice.uniform(8.0, 82.0) / 90.0) - std::numbers::pi;
  p.extent_mm = dice.log_uniform(10.0, 120.0);
  p.knots[fold_knot::kAhead] = 1.0;
  // -1 would be a plane without a fold.
  const bool both_sides = dice.sign() > 0.0;
  p.knots[fold_knot::kBehind] = both_sides ? dice.uniform(-0.5, 1.0) : 0.0;
  // Linear on either side, so largest at a corner.
  const double corners[] = {fold_at(p, {-kHalfWidthMm, -kHalfHeightMm}),
                            fold_at(p, {-kHalfWidthMm, kHalfHeightMm}),
                            fold_at(p, {kHalfWidthMm, -kHalfHeightMm}),
                            fold_at(p, {kHalfWidthMm, kHalfHeightMm})};
  const double largest = largest_size(corners);
  p.knots[fold_knot::kAhead] /= largest;
  p.knots[fold_knot::kBehind] /= largest;
}

void draw_band(Pattern& p, Dice& dice) {
  p.centre.x = dice.uniform(-1150.0, 1150.0);
  p.extent_mm = dice.uniform(100.0, 450.0);
  p.knots[band_knot::kLeftEdgeMm] = dice.uniform(15.0, 60.0);
  p.knots[band_knot::kRightEdgeMm] = dice.uniform(15.0, 60.0);
}

void draw_angle_function(Pattern& p, Dice& dice) {
  p.chain = dice.below(2);
  const std::size_t count = 4 + dice.below(4);
  const auto values = std::span(p.knots).first(count);
  for (double& v : values) v = dice.uniform(-1.0, 1.0);
  const double largest = largest_size(values);
  for (double& v : values) v /= largest;
  p.knots[angle_knot::kCount] = static_cast<double>(count);
}

void draw_heave(Pattern& p, Dice& dice) {
  constexpr Vec2 kEdgeMiddles[] = {
      {kHalfWidthMm, 0.0}, {0.0, kHalfHeightMm}, {-kHalfWidthMm, 0.0}, {0.0, -kHalfHeightMm}};
  const std::size_t edge = dice.below(4);
  p.centre = kEdgeMiddles[edge];
  p.direction_rad = 0.5 * std::numbers::pi * static_cast<double>(edge);
  p.extent_mm = dice.log_uniform(150.0, 600.0);
  const bool exponential = dice.sign() > 0.0;
  p.knots[heave_knot::kPower] = exponential ? 0.0 : dice.uniform(1.0, 4.0);
  p.knots[heave_knot::kLean] = dice.uniform(-0.6, 0.6);
}

void draw_patch(Pattern& p, Dice& dice) {
  const bool ellipse = dice.sign() > 0.0;
  if (ellipse) {
    p.centre = {dice.uniform(-1050.0, 1050.0), dice.uniform(-480.0, 480.0)};
    p.extent_mm = dice.uniform(200.0, 600.0);
    p.knots[patch_knot::kOtherRadiusMm] = dice.uniform(200.0, 600.0);
  } else {
    p.centre = {dice.uniform(-850.0, 850.0), dice.uniform(-400.0, 400.0)};
  }
  p.direction_rad = dice.uniform(-std::numbers::pi, std::numbers::pi);
  p.knots[patch_knot::kSlopeMm] = dice.uniform(30.0, 150.0);
}

void draw_steps(Pattern& p, Dice& dice) {
  p.chain = dice.below(2);
  p.extent_mm = dice.log_uniform(30.0, 200.0);
  const std::size_t steps = 1 + dice.below(steps_knot::kMostSteps);
  const auto levels = std::span(p.knots).subspan(steps_knot::kLevels, steps_knot::kMostSteps + 1);
  const auto places = std::span(p.knots).subspan(steps_knot::kPlacesMm, steps_knot::kMostSteps);
  // One step in each of as many equal parts of the length, so that steps do not coincide.
  const double first_mm = 1100.0;
  const double part_mm = (2750.0 - first_mm) / static_cast<double>(steps);
  levels[0] = dice.uniform(-0.5, 0.5);
  for (std::size_t i = 0; i < steps_knot::kMostSteps; ++i) {
    // Steps beyond those drawn have no height, so their position does not matter.
    levels[i + 1] = levels[i];
    if (i >= steps) continue;
    levels[i + 1] += dice.sign() * dice.uniform(0.4, 1.0);
    places[i] = first_mm + part_mm * (static_cast<double>(i) + dice.uniform(0.1, 0.9));
  }
  const double largest = largest_size(levels);
  for (double& level : levels) level /= largest;
}

}  // namespace

double other_field(const Pattern& pattern, const PatternSite& site) {
  switch (pattern.family) {
    case PatternFamily::fold:
      return fold_at(pattern, site.place);
    case PatternFamily::column_band:
      return band_at(pattern, site.place);
    case PatternFamily::chain_angle:
      return angle_function_at(pattern, site.angle_rad[pattern.chain]);
    case PatternFamily::edge_heave:
      return heave_at(pattern, site.place);
    case PatternFamily::patch:
      return patch_at(pattern, site.place);
    case PatternFamily::length_steps:
      return steps_at(pattern, site.length_mm[pattern.chain]);
    default:
      throw std::logic_error("other_field: a smooth family");
  }
}

Pattern draw_other_family(Dice& dice) {
  Pattern p;
  p.family = kFamilies[dice.below(std::size(kFamilies))];
  switch (p.family) {
    case PatternFamily::fold:
      draw_fold(p, dice);
      break;
    case PatternFamily::column_band:
      draw_band(p, dice);
      break;
    case PatternFamily::chain_angle:
      draw_angle_function(p, dice);
      break;
    case PatternFamily::edge_heave:
      draw_heave(p, dice);
      break;
    case PatternFamily::patch:
      draw_patch(p, dice);
      break;
    default:
      draw_steps(p, dice);
  }
  return p;
}

}  // namespace chaintrue::generator
