// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/belts/prediction.hpp"

#include <algorithm>
#include <cmath>

#include "grid/containers.hpp"
#include "grid/statistics.hpp"
#include "model/belts/belt_kinematics.hpp"

namespace chaintrue::grid::belts {

using model::Belt;

void predict_point(const MeasuredBelts& belts,
              std::size_t point,
              const AnchorVector& anchors,
              const model::PerBelt<bool>& counting,
              std::vector<double>& residual_mm) {
  if (!counting.tl || !counting.tr) return;
  const model::BeltMachine machine = with_anchors(belts.machine, anchors);
  const auto& lengths = belts.points[point].lengths_mm;
  const auto place = model::place_of_upper(machine, lengths.tl, lengths.tr);
  if (!place) return;
  for (const Belt belt : {Belt::bl, Belt::br}) {
    const auto predicted = model::reading_at(machine, belt, *place);
    if (counting[belt] && predicted) residual_mm.push_back(lengths[belt] - predicted->length_mm);
  }
}

BeltPrediction summed(const std::vector<double>& residual_mm) {
  BeltPrediction result{residual_mm.size(), rms(residual_mm), 0.0};
  for (const double off : residual_mm) result.largest_mm = std::max(result.largest_mm, std::abs(off));
  return result;
}

std::vector<std::size_t> in_order(const MeasuredBelts& belts) {
  auto order = numbers_below(belts.points.size());
  stable_sort(order, [&](std::size_t a, std::size_t b) {
    return belts.points[a].order.value_or(static_cast<int>(a)) <
           belts.points[b].order.value_or(static_cast<int>(b));
  });
  return order;
}

BeltPrediction predict_one_by_one(const MeasuredBelts& belts, const FitDiagnostics& view) {
  std::vector<double> residual_mm;
  for (std::size_t k = 0; k < belts.points.size(); ++k) {
    // A taped place is not left out: the tape would still hold its place.
    if (!view.is_placed(k) || view.is_taped(k)) continue;
    predict_point(belts, k, view.anchors_without(k), view.frame().counting[k], residual_mm);
  }
  return summed(residual_mm);
}

std::optional<BeltPrediction> predict_by_halves(const MeasuredBelts& belts,
                                                 const AnchorFit& frame) {
  if (belts.points.size() < 2 * kFewestBeltPoints) return std::nullopt;
  const MeasuredBelts untaped = without_distances(belts);
  const std::vector<std::size_t> order = in_order(belts);
  std::vector<double> residual_mm;
  for (const std::size_t half : {0UL, 1UL}) {
    Counting counting = frame.counting;
    for (std::size_t i = half; i < order.size(); i += 2) {
      counting[order[i]] = {};
    }
    const auto fitted = fit_anchors_from(untaped, frame.state, counting);
    if (!fitted || fitted->checks < 1) return std::nullopt;
    for (std::size_t i = half; i < order.size(); i += 2) {
      predict_point(belts, order[i], fitted->state.anchors, frame.counting[order[i]], residual_mm);
    }
  }
  return summed(residual_mm);
}

}  // namespace chaintrue::grid::belts
