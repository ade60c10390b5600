// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/observation/measured_holes.hpp"

#include <fmt/format.h>

#include <cmath>

#include "grid/statistics.hpp"

namespace chaintrue::grid {
std::string_view name(SheetEdge edge) {
  constexpr std::string_view kNames[] = {"left", "right", "top", "bottom"};
  return kNames[static_cast<std::size_t>(edge)];
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

double commanded_mm(const MeasuredHoles& set, const HoleDistance& distance) {
  const model::BedPoint from = set.holes.at(distance.from).commanded;
  if (!distance.edge) {
    const model::BedPoint to = set.holes.at(distance.to).commanded;
    return std::hypot(from.x_mm - to.x_mm, from.y_mm - to.y_mm);
  }
  const model::Bed bed = set.machine ? set.machine->bed : model::Bed{};
  const double half_width = 0.5 * set.sheet.width_mm.value_or(bed.width_mm);
  const double half_height = 0.5 * set.sheet.height_mm.value_or(bed.height_mm);
  switch (*distance.edge) {
    case SheetEdge::left:
      return half_width + from.x_mm;
    case SheetEdge::right:
      return half_width - from.x_mm;
    case SheetEdge::top:
      return half_height - from.y_mm;
    case SheetEdge::bottom:
      break;
  }
  return half_height + from.y_mm;
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
  for (std::size_t i = 0; i < excess.size(); ++i) {
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
