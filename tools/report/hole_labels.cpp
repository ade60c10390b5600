// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/report/hole_labels.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace chaintrue::report {
namespace {

// For letters of 18 (name) and 14 (place) units: slightly more than the width of the widest digits.
constexpr double kNameLetter = 13.0, kPlaceLetter = 7.8, kHigh = 20.0;
constexpr double kHoleRadius = 8.0;

double wide(const DrawnHole& hole, bool has_place) {
  const double name = kNameLetter * static_cast<double>(hole.name.size());
  return has_place ? name + kPlaceLetter * (1.0 + static_cast<double>(hole.place.size())) : name;
}

double overlap(const HoleLabel& a, const HoleLabel& b) {
  return std::max(0.0, std::min(a.right, b.right) - std::max(a.left, b.left)) *
         std::max(0.0, std::min(a.bottom, b.bottom) - std::max(a.top, b.top));
}

/// With the place, then without: above, below and on either side, those to the right first.
std::vector<HoleLabel> labels_around(const DrawnHole& hole) {
  constexpr double kGap = 10.0;
  std::vector<HoleLabel> labels;
  for (const bool has_place : {true, false}) {
    const double length = wide(hole, has_place);
    for (const double up : {-kGap, kGap + kHigh, 0.5 * kHigh}) {
      for (const double right : {kGap, -kGap - length, -0.5 * length}) {
        if (up == 0.5 * kHigh && right == -0.5 * length) continue;
        labels.push_back(
            {hole.x + right, hole.x + right + length, hole.y + up - kHigh, hole.y + up, has_place});
      }
    }
  }
  return labels;
}

}  // namespace

double distance_to(const HoleLabel& label, double x, double y) {
  return std::hypot(std::max({label.left - x, 0.0, x - label.right}),
                    std::max({label.top - y, 0.0, y - label.bottom}));
}

std::vector<HoleLabel> place_labels(const std::vector<DrawnHole>& holes, double left,
                                    double right) {
  std::vector<HoleLabel> taken;
  for (const DrawnHole& hole : holes) {
    taken.push_back(
        {hole.x - kHoleRadius, hole.x + kHoleRadius, hole.y - kHoleRadius, hole.y + kHoleRadius});
  }
  for (const DrawnHole& hole : holes) {
    // 0: nearer to its hole than to any other, without overlap, and within the drawing.
    const auto fault_of = [&](const HoleLabel& label) {
      // Off the bed it would be cut at the picture's edge.
      double fault =
          kHigh * (std::max(0.0, left - label.left) + std::max(0.0, label.right - right));
      for (const HoleLabel& other : taken) fault += overlap(label, other);
      // Clearly nearer: by half as much again.
      const double clear_of = 1.5 * distance_to(label, hole.x, hole.y);
      for (const DrawnHole& other : holes) {
        if (&other != &hole)
          fault += kHigh * std::max(0.0, clear_of - distance_to(label, other.x, other.y));
      }
      return fault;
    };
    std::vector<HoleLabel> labels = labels_around(hole);
    std::stable_sort(labels.begin(), labels.end(),
                     [&](const auto& a, const auto& b) { return fault_of(a) < fault_of(b); });
    taken.push_back(labels.front());
  }
  return {taken.begin() + static_cast<std::ptrdiff_t>(holes.size()), taken.end()};
}

}  // namespace chaintrue::report
