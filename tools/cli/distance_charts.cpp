// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/cli/diagnosis_sections.hpp"
#include "tools/cli/map_words.hpp"
#include "tools/cli/sheet.hpp"

namespace chaintrue::cli {
namespace {

using diagnosis::DistancePicture;

constexpr double kWidestPx = 9.0;
constexpr double kThinPx = 1.2;

struct Ends {
  MarkPoint from;
  MarkPoint to;
};

/// The place of a hole, or of an edge next to another place; an unknown name gets that place.
MarkPoint place_of(const Diagnosis& found, const std::string& name, const MarkPoint& alongside) {
  for (const auto& hole : found.holes) {
    if (hole.name == name) return hole.mark;
  }
  const auto edge = grid::edge_of(name);
  if (!edge) return alongside;
  return identity_placement(
      on_edge(identity_placement(alongside), *edge, found.extended_machine.bed));
}

Ends ends_of(const Diagnosis& found, const DistancePicture& distance) {
  const MarkPoint from = place_of(found, distance.from, {});
  return {from, place_of(found, distance.to, from)};
}

std::vector<Arrow> marks_of(const Diagnosis& found) {
  return mapped(found.holes, [](const auto& hole) {
    return Arrow{.name = hole.name, .x_mm = hole.mark.x_mm, .y_mm = hole.mark.y_mm};
  });
}

struct DistancePanel {
  std::string title;
  double DistancePicture::*residual;
};

ErrorSummary summary_of(const Diagnosis& found, double DistancePicture::*residual) {
  return summary_of_good(found.distances,
                         [&](const DistancePicture& distance) { return distance.*residual; });
}

/// The panels' tables, filled one by one.
class Panels {
 public:
  explicit Panels(const Diagnosis& found) : found_(found) {}

  /// A panel with its holes; lines are drawn in the one begun last.
  void begin(const std::string& title, const std::string& note) {
    number_ = as_double(heads_.rows.size());
    heads_.rows.push_back({number_, title, note});
    for (const auto& hole : found_.holes)
      holes_.rows.push_back({number_, hole.name, hole.mark.x_mm, hole.mark.y_mm});
  }
  void hole(const std::string& name, const MarkPoint& at) {
    holes_.rows.push_back({number_, name, at.x_mm, at.y_mm});
    marks_.push_back({.x_mm = at.x_mm, .y_mm = at.y_mm});
  }
  void line(const Ends& ends, const std::string& name, const std::string& text,
            const std::string& color, double width_px, bool is_bad) {
    lines_.rows.push_back({number_, name, ends.from.x_mm, ends.from.y_mm, ends.to.x_mm,
                           ends.to.y_mm, text, color, width_px, is_bad});
  }
  Chart finish(Chart chart) {
    chart.specification = "hole_distances";
    std::vector<Arrow> marks = marks_of(found_);
    append_all(marks, marks_);
    chart.signals = bed_signals(bed_of(found_), marks);
    chart.signals.push_back({"panels", as_double(heads_.rows.size())});
    chart.data = {std::move(heads_), std::move(lines_), std::move(holes_)};
    return chart;
  }

