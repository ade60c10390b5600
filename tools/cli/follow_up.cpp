// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/follow_up.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
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
    fmt::format_to(
        std::back_inserter(text), "{:>3}. {}{}\n", i + 1, sentences[i], chance_then(found, i));
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
    fmt::format_to(std::back_inserter(points),
                   "  {{\"x_mm\": {:.1f}, \"y_mm\": {:.1f}, {}{}}},\n",
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
    fmt::format_to(std::back_inserter(text),
                   "{:.1f},{:.1f},,{}\n",
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
    fmt::format_to(std::back_inserter(readings),
                   "  {{\"what\": \"{}\"{}, \"value\": null, \"sigma\": {}}},\n",
                   name(next.reading.value()),
                   next.side.empty() ? "" : fmt::format(", \"side\": \"{}\"", next.side),
                   next.sigma > 0.0 ? fmt::format("{:g}", next.sigma) : "null");
  }
  return readings.empty() ? readings : "add to \"readings\", replacing each null\n" + readings;
}

}  // namespace chaintrue::cli
