// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/sweep/sweep_spec.hpp"

#include <fmt/format.h>

#include "grid/containers.hpp"

namespace chaintrue::grid::sweep {

std::array<std::size_t, kFactors> level_counts(const SweepSpec& spec) {
  return {spec.machines.size(), spec.effects.size(),    spec.uses.size(),   spec.surfaces.size(),
          spec.spacings.size(), spec.jitters_mm.size(), spec.noises.size(), spec.grids.size()};
}

std::uint64_t combinations(const SweepSpec& spec) {
  std::uint64_t product = 1;
  for (const std::size_t count : level_counts(spec)) product *= count;
  return product;
}

std::uint64_t cells(const SweepSpec& spec) {
  return combinations(spec) * static_cast<std::uint64_t>(spec.repetitions);
}

Levels levels_of(const SweepSpec& spec, std::uint64_t combination) {
  const auto counts = level_counts(spec);
  Levels levels{};
  for (std::size_t factor = kFactors; factor-- > 0;) {
    levels[factor] = as_size(combination % counts[factor]);
    combination /= counts[factor];
  }
  return levels;
}

std::string level_name(const SweepSpec& spec, std::size_t factor, std::size_t level) {
  switch (factor) {
    case 0:
      return spec.machines.at(level).name;
    case 1:
      return spec.effects.at(level).name;
    case 2:
      return spec.uses.at(level).name;
    case 3:
      return std::string(name(spec.surfaces.at(level)));
    case 4:
      return spec.spacings.at(level) == synthetic::DesignKind::chebyshev ? "chebyshev" : "regular";
    case 5:
      return fmt::format("{}", spec.jitters_mm.at(level));
    case 6:
      return fmt::format("{}/{}", spec.noises.at(level).length_mm,
                         spec.noises.at(level).position_mm);
    default:
      return fmt::format("{}x{}", spec.grids.at(level).columns, spec.grids.at(level).rows);
  }
}

std::string_view name(SurfaceLevel level) {
  return word_of(level, {"residual", "direct", "direct_parabolic", "direct_natural"});
}

std::string_view name(CellStatus status) {
  return word_of(status, {"done", "no_map", "not_reached", "no_answer"});
}

}  // namespace chaintrue::grid::sweep
