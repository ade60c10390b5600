// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Makes a diagnosis from the options of `chaintrue diagnose` and its input.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "grid/diagnosis/diagnosis.hpp"
#include "tools/cli/grid_input.hpp"
#include "tools/cli/input_file.hpp"

namespace chaintrue::cli {

struct DiagnoseCommand {
  GridInput input;
  files::TapeOptions tape;
  std::vector<std::string> with;
  std::string output;
  std::string report;
  std::string extended_machine;
  std::string corrected_grid;
  std::string law;
  std::string held_out;
  std::string assume_order;
  bool accept_class = false;
  bool without_gain = false;
  std::string without;  ///< points of belts, from 1
  std::uint64_t seed = 1;
  bool json = false;
};

// Each throws Failed if there is no diagnosis.

/// Grids and holes; an order that was assumed is put into `measured`.
[[nodiscard]] Diagnosis diagnosed(const DiagnoseCommand& command, grid::Measured& measured);
/// Belts are diagnosed by themselves, on the machine in their own file.
[[nodiscard]] Diagnosis diagnosed_belts(const DiagnoseCommand& command, const InputFile& file);
/// A test drawing is diagnosed alone, with the plotter in its file.
[[nodiscard]] Diagnosis diagnosed_drawing(const DiagnoseCommand& command, const InputFile& file);

/// Without its folders.
[[nodiscard]] std::string file_name(const std::string& path);

}  // namespace chaintrue::cli
