// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Shared by every chart of the bed: its outline, the window around it, and arrows on it.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "tools/report/document.hpp"

namespace chaintrue::report {

/// An error of the tool's position.
struct ToolVector {
  double x_mm = 0.0;
  double y_mm = 0.0;

  double length_mm() const { return std::hypot(x_mm, y_mm); }
};

/// The sheet, or its measured part.
struct Outline {
  double x_min_mm = 0.0;
  double x_max_mm = 0.0;
  double y_min_mm = 0.0;
  double y_max_mm = 0.0;

  double width_mm() const { return x_max_mm - x_min_mm; }
  double height_mm() const { return y_max_mm - y_min_mm; }
  void include(double x_mm, double y_mm);
  /// Returns the outline with a margin added on every side.
  Outline widened(double margin_mm) const;
  /// \throws std::invalid_argument for one without an extent.
  void require_extent() const;
};

/// The colours of every chart, page and sheet, from Okabe and Ito's palette, which is
/// distinguishable with every colour vision. tests/report checks the chart specifications, the
/// page's style and Python against this list.
inline constexpr const char* kBeforeColor = "#d55e00";  ///< correct, too long, a bad reading
inline constexpr const char* kAfterColor = "#0072b2";   ///< with the map or the causes, too short
inline constexpr const char* kThirdColor =
    "#009e73";  ///< another way of reading: an edge, chain paid out
inline constexpr const char* kFourthColor = "#cc79a7";   ///< its opposite: chain taken in
inline constexpr const char* kNeutralColor = "#8a94a3";  ///< a reference, what is not named

/// A shift of the tool at a mark.
struct Arrow {
  std::string name{};
  double x_mm = 0.0;
  double y_mm = 0.0;
  double dx_mm = 0.0;
  double dy_mm = 0.0;
  bool is_bad = false;
  /// One sigma of the shift, drawn as an ellipse at the mark; 0: not drawn.
  double noise_x_mm = 0.0;
  double noise_y_mm = 0.0;
};

/// The largest of 1, 2, 5, 10, ... (and 0.5, 0.2, ...) not above value; 0 for 0.
double round_down_125(double value);

/// The signals declared by the charts of the bed, and others after them.
std::vector<Signal> view_signals(const Outline& view, const Outline& sheet,
                                 const std::vector<Signal>& others = {});
/// The view shows the sheet and the marks, with a margin of 5 % of the sheet's width.
/// \throws std::invalid_argument for a sheet without an extent.
std::vector<Signal> bed_signals(const Outline& sheet, const std::vector<Arrow>& marks);

/// The magnification at which the longest arrow of a good point spans an eighth of the bed; 1 if
/// all have zero length.
double magnification_of(const Outline& sheet, const std::vector<Arrow>& arrows);
/// charts/bed_arrows without a title; the scale is printed in the chart. The arrow of a bad point, which does not
/// count for the scale, ends at the frame, and the caption names it with its length:
/// " Cut off at the frame: point 9 (25.40 mm)."
Chart arrows_chart(const Outline& sheet, const std::vector<Arrow>& arrows, double magnification,
                   const char* color);
/// Texts of the charts before and after.
struct ArrowWords {
  std::string before, before_caption, after, after_caption;
  /// Preceded by the magnification of the arrows.
  std::string close_caption{};
};
/// Before and after at one scale, and after once more if it is much smaller; only before if there
/// is nothing after.
std::vector<ChartRow> arrow_rows(const Outline& sheet, const std::vector<Arrow>& before,
                                 const std::vector<Arrow>& after, const ArrowWords& words);

}  // namespace chaintrue::report
