// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/sweep_page.hpp"
#include "grid/containers.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace chaintrue::cli {
namespace {

constexpr std::array<std::string_view, sweep::kFactors> kTitles = {
    "The machine",
    "Hidden effects",
    "The machine that the map is used on",
    "The surface",
    "The spacing of the marks",
    "Distance of the sled from the marks, mm",
    "Noise of length / position, mm",
    "The grid"};

double points_of(const sweep::SweepSpec& spec, std::size_t grid) {
  return spec.grids[grid].columns * spec.grids[grid].rows;
}

Chart panel(const sweep::SweepSpec& spec,
            const std::vector<files::LevelError>& errors,
            std::size_t factor) {
  DataTable lines{"lines", {"level", "points", "rms_mm", "max_mm", "cells"}, {}};
  for (const files::LevelError& error : errors) {
    if (error.factor != factor) continue;
    const std::string level =
        factor + 1 == sweep::kFactors ? "all" : sweep::level_name(spec, factor, error.level);
    lines.rows.push_back({level,
                          points_of(spec, error.grid),
                          error.tool_rms_mm,
                          error.tool_max_mm,
                          static_cast<double>(error.cells)});
  }
  return {.specification = "sweep_lines",
          .title = std::string(kTitles[factor]),
          .caption =
              "Error of the tool over the bed, rms in mm, against the number of points; all other "
              "factors combined.",
          .data = {std::move(lines)}};
}

Table table(const sweep::SweepSpec& spec, const std::vector<files::LevelError>& errors) {
  Table table;
  table.columns = {{"factor"},
                   {"level"},
                   {"points", true},
                   {"rms at the tool, mm", true},
                   {"worst, mm", true},
                   {"cells", true}};
  const auto counts = sweep::level_counts(spec);
  for (const files::LevelError& error : errors) {
    // A factor with one level duplicates the grids.
    if (counts[error.factor] == 1 && error.factor + 1 < sweep::kFactors) continue;
    table.rows.push_back({{std::string(sweep::kFactorNames[error.factor]),
                           sweep::level_name(spec, error.factor, error.level),
                           fmt::format("{:.0f}", points_of(spec, error.grid)),
                           fmt::format("{:.3f}", error.tool_rms_mm),
                           fmt::format("{:.3f}", error.tool_max_mm),
                           fmt::format("{}", error.cells)}});
  }
  return table;
}

/// Pooled over the grids, one for each level of a factor; 0 if nothing was done.
std::vector<double> errors_of_levels(const std::vector<files::LevelError>& errors,
                                     std::size_t factor,
                                     std::size_t levels) {
  std::vector<double> squares(levels, 0.0);
  std::vector<double> cells(levels, 0.0);
  for (const files::LevelError& error : errors) {
    if (error.factor != factor) continue;
    const auto number = static_cast<double>(error.cells);
    squares[error.level] += number * error.tool_rms_mm * error.tool_rms_mm;
    cells[error.level] += number;
  }
  for (std::size_t level = 0; level < levels; ++level)
    squares[level] = cells[level] > 0.0 ? std::sqrt(squares[level] / cells[level]) : 0.0;
  return squares;
}

/// The sweep's answer to its question, a sentence for each varying factor.
std::vector<std::string> answers(const sweep::SweepSpec& spec,
                                 const std::vector<files::LevelError>& errors) {
  const auto counts = sweep::level_counts(spec);
  std::vector<std::string> sentences;
  std::vector<files::LevelError> grids;
  for (const files::LevelError& error : errors) {
    if (error.factor + 1 == sweep::kFactors) grids.push_back(error);
  }
  if (grids.size() > 1) {
    const auto [fewest, most] = grid::minmax_element(grids, [&](const auto& a, const auto& b) {
      return points_of(spec, a.grid) < points_of(spec, b.grid);
    });
    sentences.push_back(fmt::format(
        "From {:.0f} to {:.0f} points the error changes from {:.2f} to {:.2f} mm rms at the tool.",
        points_of(spec, fewest->grid),
        points_of(spec, most->grid),
        fewest->tool_rms_mm,
        most->tool_rms_mm));
  }
  for (std::size_t factor = 0; factor + 1 < sweep::kFactors; ++factor) {
    if (counts[factor] < 2) continue;
    const std::vector<double> rms = errors_of_levels(errors, factor, counts[factor]);
    const auto [least, most] = grid::minmax_element(rms);
    const auto level = [&](auto at) {
      return sweep::level_name(spec, factor, static_cast<std::size_t>(at - rms.begin()));
    };
    // Results that round to the same hundredths are equal in practice.
    if (fmt::format("{:.2f}", *least) == fmt::format("{:.2f}", *most)) {
      sentences.push_back(fmt::format(
          "{}: no difference, {:.2f} mm rms at the tool with each.", kTitles[factor], *least));
      continue;
    }
    sentences.push_back(fmt::format(
        "{}: {} has the smallest error, {:.2f} mm rms at the tool; {} the largest, {:.2f} mm.",
        kTitles[factor],
        level(least),
        *least,
        level(most),
        *most));
  }
  return sentences;
}

}  // namespace

Document sweep_page(const sweep::SweepSpec& spec, const std::vector<files::LevelError>& errors) {
  Document page;
  page.title = spec.name;
  page.subtitle = spec.question;
  const auto counts = sweep::level_counts(spec);
  Section panels{"Error against the number of points", {}};
  for (std::size_t factor = 0; factor < sweep::kFactors; ++factor) {
    const bool varies = counts[factor] > 1 && factor + 1 < sweep::kFactors;
    if (varies) panels.blocks.emplace_back(panel(spec, errors, factor));
  }
  if (panels.blocks.empty()) panels.blocks.emplace_back(panel(spec, errors, sweep::kFactors - 1));
  page.verdict = {fmt::format("{} cells: {} combinations, {} repetitions each.",
                              sweep::cells(spec),
                              sweep::combinations(spec),
                              spec.repetitions)};
  for (std::string& line : answers(spec, errors)) page.advice.push_back({std::move(line)});
  page.not_proved = {"Made with the simulator; a real machine has errors that it does not model."};
  page.sections.push_back(std::move(panels));
  page.sections.push_back({"Numbers", {table(spec, errors)}});
  return page;
}

}  // namespace chaintrue::cli
