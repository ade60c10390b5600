// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Layout of a PathReport.
#include "tools/report/path_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "grid/precondition.hpp"

namespace chaintrue::report {
namespace {

/// The largest drawn correction is this share of the path's own extent, so that it is visible.
constexpr double kDrawnCorrection = 0.05;

double size_mm(const ToolVector& vector) { return std::hypot(vector.x_mm, vector.y_mm); }

/// The least width of the view, so that a single hole has its surroundings.
constexpr double kLeastViewMm = 20.0;
constexpr double kMargin = 0.08;
/// Height by width, so that a chart fits on a screen.
constexpr double kTallest = 0.8;
constexpr double kFlattest = 0.15;

double largest_mm(const PathReport& report) {
  double largest = 0.0;
  for (const PathPiece& piece : report.pieces())
    largest = std::max(largest, size_mm(piece.correction1));
  return largest;
}

/// From the smallest correction of the cuts to the largest, at least a hundredth of a millimetre
/// apart, in round numbers.
struct Colours {
  double least_mm = 0.0;
  double largest_mm = 0.0;
};
Colours colours_of(const PathReport& report, bool rapids) {
  double least = 1e9;
  double most = 0.0;
  for (const PathPiece& piece : report.pieces()) {
    if (piece.is_rapid != rapids) continue;
    for (const ToolVector& end : {piece.correction0, piece.correction1}) {
      least = std::min(least, size_mm(end));
      most = std::max(most, size_mm(end));
    }
  }
  if (least > most) return rapids ? Colours{0.0, 1.0} : colours_of(report, true);
  const double step = std::pow(10.0, std::floor(std::log10(std::max(most - least, 0.01)))) / 2.0;
  return {step * std::floor(least / step), step * std::ceil(most / step + 1e-9)};
}

void widen(Outline& view, double x_mm, double y_mm) {
  view.x_min_mm = std::min(view.x_min_mm, x_mm);
  view.x_max_mm = std::max(view.x_max_mm, x_mm);
  view.y_min_mm = std::min(view.y_min_mm, y_mm);
  view.y_max_mm = std::max(view.y_max_mm, y_mm);
}

/// At least `least` between the ends, about their middle.
void stretch(double& low, double& high, double least) {
  const double missing = least - (high - low);
  if (missing <= 0.0) return;
  low -= 0.5 * missing;
  high += 0.5 * missing;
}

/// The cuts; the whole path if there are none.
Outline part_of(const PathReport& report, double magnification) {
  Outline view{1e9, -1e9, 1e9, -1e9};
  for (const bool rapids : {false, true}) {
    for (const PathPiece& piece : report.pieces()) {
      if (piece.is_rapid && !rapids) continue;
      widen(view, piece.x0_mm, piece.y0_mm);
      widen(view, piece.x1_mm, piece.y1_mm);
      widen(view,
            piece.x0_mm + magnification * piece.correction0.x_mm,
            piece.y0_mm + magnification * piece.correction0.y_mm);
      widen(view,
            piece.x1_mm + magnification * piece.correction1.x_mm,
            piece.y1_mm + magnification * piece.correction1.y_mm);
    }
    if (view.x_min_mm <= view.x_max_mm) break;
  }
  return view.x_min_mm <= view.x_max_mm ? view : report.sheet;
}

/// The part with a margin, in an aspect ratio that fits a page.
Outline view_of(const PathReport& report, double magnification) {
  if (!(report.sheet.x_max_mm > report.sheet.x_min_mm) ||
      !(report.sheet.y_max_mm > report.sheet.y_min_mm)) {
    throw grid::precondition("a report needs a sheet with an extent, not x {} to {}, y {} to {} mm",
                             report.sheet.x_min_mm,
                             report.sheet.x_max_mm,
                             report.sheet.y_min_mm,
                             report.sheet.y_max_mm);
  }
  Outline view = part_of(report, magnification);
  const double margin =
      kMargin *
      std::max({view.x_max_mm - view.x_min_mm, view.y_max_mm - view.y_min_mm, kLeastViewMm});
  view = {view.x_min_mm - margin,
          view.x_max_mm + margin,
          view.y_min_mm - margin,
          view.y_max_mm + margin};
  stretch(view.x_min_mm, view.x_max_mm, (view.y_max_mm - view.y_min_mm) / kTallest);
  stretch(view.y_min_mm, view.y_max_mm, (view.x_max_mm - view.x_min_mm) * kFlattest);
  return view;
}

/// A cut is drawn in parts of this share of the view, so that its colour follows the correction
/// along it.
constexpr double kColouredShare = 1.0 / 60.0;

int parts_of(const PathPiece& piece, const Outline& view, std::size_t pieces) {
  // If there are many pieces they are short, or the page has its limit of pieces.
  if (piece.is_rapid || pieces > PathReport::kMostPieces / 60) return 1;
  const double length = std::hypot(piece.x1_mm - piece.x0_mm, piece.y1_mm - piece.y0_mm);
  return std::clamp(
      static_cast<int>(length / (kColouredShare * (view.x_max_mm - view.x_min_mm))), 1, 60);
}

void add_rows(DataTable& table, const PathPiece& piece, int parts) {
  const auto row = [&](int i) {
    const double t = static_cast<double>(i) / parts;
    return std::array{
        piece.x0_mm + t * (piece.x1_mm - piece.x0_mm),
        piece.y0_mm + t * (piece.y1_mm - piece.y0_mm),
        piece.correction0.x_mm + t * (piece.correction1.x_mm - piece.correction0.x_mm),
        piece.correction0.y_mm + t * (piece.correction1.y_mm - piece.correction0.y_mm)};
  };
  for (int i = 0; i < parts; ++i) {
    const auto [x0, y0, dx0, dy0] = row(i);
    const auto [x1, y1, dx1, dy1] = row(i + 1);
    table.rows.push_back(
        {static_cast<double>(piece.line), piece.is_rapid, x0, y0, x1, y1, dx0, dy0, dx1, dy1});
  }
}

double magnification_of(const PathReport& report) {
  const double largest = largest_mm(report);
  if (!(largest > 0.0)) return 1.0;
  const Outline part = part_of(report, 0.0);
  const double extent =
      std::max({part.x_max_mm - part.x_min_mm, part.y_max_mm - part.y_min_mm, kLeastViewMm});
  return std::max(1.0, std::floor(kDrawnCorrection * extent / largest));
}

}  // namespace

void PathReport::add(const PathPiece& piece) {
  if (seen_++ % stride_ != 0) return;
  pieces_.push_back(piece);
  if (pieces_.size() < kMostPieces) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < pieces_.size(); i += 2) pieces_[kept++] = pieces_[i];
  pieces_.resize(kept);
  stride_ *= 2;
}

