// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Layout of a PathReport.
#include "tools/report/path_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace chaintrue::report {
namespace {

/// The largest drawn correction is this share of the path's own extent, so that it is visible.
constexpr double kDrawnCorrection = 0.05;

/// The least width of the view, so that a single hole has its surroundings.
constexpr double kLeastViewMm = 20.0;
constexpr double kMargin = 0.08;
/// Height by width, so that a chart fits on a screen.
constexpr double kTallest = 0.8;
constexpr double kFlattest = 0.15;

/// The pieces without rapids; all pieces if there is nothing else.
std::vector<PathPiece> cuts_of(const PathReport& report) {
  std::vector<PathPiece> cuts = report.pieces();
  std::erase_if(cuts, [](const PathPiece& piece) { return piece.is_rapid; });
  return cuts.empty() ? report.pieces() : cuts;
}

/// From the smallest correction of the cuts to the largest, at least a hundredth of a millimetre
/// apart, in round numbers.
struct Colours {
  double least_mm = 0.0;
  double largest_mm = 1.0;
};
Colours colours_of(const std::vector<PathPiece>& cuts) {
  if (cuts.empty()) return {};
  double least = 1e9, most = 0.0;
  for (const PathPiece& piece : cuts) {
    for (const ToolVector& end : {piece.correction0, piece.correction1}) {
      least = std::min(least, end.length_mm());
      most = std::max(most, end.length_mm());
    }
  }
  const double step = std::pow(10.0, std::floor(std::log10(std::max(most - least, 0.01)))) / 2.0;
  return {step * std::floor(least / step), step * std::ceil(most / step + 1e-9)};
}

/// At least `least` between the ends, about their middle.
void stretch(double& low, double& high, double least) {
  const double missing = least - (high - low);
  if (missing <= 0.0) return;
  low -= 0.5 * missing;
  high += 0.5 * missing;
}

/// What the cuts reach, before and after; the sheet if there are none.
Outline part_of(const PathReport& report, const std::vector<PathPiece>& cuts,
                double magnification) {
  if (cuts.empty()) return report.sheet;
  Outline part{1e9, -1e9, 1e9, -1e9};
  const auto include = [&](double x_mm, double y_mm, const ToolVector& correction) {
    part.include(x_mm, y_mm);
    part.include(x_mm + magnification * correction.x_mm, y_mm + magnification * correction.y_mm);
  };
  for (const PathPiece& piece : cuts) {
    include(piece.x0_mm, piece.y0_mm, piece.correction0);
    include(piece.x1_mm, piece.y1_mm, piece.correction1);
  }
  return part;
}

double extent_mm(const Outline& part) {
  return std::max({part.width_mm(), part.height_mm(), kLeastViewMm});
}

/// The part with a margin, in an aspect ratio that fits a page.
Outline view_around(const Outline& part) {
  Outline view = part.widened(kMargin * extent_mm(part));
  stretch(view.x_min_mm, view.x_max_mm, view.height_mm() / kTallest);
  stretch(view.y_min_mm, view.y_max_mm, view.width_mm() * kFlattest);
  return view;
}

/// A cut is drawn in parts of this share of the view, so that its colour follows the correction
/// along it.
constexpr double kColouredShare = 1.0 / 60.0;

void add_rows(DataTable& table, const PathPiece& piece, const Outline& view, std::size_t pieces) {
  // If there are many pieces they are short, or the page has its limit of pieces.
  const bool is_whole = piece.is_rapid || pieces > PathReport::kMostPieces / 60;
  const double length = std::hypot(piece.x1_mm - piece.x0_mm, piece.y1_mm - piece.y0_mm);
  const int parts =
      is_whole ? 1
               : std::clamp(static_cast<int>(length / (kColouredShare * view.width_mm())), 1, 60);
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

double magnification_of(const PathReport& report, const std::vector<PathPiece>& cuts) {
  double largest = 0.0;
  for (const PathPiece& piece : report.pieces())
    largest = std::max(largest, piece.correction1.length_mm());
  if (!(largest > 0.0)) return 1.0;
  const double extent = extent_mm(part_of(report, cuts, 0.0));
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
  report.sheet.require_extent();
  const std::vector<PathPiece> cuts = cuts_of(report);
  const double magnification = magnification_of(report, cuts);
  const Outline view = view_around(part_of(report, cuts, magnification));
  const Colours colours = colours_of(cuts);
  DataTable table{"pieces",
                  {"line", "is_rapid", "x0_mm", "y0_mm", "x1_mm", "y1_mm", "dx0_mm", "dy0_mm",
                   "dx1_mm", "dy1_mm"}};
  for (const PathPiece& piece : report.pieces())
    add_rows(table, piece, view, report.pieces().size());
  const Chart chart{
      .specification = "gcode_path",
      .title = "The path before and after",
      .caption = fmt::format(
          "Grey: the intended path, as the program commanded it. Coloured: the compensated path, "
          "with its distance from the grey one drawn {:g} times as large. Dashed: rapids. The "
          "picture shows the cuts, X {:.0f} to {:.0f} and Y {:.0f} to {:.0f} mm of the sheet; the "
          "sheet is tinted.{}",
          magnification, view.x_min_mm, view.x_max_mm, view.y_min_mm, view.y_max_mm,
          report.stride() > 1 ? fmt::format(" One piece in {} is drawn.", report.stride()) : ""),
      .data = {std::move(table)},
      .signals = view_signals(view, report.sheet,
                              {{"magnification", magnification},
                               {"least_mm", colours.least_mm},
                               {"largest_mm", colours.largest_mm}})};
  return {.title = fmt::format("{}, compensated", report.name),
          .verdict = {report.verdict},
          .sections = {{"The part", {chart}}, {"In numbers", {Figures{report.figures}}}}};
}

}  // namespace chaintrue::report
