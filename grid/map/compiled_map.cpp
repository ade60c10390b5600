// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/compiled_map.hpp"

#include <algorithm>
#include <array>
#include <optional>

namespace chaintrue::grid {

tl::expected<interp::CompiledPair, MapFailure> compile(const CompensationMap& map,
                                                       int columns,
                                                       int rows) {
  const interp::Rectangle& domain = map.contents().domain;
  const model::Machine* machine = map.machine();
  const auto is_wave = [](const model::AppliedEffect& e) {
    return e.effect == "sprocket_eccentricity";
  };
  if (machine != nullptr &&
      std::any_of(machine->effects.begin(), machine->effects.end(), is_wave)) {
    return tl::unexpected(MapFailure::wave_along_chain);
  }
  std::optional<MapFailure> failure;
  const auto lengths = [&](double x_mm, double y_mm) {
    // Nodes of the table's edges may miss the domain by a rounding error.
    const auto here = map.lengths({std::clamp(x_mm, domain.x_min, domain.x_max),
                                   std::clamp(y_mm, domain.y_min, domain.y_max)});
    if (here) return std::array{here->lengths.left_mm, here->lengths.right_mm};
    failure = here.error();
    return std::array{0.0, 0.0};
  };
  auto table = interp::CompiledPair::compile(domain, columns, rows, lengths);
  if (failure) return tl::unexpected(*failure);
  return table;
}

}  // namespace chaintrue::grid
