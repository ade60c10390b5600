// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/follow_up_holes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "grid/containers.hpp"

namespace chaintrue::cli {
namespace {

struct Lines {
  std::vector<grid::Hole> holes;
  std::vector<std::pair<std::string, std::string>> distances;
};

/// N1, N2, ... except names in use.
class FreeNames {
 public:
  explicit FreeNames(const MeasuredHoles& set) : set_(set) {}
  std::string next() {
    std::string name;
    do {
      name = fmt::format("N{}", ++number_);
    } while (grid::any_of(set_.holes, [&](const grid::Hole& hole) { return hole.name == name; }));
    return name;
  }

 private:
  const MeasuredHoles& set_;
  int number_ = 0;
};

/// A hole's name in the diagnosis.
std::string name_in_diagnosis(const grid::Hole& hole, std::size_t position) {
  return position == 0 ? hole.name : fmt::format("{} ({})", hole.name, position + 1);
}

/// Its name in the set's file; an edge keeps its name. Empty if the set has no such hole.
std::string name_in_file(const MeasuredHoles& set, std::size_t position, const std::string& name) {
  for (const grid::Hole& hole : set.holes) {
    if (name_in_diagnosis(hole, position) == name) return hole.name;
  }
  const bool edge =
      grid::any_of(grid::kSheetEdges, [&](grid::SheetEdge e) { return grid::name(e) == name; });
  return edge ? name : "";
}

Lines lines_of(const Diagnosis& found,
               const std::vector<MeasuredHoles>& sets,
               std::size_t position) {
  const MeasuredHoles& set = sets[position];
  Lines lines;
  FreeNames names(set);
  for (const NextMeasurement& next : found.next_measurements) {
    if (next.kind != diagnosis::MeasurementKind::distance) continue;
    // A new hole has no name yet; its set follows from the holes to which it is measured.
    std::string from = name_in_file(set, position, next.mark ? next.to.front() : next.from);
    if (from.empty()) continue;
    if (next.mark) {
      from = names.next();
      lines.holes.push_back({from, model::identity_placement(*next.mark)});
    }
    for (const std::string& to : next.to) {
      lines.distances.emplace_back(from, name_in_file(set, position, to));
    }
  }
  return lines;
}

}  // namespace

bool is_diagnosis_of(const Diagnosis& found, const std::vector<MeasuredHoles>& sets) {
  constexpr double kSamePlaceMm = 1e-3;
  std::vector<grid::Hole> holes;
  std::size_t distances = 0;
  for (std::size_t k = 0; k < sets.size(); ++k) {
    for (const grid::Hole& hole : sets[k].holes) {
      holes.push_back({name_in_diagnosis(hole, k), hole.commanded});
    }
    distances += sets[k].distances.size();
  }
  return found.distances.size() == distances &&
         std::equal(found.holes.begin(),
                    found.holes.end(),
                    holes.begin(),
                    holes.end(),
                    [&](const auto& pictured, const grid::Hole& hole) {
                      return pictured.name == hole.name &&
                             std::hypot(pictured.commanded.x_mm - hole.commanded.x_mm,
                                        pictured.commanded.y_mm - hole.commanded.y_mm) <
                                 kSamePlaceMm;
                    });
}

std::string distances_json(const Diagnosis& found,
                           const std::vector<MeasuredHoles>& sets,
                           std::size_t position) {
  const Lines lines = lines_of(found, sets, position);
  std::string text;
  if (!lines.holes.empty()) text += "cut, and add to \"holes\"\n";
  for (const grid::Hole& hole : lines.holes) {
    fmt::format_to(std::back_inserter(text),
                   "  {{\"name\": \"{}\", \"x_mm\": {:.0f}, \"y_mm\": {:.0f}}},\n",
                   hole.name,
                   hole.commanded.x_mm + 0.0,
                   hole.commanded.y_mm + 0.0);
  }
  if (!lines.distances.empty()) text += "add to \"distances\", replacing each null\n";
  for (const auto& [from, to] : lines.distances) {
    fmt::format_to(std::back_inserter(text),
                   "  {{\"from\": \"{}\", \"to\": \"{}\", \"distance_mm\": null}},\n",
                   from,
                   to);
  }
  return text;
}

std::string distances_csv(const Diagnosis& found,
                          const std::vector<MeasuredHoles>& sets,
                          std::size_t position) {
  const Lines lines = lines_of(found, sets, position);
  std::string text = "hole,x_mm,y_mm\n";
  for (const grid::Hole& hole : lines.holes) {
    fmt::format_to(std::back_inserter(text),
                   "{},{:.0f},{:.0f}\n",
                   hole.name,
                   hole.commanded.x_mm + 0.0,
                   hole.commanded.y_mm + 0.0);
  }
  text += "from,to,distance_mm\n";
  for (const auto& [from, to] : lines.distances) {
    fmt::format_to(std::back_inserter(text), "{},{},\n", from, to);
  }
  return text;
}

}  // namespace chaintrue::cli
