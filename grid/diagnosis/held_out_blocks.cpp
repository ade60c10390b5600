// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/held_out_blocks.hpp"

#include "grid/containers.hpp"
#include "grid/estimation/spatial_blocks.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// Blocks of the bed over all marks at which chains were read; none where they are too few.
HeldOutBlocks blocks_of_the_bed(const ObservationSet& session) {
  std::vector<LengthPoint> points;
  std::vector<std::size_t> units;
  for (const auto& [part, readings] : parts_of<observation::ChainLengthReadings>(session)) {
    for (std::size_t i = 0; i < readings->places().size(); ++i) {
      const NumberedPlace& place = session.places[part->first_place + i];
      points.push_back({place.index, place.mark, place.lengths});
      units.push_back(part->first_unit + i);
    }
  }
  HeldOutBlocks result{{}, true};
  if (points.size() < 2 * kFewestPoints) return result;
  result.units = spatial_blocks(points);
  for (auto& block : result.units) {
    for (std::size_t& u : block) u = units[u];
  }
  return result;
}

/// Each hole with all distances that end there; none where too few distances would be left.
HeldOutBlocks blocks_by_hole(const ObservationSet& session) {
  HeldOutBlocks result;
  for (const auto& [part, tape] : parts_of<observation::TapeDistances>(session)) {
    const MeasuredHoles& set = tape->set();
    const std::size_t first = result.units.size();
    result.units.resize(first + set.holes.size());
    for (std::size_t k = 0; k < set.distances.size(); ++k) {
      const HoleDistance& distance = set.distances[k];
      result.units[first + distance.from].push_back(part->first_unit + k);
      if (!distance.edge) result.units[first + distance.to].push_back(part->first_unit + k);
    }
  }
  std::erase_if(result.units, [](const auto& block) { return block.empty(); });
  const bool enough = all_of(result.units, [&](const auto& block) {
    return session.units.size() - block.size() >= kFewestDistances;
  });
  if (!enough) result.units.clear();
  return result;
}

}  // namespace

HeldOutBlocks held_out_blocks(const ObservationSet& session) {
  constexpr std::size_t kFewestBlocks = 3;
  for (const auto& blocks : {blocks_of_the_bed(session), blocks_by_hole(session)}) {
    if (blocks.units.size() >= kFewestBlocks) return blocks;
  }
  return {};
}

}  // namespace chaintrue::grid::diagnosis
