// SPDX-License-Identifier: GPL-3.0-or-later
// consumer GRID.json DIAGNOSIS.json: a measured grid becomes a map, answers and a diagnosis.
#include <fmt/format.h>

#include <chaintrue/grid.hpp>
#include <exception>
#include <fstream>

namespace grid = chaintrue::grid;
namespace files = chaintrue::grid::files;

int main(int count, char** arguments) try {
  if (count != 3) return 2;
  // Bad input throws, with every problem in the message.
  const auto read = files::read(files::parse_grid, arguments[1]);

  // A normal numeric outcome is a value: test it, and read its reason or sentence.
  const auto map = grid::fit(read.grid);
  if (!map && map.error() == grid::FitReason::no_machine) return 3;
  if (!map) return fmt::print(stderr, "{}\n", map.error().sentence()), 1;

  // One place, or many: each has its answer, or its reason.
  const auto there = map->query({100.0, -200.0});
  if (!there) return fmt::print(stderr, "{}\n", there.error().sentence()), 1;
  fmt::print("at (100, -200): left {:.3f} mm, right {:.3f} mm\n", there->lengths.left_mm,
             there->lengths.right_mm);
  const std::vector<chaintrue::model::MarkPoint> path = {{0.0, 0.0}, {50.0, 0.0}, {1e4, 0.0}};
  std::vector<grid::MapAnswerOrFailure> answers(path.size());
  grid::query(*map, path, answers);
  for (const auto& answer : answers) {
    fmt::print("{}\n",
               answer ? fmt::format("{:.3f}", answer->lengths.left_mm) : answer.error().sentence());
  }

  // Points, holes with a tape, or both: Measured takes any mix of one machine.
  grid::Measured measured(read.grid);
  const auto found = grid::diagnosis::diagnose(measured);
  if (!found) return fmt::print(stderr, "{}\n", found.error().sentence()), 1;
  fmt::print("{}\n", found->sentence);
  for (const auto& cause : found->causes) {
    fmt::print("{}: probability {:.2f}\n", cause.cause.effect->id, cause.probability);
  }

  // All data of the report, as a file, with its input files.
  const grid::Provenance made_by = {
      std::string(files::version()), "consumer", {}, files::sources_read()};
  std::ofstream(arguments[2]) << files::write_diagnosis(*found, made_by);
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "{}\n", error.what());
  return 1;
}
