// SPDX-License-Identifier: GPL-3.0-or-later
// consumer GRID.json DIAGNOSIS.json: a measured grid becomes a map, an answer and a diagnosis.
#include <fmt/format.h>

#include <exception>
#include <fstream>

#include "grid/diagnosis/diagnose.hpp"
#include "grid/files/diagnosis_file.hpp"
#include "grid/files/grid_file.hpp"
#include "grid/map/fit.hpp"

namespace grid = chaintrue::grid;

int main(int count, char** arguments) try {
  if (count != 3) return 2;
  // Bad input throws, with every problem in the message.
  const auto read = grid::files::read_grid(arguments[1]);

  // A normal numeric outcome is a value: test it, and read its sentence.
  const auto map = grid::fit(read.grid);
  if (!map) return fmt::print(stderr, "{}\n", map.error().sentence), 1;
  const auto there = map->query({100.0, -200.0});
  if (!there) return 1;
  fmt::print("at (100, -200): left {:.3f} mm, right {:.3f} mm\n",
             there->lengths.left_mm,
             there->lengths.right_mm);

  // Points, holes with a tape, or both: Measured takes any mix of one machine.
  grid::Measured measured(read.grid);
  const auto found = grid::diagnosis::diagnose(measured);
  if (!found) return fmt::print(stderr, "{}\n", found.error().sentence), 1;
  fmt::print("{}\n", found->sentence);
  for (const auto& cause : found->causes) {
    fmt::print("{}: probability {:.2f}\n", cause.cause.effect->id, cause.probability);
  }

  // Everything that the report draws, as a file.
  std::ofstream(arguments[2]) << grid::files::write_diagnosis(*found);
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "{}\n", error.what());
  return 1;
}
