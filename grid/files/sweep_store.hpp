// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The finished cells of a sweep on disk, so that it can be stopped at any moment, resumed, or spread
/// over processes; and the results made of them, with the same bytes in every case.
///
///   DIR/parts/NAME.csv   one line a cell, in any order, each with a check of itself: one that is torn
///                        or damaged counts as not finished
///   DIR/results.csv      every cell, in the order of their numbers
///   DIR/summary.json     every combination: medians and worst values over the repetitions
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "grid/files/sweep_file.hpp"
#include "grid/sweep/run_sweep.hpp"

namespace chaintrue::grid::files {

/// The errors of a cell by their names in files.
inline constexpr std::pair<std::string_view, double sweep::CellResult::*> kCellErrors[] = {
    {"chain_rms_mm", &sweep::CellResult::chain_rms_mm},
    {"chain_max_mm", &sweep::CellResult::chain_max_mm},
    {"tool_rms_mm", &sweep::CellResult::tool_rms_mm},
    {"tool_max_mm", &sweep::CellResult::tool_max_mm},
    {"expected_tool_rms_mm", &sweep::CellResult::expected_tool_rms_mm}};

/// By number; empty if a cell is not finished.
using FinishedCells = std::vector<std::optional<sweep::CellResult>>;

/// Those of every part of the folder; a folder that is not there has none. \throws InputError for parts of
/// another specification.
FinishedCells finished_cells(const std::filesystem::path& directory, const ReadSweep& read);

/// The store of a folder for run_sweep: its parts, and a part of the share's own to append to.
/// \throws InputError as finished_cells(), or if it cannot be written.
sweep::CellStore cells_kept_in(const std::filesystem::path& directory, const ReadSweep& read,
                               const sweep::Share& share);

/// A point of the report's lines: error for one factor's level at one number of points, over all
/// other factors and repetitions.
struct LevelError {
  std::size_t factor = 0;
  std::size_t level = 0;
  std::size_t grid = 0;
  std::uint64_t cells = 0;
  double tool_rms_mm = 0.0;
  double tool_max_mm = 0.0;
};

/// Writes results.csv and summary.json. \returns the data of the report's charts. \throws
/// std::logic_error where a cell is not finished.
std::vector<LevelError> write_results(const sweep::SweepSpec& spec, const FinishedCells& cells,
                                      const std::filesystem::path& directory);

}  // namespace chaintrue::grid::files
