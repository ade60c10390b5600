// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/belts_outliers.hpp"

namespace chaintrue::grid::diagnosis {

using model::Belt;
using model::kBelts;

namespace {

constexpr std::size_t kReadingsOfPlace = 4;

/// How many readings of a place a set rejects.
std::size_t rejected_of(const std::vector<bool>& set, std::size_t place) {
  std::size_t count = 0;
  for (std::size_t b = 0; b < kReadingsOfPlace; ++b) {
    if (set[kReadingsOfPlace * place + b]) ++count;
  }
  return count;
}

}  // namespace

std::vector<OutlierGroup> reading_groups(const BeltsSystem& system) {
  std::vector<OutlierGroup> groups;
  for (std::size_t k = 0; k < system.checks.size(); ++k) {
    for (const Belt belt : kBelts) {
      groups.push_back(
          {static_cast<Eigen::Index>(2 * k),
           2,
           Eigen::Vector2d(system.checks[k].row(static_cast<Eigen::Index>(belt)).transpose())});
    }
  }
  return groups;
}

OutlierLimits reading_limits(const BeltsSystem& system) {
  // Two rows more than anchors, or nothing is left to judge by.
  constexpr Eigen::Index kFewestChecks = 3;
  // Two bad readings of a place, and of places beside each other, can mask one another.
  constexpr std::size_t kBeyondTheBest = 8;
  return {.fewest_rows = system.system.by_setting.cols() + kFewestChecks,
          .beyond_the_best = kBeyondTheBest};
}

Suspects suspects_of(const std::vector<std::vector<bool>>& sets) {
  Suspects suspects(sets.empty() ? 0 : sets.front().size() / kReadingsOfPlace);
  for (const std::vector<bool>& set : sets) {
    for (std::size_t k = 0; k < suspects.size(); ++k) {
      if (suspects[k] || rejected_of(set, k) != 1) continue;
      for (const Belt belt : kBelts) {
        if (set[kReadingsOfPlace * k + static_cast<std::size_t>(belt)]) suspects[k] = belt;
      }
    }
  }
  return suspects;
}

std::vector<bool> units_of(const std::vector<bool>& set, const Suspects& suspects) {
  std::vector<bool> units(2 * suspects.size(), false);
  for (std::size_t k = 0; k < suspects.size(); ++k) {
    const std::size_t bad = rejected_of(set, k);
    if (bad == 0) continue;
    const bool alone = bad == 1 && suspects[k] &&
                       set[kReadingsOfPlace * k + static_cast<std::size_t>(*suspects[k])];
    units[2 * k] = true;
    units[2 * k + 1] = !alone;
  }
  return units;
}

std::vector<model::PerBelt<bool>> readings_of(const std::vector<bool>& units,
                                              const Suspects& suspects) {
  std::vector<model::PerBelt<bool>> bad(units.size() / 2);
  for (std::size_t k = 0; k < bad.size(); ++k) {
    if (units[2 * k + 1]) {
      bad[k] = {true, true, true, true};
    } else if (units[2 * k] && suspects[k]) {
      bad[k][*suspects[k]] = true;
    }
  }
  return bad;
}

}  // namespace chaintrue::grid::diagnosis
