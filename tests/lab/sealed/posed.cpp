// SPDX-License-Identifier: GPL-3.0-or-later
#include "sealed/posed.hpp"

#include <gtest/gtest.h>

#include "grid/files/grid_file.hpp"

namespace chaintrue::sealed {

generator::SealedSet posed(std::vector<generator::Hidden> effects,
                           generator::Order order,
                           std::uint64_t seed,
                           int points) {
  generator::Recipe recipe;
  recipe.kind = generator::Mix::nothing;
  recipe.points = points;
  recipe.order = order;
  recipe.exactly = std::move(effects);
  return generator::draw_set(recipe, seed);
}

grid::MeasuredGrid read(const generator::SealedSet& set) {
  return grid::files::parse_grid(set.grid_text, "sealed.json").grid;
}

grid::diagnosis::Diagnosis diagnosed(const grid::MeasuredGrid& grid) {
  grid::diagnosis::DiagnosisOptions how;
  how.improvement = false;
  how.next_measurements = false;
  auto found = grid::diagnosis::diagnose(grid, how);
  if (!found) {
    ADD_FAILURE() << found.error().sentence();
    return {};
  }
  return std::move(*found);
}

std::vector<std::string> ids(const grid::diagnosis::Diagnosis& found) {
  std::vector<std::string> all;
  for (const auto& cause : found.causes) all.push_back(id_of(cause.cause));
  return all;
}

bool led_by(const grid::diagnosis::Diagnosis& found, const std::string& id) {
  if (found.causes.empty()) return false;
  const auto& leader = found.causes.front();
  if (id_of(leader.cause) == id) return true;
  for (const auto& same : leader.same_as) {
    if (id_of(same.cause) == id) return true;
  }
  return false;
}

bool names_any(const grid::diagnosis::Diagnosis& found) {
  using grid::diagnosis::Verdict;
  return found.verdict == Verdict::named || found.verdict == Verdict::named_set ||
         found.verdict == Verdict::several_causes;
}

std::vector<Trial> trials(TrialOptions options, std::uint64_t first, int count) {
  std::vector<Trial> all;
  for (int i = 0; i < count; ++i) {
    all.push_back(run_trial(options, first + static_cast<std::uint64_t>(i)));
  }
  return all;
}

}  // namespace chaintrue::sealed
