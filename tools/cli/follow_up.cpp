// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "grid/plane_vectors.hpp"
#include "tools/cli/diagnosis_sections.hpp"
#include "tools/cli/fields.hpp"

namespace chaintrue::cli {
namespace {

/// Points of this grid give commands in place of lengths.
bool gives_commands(const MeasuredGrid& measured) {
  return !measured.points.empty() && !measured.points.front().lengths;
}

/// The lines as JSON after a heading that says what to do with them; empty if there are none.
std::string json_lines(const std::string& what_to_do, const std::vector<Fields>& lines) {
  std::string text = lines.empty() ? "" : what_to_do;
  for (const auto& fields : lines) text += "  " + json_of(fields) + ",\n";
  return text;
}

std::string csv_lines(std::string text, const std::vector<Fields>& lines) {
  for (const auto& fields : lines) text += csv_values(fields);
  return text;
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
  const Words sentences = follow_ups_in_words(found);
  for (const auto i : each_index(sentences)) {
    text += fmt::format("{:>3}. {}{}\n", i + 1, sentences[i], chance_then(found, i));
  }
  return text;
}

bool proposes(const Diagnosis& found, MeasurementKind kind) {
  return any_of(found.next_measurements, having(&NextMeasurement::kind, kind));
}

std::string point_lines(const Diagnosis& found, const MeasuredGrid& measured, bool is_json) {
  std::optional<int> visit = next_visit(measured.points);
  const bool commands = gives_commands(measured);
  std::vector<Fields> points;
  for (const NextMeasurement& next : found.next_measurements) {
    if (!is_point(next)) continue;
    Fields& fields =
        points.emplace_back(Fields{{"x_mm", fmt::format("{:.1f}", next.mark->x_mm + 0.0)},
                                   {"y_mm", fmt::format("{:.1f}", next.mark->y_mm + 0.0)},
                                   {commands ? "commanded_x_mm" : "left_mm", ""},
                                   {commands ? "commanded_y_mm" : "right_mm", ""}});
    if (visit) fields.push_back({"order", fmt::format("{}", (*visit)++)});
  }
  return is_json ? json_lines("add to \"points\", replacing each null\n", points)
                 : csv_lines(
                       fmt::format("x_mm,y_mm,{}{}\n",
                                   commands ? "commanded_x_mm,commanded_y_mm" : "left_mm,right_mm",
                                   visit ? ",order" : ""),
                       points);
}

std::string readings_json(const Diagnosis& found) {
  std::vector<Fields> readings;
  for (const NextMeasurement& next : found.next_measurements) {
    if (next.kind != MeasurementKind::reading) continue;
    Fields& fields = readings.emplace_back();
    fields.push_back({"what", std::string(name(next.reading.value())), true});
    if (!next.side.empty()) fields.push_back({"side", next.side, true});
    fields.push_back({"value", ""});
    fields.push_back({"sigma", next.sigma > 0.0 ? fmt::format("{:g}", next.sigma) : ""});
  }
  return json_lines("add to \"readings\", replacing each null\n", readings);
}

namespace {

/// A hole's name in the diagnosis.
std::string name_in_diagnosis(const Hole& hole, std::size_t position) {
  return position == 0 ? hole.name : fmt::format("{} ({})", hole.name, position + 1);
}

/// Its name in the set's file; an edge keeps its name. Empty if the set has no such hole.
std::string name_in_file(const MeasuredHoles& set, std::size_t position, const std::string& name) {
  for (const Hole& hole : set.holes) {
    if (name_in_diagnosis(hole, position) == name) return hole.name;
  }
  return grid::edge_of(name) ? name : "";
}

/// N1, N2, ... except names in use.
std::string free_name(const MeasuredHoles& set, int& number) {
  const std::string name = fmt::format("N{}", ++number);
  const bool is_used = any_of(set.holes, having(&Hole::name, name));
  return is_used ? free_name(set, number) : name;
}

}  // namespace

bool is_diagnosis_of(const Diagnosis& found, const std::vector<const MeasuredHoles*>& sets) {
  constexpr double kSamePlaceMm = 1e-3;
  std::vector<Hole> holes;
  std::size_t distances = 0;
  for (const auto k : each_index(sets)) {
    for (const Hole& hole : sets[k]->holes) {
      holes.push_back({name_in_diagnosis(hole, k), hole.commanded});
    }
    distances += sets[k]->distances.size();
  }
  return found.distances.size() == distances &&
         std::equal(found.holes.begin(), found.holes.end(), holes.begin(), holes.end(),
                    [&](const auto& pictured, const Hole& hole) {
                      return pictured.name == hole.name &&
                             grid::distance_mm(pictured.commanded, hole.commanded) < kSamePlaceMm;
                    });
}

std::string distance_lines(const Diagnosis& found, const std::vector<const MeasuredHoles*>& sets,
                           std::size_t position, bool is_json) {
  const MeasuredHoles& set = *sets[position];
  std::vector<Fields> holes, distances;
  int number = 0;
  for (const NextMeasurement& next : found.next_measurements) {
    if (next.kind != MeasurementKind::distance) continue;
    // A new hole has no name yet; its set follows from the holes to which it is measured.
    std::string from = name_in_file(set, position, next.mark ? next.to.front() : next.from);
    if (from.empty()) continue;
    if (next.mark) {
      from = free_name(set, number);
      holes.push_back({{"name", from, true},
                       {"x_mm", fmt::format("{:.0f}", next.mark->x_mm + 0.0)},
                       {"y_mm", fmt::format("{:.0f}", next.mark->y_mm + 0.0)}});
    }
    for (const std::string& to : next.to) {
      distances.push_back({{"from", from, true},
                           {"to", name_in_file(set, position, to), true},
                           {"distance_mm", ""}});
    }
  }
  return is_json
             ? json_lines("cut, and add to \"holes\"\n", holes) +
                   json_lines("add to \"distances\", replacing each null\n", distances)
             : csv_lines("hole,x_mm,y_mm\n", holes) + csv_lines("from,to,distance_mm\n", distances);
}

}  // namespace chaintrue::cli
