// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/belts/foretelling.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "grid/statistics.hpp"
#include "model/belts/belt_kinematics.hpp"

namespace chaintrue::grid::belts {

using model::Belt;

void foretell(const MeasuredBelts& belts,
              std::size_t point,
              const AnchorVector& anchors,
              const model::PerBelt<bool>& counting,
              std::vector<double>& off_mm) {
  if (!counting.tl || !counting.tr) return;
  const model::BeltMachine machine = with_anchors(belts.machine, anchors);
  const auto& lengths = belts.points[point].lengths_mm;
  const auto place = model::place_of_upper(machine, lengths.tl, lengths.tr);
  if (!place) return;
  for (const Belt belt : {Belt::bl, Belt::br}) {
    const auto foretold = model::reading_at(machine, belt, *place);
    if (counting[belt] && foretold) off_mm.push_back(lengths[belt] - foretold->length_mm);
  }
}

BeltPrediction summed(const std::vector<double>& off_mm) {
  BeltPrediction result{off_mm.size(), rms(off_mm), 0.0};
  for (const double off : off_mm) result.largest_mm = std::max(result.largest_mm, std::abs(off));
  return result;
}

std::vector<std::size_t> in_order(const MeasuredBelts& belts) {
  std::vector<std::size_t> order(belts.points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return belts.points[a].order.value_or(static_cast<int>(a)) <
           belts.points[b].order.value_or(static_cast<int>(b));
  });
  return order;
}

BeltPrediction foretell_one_by_one(const MeasuredBelts& belts, const FitDiagnostics& view) {
  std::vector<double> off_mm;
  for (std::size_t k = 0; k < belts.points.size(); ++k) {
    // A taped place is not left out: the tape would still hold its place.
    if (!view.is_placed(k) || view.is_taped(k)) continue;
    foretell(belts, k, view.anchors_without(k), view.frame().counting[k], off_mm);
  }
  return summed(off_mm);
}

std::optional<BeltPrediction> foretell_by_halves(const MeasuredBelts& belts,
                                                 const AnchorFit& frame) {
  if (belts.points.size() < 2 * kFewestBeltPoints) return std::nullopt;
  MeasuredBelts untaped = belts;
  untaped.distances.clear();
  const std::vector<std::size_t> order = in_order(belts);
  std::vector<double> off_mm;
  for (const std::size_t half : {0, 1}) {
    Counting counting = frame.counting;
    for (std::size_t i = half; i < order.size(); i += 2) {
      counting[order[i]] = {false, false, false, false};
    }
    const auto fitted = settle_from(untaped, frame.state, counting);
    if (!fitted || fitted->checks < 1) return std::nullopt;
    for (std::size_t i = half; i < order.size(); i += 2) {
      foretell(belts, order[i], fitted->state.anchors, frame.counting[order[i]], off_mm);
    }
  }
  return summed(off_mm);
}

}  // namespace chaintrue::grid::belts
