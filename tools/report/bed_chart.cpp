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

/// The sheet and the marks.
Outline view_of(const Outline& sheet, const std::vector<Arrow>& marks) {
  sheet.require_extent();
  Outline view = sheet;
  for (const Arrow& mark : marks) view.include(mark.x_mm, mark.y_mm);
  return view.widened(0.05 * sheet.width_mm());
}

double length_mm(const Arrow& arrow) { return std::hypot(arrow.dx_mm, arrow.dy_mm); }

}  // namespace

void Outline::include(double x_mm, double y_mm) {
  x_min_mm = std::min(x_min_mm, x_mm);
  x_max_mm = std::max(x_max_mm, x_mm);
  y_min_mm = std::min(y_min_mm, y_mm);
  y_max_mm = std::max(y_max_mm, y_mm);
}

Outline Outline::widened(double margin_mm) const {
  return {x_min_mm - margin_mm, x_max_mm + margin_mm, y_min_mm - margin_mm, y_max_mm + margin_mm};
}

void Outline::require_extent() const {
  if (width_mm() > 0.0 && height_mm() > 0.0) return;
  throw grid::precondition("a report needs a sheet with an extent, not x {} to {}, y {} to {} mm",
                           x_min_mm, x_max_mm, y_min_mm, y_max_mm);
}

double round_down_125(double value) {
  if (!(value > 0.0)) return 0.0;
  const double decade = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {5.0, 2.0}) {
    if (value >= step * decade) return step * decade;
  }
  return decade;
}

std::vector<Signal> view_signals(const Outline& view, const Outline& sheet,
                                 const std::vector<Signal>& others) {
  std::vector<Signal> signals = {
      {"x_min_mm", view.x_min_mm},        {"x_max_mm", view.x_max_mm},
      {"y_min_mm", view.y_min_mm},        {"y_max_mm", view.y_max_mm},
      {"sheet_x_min_mm", sheet.x_min_mm}, {"sheet_x_max_mm", sheet.x_max_mm},
      {"sheet_y_min_mm", sheet.y_min_mm}, {"sheet_y_max_mm", sheet.y_max_mm}};
  signals.insert(signals.end(), others.begin(), others.end());
  return signals;
}

std::vector<Signal> bed_signals(const Outline& sheet, const std::vector<Arrow>& marks) {
  return view_signals(view_of(sheet, marks), sheet);
}

double magnification_of(const Outline& sheet, const std::vector<Arrow>& arrows) {
  double longest_mm = 0.0;
  for (const Arrow& arrow : arrows) {
    if (!arrow.is_bad) longest_mm = std::max(longest_mm, length_mm(arrow));
  }
  return longest_mm > 0.0 ? round_down_125(kLongestArrow * sheet.width_mm() / longest_mm) : 1.0;
}

Chart arrows_chart(const Outline& sheet, const std::vector<Arrow>& arrows, double magnification,
                   const char* color) {
  DataTable table{
      "arrows",
      {"name", "x_mm", "y_mm", "dx_mm", "dy_mm", "is_bad", "noise_x_mm", "noise_y_mm", "shown"}};
  const Outline view = view_of(sheet, arrows);
  std::vector<std::string> cut;
  for (const Arrow& arrow : arrows) {
    const double shown = shown_of(arrow, view, magnification);
    if (shown != 1.0) cut.push_back(fmt::format("{} ({:.2f} mm)", arrow.name, length_mm(arrow)));
    table.rows.push_back({arrow.name, arrow.x_mm, arrow.y_mm, arrow.dx_mm, arrow.dy_mm,
                          arrow.is_bad, arrow.noise_x_mm, arrow.noise_y_mm, shown});
  }
  const double key_mm = round_down_125(kLongestArrow * sheet.width_mm() / magnification);
  const std::string key = fmt::format("{:g} mm, drawn {:g} times as long", key_mm, magnification);
  return {
      .specification = "bed_arrows",
      .caption = cut.empty() ? "" : fmt::format(" Cut off at the frame: {}.", fmt::join(cut, ", ")),
      .data = {std::move(table)},
      .signals = view_signals(view, sheet,
                              {{"magnification", magnification},
                               {"key_mm", key_mm},
                               {"key_text", key},
                               {"color", std::string(color)}})};
}

std::vector<ChartRow> arrow_rows(const Outline& sheet, const std::vector<Arrow>& before,
                                 const std::vector<Arrow>& after, const ArrowWords& words) {
  const auto chart = [&sheet](const std::vector<Arrow>& arrows, double magnification,
                              const char* color, const std::string& title,
                              const std::string& caption) {
    Chart drawn = arrows_chart(sheet, arrows, magnification, color);
    drawn.title = title;
    drawn.caption.insert(0, caption);
    return drawn;
  };
  const double coarse = magnification_of(sheet, before), fine = magnification_of(sheet, after);
  std::vector<ChartRow> rows = {
      {{chart(before, coarse, kBeforeColor, words.before, words.before_caption)}}};
  if (after.empty()) return rows;
  rows[0].charts.push_back(chart(after, coarse, kAfterColor, words.after, words.after_caption));
  if (fine >= 2.0 * coarse) {
    rows.push_back({{chart(after, fine, kAfterColor, "After, magnified",
                           fmt::format("The same arrows, {:g} times larger.{}", fine / coarse,
                                       words.close_caption))}});
  }
  return rows;
}

}  // namespace chaintrue::report
