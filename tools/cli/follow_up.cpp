// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/follow_up.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "grid/containers.hpp"
#include "tools/cli/diagnosis_words.hpp"

namespace chaintrue::cli {
namespace {

using diagnosis::MeasurementKind;

/// The number of the next visit; empty where visits are not numbered.
std::optional<int> next_visit(const MeasuredGrid& measured) {
  std::optional<int> last;
  for (const auto& point : measured.points) {
    if (point.order) last = std::max(last.value_or(*point.order), *point.order);
  }
  return last ? std::optional(*last + 1) : std::nullopt;
}

/// Points of this grid give commands in place of lengths.
bool gives_commands(const MeasuredGrid& measured) {
  return !measured.points.empty() && !measured.points.front().lengths;
}

bool is_point(const NextMeasurement& next) {
  return next.kind == MeasurementKind::point || next.kind == MeasurementKind::revisit;
}

}  // namespace

std::string follow_up_list(const Diagnosis& found) {
  if (found.next_measurements.empty()) {
    return "Nothing more needs measuring: no further reading is expected to change the answer.\n";
  }
  std::string text = "Measure, in this order:\n";
  const std::vector<std::string> sentences = follow_ups_in_words(found);
  for (std::size_t i = 0; i < sentences.size(); ++i) {
    text += fmt::format("{:>3}. {}{}\n", i + 1, sentences[i], chance_then(found, i));
  }
  return text;
}

bool proposes(const Diagnosis& found, MeasurementKind kind) {
  return grid::any_of(found.next_measurements,
                      [&](const NextMeasurement& next) { return next.kind == kind; });
}

std::string points_json(const Diagnosis& found, const MeasuredGrid& measured) {
  const std::string_view values = gives_commands(measured)
                                      ? R"("commanded_x_mm": null, "commanded_y_mm": null)"
                                      : R"("left_mm": null, "right_mm": null)";
  std::optional<int> visit = next_visit(measured);
  std::string points;
  for (const NextMeasurement& next : found.next_measurements) {
    if (!is_point(next)) continue;
    points += fmt::format("  {{\"x_mm\": {:.1f}, \"y_mm\": {:.1f}, {}{}}},\n",
                          next.mark->x_mm + 0.0,
                          next.mark->y_mm + 0.0,
                          values,
                          visit ? fmt::format(", \"order\": {}", (*visit)++) : "");
  }
  return points.empty() ? points : "add to \"points\", replacing each null\n" + points;
}

std::string points_csv(const Diagnosis& found, const MeasuredGrid& measured) {
  std::optional<int> visit = next_visit(measured);
  const bool commands = gives_commands(measured);
  std::string text = fmt::format("x_mm,y_mm,{}{}\n",
                                 commands ? "commanded_x_mm,commanded_y_mm" : "left_mm,right_mm",
                                 visit ? ",order" : "");
  for (const NextMeasurement& next : found.next_measurements) {
    if (!is_point(next)) continue;
    text += fmt::format("{:.1f},{:.1f},,{}\n",
                        next.mark->x_mm + 0.0,
                        next.mark->y_mm + 0.0,
                        visit ? fmt::format(",{}", (*visit)++) : "");
  }
  return text;
}

std::string readings_json(const Diagnosis& found) {
  std::string readings;
  for (const NextMeasurement& next : found.next_measurements) {
    if (next.kind != MeasurementKind::reading) continue;
    readings += fmt::format("  {{\"what\": \"{}\"{}, \"value\": null, \"sigma\": {}}},\n",
                            name(next.reading.value()),
                            next.side.empty() ? "" : fmt::format(", \"side\": \"{}\"", next.side),
                            next.sigma > 0.0 ? fmt::format("{:g}", next.sigma) : "null");
  }
  return readings.empty() ? readings : "add to \"readings\", replacing each null\n" + readings;
}

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
    text += fmt::format("  {{\"name\": \"{}\", \"x_mm\": {:.0f}, \"y_mm\": {:.0f}}},\n",
                        hole.name,
                        hole.commanded.x_mm + 0.0,
                        hole.commanded.y_mm + 0.0);
  }
  if (!lines.distances.empty()) text += "add to \"distances\", replacing each null\n";
  for (const auto& [from, to] : lines.distances) {
    text +=
        fmt::format("  {{\"from\": \"{}\", \"to\": \"{}\", \"distance_mm\": null}},\n", from, to);
  }
  return text;
}

std::string distances_csv(const Diagnosis& found,
                          const std::vector<MeasuredHoles>& sets,
                          std::size_t position) {
  const Lines lines = lines_of(found, sets, position);
  std::string text = "hole,x_mm,y_mm\n";
  for (const grid::Hole& hole : lines.holes) {
    text += fmt::format(
        "{},{:.0f},{:.0f}\n", hole.name, hole.commanded.x_mm + 0.0, hole.commanded.y_mm + 0.0);
  }
  text += "from,to,distance_mm\n";
  for (const auto& [from, to] : lines.distances) {
    text += fmt::format("{},{},\n", from, to);
  }
  return text;
}

}  // namespace chaintrue::cli
