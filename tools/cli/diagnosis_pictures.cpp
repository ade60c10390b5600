// SPDX-License-Identifier: GPL-3.0-or-later
// A picture of each named cause.
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>

#include "grid/diagnosis/causes_fit.hpp"
#include "grid/synthetic/strength.hpp"
#include "model/reading_model.hpp"
#include "tools/cli/diagnosis_sections.hpp"

namespace chaintrue::cli {

namespace {

/// The measured places, without a shift.
struct Places {
  std::vector<model::Visit> visits;
  std::vector<Arrow> arrows;
};

/// Among several sessions, the one with a known order of visits; for holes alone, their commanded
/// places.
Places places_of(const Diagnosis& found) {
  Places places;
  const auto add = [&places](const std::string& name, const MarkPoint& mark, int order) {
    places.visits.push_back({{mark.x_mm, mark.y_mm}, order});
    places.arrows.push_back({.name = name, .x_mm = mark.x_mm, .y_mm = mark.y_mm});
  };
  const bool ordered = has_order(found);
  for (const auto& point : found.points) {
    if (ordered && !point.order) continue;
    add(point_name(point.index), point.mark, point.order.value_or(as_int(places.visits.size())));
  }
  if (!found.points.empty()) return places;
  for (const auto& hole : found.holes)
    add("hole " + hole.name, hole.commanded, as_int(places.visits.size()));
  return places;
}

/// The machine as found, without this cause.
Machine machine_without(const Diagnosis& found, const AppliedEffect& cause) {
  Machine machine = found.extended_machine;
  std::erase_if(machine.effects, [&](const AppliedEffect& effect) {
    return effect.effect == cause.effect && effect.side == cause.side;
  });
  return machine;
}

/// Shift of the tool at each place; empty if a place is out of reach, with or without the cause, or
/// if a file's numbers are impossible: two visits with one number, a size out of range.
std::optional<std::vector<Eigen::Vector2d>> shifts_by(const Diagnosis& found, const Cause& cause,
                                                      const std::vector<model::Visit>& visits) {
  try {
    const AppliedEffect applied = diagnosis::applied(cause);
    const auto shifts =
        synthetic::signature(machine_without(found, applied), {applied}, visits).tool_shift_mm();
    const bool finite = all_of(shifts, [](const auto& shift) { return shift.allFinite(); });
    return finite ? std::optional(shifts) : std::nullopt;
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

Chart chart_of(const Diagnosis& found, const Cause& cause, const Places& places,
               const std::vector<Eigen::Vector2d>& shifts) {
  std::vector<Arrow> arrows = places.arrows;
  double largest_mm = 0.0;
  for (const auto i : each_index(arrows)) {
    arrows[i].dx_mm = shifts[i].x();
    arrows[i].dy_mm = shifts[i].y();
    largest_mm = std::max(largest_mm, shifts[i].norm());
  }
  const report::Outline sheet = bed_of(found);
  Chart chart = arrows_chart(sheet, arrows, magnification_of(sheet, arrows), report::kBeforeColor);
  chart.title = fmt::format("{}: {}", cause_title(cause.cause),
                            sizes_in_words(cause.cause, cause.parameters));
  chart.caption = fmt::format(
      "Error of the tool from this cause alone: {:.1f} mm at most. Computed for the size found, "
      "with unchanged settings.",
      largest_mm);
  return chart;
}

}  // namespace

std::vector<Chart> cause_charts(const Diagnosis& found) {
  const Places places = places_of(found);
  if (found.belts || places.visits.empty()) return {};
  std::vector<Chart> charts;
  for (const Cause& cause : found.causes) {
    if (const auto shifts = shifts_by(found, cause, places.visits))
      charts.push_back(chart_of(found, cause, places, *shifts));
  }
  return charts;
}

}  // namespace chaintrue::cli
