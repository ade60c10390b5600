// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/belts/first_frames.hpp"

#include <algorithm>
#include <cmath>

#include "grid/containers.hpp"
#include "model/belts/belt_kinematics.hpp"

namespace chaintrue::grid::belts {

using model::Belt;
using model::FramePoint;
using model::kBelts;

FramePoint nearest_place(const model::BeltMachine& machine,
                         const BeltPoint& point,
                         const model::PerBelt<bool>& counting) {
  model::PerBelt<double> spans;
  for (const Belt belt : kBelts) {
    spans[belt] = model::span_of(machine, belt, point.lengths_mm[belt])
                      .value_or(point.lengths_mm[belt] + model::reach_mm(machine));
  }
  const auto& a = machine.anchors;
  const auto square_at = [&](FramePoint at) {
    double square = 0.0;
    for (const Belt belt : kBelts) {
      if (!counting[belt]) continue;
      const double off = std::hypot(at.x_mm - a[belt].x_mm, at.y_mm - a[belt].y_mm) - spans[belt];
      square += off * off;
    }
    return square;
  };
  // The crossing of any two counting belts; the middle of the frame if none cross.
  FramePoint best{0.5 * a.br.x_mm, 0.5 * std::max(a.tl.y_mm, a.tr.y_mm)};
  double least = square_at(best);
  for (const Belt first : kBelts) {
    for (const Belt second : kBelts) {
      if (first == second || !counting[first] || !counting[second]) continue;
      const auto at = model::crossing({a[first].x_mm, a[first].y_mm},
                                      spans[first],
                                      {a[second].x_mm, a[second].y_mm},
                                      spans[second]);
      if (!at || square_at(*at) >= least) continue;
      best = *at;
      least = square_at(best);
    }
  }
  return best;
}

std::vector<AnchorVector> first_frames(const MeasuredBelts& belts) {
  std::vector<AnchorVector> frames;
  if (belts.machine.anchors_known) frames.push_back(anchors_of(belts.machine));
  // Two belts from opposite sides are together at least as long as their side of the frame. The
  // other points reveal a lost digit.
  std::vector<double> widths;
  std::vector<double> heights;
  for (const BeltPoint& point : belts.points) {
    const auto& l = point.lengths_mm;
    widths.push_back(std::min(l.tl + l.tr, l.bl + l.br));
    heights.push_back(std::min(l.tl + l.bl, l.tr + l.br));
  }
  sort(widths);
  sort(heights);
  const double arms_mm = belts.machine.lengths == model::BeltLengths::belt
                             ? 2.0 * model::reach_mm(belts.machine)
                             : 0.0;
  for (std::size_t least = 0; least < std::min<std::size_t>(widths.size(), 2); ++least) {
    for (const double share : {0.9, 0.75, 0.97}) {
      for (const double other : {share, 0.6}) {
        const double w = share * (widths[least] + arms_mm);
        const double h = other * (heights[least] + arms_mm);
        frames.emplace_back(AnchorVector{0.0, h, w, h, w});
      }
    }
  }
  return frames;
}

}  // namespace chaintrue::grid::belts
