// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/observation/measured_holes.hpp"

#include <fmt/format.h>

#include <cmath>

#include "grid/containers.hpp"
#include "grid/plane_vectors.hpp"
#include "grid/statistics.hpp"

namespace chaintrue::grid {
std::string_view name(SheetEdge edge) { return word_of(edge, {"left", "right", "top", "bottom"}); }

std::optional<SheetEdge> edge_of(std::string_view word) {
  for (const SheetEdge edge : kSheetEdges) {
    if (word == name(edge)) return edge;
  }
  return std::nullopt;
}

double sigma_of(const MeasuredHoles& set, const HoleDistance& distance) {
  return distance.sigma_mm.value_or(set.tape.sigma_mm);
}

double length_of(const MeasuredHoles& set, const HoleDistance& distance) {
  return distance.distance_mm - set.tape.tape_zero_offset_mm;
}

std::string words_of(const MeasuredHoles& set, const HoleDistance& distance) {
  const std::string& from = set.holes.at(distance.from).name;
  return distance.edge ? fmt::format("{} to the {} edge", from, name(*distance.edge))
                       : fmt::format("{}-{}", from, set.holes.at(distance.to).name);
}

EdgeLine edge_line(const MeasuredHoles& set, SheetEdge edge) {
  const Bed bed = set.machine ? set.machine->bed : Bed{};
  const double sign = edge == SheetEdge::left || edge == SheetEdge::bottom ? 1.0 : -1.0;
  if (edge == SheetEdge::left || edge == SheetEdge::right)
    return {set.sheet.width_mm.value_or(bed.width_mm), 0, sign};
  return {set.sheet.height_mm.value_or(bed.height_mm), 1, sign};
}

double commanded_mm(const MeasuredHoles& set, const HoleDistance& distance) {
  const BedPoint from = set.holes.at(distance.from).commanded;
  if (!distance.edge) return distance_mm(from, set.holes.at(distance.to).commanded);
  const EdgeLine line = edge_line(set, *distance.edge);
  return 0.5 * line.size_mm + line.sign * vector_of(from)[line.axis];
}

std::optional<double> suspected_tape_zero_offset_mm(const MeasuredHoles& set) {
  constexpr std::size_t kFewest = 3;
  constexpr double kLeastMm = 8.0;  // tapes are held by the hook or at a mark of 10 mm or more
  std::vector<double> excess;
  std::vector<double> ratio;
  std::vector<double> commanded;
  for (const HoleDistance& distance : set.distances) {
    if (distance.edge) continue;
    commanded.push_back(commanded_mm(set, distance));
    excess.push_back(length_of(set, distance) - commanded.back());
    ratio.push_back(excess.back() / commanded.back());
  }
  if (excess.size() < kFewest) return std::nullopt;
  const double middle = median(excess);
  if (std::abs(middle) < kLeastMm) return std::nullopt;
  // An error of scale grows with the distance; an offset is the same for all.
  const double scale = median(ratio);
  std::vector<double> residual_of_scale;
  for (const auto i : each_index(excess)) {
    residual_of_scale.push_back(std::abs(excess[i] - scale * commanded[i]));
    excess[i] = std::abs(excess[i] - middle);
  }
  constexpr double kEqualWithin = 0.25;
  constexpr double kClearlyBetter = 0.5;
  const double spread = median(excess);
  if (spread > kEqualWithin * std::abs(middle) ||
      spread > kClearlyBetter * median(residual_of_scale))
    return std::nullopt;
  return middle;
}

}  // namespace chaintrue::grid
