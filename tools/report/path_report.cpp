// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Lays a PathReport out.
#include "tools/report/path_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace chaintrue::report {
namespace {

/// The largest drawn correction spans this share of the path's own extent, so that it can be seen.
constexpr double kDrawnCorrection = 0.05;

double size_mm(const ToolVector& vector) { return std::hypot(vector.x_mm, vector.y_mm); }

double largest_mm(const PathReport& report) {
  double largest = 0.0;
  for (const PathPiece& piece : report.pieces())
    largest = std::max(largest, size_mm(piece.correction1));
  return largest;
}

/// Sheet and path, with a margin.
Outline view_of(const PathReport& report) {
  Outline view = report.sheet;
  if (!(view.x_max_mm > view.x_min_mm) || !(view.y_max_mm > view.y_min_mm)) {
    throw std::invalid_argument(
        fmt::format("a report needs a sheet with an extent, not x {} to {}, y {} to {} mm",
                    view.x_min_mm,
                    view.x_max_mm,
                    view.y_min_mm,
                    view.y_max_mm));
  }
  for (const PathPiece& piece : report.pieces()) {
    view.x_min_mm = std::min(view.x_min_mm, piece.x1_mm);
    view.x_max_mm = std::max(view.x_max_mm, piece.x1_mm);
    view.y_min_mm = std::min(view.y_min_mm, piece.y1_mm);
    view.y_max_mm = std::max(view.y_max_mm, piece.y1_mm);
  }
  const double margin = 0.03 * (view.x_max_mm - view.x_min_mm);
  return {view.x_min_mm - margin,
          view.x_max_mm + margin,
          view.y_min_mm - margin,
          view.y_max_mm + margin};
}

double magnification_of(const PathReport& report, const Outline& view) {
  const double largest = largest_mm(report);
  if (!(largest > 0.0)) return 1.0;
  const double wished = kDrawnCorrection * (view.y_max_mm - view.y_min_mm) / largest;
  return std::max(1.0, std::floor(wished));
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

Page page_of(const PathReport& report) {
  const Outline view = view_of(report);
  const double magnification = magnification_of(report, view);
  Chart chart{.specification = "gcode_path"};
  chart.title = "The path before and after";
  chart.caption = fmt::format(
      "Grey: where the tool shall go, which is what the program commanded before. Coloured: what "
      "is commanded now, its "
      "distance from the grey path drawn {:g} times as large. Dashed: rapids.{}",
      magnification,
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
    table.rows.push_back({static_cast<double>(piece.line),
                          piece.is_rapid,
                          piece.x0_mm,
                          piece.y0_mm,
                          piece.x1_mm,
                          piece.y1_mm,
                          piece.correction0.x_mm,
                          piece.correction0.y_mm,
                          piece.correction1.x_mm,
                          piece.correction1.y_mm});
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
                   {"largest_mm", std::max(largest_mm(report), 1e-3)}};
  Page page{.title = fmt::format("{}, compensated", report.name)};
  page.verdict = report.verdict;
  page.sections.push_back({"On the bed", {chart}});
  page.sections.push_back({"In numbers", {Figures{report.figures}}});
  return page;
}

}  // namespace chaintrue::report
