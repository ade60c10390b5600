// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What start makes for a V-plotter: the page that it draws, the sheet of what to measure on it, and
/// the drawing to fill in.
#pragma once

#include <memory>
#include <string>

#include "grid/files/plotter_settings.hpp"
#include "grid/plotter/plotter_map.hpp"
#include "tools/cli/input_file.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {

/// A chaintrue_plotter, or settings that are of nothing else than a V-plotter.
[[nodiscard]] bool is_of_a_plotter(const InputFile& file);

/// A chaintrue_plotter, or the settings of a V-plotter's controller. \throws files::InputError with
/// every problem.
[[nodiscard]] grid::files::ReadPlotter load_plotter(const InputFile& file);
/// What a drawing found of it, as a map. \throws files::InputError where no drawing was measured, or
/// where its page cannot be drawn.
[[nodiscard]] std::unique_ptr<const grid::PlotterMap> load_plotter_map(
    const InputFile& file, const grid::KnownPlotter& plotter);

/// With `folder` empty next to the plotter's own file. A plotter that was measured is taken as it is
/// once the numbers of export plotter are typed in.
int start_plotter(Verb verb, const InputFile& file, std::string folder);

}  // namespace chaintrue::cli
