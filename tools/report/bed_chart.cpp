// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/report/bed_chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grid/precondition.hpp"

namespace chaintrue::report {
namespace {

/// The longest arrow of a panel spans this share of the bed's width.
constexpr double kLongestArrow = 0.12;

double width_mm(const Outline& outline) { return outline.x_max_mm - outline.x_min_mm; }

/// The share of the segment from `from` by `way` up to the first of two borders; 1 if it ends
/// before.
double share_within(double from, double way, double low, double high) {
  if (way == 0.0) return 1.0;
  return std::clamp(((way > 0.0 ? high : low) - from) / way, 0.0, 1.0);
}

/// The drawn share of an arrow: a good point's is drawn whole, a bad point's up to the frame.
double shown_of(const Arrow& arrow, const Outline& view, double magnification) {
  if (!arrow.is_bad) return 1.0;
  return std::min(
      share_within(arrow.x_mm, magnification * arrow.dx_mm, view.x_min_mm, view.x_max_mm),
      share_within(arrow.y_mm, magnification * arrow.dy_mm, view.y_min_mm, view.y_max_mm));
}

}  // namespace

double round_down_125(double value) {
  if (!(value > 0.0)) return 0.0;
  const double decade = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {5.0, 2.0}) {
    if (value >= step * decade) return step * decade;
  }
  return decade;
}

Outline view_of(const Outline& sheet, const std::vector<Arrow>& marks) {
  if (!(width_mm(sheet) > 0.0) || !(sheet.y_max_mm > sheet.y_min_mm)) {
    throw grid::precondition("a report needs a sheet with an extent, not x {} to {}, y {} to {} mm",
                             sheet.x_min_mm,
                             sheet.x_max_mm,
                             sheet.y_min_mm,
                             sheet.y_max_mm);
  }
  Outline view = sheet;
  for (const Arrow& mark : marks) {
    view.x_min_mm = std::min(view.x_min_mm, mark.x_mm);
    view.x_max_mm = std::max(view.x_max_mm, mark.x_mm);
    view.y_min_mm = std::min(view.y_min_mm, mark.y_mm);
    view.y_max_mm = std::max(view.y_max_mm, mark.y_mm);
  }
  const double margin_mm = 0.05 * width_mm(sheet);
  return {view.x_min_mm - margin_mm,
          view.x_max_mm + margin_mm,
          view.y_min_mm - margin_mm,
          view.y_max_mm + margin_mm};
}

std::vector<Signal> bed_signals(const Outline& sheet, const std::vector<Arrow>& marks) {
  const Outline view = view_of(sheet, marks);
  return {{"x_min_mm", view.x_min_mm},
          {"x_max_mm", view.x_max_mm},
          {"y_min_mm", view.y_min_mm},
          {"y_max_mm", view.y_max_mm},
          {"sheet_x_min_mm", sheet.x_min_mm},
          {"sheet_x_max_mm", sheet.x_max_mm},
          {"sheet_y_min_mm", sheet.y_min_mm},
          {"sheet_y_max_mm", sheet.y_max_mm}};
}

double magnification_of(const Outline& sheet, const std::vector<Arrow>& arrows) {
  double longest_mm = 0.0;
  for (const Arrow& arrow : arrows) {
    if (!arrow.is_bad) longest_mm = std::max(longest_mm, std::hypot(arrow.dx_mm, arrow.dy_mm));
  }
  return longest_mm > 0.0 ? round_down_125(kLongestArrow * width_mm(sheet) / longest_mm) : 1.0;
}

std::string cut_off_at_frame(const Outline& sheet,
                             const std::vector<Arrow>& arrows,
                             double magnification) {
  const Outline view = view_of(sheet, arrows);
  std::vector<std::string> names;
  for (const Arrow& arrow : arrows) {
    if (shown_of(arrow, view, magnification) == 1.0) continue;
    names.push_back(
        fmt::format("{} ({:.2f} mm)", arrow.name, std::hypot(arrow.dx_mm, arrow.dy_mm)));
  }
  return names.empty() ? "" : fmt::format(" Cut off at the frame: {}.", fmt::join(names, ", "));
}

Chart arrows_chart(const Outline& sheet,
                   const std::vector<Arrow>& arrows,
                   double magnification,
                   const char* color) {
  Chart chart{.specification = "bed_arrows"};
  DataTable table{
      "arrows",
      {"name", "x_mm", "y_mm", "dx_mm", "dy_mm", "is_bad", "noise_x_mm", "noise_y_mm", "shown"},
      {}};
  const Outline view = view_of(sheet, arrows);
  for (const Arrow& arrow : arrows) {
    table.rows.push_back({arrow.name,
                          arrow.x_mm,
                          arrow.y_mm,
                          arrow.dx_mm,
                          arrow.dy_mm,
                          arrow.is_bad,
                          arrow.noise_x_mm,
                          arrow.noise_y_mm,
                          shown_of(arrow, view, magnification)});
  }
  chart.data.push_back(std::move(table));
  chart.signals = bed_signals(sheet, arrows);
  const double key_mm = round_down_125(kLongestArrow * width_mm(sheet) / magnification);
  chart.signals.push_back({"magnification", magnification});
  chart.signals.push_back({"key_mm", key_mm});
  chart.signals.push_back(
      {"key_text", fmt::format("{:g} mm, drawn {:g} times as long", key_mm, magnification)});
  chart.signals.push_back({"color", std::string(color)});
  return chart;
}

std::vector<ChartRow> arrow_rows(const Outline& sheet,
                                 const std::vector<Arrow>& before,
                                 const std::vector<Arrow>& after,
                                 const ArrowWords& words) {
  const auto chart = [&sheet](const std::vector<Arrow>& arrows,
                              double magnification,
                              const char* color,
                              const std::string& title,
                              const std::string& caption) {
    Chart drawn = arrows_chart(sheet, arrows, magnification, color);
    drawn.title = title;
    drawn.caption = caption + cut_off_at_frame(sheet, arrows, magnification);
    return drawn;
  };
  const double coarse = magnification_of(sheet, before), fine = magnification_of(sheet, after);
  std::vector<ChartRow> rows = {
      {{chart(before, coarse, kBeforeColor, words.before, words.before_caption)}}};
  if (after.empty()) return rows;
  rows[0].charts.push_back(chart(after, coarse, kAfterColor, words.after, words.after_caption));
  if (fine >= 2.0 * coarse) {
    rows.push_back({{chart(
        after,
        fine,
        kAfterColor,
        "After, magnified",
        fmt::format(
            "The same arrows, {:g} times larger.{}", fine / coarse, words.close_caption))}});
  }
  return rows;
}

}  // namespace chaintrue::report