Document page_of(const PathReport& report) {
  const double magnification = magnification_of(report);
  const Outline view = view_of(report, magnification);
  const Colours colours = colours_of(report, false);
  Chart chart{.specification = "gcode_path"};
  chart.title = "The path before and after";
  chart.caption = fmt::format(
      "Grey: the intended path, as the program commanded it. Coloured: the compensated path, with "
      "its distance from the grey one drawn {:g} times as large. Dashed: rapids. The picture shows "
      "the cuts, X {:.0f} to {:.0f} and Y {:.0f} to {:.0f} mm of the sheet; the sheet is tinted.{}",
      magnification,
      view.x_min_mm,
      view.x_max_mm,
      view.y_min_mm,
      view.y_max_mm,
      report.stride() > 1 ? fmt::format(" One piece in {} is drawn.", report.stride())
                          : std::string());
  DataTable table{"pieces",
                  {"line",
                   "is_rapid",
                   "x0_mm",
                   "y0_mm",
                   "x1_mm",
                   "y1_mm",
                   "dx0_mm",
                   "dy0_mm",
                   "dx1_mm",
                   "dy1_mm"},
                  {}};
  for (const PathPiece& piece : report.pieces()) {
    add_rows(table, piece, parts_of(piece, view, report.pieces().size()));
  }
  chart.data.push_back(std::move(table));
  chart.signals = {{"x_min_mm", view.x_min_mm},
                   {"x_max_mm", view.x_max_mm},
                   {"y_min_mm", view.y_min_mm},
                   {"y_max_mm", view.y_max_mm},
                   {"sheet_x_min_mm", report.sheet.x_min_mm},
                   {"sheet_x_max_mm", report.sheet.x_max_mm},
                   {"sheet_y_min_mm", report.sheet.y_min_mm},
                   {"sheet_y_max_mm", report.sheet.y_max_mm},
                   {"magnification", magnification},
                   {"least_mm", colours.least_mm},
                   {"largest_mm", colours.largest_mm}};
  Document page{.title = fmt::format("{}, compensated", report.name)};
  page.verdict = {report.verdict};
  page.sections.push_back({"The part", {chart}});
  page.sections.push_back({"In numbers", {Figures{report.figures}}});
  return page;
}

}  // namespace chaintrue::report
