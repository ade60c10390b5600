// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/report/hole_labels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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

class Labels {
 public:
  Labels(const std::vector<DrawnHole>& holes, double left, double right)
      : holes_(holes), left_(left), right_(right) {
    for (const DrawnHole& hole : holes) {
      taken_.push_back(
          {hole.x - kHoleRadius, hole.x + kHoleRadius, hole.y - kHoleRadius, hole.y + kHoleRadius});
    }
  }

  HoleLabel place(std::size_t own) {
    HoleLabel least{};
    double least_fault = std::numeric_limits<double>::infinity();
    for (const bool has_place : {true, false}) {
      for (const HoleLabel& label : around(holes_[own], has_place)) {
        const double fault = fault_of(label, own);
        if (fault >= least_fault) continue;
        least_fault = fault;
        least = label;
        if (fault == 0.0) break;
      }
      if (least_fault == 0.0) break;
    }
    taken_.push_back(least);
    return least;
  }

 private:
  /// Above, below and on either side, those to the right first.
  static std::vector<HoleLabel> around(const DrawnHole& hole, bool has_place) {
    constexpr double kGap = 10.0;
    const double length = wide(hole, has_place);
    std::vector<HoleLabel> labels;
    for (const double up : {-kGap, kGap + kHigh, 0.5 * kHigh}) {
      for (const double right : {kGap, -kGap - length, -0.5 * length}) {
        if (up == 0.5 * kHigh && right == -0.5 * length) continue;
        labels.push_back(
            {hole.x + right, hole.x + right + length, hole.y + up - kHigh, hole.y + up, has_place});
      }
    }
    return labels;
  }

  /// 0: nearer to its hole than to any other, without overlap, and within the drawing.
  [[nodiscard]] double fault_of(const HoleLabel& label, std::size_t own) const {
    // Off the bed it would be cut at the picture's edge.
    double fault =
        kHigh * (std::max(0.0, left_ - label.left) + std::max(0.0, label.right - right_));
    for (const HoleLabel& other : taken_) fault += overlap(label, other);
    const double own_distance = distance_to(label, holes_[own].x, holes_[own].y);
    for (std::size_t i = 0; i < holes_.size(); ++i) {
      const double distance = distance_to(label, holes_[i].x, holes_[i].y);
      // Clearly nearer: by half as much again.
      constexpr double kClearly = 1.5;
      if (i != own) fault += kHigh * std::max(0.0, kClearly * own_distance - distance);
    }
    return fault;
  }

  const std::vector<DrawnHole>& holes_;
  double left_, right_;
  std::vector<HoleLabel> taken_;
};

}  // namespace

double distance_to(const HoleLabel& label, double x, double y) {
  return std::hypot(std::max({label.left - x, 0.0, x - label.right}),
                    std::max({label.top - y, 0.0, y - label.bottom}));
}

std::vector<HoleLabel> place_labels(const std::vector<DrawnHole>& holes,
                                    double left,
                                    double right) {
  Labels labels(holes, left, right);
  std::vector<HoleLabel> placed;
  for (std::size_t i = 0; i < holes.size(); ++i) placed.push_back(labels.place(i));
  return placed;
}

}  // namespace chaintrue::report
