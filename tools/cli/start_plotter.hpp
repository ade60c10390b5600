// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The files of start for a V-plotter: the page to draw, the sheet of what to measure on it, and
/// the drawing file to fill in.
#pragma once

#include <memory>
#include <string>

#include "grid/files/plotter_settings.hpp"
#include "grid/plotter/plotter_map.hpp"
#include "tools/cli/input_file.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {

/// A chaintrue_plotter, or settings that only a V-plotter has.
[[nodiscard]] bool is_of_a_plotter(const InputFile& file);

/// A chaintrue_plotter, or the settings of a V-plotter's controller. \throws InputError with
/// every problem.
[[nodiscard]] files::ReadPlotter load_plotter(const InputFile& file);
/// The map from its drawing. \throws InputError if no drawing was measured, or if its page
/// cannot be drawn.
[[nodiscard]] std::unique_ptr<const grid::PlotterMap> load_plotter_map(
    const InputFile& file, const grid::KnownPlotter& plotter);

/// Next to the plotter's file if `folder` is empty. A measured plotter is assumed to have the
/// numbers of export plotter typed in.
int start_plotter(Verb verb, const InputFile& file, std::string folder);

}  // namespace chaintrue::cli