 private:
  const Diagnosis& found_;
  double number_ = 0.0;
  std::vector<Arrow> marks_;
  DataTable heads_{"heads", {"panel", "title", "note"}};
  DataTable lines_{
      "lines",
      {"panel", "name", "x1_mm", "y1_mm", "x2_mm", "y2_mm", "text", "color", "width_px", "is_bad"}};
  DataTable holes_{"holes", {"panel", "name", "x_mm", "y_mm"}};
};

Chart residual_panels(const Diagnosis& found, const std::vector<DistancePanel>& panels,
                      std::string title) {
  double full_mm = 0.0, noise_mm = 0.0;
  for (const DistancePanel& panel : panels)
    full_mm = std::max(full_mm, summary_of(found, panel.residual).maximum_mm);
  Panels drawn(found);
  for (const DistancePanel& panel : panels) {
    drawn.begin(panel.title,
                fmt::format("rms {:.2f} mm", summary_of(found, panel.residual).rms_mm));
    for (const DistancePicture& distance : found.distances) {
      const double mm = distance.*panel.residual;
      noise_mm = std::max(noise_mm, distance.noise_sigma_mm);
      const double share = std::min(1.0, std::abs(mm) / std::max(full_mm, 1e-9));
      drawn.line(ends_of(found, distance), words_of_ends(distance), fixed(mm, 2) + " mm",
                 mm < 0.0 ? report::kAfterColor : report::kBeforeColor,
                 std::max(kThinPx, kWidestPx * share), distance.bad);
    }
  }
  return drawn.finish(
      {.title = std::move(title),
       .caption = fmt::format(
           "Vermilion: more was read than predicted; blue: less. The widest lines are off by "
           "{:.2f} mm; one sigma of the noise is up to {:.2f} mm. Dashed: left out.",
           full_mm, noise_mm)});
}

/// Dots of one kind against something of the distance. \param chart its titles
Chart scatter_chart(const Diagnosis& found, ResidualScatter chart,
                    double (*x_of)(const DistancePicture&, const Ends&)) {
  const bool has_after = !found.causes.empty();
  chart.least_span_mm = 0.5;
  chart.first_label = "calibrated";
  chart.second_label = has_after ? "with the cause" : "";
  for (const DistancePicture& distance : found.distances) {
    const double x = x_of(distance, ends_of(found, distance));
    const auto add = [&](double mm, bool is_first) {
      chart.dots.push_back({words_of_ends(distance), x, mm, is_first, distance.bad});
    };
    add(distance.before_mm, true);
    if (has_after) add(distance.after_mm, false);
  }
  return residual_scatter_chart(chart);
}

}  // namespace

Chart distance_chart(const Diagnosis& found) {
  std::vector<DistancePanel> panels = {
      {"Before: the machine calibrated", &DistancePicture::before_mm}};
  if (!found.causes.empty())
    panels.push_back({"After: with what was named", &DistancePicture::after_mm});
  return residual_panels(found, panels, "The distances, read minus expected");
}

Chart distance_strip_chart(const Diagnosis& found) {
  std::vector<DistancePanel> panels = {{"Measured", &DistancePicture::before_mm}};
  panels.push_back({title_of_causes(found), &DistancePicture::best_mm});
  if (found.causes.front().rival)
    panels.push_back({title_of_rival(found), &DistancePicture::rival_mm});
  panels.push_back({"What is left", &DistancePicture::after_mm});
  return residual_panels(found, panels, "Distance by distance");
}

ChartRow distance_scatter_charts(const Diagnosis& found) {
  return {{scatter_chart(
               found,
               {"Against the distance's length",
                "A slope means a scale error: the tape, or both chains, are too long or short.",
                "distance, mm"},
               [](const DistancePicture& d, const Ends&) { return d.read_mm; }),
           scatter_chart(found, {"Against the tape's direction", "", "degrees from the horizontal"},
                         [](const DistancePicture&, const Ends& ends) {
                           return std::atan2(std::abs(ends.to.y_mm - ends.from.y_mm),
                                             std::abs(ends.to.x_mm - ends.from.x_mm)) *
                                  180.0 / std::numbers::pi;
                         })}};
}

Chart next_distances_chart(const Diagnosis& found) {
  Panels drawn(found);
  drawn.begin("Next, on the bed", "");
  for (const DistancePicture& distance : found.distances)
    drawn.line(ends_of(found, distance), words_of_ends(distance), "measured", report::kNeutralColor,
               kThinPx, false);
  for (const auto i : each_index(found.next_measurements)) {
    const NextMeasurement& next = found.next_measurements[i];
    const std::string number = fmt::format("{}.", i + 1);
    const MarkPoint from = next.mark ? *next.mark : place_of(found, next.from, {});
    if (next.mark) drawn.hole(number, from);
    for (const std::string& to : next.to)
      drawn.line({from, place_of(found, to, from)}, fmt::format("{} {}", number, next.words),
                 "to be measured", report::kAfterColor, 3.0, false);
  }
  return drawn.finish({.title = "What to measure",
                       .caption = "Blue: to be measured; holes to be cut, numbered as in the "
                                  "table. Grey: already measured."});
}

}  // namespace chaintrue::cli
