// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/plotter/drawing_slips.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "grid/statistics.hpp"

namespace chaintrue::grid {
namespace {

using observation::DrawnMeasure;

// Zeros that are five sigmas off, 50 mm, draw 800 mm wrong by less.
constexpr double kMostMachineShare = 0.08;
// How far lengths that share one factor are from it: settings that are off bend the page by so much.
constexpr double kSameFactor = 0.03;
// A page that was fitted to its sheet is smaller by more; pins and pulleys are known better.
constexpr double kFittedToSheet = 0.012;
// How well both are found.
constexpr double kSameShare = 0.005;
// No line bows by a fifth of its length that a cord could still draw.
constexpr double kMostBowShare = 0.2;
constexpr double kMmPerInch = 25.4;

/// Measured over drawn, of the lengths.
std::vector<double> shares_of(const TestDrawing& drawing, const Eigen::VectorXd& drawn) {
  std::vector<double> shares;
  for (std::size_t i = 0; i < drawing.measures.size(); ++i) {
    if (drawing.measures[i].kind != DrawnMeasure::Kind::length) continue;
    shares.push_back(drawing.measures[i].value_mm / drawn[static_cast<Eigen::Index>(i)]);
  }
  return shares;
}

DrawingFailure scaled_page(double factor) {
  return {
      DrawingFailure::Reason::scaled_when_printed,
      fmt::format("all lengths are {:.3f} times what was commanded, more than a plotter's "
                  "settings do and the same in every direction: the page was scaled, when it was "
                  "printed or when it was sent to the plotter. Draw it at 100 % and measure that",
                  factor)};
}

std::optional<DrawingFailure> wrong_unit(const TestDrawing& drawing, const Eigen::VectorXd& drawn) {
  const std::vector<double> shares = shares_of(drawing, drawn);
  if (shares.empty()) return std::nullopt;
  const double factor = median(shares);
  if (std::abs(factor * kMmPerInch - 1.0) < kMostMachineShare) {
    return DrawingFailure{
        DrawingFailure::Reason::inches,
        fmt::format("the lengths are {:.4f} of what was commanded, as if they were read in inches; "
                    "write millimetres (inches times 25.4)",
                    factor)};
  }
  std::vector<double> off;
  for (const double share : shares) off.push_back(std::abs(share / factor - 1.0));
  if (std::abs(factor - 1.0) <= kMostMachineShare || median(off) > kSameFactor) return std::nullopt;
  return scaled_page(factor);
}

}  // namespace

std::optional<DrawingFailure> slip_before_fit(const TestDrawing& drawing,
                                              const Eigen::VectorXd& as_set) {
  for (std::size_t i = 0; i < drawing.measures.size(); ++i) {
    const DrawnMeasure& own = drawing.measures[i];
    if (own.kind != DrawnMeasure::Kind::bow) continue;
    const model::BedPoint a = drawing.crosses.at(own.from).commanded;
    const model::BedPoint b = drawing.crosses.at(own.to).commanded;
    const double length = std::hypot(b.x_mm - a.x_mm, b.y_mm - a.y_mm);
    if (std::abs(own.value_mm) <= kMostBowShare * length) continue;
    return DrawingFailure{
        DrawingFailure::Reason::bow_is_a_length,
        fmt::format("{} is {:.1f} mm, and the line is {:.0f} mm long: that is a length along the "
                    "line. Hold a string from one end to the other and measure from the string "
                    "across to the line at its middle",
                    words_of(drawing, i),
                    own.value_mm,
                    length)};
  }
  return wrong_unit(drawing, as_set);
}

std::optional<DrawingFailure> scaled_page_of(const model::PlotterMachine& stated,
                                             const model::PlotterMachine& found) {
  // Of a page that is smaller as a whole the pins are nearer and both cords shorter by one share.
  const double pins = found.pin_spacing_mm / stated.pin_spacing_mm;
  const auto cords = [&](model::Side side) {
    return (1.0 + 1e-3 * stated.scale_mm_per_m[side]) / (1.0 + 1e-3 * found.scale_mm_per_m[side]);
  };
  const double left = cords(model::Side::left), right = cords(model::Side::right);
  if (std::abs(pins - 1.0) < kFittedToSheet || std::abs(left - pins) > kSameShare ||
      std::abs(right - pins) > kSameShare)
    return std::nullopt;
  return scaled_page(pins);
}

std::optional<DrawingFailure> exchanged_rows(const TestDrawing& drawing,
                                             const Eigen::VectorXd& found,
                                             const std::vector<bool>& rejected) {
  // Both then within what 4.5 sigmas of a reading and the estimate allow.
  constexpr double kFitsSigmas = 8.0;
  for (std::size_t i = 0; i < rejected.size(); ++i) {
    for (std::size_t j = i + 1; j < rejected.size(); ++j) {
      if (!rejected[i] || !rejected[j]) continue;
      const DrawnMeasure &a = drawing.measures[i], &b = drawing.measures[j];
      const double sigma = kFitsSigmas * std::max(a.sigma_mm, b.sigma_mm);
      if (std::abs(a.value_mm - found[static_cast<Eigen::Index>(j)]) > sigma ||
          std::abs(b.value_mm - found[static_cast<Eigen::Index>(i)]) > sigma)
        continue;
      return DrawingFailure{
          DrawingFailure::Reason::rows_exchanged,
          fmt::format("{} ({:.1f} mm) and {} ({:.1f} mm) fit once they are exchanged: they were "
                      "typed into each other's row. Look at the sheet and correct them",
                      words_of(drawing, i),
                      a.value_mm,
                      words_of(drawing, j),
                      b.value_mm)};
    }
  }
  return std::nullopt;
}

}  // namespace chaintrue::grid
